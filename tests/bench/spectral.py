#!/usr/bin/env python3
"""Holds a dispersing scene against Mitsuba 3, region by region.

usage: spectral.py SCENE.glb OURS.exr [--light] [--wavelengths N] [--spp N] [--blocks N] [--rings X,Z,R1,R2,...]

Mitsuba's dielectric takes no spectral index, so that its picture is a sum of monochromatic ones: at each of N evenly spaced
wavelengths all solids have Cauchy's index there, and the picture is weighed by D65 and the observer's curves (Mitsuba's own) into
linear Rec. 709. --light traces from the lights (for delta lights; what is seen through glass is then missing, so OURS.exr is to be
rendered with --only 'L.*DE'). Prints the flux of each block of the picture and channel, and with --rings that between circles of
these radii around a point of the floor y = 0. Needs mitsuba 3, numpy, OpenEXR 3.3 (pip),
and scenes by generate.py: triangles with positions and normals, nodes without children.
"""
import argparse
import math

import mitsuba as mi
import numpy as np
import OpenEXR

from glb_file import read_glb

REC709 = np.array([[3.2404542, -1.5371385, -0.4985314], [-0.9692660, 1.8760108, 0.0415560], [0.0556434, -0.2040259, 1.0572252]])
COMPONENTS = {5126: '<f4', 5123: '<u2', 5125: '<u4'}
NUMBERS = {'SCALAR': 1, 'VEC3': 3}


class Glb:
    def __init__(self, path):
        self.json, self.blob = read_glb(path)

    def array(self, index):
        a = self.json['accessors'][index]
        start = self.json['bufferViews'][a['bufferView']]['byteOffset']
        n = NUMBERS[a['type']]
        values = np.frombuffer(self.blob, COMPONENTS[a['componentType']], a['count'] * n, start)
        return values.reshape(-1, n)

    def extension(self, thing, name):
        return thing.get('extensions', {}).get(name, {})


