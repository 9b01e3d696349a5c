#!/usr/bin/env python3
"""Writes a copy of a .glb file that other renderers define as this one does, with a camera and a lamp, for gltf_to_mitsuba.py.

usage: staged_copy.py IN.glb OUT.glb --eye X,Y,Z --target X,Y,Z [--fov DEGREES] [--size WxH]
                      [--lamp X,Y,Z [--lamp-size M] [--radiance L]]

What is not a solid of KHR_materials_volume loses what they define otherwise: dielectrics their coat, panes their passage, metals
their colour (they become white; those darker than 10% dull), all their normal textures. The lamp is a square that faces the
target. Needs numpy.
"""
import argparse
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / 'scenes'))
from gltf_writer import emitter, looking, upright  # noqa: E402
from shapes import square  # noqa: E402

import numpy as np  # noqa: E402

from glb_file import pack_glb, read_glb  # noqa: E402


def simplify(material):
    extensions = material.setdefault('extensions', {})
    if extensions.get('KHR_materials_volume', {}).get('thicknessFactor', 0) > 0:
        return
    pbr = material.setdefault('pbrMetallicRoughness', {})
    material.pop('normalTexture', None)
    extensions.pop('KHR_materials_transmission', None)
    base = pbr.get('baseColorFactor', [1, 1, 1, 1])
    if pbr.get('metallicFactor', 1) == 1 and 'metallicRoughnessTexture' not in pbr and max(base[:3]) > 0.1:
        pbr.pop('baseColorTexture', None)
        pbr['baseColorFactor'] = [1, 1, 1, 1]
        return
    pbr['metallicFactor'] = 0
    pbr.pop('metallicRoughnessTexture', None)
    extensions['KHR_materials_specular'] = dict(specularFactor=0)


class Copy:
    def __init__(self, path):
        self.json, binary = read_glb(path)
        self.blob = bytearray(binary)
        self.blob += bytes(-len(self.blob) % 4)

    def add(self, kind, value):
        self.json.setdefault(kind, []).append(value)
        return len(self.json[kind]) - 1

    def place(self, **node):
        self.json['scenes'][self.json.get('scene', 0)]['nodes'].append(self.add('nodes', node))

    def accessor(self, array, **description):
        view = self.add('bufferViews', dict(buffer=0, byteOffset=len(self.blob), byteLength=array.nbytes))
        self.blob += array.tobytes()
        return self.add('accessors', dict(bufferView=view, **description))

    def lamp(self, size, position, target, radiance):
        mesh = square(size)
        p = mesh.positions.astype('<f4')
        positions = self.accessor(p, componentType=5126, count=len(p), type='VEC3', min=p.min(axis=0).tolist(), max=p.max(axis=0).tolist())
        indices = self.accessor(mesh.triangles.astype('<u4'), componentType=5125, count=mesh.triangles.size, type='SCALAR')
        primitive = dict(attributes=dict(POSITION=positions), indices=indices, material=self.add('materials', emitter(radiance)))
        self.place(name='lamp', translation=position, rotation=upright(np.subtract(target, position)), mesh=self.add('meshes', dict(primitives=[primitive])))

    def bytes(self):
        used = {name for m in self.json['materials'] for name in m['extensions']}
        self.json['extensionsUsed'] = sorted(used | set(self.json.get('extensionsUsed', [])))
        self.json['buffers'][0]['byteLength'] = len(self.blob)
        return pack_glb(self.json, self.blob)


def main():
    vector = lambda s: [float(v) for v in s.split(',')]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('input', type=Path)
    parser.add_argument('output', type=Path)
    parser.add_argument('--eye', type=vector, required=True)
    parser.add_argument('--target', type=vector, required=True)
    parser.add_argument('--fov', type=float, default=40)
    parser.add_argument('--size', type=lambda s: [int(v) for v in s.split('x')], default=[128, 128])
    parser.add_argument('--lamp', type=vector)
    parser.add_argument('--lamp-size', type=float, default=1)
    parser.add_argument('--radiance', type=float, default=10)
    a = parser.parse_args()
    copy = Copy(a.input)
    for material in copy.json['materials']:
        simplify(material)
    perspective = dict(yfov=np.radians(a.fov), aspectRatio=a.size[0] / a.size[1], znear=0.01)
    camera = dict(type='perspective', perspective=perspective, extras=dict(resolution=a.size))
    copy.place(name='staged', camera=copy.add('cameras', camera), **looking(a.eye, a.target))
    if a.lamp:
        copy.lamp(a.lamp_size, a.lamp, a.target, a.radiance)
    a.output.write_bytes(copy.bytes())


if __name__ == '__main__':
    main()
