"""A Mitsuba scene, as far as LuxCore can express it alike, as LuxCore's properties. Needs numpy, not LuxCore.

Known are: a perspective sensor with a box filter, PLY meshes, diffuse, dielectric, conductor (of material none), media
that only absorb, area, point, directional and hard-edged spot lights. All else is refused: LuxCore's rough metals and
glasses, for one, have Schlick's distribution of facets in place of GGX.
"""
import math
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from pathlib import Path

import numpy as np

SOFT = .1  # degrees: a spot's softer edge differs too much, LuxCore's goes as the fourth power, Mitsuba's as the angle


class Inexpressible(Exception):
    """LuxCore lacks it or it is not known here; the message is one line that names the element."""


class Plugin:
    """An element with its parameters and the plugins in it, each to be taken once; done() refuses what is left."""

    def __init__(self, element, defaults):
        self.type = element.get('type')
        self.what = ' '.join(filter(None, (element.tag, f'"{self.type}"', element.get('id'))))
        self.left = {}
        for child in element:
            key = child.get('name') or child.tag
            if key in self.left:
                raise Inexpressible(f'{self.what}: a second {key}')
            self.left[key] = Plugin(child, defaults) if child.get('type') else self.parameter(child, defaults)

    def parameter(self, child, defaults):
        text = child.get('value', '')
        text = defaults[text[1:]] if text.startswith('$') else text
        match child.tag:
            case 'string':
                return text
            case 'float' | 'integer':
                return float(text) if child.tag == 'float' else int(text)
            case 'rgb':
                values = [float(v) for v in text.replace(',', ' ').split()]
                return values * 3 if len(values) == 1 else values
            case 'point' | 'vector':
                return [float(child.get(axis)) for axis in 'xyz']
            case 'transform' if [step.tag for step in child] == ['matrix']:
                return np.reshape([float(v) for v in child[0].get('value').split()], (4, 4))
        raise Inexpressible(f'{self.what}: {child.tag} "{child.get("name", "")}" is not known here')

    def take(self, name, *default):
        if name not in self.left and not default:
            raise Inexpressible(f'{self.what}: has no {name}')
        return self.left.pop(name, *default)

    def refuse(self, why='is not known here'):
        raise Inexpressible(f'{self.what}: {why}')

    def done(self):
        for name, value in self.left.items():
            self.refuse(f'{value.what if isinstance(value, Plugin) else name} is not known here')


@dataclass
class Translation:
    width: int
    height: int
    properties: dict  # name -> number, word or list
    meshes: list  # the PLY files of what does not shine
    caustics: bool  # whether anything is a mirror or glass

    def view_height(self):
        """Metres that the picture's height spans as far away as the middle of the scene, lamps aside."""
        points = np.concatenate([np.array(extent(mesh)) for mesh in self.meshes])
        middle = (points.min(0) + points.max(0)) / 2
        distance = np.linalg.norm(middle - self.properties['scene.camera.lookat.orig'])
        _, _, bottom, top = self.properties['scene.camera.screenwindow']
        half_angle = math.radians(self.properties['scene.camera.fieldofview']) / 2
        return float(distance * (top - bottom) * math.tan(half_angle))


def extent(ply):
    """The corners (lowest, highest) of a binary PLY file's bounding box."""
    header, _, data = ply.read_bytes().partition(b'end_header\n')
    lines = [line.split() for line in header.decode().splitlines()]
    count = next(int(words[2]) for words in lines if words[:2] == ['element', 'vertex'])
    columns = sum(words[:2] == ['property', 'float'] for words in lines)  # all the vertex's, as positions come first
    vertices = np.frombuffer(data, '<f4', count * columns).reshape(count, columns)[:, :3]
    return vertices.min(0), vertices.max(0)


def camera(sensor):
    """(width, height, properties)"""
    film, frame, axis = sensor.take('film'), sensor.take('to_world'), sensor.take('fov_axis', 'x')
    width, height = film.take('width'), film.take('height')
    for name, expected in ('pixel_format', 'rgb'), ('component_format', 'float32'):
        if film.take(name, expected) != expected:
            film.refuse(f'{name} other than {expected}')
    if film.take('rfilter').type != 'box':
        film.refuse('a filter other than box')
    film.done()
    if sensor.type != 'perspective' or axis not in ('x', 'y'):
        sensor.refuse(f'fov_axis {axis} is not known here')
    _, up, forward, origin = frame[:3].T
    turn = frame[:3, :3]
    if not np.allclose(turn.T @ turn, np.eye(3), atol=1e-4) or np.linalg.det(turn) < 0:
        sensor.refuse('to_world scales, shears or mirrors')
    x, y = (width / height, 1) if axis == 'y' else (1, height / width)
    row = 2 * y / height  # LuxCore counts rows from the second: all would lie one too low
    properties = {'type': 'perspective', 'lookat.orig': origin, 'lookat.target': origin + forward, 'up': up,
                  'fieldofview': sensor.take('fov'), 'screenwindow': [-x, x, -y - row, y - row],
                  'cliphither': sensor.take('near_clip', .01), 'clipyon': sensor.take('far_clip', 1e4),
                  'autofocus.enable': False, 'lensradius': 0.}
    sensor.take('sampler', None)
    sensor.done()
    return width, height, {f'scene.camera.{k}': v for k, v in properties.items()}