def placement(node):
    x, y, z, w = node.get('rotation', (0, 0, 0, 1))
    m = np.eye(4)
    m[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                 [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                 [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    m[:3, :3] *= node.get('scale', (1,))[0]
    m[:3, 3] = node.get('translation', (0, 0, 0))
    return m


def cauchy(ior, dispersion, nm):
    """KHR_materials_dispersion."""
    return max(1, ior + (ior - 1) * dispersion / 20 * (523655 / nm ** 2 - 1.5168))


def material(glb, m, nm):
    if 'KHR_materials_transmission' in m.get('extensions', {}):
        dispersion = glb.extension(m, 'KHR_materials_dispersion').get('dispersion', 0)
        return dict(type='dielectric', int_ior=cauchy(glb.extension(m, 'KHR_materials_ior')['ior'], dispersion, nm), ext_ior=1.0)
    base = m['pbrMetallicRoughness']['baseColorFactor']
    diffuse = dict(type='diffuse', reflectance=dict(type='uniform', value=base[0]))
    return dict(type='twosided', bsdf=diffuse) if m['doubleSided'] else diffuse


def mesh(glb, node, nm):
    primitive = glb.json['meshes'][node['mesh']]['primitives'][0]
    m = glb.json['materials'][primitive['material']]
    world = placement(node)
    positions = glb.array(primitive['attributes']['POSITION']) @ world[:3, :3].T + world[:3, 3]
    normals = glb.array(primitive['attributes']['NORMAL']) @ world[:3, :3].T
    properties = mi.Properties()
    properties['bsdf'] = mi.load_dict(material(glb, m, nm))
    if 'emissiveFactor' in m:
        strength = glb.extension(m, 'KHR_materials_emissive_strength')['emissiveStrength']
        properties['emitter'] = mi.load_dict(dict(type='area', radiance=dict(type='uniform', value=strength * m['emissiveFactor'][0])))
    triangles = glb.array(primitive['indices'])
    out = mi.Mesh(node['name'], len(positions), len(triangles) // 3, has_vertex_normals=True, props=properties)
    params = mi.traverse(out)
    params['vertex_positions'] = positions.ravel().astype(np.float32)
    params['vertex_normals'] = (normals / np.linalg.norm(normals, axis=1, keepdims=True)).ravel().astype(np.float32)
    params['faces'] = triangles.ravel().astype(np.uint32)
    params.update()
    return out


def light(glb, node):
    value = glb.json['extensions']['KHR_lights_punctual']['lights'][node['extensions']['KHR_lights_punctual']['light']]
    m = placement(node)
    position, ahead = m[:3, 3], -m[:3, 2]
    intensity = dict(type='uniform', value=value['intensity'])
    if value['type'] == 'directional':
        return dict(type='directional', direction=ahead.tolist(), irradiance=intensity)
    if value['type'] == 'point':
        return dict(type='point', position=position.tolist(), intensity=intensity)
    inner, outer = (math.degrees(value['spot'][k]) for k in ('innerConeAngle', 'outerConeAngle'))
    to_world = mi.ScalarTransform4f().look_at(position.tolist(), (position + ahead).tolist(), m[:3, 1].tolist())
    return dict(type='spot', to_world=to_world, intensity=intensity, cutoff_angle=outer, beam_width=inner)


def sensor(glb, node, size):
    m = placement(node)
    eye = m[:3, 3]
    to_world = mi.ScalarTransform4f().look_at(eye.tolist(), (eye - m[:3, 2]).tolist(), m[:3, 1].tolist())
    film = dict(type='hdrfilm', width=size[0], height=size[1], rfilter=dict(type='box'), component_format='float32', pixel_format='luminance')
    fov = math.degrees(glb.json['cameras'][node['camera']]['perspective']['yfov'])
    return dict(type='perspective', to_world=to_world, fov=fov, fov_axis='y', film=film)


def scene_at(glb, nm, size):
    out = dict(type='scene')
    for i, node in enumerate(glb.json['nodes']):
        if 'mesh' in node:
            out[f'n{i}'] = mesh(glb, node, nm)
        elif 'camera' in node:
            out[f'n{i}'] = sensor(glb, node, size)
        else:
            out[f'n{i}'] = light(glb, node)
    return mi.load_dict(out)


def weights(count):
    """Wavelengths in nm, and what each weighs in linear Rec. 709: the weights of a channel sum to one."""
    mi.set_variant('scalar_spectral')
    edges = np.linspace(380, 730, count + 1)
    d65 = np.array(mi.traverse(mi.load_dict(dict(type='d65')))['values'])
    d65_nm = np.linspace(360, 830, len(d65))
    out = []
    for low, high in zip(edges, edges[1:]):
        fine = np.linspace(low, high, 33)[:-1] + (high - low) / 64
        xyz = np.array([list(mi.cie1931_xyz(float(nm))) for nm in fine])
        out.append(REC709 @ (xyz * np.interp(fine, d65_nm, d65)[:, None]).sum(axis=0))
    return (edges[:-1] + edges[1:]) / 2, np.array(out) / np.sum(out, axis=0)


def by_blocks(picture, n):
    h, w, _ = picture.shape
    return picture[:h // n * n, :w // n * n].reshape(n, h // n, n, w // n, 3).mean(axis=(1, 3))


def on_floor(glb, size):
    """(x, z) where the ray through each pixel's middle meets the plane y = 0; h x w x 2."""
    node = next(n for n in glb.json['nodes'] if 'camera' in n)
    m, half = placement(node), math.tan(glb.json['cameras'][node['camera']]['perspective']['yfov'] / 2)
    w, h = size
    x, y = np.meshgrid((2 * np.arange(w) + 1 - w) / h * half, (h - 1 - 2 * np.arange(h)) / h * half)
    ray = np.stack([x, y, -np.ones_like(x)], axis=2) @ m[:3, :3].T
    return (m[:3, 3] - ray * (m[1, 3] / ray[..., 1:2]))[..., [0, 2]]


def print_rings(glb, rings, ours, halves):
    distance = np.linalg.norm(on_floor(glb, ours.shape[1::-1]) - rings[:2], axis=2)
    theirs = sum(halves) / 2
    for low, high in zip([0] + rings[2:], rings[2:] + [math.inf]):
        ring = (distance >= low) & (distance < high)
        flux = theirs[ring].sum(axis=0)
        print(f'ring {low:g} to {high:g} m: {ring.sum()} pixels, theirs', np.round(theirs[ring].mean(axis=0), 5), 'ours / theirs',
              np.round(ours[ring].sum(axis=0) / flux, 4), 'halves apart', np.round((halves[0] - halves[1])[ring].sum(axis=0) / flux, 4))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('scene')
    parser.add_argument('ours')
    parser.add_argument('--light', action='store_true')
    parser.add_argument('--wavelengths', type=int, default=35)
    parser.add_argument('--spp', type=int, default=256)
    parser.add_argument('--blocks', type=int, default=4)
    parser.add_argument('--rings', type=lambda s: [float(v) for v in s.split(',')])
    a = parser.parse_args()
    ours = OpenEXR.File(a.ours, separate_channels=True).channels()
    ours = np.stack([ours[c].pixels for c in 'RGB'], axis=2).astype(float)
    glb = Glb(a.scene)
    spectrum = weights(a.wavelengths)
    mi.set_variant('llvm_ad_mono')
    integrator = mi.load_dict(dict(type='ptracer' if a.light else 'path', max_depth=40, rr_depth=20))
    total, halves = 0, [0, 0]
    for i, (nm, weight) in enumerate(zip(*spectrum)):
        scene = scene_at(glb, nm, ours.shape[1::-1])
        for half in (0, 1):
            picture = np.array(mi.render(scene, integrator=integrator, spp=a.spp // 2, seed=2 * i + half))[:, :, :1] * weight
            halves[half] = halves[half] + picture
    theirs = (halves[0] + halves[1]) / 2
    noise = by_blocks(halves[0] - halves[1], a.blocks) / 2
    if a.rings:
        print_rings(glb, a.rings, ours, halves)
    x, y = by_blocks(ours, a.blocks), by_blocks(theirs, a.blocks)
    print('whole picture: ours / theirs by channel', np.round(ours.mean(axis=(0, 1)) / theirs.mean(axis=(0, 1)), 4))
    most = np.abs(y).max(axis=(0, 1))
    for by, bx in np.ndindex(a.blocks, a.blocks):
        if (np.abs(y[by, bx]) > 0.05 * most).any():
            print(f'block {by} {bx}: ours', np.round(x[by, bx], 5), 'theirs', np.round(y[by, bx], 5), 'difference % of the channel\'s brightest block',
                  np.round(100 * (x - y)[by, bx] / most, 2), 'noise', np.round(100 * noise[by, bx] / most, 2))


if __name__ == '__main__':
    main()
