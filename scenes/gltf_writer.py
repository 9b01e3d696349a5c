"""Materials, nodes and the .glb file for generate.py."""
import json
import math
import struct
from dataclasses import dataclass, field

import numpy as np

from shapes import Mesh, square

FLOAT, UINT16, UINT32, VERTICES, INDICES = 5126, 5123, 5125, 34962, 34963  # of the glTF specification


def _material(base, metallic=0, roughness=1, double_sided=False, **extensions):
    return dict(doubleSided=double_sided, extensions={f'KHR_materials_{k}': v for k, v in extensions.items()},
                pbrMetallicRoughness=dict(baseColorFactor=[*base, 1], metallicFactor=metallic, roughnessFactor=roughness))


def lambert(r, g, b):
    """Exactly Lambertian: specularFactor 0 takes the dielectric coat away."""
    return _material((r, g, b), double_sided=True, specular=dict(specularFactor=0))


def emitter(radiance, albedo=0, color=(1, 1, 1)):
    """One-sided; a lamp (albedo 0) reflects nothing. Radiance is that of a channel where color is 1."""
    material = _material((albedo,) * 3, specular=dict(specularFactor=0), emissive_strength=dict(emissiveStrength=radiance))
    return material | dict(emissiveFactor=list(color))


def glass(ior, absorption=None, roughness=0, abbe=None):
    """A solid; absorption is (colour, metres after which that colour is left), abbe the number V_d of a dispersive one."""
    volume = dict(thicknessFactor=1)  # any value > 0 says solid
    if absorption:
        volume |= dict(attenuationColor=list(absorption[0]), attenuationDistance=absorption[1])
    dispersion = dict(dispersion=dict(dispersion=20 / abbe)) if abbe else {}
    return _material((1, 1, 1), roughness=roughness, transmission=dict(transmissionFactor=1), ior=dict(ior=ior), volume=volume, **dispersion)


def thin_glass(r, g, b):
    """A pane: passes light unbent, tinted."""
    return _material((r, g, b), roughness=0, double_sided=True, transmission=dict(transmissionFactor=1), ior=dict(ior=1.5))


def metal(r, g, b, roughness=0, double_sided=False):
    return _material((r, g, b), metallic=1, roughness=roughness, double_sided=double_sided)


@dataclass
class Node:
    name: str
    translation: tuple = None
    rotation: tuple = None  # quaternion x, y, z, w
    scale: float = None
    mesh: Mesh = None
    material: dict = None
    camera: dict = None
    light: dict = None
    extras: dict = field(default_factory=dict)


def quaternion(x, y, z):
    """Of the rotation whose matrix has these columns."""
    m = np.stack([x, y, z], axis=1)
    # The eigenvector of the largest eigenvalue (Bar-Itzhack 2000): sound for every rotation, half turns included.
    k = np.array([[m[0, 0] - m[1, 1] - m[2, 2], m[0, 1] + m[1, 0], m[0, 2] + m[2, 0], m[2, 1] - m[1, 2]],
                  [0, m[1, 1] - m[0, 0] - m[2, 2], m[1, 2] + m[2, 1], m[0, 2] - m[2, 0]],
                  [0, 0, m[2, 2] - m[0, 0] - m[1, 1], m[1, 0] - m[0, 1]],
                  [0, 0, 0, m[0, 0] + m[1, 1] + m[2, 2]]])
    q = np.linalg.eigh(k, UPLO='U')[1][:, -1]
    return tuple(float(v) for v in q / math.copysign(np.linalg.norm(q), q[3]))


def _frame(main, hint):
    """Unit main, and two axes such that (first, main, second) is right-handed."""
    main = np.array(main, float) / np.linalg.norm(main)
    first = np.cross(main, hint)
    first /= np.linalg.norm(first)
    return first, main, np.cross(first, main)


def looking(eye, target):
    """Placement of a camera, spot or directional light, which look along their -Z."""
    behind = np.subtract(eye, target)
    x, back, down = _frame(behind, (0, -1, 0) if np.any(behind[[0, 2]]) else (0, 0, 1))
    return dict(translation=eye, rotation=quaternion(x, -down, back))


def camera(eye, target, yfov_degrees, width=512, height=512):
    perspective = dict(yfov=math.radians(yfov_degrees), aspectRatio=width / height, znear=0.01)
    return Node('camera', **looking(eye, target),
                camera=dict(type='perspective', perspective=perspective, extras=dict(resolution=[width, height])))


def upright(direction):
    """Rotation that takes +Y to a direction."""
    hint = (0, 0, 1) if abs(direction[2]) < 0.9 * np.linalg.norm(direction) else (1, 0, 0)
    return quaternion(*_frame(direction, hint))


def lamp(size, position, toward, radiance, name='light', color=(1, 1, 1)):
    """A square one-sided lamp that faces a point."""
    return Node(name, position, upright(np.subtract(toward, position)), mesh=square(size), material=emitter(radiance, color=color))