def absorption(medium):
    """Per metre."""
    if medium.type != 'homogeneous' or np.any(medium.take('albedo', .75)):
        medium.refuse('scatters')
    sigma = np.broadcast_to(np.multiply(medium.take('sigma_t', 1.), medium.take('scale', 1.)), 3)
    medium.done()
    return sigma


def material(bsdf):
    if bsdf.type == 'twosided':  # as LuxCore's matte and mirror always are
        inner = bsdf.take('bsdf')
        if inner.type not in ('diffuse', 'conductor'):
            inner.refuse()
        bsdf.done()
        return material(inner)
    white = [1.] * 3
    if bsdf.type == 'diffuse':
        properties = {'type': 'matte', 'kd': bsdf.take('reflectance')}
    elif bsdf.type == 'dielectric':
        properties = {'type': 'glass', 'interiorior': bsdf.take('int_ior'), 'exteriorior': bsdf.take('ext_ior'),
                      'kr': bsdf.take('specular_reflectance', white), 'kt': bsdf.take('specular_transmittance', white)}
    elif bsdf.type == 'conductor' and bsdf.take('material', None) == 'none':
        properties = {'type': 'mirror', 'kr': bsdf.take('specular_reflectance', white)}
    else:
        bsdf.refuse()
    bsdf.done()
    return properties


def shape(plugin, name, folder):
    if plugin.type != 'ply':
        plugin.refuse()
    mesh, look = folder / plugin.take('filename'), material(plugin.take('bsdf'))
    properties = {f'scene.shapes.{name}.type': 'mesh', f'scene.shapes.{name}.ply': str(mesh),
                  f'scene.objects.{name}.shape': name, f'scene.objects.{name}.material': name}
    emitter, inside = plugin.take('emitter', None), plugin.take('interior', None)
    plugin.done()
    if emitter:
        if emitter.type != 'area':
            emitter.refuse()
        look |= {'emission': emitter.take('radiance'), 'emission.gain': [1.] * 3}
        emitter.done()
    if inside:  # its index takes the place of the material's, whose name it must not have
        look['volume.interior'] = f'{name}_inside'
        volume = {'type': 'clear', 'absorption': absorption(inside), 'ior': look.get('interiorior', 1.)}
        properties |= {f'scene.volumes.{name}_inside.{k}': v for k, v in volume.items()}
    return properties | {f'scene.materials.{name}.{k}': v for k, v in look.items()}


def spot(emitter):
    """LuxCore's intensity grows as 1 / cos off the axis. Its power is kept: for 18 degrees, 2.5% are lacking at the
    axis, and as much is in excess at the edge."""
    outer = emitter.take('cutoff_angle')
    if emitter.take('beam_width') < outer - SOFT:
        emitter.refuse('has a soft edge')
    _, _, forward, origin = emitter.take('to_world')[:3].T
    edge = math.cos(math.radians(outer))
    return {'type': 'spot', 'position': origin, 'target': origin + forward, 'color': emitter.take('intensity'),
            'gain': [(1 - edge) / -math.log(edge)] * 3, 'coneangle': outer, 'conedeltaangle': 1e-3}


def light(emitter, name, bidirectional):
    if emitter.type == 'point':  # its gain is power, unlike the others'
        properties = {'type': 'point', 'position': emitter.take('position'), 'color': emitter.take('intensity'),
                      'gain': [4 * math.pi] * 3}
    elif emitter.type == 'spot':
        properties = spot(emitter)
    elif emitter.type == 'directional':
        if bidirectional:
            emitter.refuse('is a tenth too dark in BIDIRCPU')
        properties = {'type': 'sharpdistant', 'direction': emitter.take('direction'),
                      'color': emitter.take('irradiance'), 'gain': [1.] * 3}
    else:
        emitter.refuse()
    emitter.done()
    return {f'scene.lights.{name}.{k}': v for k, v in properties.items()}


def translate(xml, folder=Path(), bidirectional=False):
    """xml: the text of a Mitsuba scene. folder: that of its meshes. bidirectional: whether BIDIRCPU is to render it.
    Integrators are left to the caller."""
    root = ElementTree.fromstring(xml)
    defaults = {e.get('name'): e.get('value') for e in root if e.tag == 'default'}
    size, properties, meshes = None, {}, []
    for number, element in enumerate(root):
        if element.tag in ('default', 'integrator'):
            continue
        plugin = Plugin(element, defaults)
        if element.tag == 'sensor' and not size:
            *size, its = camera(plugin)
        elif element.tag == 'shape':
            name = f'shape{number}'
            its = shape(plugin, name, folder)
            if f'scene.materials.{name}.emission' not in its:
                meshes.append(Path(its[f'scene.shapes.{name}.ply']))
        elif element.tag == 'emitter':
            its = light(plugin, f'light{number}', bidirectional)
        else:
            plugin.refuse()
        properties |= its
    if not size:
        raise Inexpressible('the scene has no sensor')
    caustics = any(k.startswith('scene.materials.') and v in ('glass', 'mirror') for k, v in properties.items()
                   if k.endswith('.type'))
    return Translation(*size, {k: np.asarray(v).tolist() for k, v in properties.items()}, meshes, caustics)
