#!/usr/bin/env python3
"""Renders a glTF scene with Mitsuba 3, for the materials that both define alike.

usage: gltf_to_mitsuba.py SCENE.glb -o PICTURE.exr [--spp N] [--seed K] [--size WxH] [--camera NAME] [--integrator volpath]

Writes PICTURE.exr and its two independent halves PICTURE.a.exr and PICTURE.b.exr. Alike are: Lambert's diffuse (glTF's
dielectric of specularFactor 0; with --coats-as-diffuse any, without its coat), solids of KHR_materials_volume with their
roughness (constant or textured) and attenuation, alone or touching where they share triangles, white metals (Mitsuba has no
Schlick), emissive meshes, point, spot and directional lights. All else is refused. Needs mitsuba, Pillow, numpy and OpenEXR 3.3; DRJIT_LIBLLVM_PATH names an LLVM other than 15.
"""
import argparse
import io
import math
import sys
from dataclasses import dataclass
from pathlib import Path

import mitsuba as mi
import numpy as np
import OpenEXR
from PIL import Image

from glb_file import read_glb

DEPTH = 64
COMPONENTS = dict(SCALAR=1, VEC2=2, VEC3=3, VEC4=4)
TYPES = {5120: 'i1', 5121: 'u1', 5122: '<i2', 5123: '<u2', 5125: '<u4', 5126: '<f4'}


class Glb:
    def __init__(self, path):
        self.json, self.binary = read_glb(path)

    def view(self, index):
        v = self.json['bufferViews'][index]
        begin = v.get('byteOffset', 0)
        return self.binary[begin:begin + v['byteLength']], v.get('byteStride')

    def accessor(self, index):
        a = self.json['accessors'][index]
        data, stride = self.view(a['bufferView'])
        dtype, n = np.dtype(TYPES[a['componentType']]), COMPONENTS[a['type']]
        out = np.ndarray((a['count'], n), dtype, data, a.get('byteOffset', 0), (stride or n * dtype.itemsize, dtype.itemsize))
        return out / np.iinfo(dtype).max if a.get('normalized') else out

    def image(self, texture):
        image = self.json['images'][self.json['textures'][texture]['source']]
        return np.asarray(Image.open(io.BytesIO(self.view(image['bufferView'])[0])).convert('RGB'))