def sun(irradiance, direction):
    """A directional light that shines along the direction."""
    return Node('sun', **looking((0, 0, 0), direction), light=dict(type='directional', intensity=irradiance))


def spot_light(name, position, toward, intensity, inner_degrees, outer_degrees, color=None):
    cone = dict(innerConeAngle=math.radians(inner_degrees), outerConeAngle=math.radians(outer_degrees))
    tint = dict(color=list(color)) if color else {}
    return Node(name, **looking(position, toward), light=dict(type='spot', intensity=intensity, spot=cone, **tint))


def point_light(name, position, intensity, color=(1, 1, 1)):
    return Node(name, position, light=dict(type='point', color=list(color), intensity=intensity))


class _Glb:
    def __init__(self, scene_name):
        self.blob = bytearray()
        self.extensions = set()
        self.meshes = {}
        self.json = dict(asset=dict(version='2.0', generator='scenes/generate.py'), scene=0,
                         scenes=[dict(name=scene_name, nodes=[])], nodes=[], meshes=[], materials=[], accessors=[], bufferViews=[])

    def add(self, kind, value):
        self.json.setdefault(kind, []).append(value)
        return len(self.json[kind]) - 1

    def accessor(self, array, component, kind, target, **bounds):
        data = array.tobytes()
        view = self.add('bufferViews', dict(buffer=0, byteOffset=len(self.blob), byteLength=len(data), target=target))
        self.blob += data + bytes(-len(data) % 4)
        count = array.size if kind == 'SCALAR' else len(array)
        return self.add('accessors', dict(bufferView=view, componentType=component, count=count, type=kind, **bounds))

    def mesh(self, node):
        """Nodes that share a Mesh object and a material share it in the file."""
        key = (id(node.mesh), json.dumps(node.material, sort_keys=True))
        if key not in self.meshes:
            self.meshes[key] = self.new_mesh(node)
        return self.meshes[key]

    def new_mesh(self, node):
        p, n = (a.astype('<f4') for a in (node.mesh.positions, node.mesh.normals))
        short = len(p) < 65535  # 65535 itself would restart the primitive
        attributes = dict(POSITION=self.accessor(p, FLOAT, 'VEC3', VERTICES, min=p.min(axis=0).tolist(), max=p.max(axis=0).tolist()),
                          NORMAL=self.accessor(n, FLOAT, 'VEC3', VERTICES))
        indices = self.accessor(node.mesh.triangles.astype('<u2' if short else '<u4'), UINT16 if short else UINT32, 'SCALAR', INDICES)
        primitive = dict(attributes=attributes, indices=indices, material=self.material(node))
        return self.add('meshes', dict(name=node.name, primitives=[primitive]))

    def material(self, node):
        material = {k: v for k, v in node.material.items() if k != 'extensions' or v}
        self.extensions |= set(node.material['extensions'])
        for i, known in enumerate(self.json['materials']):
            if known | dict(name=None) == material | dict(name=None):
                return i
        return self.add('materials', dict(name=node.name, **material))

    def light(self, node):
        self.extensions.add('KHR_lights_punctual')
        lights = self.json.setdefault('extensions', {}).setdefault('KHR_lights_punctual', dict(lights=[]))['lights']
        lights.append(dict(name=node.name, **node.light))
        return dict(KHR_lights_punctual=dict(light=len(lights) - 1))

    def node(self, node):
        entry = dict(name=node.name)
        if node.translation is not None:
            entry['translation'] = [float(v) for v in node.translation]
        if node.rotation is not None:
            entry['rotation'] = list(node.rotation)
        if node.scale is not None:
            entry['scale'] = [node.scale] * 3
        if node.mesh is not None:
            entry['mesh'] = self.mesh(node)
        if node.camera is not None:
            entry['camera'] = self.add('cameras', dict(name=node.name, **node.camera))
        if node.light is not None:
            entry['extensions'] = self.light(node)
        if node.extras:
            entry['extras'] = node.extras
        self.json['scenes'][0]['nodes'].append(self.add('nodes', entry))

    def bytes(self):
        self.json['extensionsUsed'] = sorted(self.extensions)
        self.json['buffers'] = [dict(byteLength=len(self.blob))]
        text = json.dumps(self.json, separators=(',', ':')).encode()
        text += b' ' * (-len(text) % 4)
        header = struct.pack('<4sII', b'glTF', 2, 28 + len(text) + len(self.blob))
        return header + struct.pack('<I4s', len(text), b'JSON') + text + struct.pack('<I4s', len(self.blob), b'BIN\0') + self.blob


def write_glb(path, scene_name, nodes):
    glb = _Glb(scene_name)
    for node in nodes:
        glb.node(node)
    path.write_bytes(glb.bytes())
