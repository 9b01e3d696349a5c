#!/usr/bin/env python3
"""Renders a scene with Mitsuba 3 until the CPU seconds are used up, start-up and compilation included.

usage: peer_mitsuba.py SCENE.xml --cpu-time S --seed K -o PICTURE.npy [--integrator path|ptracer] [--spp N]

Needs mitsuba, and LLVM other than 15, which crashes it: DRJIT_LIBLLVM_PATH names the library.
"""
import argparse
import time

import mitsuba
import numpy as np

DEPTH = 64  # that of the truths


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('scene')
    parser.add_argument('--cpu-time', type=float, required=True)
    parser.add_argument('--seed', type=int, required=True)
    parser.add_argument('-o', '--output', required=True)
    parser.add_argument('--integrator', default='path')
    parser.add_argument('--spp', type=int, default=8, help='samples per pixel of one pass')
    arguments = parser.parse_args()
    mitsuba.set_variant('llvm_ad_rgb')
    scene = mitsuba.load_file(arguments.scene)
    integrator = mitsuba.load_dict(dict(type=arguments.integrator, max_depth=DEPTH))

    total, passes = 0, 0
    while True:
        begin = time.process_time()
        seed = arguments.seed * 1_000_000 + passes  # never that of another run's pass
        total = total + np.array(mitsuba.render(scene, integrator=integrator, spp=arguments.spp, seed=seed), np.float64)
        passes += 1
        now = time.process_time()
        if now + (now - begin) > arguments.cpu_time:  # the next would overrun
            break
    np.save(arguments.output, (total / passes).astype(np.float32))


if __name__ == '__main__':
    main()
