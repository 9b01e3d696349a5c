#!/usr/bin/env python3
"""Prints the values that flip_test.cpp and metrics_test.cpp record, by other programs' implementations.

usage: record_oracles.py REFERENCE_FOLDER      (tests/data/reference)
Needs: pip install flip-evaluator==1.7 scikit-image==0.26.0 numpy "OpenEXR>=3.3"
"""
import sys

import flip_evaluator
import numpy as np
import OpenEXR
from skimage.metrics import structural_similarity

WIDTH, HEIGHT = 64, 48


def hash32(x):
    """The same as hash32 in pictures.h."""
    x = x.astype(np.uint32)
    x ^= x >> np.uint32(16)
    x *= np.uint32(0x7FEB352D)
    x ^= x >> np.uint32(15)
    x *= np.uint32(0x846CA68B)
    return x ^ (x >> np.uint32(16))


def picture(disc_x, disc, noise):
    """The same as testPicture in pictures.h: a gradient with a disc, and noise."""
    y, x, c = np.mgrid[:HEIGHT, :WIDTH, :3]
    u, v = (x + .5) / WIDTH, (y + .5) / HEIGHT
    value = np.where((x - disc_x) ** 2 + (y - 20) ** 2 < 60, disc, .1 + .8 * np.choose(c, [u, v, u * v]))
    random = (hash32((y * WIDTH + x) * 3 + c) >> np.uint32(8)) / 2.0 ** 24
    return (value * (1 + noise * (random - .5))).astype(np.float32)


def load(path):
    channels = OpenEXR.File(path, separate_channels=True).channels()
    return np.stack([channels[c].pixels for c in 'RGB'], -1).astype(np.float32)


def srgb(x):
    x = np.clip(x.astype(np.float64), 0, 1)
    return np.where(x <= .0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - .055)


def flip(name, image, reference, kind):
    if kind == 'LDR':
        image, reference = np.clip(image, 0, 1), np.clip(reference, 0, 1)
    errors, mean, parameters = flip_evaluator.evaluate(reference, image, kind, inputsRGB=False, applyMagma=False)
    print(f'{kind}-FLIP {name}: mean {mean:.7f}, at (10, 7) {errors[7, 10, 0]:.6f}, largest {errors.max():.6f}', end='')
    if kind == 'HDR':
        print(f', exposures {parameters["startExposure"]:.6f} to {parameters["stopExposure"]:.6f}, '
              f'{parameters["numExposures"]}', end='')
    print()


def ssim(name, image, reference):
    displayed = [srgb(p.astype(np.float64) @ [.2126, .7152, .0722]) for p in (image, reference)]
    value = structural_similarity(*displayed, data_range=1, gaussian_weights=True, sigma=1.5,
                                  use_sample_covariance=False)
    print(f'SSIM {name}: {value:.8f}')


def main(folder):
    pairs = {
        'noise': (picture(40, .9, .5), picture(40, .9, 0)),
        'moved disc': (picture(37, .9, 0), picture(40, .9, 0)),
        'bright disc': (picture(40, 15, .5), picture(40, 16, 0)),
        'glass-sphere.a': (load(f'{folder}/glass-sphere.a.exr'), load(f'{folder}/glass-sphere.exr')),
        'cornell against pool': (load(f'{folder}/cornell.exr'), load(f'{folder}/pool.exr')),
    }
    for name, pair in pairs.items():
        flip(name, *pair, 'LDR')
        flip(name, *pair, 'HDR')
        ssim(name, *pair)


if __name__ == '__main__':
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
