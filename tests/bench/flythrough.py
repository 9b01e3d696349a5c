#!/usr/bin/env python3
"""Many frames by one map against each frame by its own: cost, error, flicker. Needs numpy and OpenEXR.

The first camera goes round the scene's vertical axis through the origin. With --truth STEM (STEM.exr, STEM.a.exr,
STEM.b.exr: the first camera's picture) frames are held against it at every turn after which the scene looks the same
(--turns of them), so that they need no truth of their own.
"""
import argparse
import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

import truths
from errors import figures
from glb_file import pack_glb, read_glb


def orbit(path, frames):
    """The scene with its first camera alone, as `frames` cameras f00, f01, ... on a circle."""
    gltf, binary = read_glb(path)
    nodes = gltf['nodes']
    view = dict(next(node for node in nodes if 'camera' in node))
    for node in nodes:
        node.pop('camera', None)
    roots = gltf['scenes'][gltf.get('scene', 0)]['nodes']
    x, y, z = view['translation']
    for i in range(frames):
        angle = 2 * math.pi * i / frames
        c, s = math.cos(angle), math.sin(angle)
        half_c, half_s = math.cos(angle / 2), math.sin(angle / 2)
        qx, qy, qz, qw = view.get('rotation', [0, 0, 0, 1])
        nodes.append({'name': f'f{i:02d}', 'camera': view['camera'], 'translation': [c * x + s * z, y, c * z - s * x],
                      'rotation': [half_c * qx + half_s * qz, half_c * qy + half_s * qw, half_c * qz - half_s * qx,
                                   half_c * qw - half_s * qy]})
        roots.append(len(nodes) - 1)
    return pack_glb(gltf, binary)


def render(arguments, scene, out, *options):
    report = out.with_suffix('.json')
    command = [arguments.lsde, 'render', scene, '-o', out, '--json', report, '--force', '--quiet', '--no-cache',
               '--threads', arguments.threads, *options]
    subprocess.run([str(c) for c in command], check=True, stderr=subprocess.DEVNULL)
    return json.loads(report.read_text())


def low_pass(picture, size=8):
    h, w = (n // size * size for n in picture.shape[:2])
    return picture[:h, :w].reshape(h // size, size, w // size, size, -1).mean((1, 3))


def flicker(first, second):
    """relMSE between two pictures of one view, of blocks of 8x8 pixels: what the eye sees crawl."""
    a, b = low_pass(first), low_pass(second)
    return ((a - b) ** 2 / 2 / (((a + b) / 2) ** 2 + 0.01)).mean()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('scene', type=Path)
    parser.add_argument('--frames', type=int, default=48)
    parser.add_argument('--shared', nargs=2, metavar=('PHOTONS', 'SPP'), default=('1000000', '4'),
                        help='of the map that all frames share, and of each frame')
    parser.add_argument('--own', nargs=2, metavar=('PHOTONS', 'SPP'), default=('500000', '4'),
                        help='of each frame by itself')
    parser.add_argument('--truth', type=Path, metavar='STEM')
    parser.add_argument('--turns', type=int, default=1, help='of the circle, after which the scene looks the same')
    parser.add_argument('--threads', default='1')
    parser.add_argument('--lsde', type=Path, default=truths.PROJECT / 'build/release/lsde')
    arguments = parser.parse_args()
    truth = truths.load_truth(arguments.truth) if arguments.truth else None
    alike = range(0, arguments.frames, arguments.frames // arguments.turns)
    with tempfile.TemporaryDirectory() as folder:
        scene = Path(folder) / 'fly.glb'
        scene.write_bytes(orbit(arguments.scene, arguments.frames))

        def error_of(picture):
            if truth is None:
                return 'no truth'
            return f"{figures([truths.load(picture)], truth)['relMSE']['error']:.2e}"

        photons, spp = arguments.shared
        all_frames = render(arguments, scene, Path(folder) / 'all.exr', '--camera', 'all', '--photons', photons, '--spp', spp)
        estimates = sorted(p['estimatedRelMse']['total'] for p in all_frames['pictures'])
        phases = {p['name']: p['cpuSeconds'] for p in all_frames['phases']}
        per_frame = all_frames['cpuSeconds'] / arguments.frames
        print(f'one map of {photons} paths, {spp} samples: {per_frame:.2f} CPU s a frame '
              f"({phases['emit'] / arguments.frames:.3f} of it emission); estimated relMSE least {estimates[0]:.2e}, "
              f'median {estimates[len(estimates) // 2]:.2e}, most {estimates[-1]:.2e}')
        for i in alike:
            print(f'  frame {i}: {error_of(Path(folder) / f"all.f{i:02d}.exr")}')
        photons, spp = arguments.own
        seconds, errors = [], []
        for i in alike:
            out = Path(folder) / f'own.f{i:02d}.exr'
            seconds.append(render(arguments, scene, out, '--camera', f'f{i:02d}', '--photons', photons, '--spp', spp,
                                  '--seed', i)['cpuSeconds'])
            errors.append(error_of(out))
        own = sum(seconds) / len(seconds)
        print(f'each its own of {photons} paths, {spp} samples: {own:.2f} CPU s a frame; ' + ', '.join(errors))
        print(f'a frame by the shared map costs {per_frame / own:.2f} of one by its own')

        shared = Path(folder) / 'shared.lsmap'
        subprocess.run([arguments.lsde, 'emit', scene, '-o', shared, '--photons', arguments.shared[0], '--quiet'], check=True)
        pictures = {}
        for seed in (1, 2):
            for name, options in (('shared', ('--map', shared, '--spp', arguments.shared[1])),
                                  ('own', ('--photons', photons, '--spp', spp))):
                out = Path(folder) / f'{name}.exr'
                render(arguments, scene, out, '--camera', 'f00', '--seed', seed, *options)
                pictures[name, seed] = truths.load(out)
        for name in ('shared', 'own'):
            print(f'flicker, {name} map: {flicker(pictures[name, 1], pictures[name, 2]):.2e}')


if __name__ == '__main__':
    sys.exit(main())
