#!/usr/bin/env python3
"""Renders a Mitsuba scene with LuxCore until the CPU seconds are used up, start-up and photons included.

usage: peer_luxcore.py SCENE.xml --cpu-time S --seed K -o PICTURE.npy --method photongi|bidir|path

Paths have up to 64 vertices; no pixel filter, no clamping, no denoiser, samples spread evenly (Sobol, not adaptive).
path      PATHCPU: next event estimation and multiple importance sampling.
photongi  PATHCPU with PhotonGI's map of caustics, traced anew for each sample of a pixel: 150 000 light paths by its
          Metropolis sampler. The radius of the lookup begins with 1/150 of the height that the picture spans at the
          middle of the scene, 3.4 pixels of 512, and shrinks by 4% each time, to a fifth. No map of indirect light.
          Half or twice as many paths are no better, nor is a larger map that stays: its lookups cost samples. A radius
          a third smaller is better for the ring, a larger one for the pool. LuxCore's default is 15 cm, which blurs.
bidir     BIDIRCPU, with Russian roulette from the 17th vertex on: its weights leave roulette out, so that with the
          default, from the third on, the Cornell box is 5% too bright. Directional lights are refused: it loses 10%.
Needs pyluxcore. What LuxCore cannot express is refused (mitsuba_to_luxcore.py).
"""
import argparse
import os
import sys
import time
from pathlib import Path

import numpy as np
import pyluxcore

from mitsuba_to_luxcore import Inexpressible, translate

DEPTH = 64  # that of the truths


def photongi(scene, seed):
    if not scene.caustics:  # it would trace in vain
        return {}
    radius = scene.view_height() / 150
    return {'path.photongi.caustic.enabled': True, 'path.photongi.indirect.enabled': False,
            'path.photongi.photon.maxcount': 150_000, 'path.photongi.caustic.maxsize': 10_000_000,
            # Photons know no seed, but a path takes as many random numbers as its depth asks for: another, other paths.
            'path.photongi.photon.maxdepth': 8 + seed % 16,
            'path.photongi.visibility.lookup.radius': 4 * radius,  # where the camera looks; its own estimate takes 1 s
            'path.photongi.caustic.lookup.radius': radius, 'path.photongi.caustic.updatespp': 1,
            'path.photongi.caustic.updatespp.radiusreduction': .96,
            'path.photongi.caustic.updatespp.minradius': radius / 5}


def settings(method, scene, seed):
    common = {'film.width': scene.width, 'film.height': scene.height, 'film.filter.type': 'NONE',
              'film.imagepipelines.0.0.type': 'NOP', 'film.opencl.enable': False,
              'native.threads.count': len(os.sched_getaffinity(0)), 'renderengine.seed': seed,
              'sampler.type': 'SOBOL', 'sampler.sobol.adaptive.strength': 0.}
    if method == 'bidir':
        return common | {'renderengine.type': 'BIDIRCPU', 'path.maxdepth': DEPTH, 'light.maxdepth': DEPTH,
                         'path.russianroulette.depth': 16}
    depths = {f'path.pathdepth.{kind}': DEPTH for kind in ('total', 'diffuse', 'glossy', 'specular')}
    return common | depths | {'renderengine.type': 'PATHCPU', 'path.clamping.variance.maxvalue': 0.} | (
        photongi(scene, seed) if method == 'photongi' else {})


def properties_of(values):
    properties = pyluxcore.Properties()
    for name, value in values.items():
        properties.Set(pyluxcore.Property(name, value if isinstance(value, list) else [value]))
    return properties


def render(translation, method, seed, cpu_time):
    scene = pyluxcore.Scene()
    scene.Parse(properties_of(translation.properties))
    config = pyluxcore.RenderConfig(properties_of(settings(method, translation, seed)), scene)
    session = pyluxcore.RenderSession(config)
    session.Start()
    while time.process_time() < cpu_time and not session.HasDone():
        time.sleep(.002)
    session.Stop()
    picture = np.zeros((translation.height, translation.width, 3), np.float32)
    session.GetFilm().GetOutputFloat(pyluxcore.FilmOutputType.RGB_IMAGEPIPELINE, picture, 0, True)
    return picture[::-1]  # its first row is the lowest


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('scene', type=Path)
    parser.add_argument('--cpu-time', type=float, required=True)
    parser.add_argument('--seed', type=int, required=True)
    parser.add_argument('-o', '--output', required=True)
    parser.add_argument('--method', choices=('photongi', 'bidir', 'path'), required=True)
    arguments = parser.parse_args()
    try:
        translation = translate(arguments.scene.read_text(), arguments.scene.parent, arguments.method == 'bidir')
    except Inexpressible as problem:
        sys.exit(f'{arguments.scene.name}: {problem}')
    pyluxcore.Init()
    np.save(arguments.output, render(translation, arguments.method, arguments.seed, arguments.cpu_time))


if __name__ == '__main__':
    main()