def local(node):
    if 'matrix' in node:
        return np.reshape(node['matrix'], (4, 4)).T
    x, y, z, w = node.get('rotation', (0, 0, 0, 1))
    m = np.eye(4)
    m[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                 [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                 [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    m[:3, :3] *= node.get('scale', (1, 1, 1))
    m[:3, 3] = node.get('translation', (0, 0, 0))
    return m


def placed(glb):
    """All nodes of the scene with their matrices."""
    stack = [(n, np.eye(4)) for n in glb.json['scenes'][glb.json.get('scene', 0)]['nodes']]
    while stack:
        index, parent = stack.pop()
        node = glb.json['nodes'][index]
        world = parent @ local(node)
        stack += [(child, world) for child in node.get('children', ())]
        yield node, world


def rgb(value):
    return dict(type='rgb', value=[float(v) for v in value])


class Materials:
    def __init__(self, glb, coats_as_diffuse, channel):
        self.glb, self.coats_as_diffuse, self.channel = glb, coats_as_diffuse, channel

    def base_color(self, pbr):
        factor = pbr.get('baseColorFactor', (1, 1, 1, 1))[:3]
        if 'baseColorTexture' not in pbr:
            return rgb(factor)
        return self.bitmap(pbr['baseColorTexture']['index'], lambda c: srgb_to_linear(c) * factor)

    def bitmap(self, texture, change):
        values = change(self.glb.image(texture).astype(np.float32) / 255).astype(np.float32)
        return dict(type='bitmap', bitmap=mi.Bitmap(np.ascontiguousarray(values)), raw=True)

    def alpha(self, pbr):
        factor = pbr.get('roughnessFactor', 1)
        if 'metallicRoughnessTexture' not in pbr:
            return factor ** 2
        # Interpolated squares are not squares of interpolated values: exact where the texture is even.
        return self.bitmap(pbr['metallicRoughnessTexture']['index'], lambda c: np.maximum((factor * c[..., 1:2]) ** 2, 1e-4))

    def of(self, index):
        """(bsdf, interior medium or None, radiance)"""
        m = self.glb.json['materials'][index] if index is not None else {}
        extensions, pbr = m.get('extensions', {}), m.get('pbrMetallicRoughness', {})
        ext = lambda name: extensions.get('KHR_materials_' + name, {})
        strength = ext('emissive_strength').get('emissiveStrength', 1)
        radiance = [strength * e for e in m.get('emissiveFactor', (0, 0, 0))]
        if ext('transmission').get('transmissionFactor', 0) == 1 and ext('volume').get('thicknessFactor', 0) > 0:
            return self.solid(pbr, ext('ior').get('ior', 1.5), ext('volume')) + (radiance,)
        if pbr.get('metallicFactor', 1) == 1 and 'metallicRoughnessTexture' not in pbr and 'baseColorTexture' not in pbr:
            if pbr.get('baseColorFactor', [1])[:3] != [1, 1, 1]:
                raise SystemExit(f'{m.get("name")}: a metal that is not white')
            alpha = pbr.get('roughnessFactor', 1) ** 2
            metal = dict(type='roughconductor', material='none', distribution='ggx', alpha=alpha) if alpha else dict(type='conductor', material='none')
            return dict(type='twosided', bsdf=metal), None, radiance
        if not self.coats_as_diffuse and ext('specular').get('specularFactor', 1) != 0:
            raise SystemExit(f'{m.get("name")}: a dielectric with a coat')
        diffuse = dict(type='diffuse', reflectance=self.base_color(pbr))
        return (diffuse if any(radiance) else dict(type='twosided', bsdf=diffuse)), None, radiance

    def solid(self, pbr, ior, volume):
        ior = float(ior)
        tint = self.base_color(pbr)
        rough = 'metallicRoughnessTexture' in pbr or pbr.get('roughnessFactor', 1) > 0
        if rough and ior != 1:
            bsdf = dict(type='roughdielectric', distribution='ggx', alpha=self.alpha(pbr), int_ior=ior, ext_ior=1.0, specular_transmittance=tint)
        else:
            bsdf = dict(type='dielectric', int_ior=ior, ext_ior=1.0, specular_transmittance=tint)
        distance = volume.get('attenuationDistance', math.inf)
        color = volume.get('attenuationColor', (1, 1, 1))[self.channel]
        sigma = -math.log(max(color, 1e-30)) / distance
        return bsdf, dict(type='homogeneous', albedo=0.0, sigma_t=1.0, scale=sigma) if sigma else None


def srgb_to_linear(c):
    return np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)


@dataclass
class Body:
    name: str
    positions: np.ndarray  # n x 3, in the scene's axes
    normals: np.ndarray | None  # n x 3
    coordinates: np.ndarray | None  # n x 2, of textures
    triangles: np.ndarray  # m x 3
    material: tuple  # Materials.of()


def body(glb, primitive, world, material, name):
    """A mirroring node turns triangles over, which glTF's winding rule undoes."""
    attributes = primitive['attributes']
    positions = glb.accessor(attributes['POSITION']) @ world[:3, :3].T + world[:3, 3]
    triangles = glb.accessor(primitive['indices']).reshape(-1, 3) if 'indices' in primitive else np.arange(len(positions)).reshape(-1, 3)
    if np.linalg.det(world[:3, :3]) < 0:
        triangles = triangles[:, [0, 2, 1]]
    normals = glb.accessor(attributes['NORMAL']) @ np.linalg.inv(world[:3, :3]) if 'NORMAL' in attributes else None
    coordinates = glb.accessor(attributes['TEXCOORD_0']) if 'TEXCOORD_0' in attributes else None
    return Body(name, positions, normals, coordinates, triangles, material)


def is_solid(one):
    return one.material[0]['type'] in ('dielectric', 'roughdielectric')


def interfaces(bodies):
    """(body, some of its triangles, what lies before them or None): where two solids share triangles, one of the two has
    them, and the other is what lies before them. Solids that overlap are not told, as Mitsuba has no priorities."""
    def corners(one):
        return [frozenset(map(tuple, np.round(one.positions[t], 5))) for t in one.triangles]

    solids = [one for one in bodies if is_solid(one)]
    owners = {}  # of each triangle that is a solid's
    for number, one in enumerate(solids):
        for key in corners(one):
            owners.setdefault(key, []).append(number)
    yield from ((one, one.triangles, None) for one in bodies if not is_solid(one))
    for number, one in enumerate(solids):
        before = np.array([next((k for k in owners[key] if k != number), -1) for key in corners(one)])
        for other in sorted(set(before[(before > number) | (before == -1)])):
            yield one, one.triangles[before == other], solids[other] if other >= 0 else None


def shape(one, triangles, before, name):
    bsdf, medium, radiance = one.material
    properties = mi.Properties()
    if before:
        bsdf = bsdf | dict(ext_ior=before.material[0]['int_ior'])
        if before.material[1]:
            properties['exterior'] = mi.load_dict(before.material[1])
    properties['bsdf'] = mi.load_dict(bsdf)
    if any(radiance):
        properties['emitter'] = mi.load_dict(dict(type='area', radiance=rgb(radiance)))
    if medium:
        properties['interior'] = mi.load_dict(medium)
    out = mi.Mesh(name, len(one.positions), len(triangles), has_vertex_normals=one.normals is not None,
                  has_vertex_texcoords=one.coordinates is not None, props=properties)
    parameters = mi.traverse(out)
    parameters['vertex_positions'] = one.positions.astype(np.float32).ravel()
    parameters['faces'] = triangles.astype(np.uint32).ravel()
    if one.normals is not None:
        parameters['vertex_normals'] = (one.normals / np.linalg.norm(one.normals, axis=1, keepdims=True)).astype(np.float32).ravel()
    if one.coordinates is not None:
        parameters['vertex_texcoords'] = np.array(one.coordinates, np.float32).ravel()
    parameters.update()
    return out


def light(glb, node, world):
    entry = glb.json['extensions']['KHR_lights_punctual']['lights'][node['extensions']['KHR_lights_punctual']['light']]
    intensity = rgb(np.multiply(entry.get('color', (1, 1, 1)), entry.get('intensity', 1)))
    position, direction = world[:3, 3].tolist(), (-world[:3, 2] / np.linalg.norm(world[:3, 2])).tolist()
    if entry['type'] == 'directional':
        return dict(type='directional', direction=direction, irradiance=intensity)
    if entry['type'] == 'point':
        return dict(type='point', position=position, intensity=intensity)
    cone = entry.get('spot', {})
    to_world = mi.ScalarTransform4f().look_at(position, np.add(position, direction).tolist(), (world[:3, 1]).tolist())
    return dict(type='spot', to_world=to_world, intensity=intensity, **falloff(cone.get('innerConeAngle', 0), cone.get('outerConeAngle', math.pi / 4)))


def falloff(inner, outer):
    """Mitsuba's cone dims along the angle, glTF's along its cosine, squared: that is a picture which an even cone projects."""
    axis = math.tan(outer) * ((np.arange(2048) + 0.5) / 1024 - 1)
    cosine = 1 / np.sqrt(1 + axis ** 2 + axis[:, None] ** 2)
    dimmed = np.clip((cosine - math.cos(outer)) / max(0.001, math.cos(inner) - math.cos(outer)), 0, 1) ** 2
    bitmap = mi.Bitmap(np.repeat(dimmed[..., None], 3, axis=2).astype(np.float32))
    return dict(cutoff_angle=math.degrees(outer), beam_width=math.degrees(outer) * 0.9999, texture=dict(type='bitmap', bitmap=bitmap, raw=True))


def sensor(glb, node, world, size):
    camera = glb.json['cameras'][node['camera']]
    width, height = size or camera.get('extras', {}).get('resolution') or camera['perspective'].get('extras', {}).get('resolution')
    frame = world.copy()
    frame[:3, :3] /= np.linalg.norm(frame[:3, :3], axis=0)
    frame[:3, 0] *= -1  # Mitsuba's camera looks along +Z with +X to the left
    frame[:3, 2] *= -1
    film = dict(type='hdrfilm', width=width, height=height, pixel_format='rgb', component_format='float32', rfilter=dict(type='box'))
    return dict(type='perspective', fov_axis='y', fov=math.degrees(camera['perspective']['yfov']), near_clip=1e-3,
                to_world=mi.ScalarTransform4f(frame), film=film, sampler=dict(type='independent'))


def convert(glb, arguments, channel):
    materials = Materials(glb, arguments.coats_as_diffuse, channel)
    scene = dict(type='scene', integrator=dict(type=arguments.integrator, max_depth=DEPTH))
    bodies = []
    for number, (node, world) in enumerate(placed(glb)):
        if 'mesh' in node:
            for i, primitive in enumerate(glb.json['meshes'][node['mesh']]['primitives']):
                bodies.append(body(glb, primitive, world, materials.of(primitive.get('material')), f'mesh{number}_{i}'))
        if 'KHR_lights_punctual' in node.get('extensions', {}):
            scene[f'light{number}'] = light(glb, node, world)
        if 'camera' in node and 'sensor' not in scene and arguments.camera in (None, node.get('name')):
            scene['sensor'] = sensor(glb, node, world, arguments.size)
    for number, (one, triangles, before) in enumerate(interfaces(bodies)):
        scene[f'{one.name}_{number}'] = shape(one, triangles, before, f'{one.name}_{number}')
    return mi.load_dict(scene)


def render(scene, arguments):
    """Two independent halves."""
    halves = []
    for half in range(2):
        seeds = [arguments.seed * 1000 + half * 500 + i for i in range(arguments.passes)]
        halves.append(sum(np.array(mi.render(scene, spp=arguments.spp // arguments.passes, seed=s), np.float64) for s in seeds) / len(seeds))
    return halves


def write(path, picture):
    """Not by mi.Bitmap, whose writer was seen to hang in a process bound to one core."""
    header = dict(compression=OpenEXR.ZIP_COMPRESSION, type=OpenEXR.scanlineimage)
    OpenEXR.File(header, dict(RGB=np.ascontiguousarray(picture, np.float32))).write(str(path))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('scene', type=Path)
    parser.add_argument('-o', '--output', type=Path, required=True)
    parser.add_argument('--spp', type=int, default=256, help='of each half')
    parser.add_argument('--passes', type=int, default=1, help='that each half is made of, so that memory suffices')
    parser.add_argument('--seed', type=int, default=1)
    parser.add_argument('--size', type=lambda s: [int(v) for v in s.split('x')])
    parser.add_argument('--camera')
    parser.add_argument('--integrator', default='path', help='volpath where solids attenuate')
    parser.add_argument('--variant', default='llvm_ad_rgb')
    parser.add_argument('--coats-as-diffuse', action='store_true')
    arguments = parser.parse_args()
    mi.set_variant(arguments.variant)
    glb = Glb(arguments.scene)
    attenuates = any('attenuationColor' in m.get('extensions', {}).get('KHR_materials_volume', {}) for m in glb.json.get('materials', ()))
    if attenuates:
        # A distance is drawn by one channel and weighs in all, up to e^9 times too much where glass is metres thick: each
        # channel is taken from a picture of its own, with grey media.
        pictures = [render(convert(glb, arguments, c), arguments) for c in range(3)]
        halves = [np.stack([pictures[c][half][..., c] for c in range(3)], axis=-1) for half in range(2)]
    else:
        halves = render(convert(glb, arguments, 0), arguments)
    for suffix, picture in (('', sum(halves) / 2), ('.a', halves[0]), ('.b', halves[1])):
        write(arguments.output.with_suffix(suffix + arguments.output.suffix), picture)
    print('mean', *np.mean(halves, axis=(0, 1, 2)), file=sys.stderr)


if __name__ == '__main__':
    main()
