#!/usr/bin/env python3
"""Holds the project's pictures of Khronos' sample files (KhronosGroup/glTF-Sample-Assets) against Mitsuba 3's.

usage: khronos_samples.py SAMPLES FOLDER --lsde PROGRAM --mitsuba PYTHON [--names NAME,...] [--photons N]

SAMPLES holds NAME.glb. Writes into FOLDER a copy of each that both define alike (staged_copy.py), with the eye and the lamp
below, and the pictures by photons and by Mitsuba (PYTHON has what gltf_to_mitsuba.py needs). Prints the means' ratio, by channel
too, and relMSE without Mitsuba's own noise. What Mitsuba has made already is not made again. Needs numpy and OpenEXR 3.3 (pip).
"""
import argparse
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import truths
from errors import figures


@dataclass
class Stage:
    eye: str
    target: str
    fov: float
    size: str = '128x128'
    lamp: tuple = ()  # staged_copy.py's arguments
    mitsuba: tuple = ()


STAGES = dict(
    AttenuationTest=Stage('0,1,24', '0,1,0', 46, lamp=('--lamp', '6,10,14', '--lamp-size', 6, '--radiance', 40),
                          mitsuba=('--integrator', 'volpath', '--spp', 2048, '--passes', 16)),
    TransmissionRoughnessTest=Stage('.1,0,1.5', '.1,0,0', 40, '160x112', ('--lamp', '.5,.7,1.5', '--lamp-size', .45, '--radiance', 40),
                                    ('--spp', 2048, '--passes', 16)),
    EmissiveStrengthTest=Stage('0,2,16', '0,.12,0', 52, mitsuba=('--spp', 2048, '--passes', 4)),
    Lights=Stage('7.36,4.96,6.93', '0,0,0', 40, mitsuba=('--spp', 1024, '--passes', 2)),
    NegativeScaleTest=Stage('.5,-.5,12', '.3,-.5,0', 45, lamp=('--lamp', '4,5,9', '--lamp-size', 3, '--radiance', 10),
                            mitsuba=('--spp', 2048, '--passes', 8)),
)


def run(*command):
    subprocess.run([str(c) for c in command], check=True, stdout=subprocess.DEVNULL)


def compare(arguments, name, stage):
    copy, truth, picture = (arguments.folder / f'{name}{ending}' for ending in ('.glb', '.mitsuba.exr', '.exr'))
    here = Path(__file__).parent
    run(sys.executable, here / 'staged_copy.py', arguments.samples / f'{name}.glb', copy, '--eye', stage.eye, '--target', stage.target,
        '--fov', stage.fov, '--size', stage.size, *stage.lamp)
    if not truth.exists():
        run(arguments.mitsuba, here / 'gltf_to_mitsuba.py', copy, '--camera', 'staged', '-o', truth, *stage.mitsuba)
    run(arguments.lsde, 'render', copy, '--camera', 'staged', '-o', picture, '--photons', arguments.photons, '--spp', 64,
        '--no-cache', '--quiet', '--force')
    mitsuba, ours = truths.load_truth(truth.with_suffix('')), truths.load(picture)
    channels = ' '.join(f'{r:.4f}' for r in ours.mean((0, 1)) / mitsuba.mean.mean((0, 1)))
    print(f"| {name} | {ours.mean() / mitsuba.mean.mean():.4f} | {channels} | {figures([ours], mitsuba)['relMSE']['error']:.1e} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('samples', type=Path)
    parser.add_argument('folder', type=Path)
    parser.add_argument('--lsde', required=True)
    parser.add_argument('--mitsuba', required=True)
    parser.add_argument('--names', default=','.join(STAGES))
    parser.add_argument('--photons', type=int, default=1000000)
    arguments = parser.parse_args()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    print('| file | mean / Mitsuba | by channel | relMSE nc |\n|---|---|---|---|')
    for name in arguments.names.split(','):
        compare(arguments, name, STAGES[name])


if __name__ == '__main__':
    main()
