#!/usr/bin/env python3
"""Sweeps the roughness of a glass ball and of a mirror ring across the split between photons and direct light.

usage: roughness_sweep.py FOLDER --lsde PROGRAM [--mitsuba PYTHON] [--kinds glass,metal]

Writes into FOLDER the scenes and their pictures by photons, by path tracing and by Mitsuba 3 (PYTHON has what
gltf_to_mitsuba.py needs), and a strip of them for each kind, a row for each method. Prints the table of scenes/README.md.
What is there already is not made again. Needs numpy, OpenEXR 3.3 (pip) and Pillow.
"""
import argparse
import subprocess
import sys
from pathlib import Path

import numpy as np
from PIL import Image

sys.path.insert(0, str(Path(__file__).parents[2] / 'scenes'))
from gltf_writer import Node, camera, glass, lambert, lamp, metal, write_glb  # noqa: E402
from shapes import icosphere, revolve, square  # noqa: E402

import truths  # noqa: E402
from errors import figures  # noqa: E402

ROUGHNESS = (0, 0.05, 0.1, 0.15, 0.2, 0.24, 0.26, 0.3, 0.4, 0.5, 0.6)
GREY = lambert(0.7, 0.7, 0.7)


def ball(roughness):
    return [camera((0, 2.5, 4), (0, 0.4, 0), 35, 96, 96), Node('floor', mesh=square(6), material=GREY),
            Node('ball', (0, 0.8, 0), scale=0.5, mesh=icosphere(5), material=glass(1.5, roughness=roughness)), lamp(0.5, (0.5, 3, 0), (0, 0, 0), 60)]


def ring(roughness):
    """Its lamp is so large that path tracing finds it."""
    return [camera((0, 3.6, 3.6), (0.15, 0.1, 0), 36, 96, 96), Node('floor', mesh=square(8), material=GREY),
            Node('ring', mesh=revolve([(1, 0), (1, 0.6)], 512), material=metal(1, 1, 1, roughness=roughness, double_sided=True)),
            lamp(1.2, (-2.4, 2.4, 0), (0, 0, 0), 14)]


SCENES = dict(glass=ball, metal=ring)


def commands(arguments, scene):
    """By method: what renders the scene, with the picture's name to be appended."""
    out = dict(photons=[arguments.lsde, 'render', scene, '--no-cache', '--quiet', '--spp', 64, '--photons', 2000000, '-o'],
               paths=[arguments.lsde, 'reference', scene, '--quiet', '--spp', 2048, '-o'])
    if arguments.mitsuba:
        converter = Path(__file__).with_name('gltf_to_mitsuba.py')
        out['mitsuba'] = [arguments.mitsuba, converter, scene, '--spp', 2048, '--passes', 2, '-o']
    return out


def row(roughness, pictures, truth):
    """Means, and relMSE against Mitsuba without its own noise."""
    cells = [f'{roughness:g}'] + [f'{p.mean():.5f}' for p in pictures.values()]
    if truth:
        for p in (pictures['photons'], pictures['paths']):
            cells += [f'{p.mean() / truth.mean.mean():.4f}', f"{figures([p], truth)['relMSE']['error']:.1e}"]
    return '| ' + ' | '.join(cells) + ' |'


def sweep(arguments, kind):
    columns = []
    for roughness in ROUGHNESS:
        scene = arguments.folder / f'{kind}{roughness:g}.glb'
        write_glb(scene, kind, SCENES[kind](roughness))
        pictures = {}
        for method, command in commands(arguments, scene).items():
            path = arguments.folder / f'{kind}{roughness:g}.{method}.exr'
            if not path.exists():
                subprocess.run([str(c) for c in (*command, path)], check=True)
            pictures[method] = truths.load(path)
        truth = truths.load_truth(arguments.folder / f'{kind}{roughness:g}.mitsuba') if arguments.mitsuba else None
        print(row(roughness, pictures, truth), flush=True)
        columns.append(np.concatenate(list(pictures.values())))
    strip = np.clip(np.concatenate(columns, axis=1), 0, 1) ** (1 / 2.2)
    Image.fromarray((255 * strip).astype(np.uint8)).save(arguments.folder / f'roughness-{kind}.png', optimize=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('folder', type=Path)
    parser.add_argument('--lsde', required=True)
    parser.add_argument('--mitsuba')
    parser.add_argument('--kinds', default='glass,metal')
    arguments = parser.parse_args()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    for kind in arguments.kinds.split(','):
        print(kind)
        sweep(arguments, kind)


if __name__ == '__main__':
    main()
