#!/usr/bin/env python3
"""Checks that includes point downwards only, and that each third-party library has one room.

usage: layers.py ROOT          the project's folder; prints each violation, exits 1 if there is one
       layers.py --self-test   shows that seeded violations are found
"""
import re
import sys
import tempfile
from pathlib import Path

# Each room and the rooms right below it; what these may use, it may use too.
BELOW = {
    'main': ['integrators'],
    'integrators': ['stages'],
    'stages': ['transport', 'photon', 'image', 'compare', 'store'],
    'transport': ['scene', 'photon'],
    'scene': ['bsdf', 'image', 'store'],
    'photon': ['bsdf', 'path', 'store'],  # never scene: a gather takes a SurfacePoint and a Bsdf
    'compare': ['image', 'store'],
    'image': ['store'],
    'bsdf': ['sampling', 'path'],
    'sampling': ['base', 'data'],
    'path': ['base'],
    'store': ['base'],
    'base': [],
    'data': [],  # measured constants
}

# Third-party headers, and the one file that may include them, so that each library can be replaced in one room.
OWNERS = [
    (re.compile(r'embree\d*/'), 'src/scene/accel.cpp'),
    (re.compile(r'draco/'), 'src/scene/gltf_draco.cpp'),
    (re.compile(r'meshoptimizer'), 'src/scene/gltf_meshopt.cpp'),
    (re.compile(r'webp/'), 'src/scene/webp.cpp'),
    (re.compile(r'tiny_gltf'), 'src/scene/gltf_model.cpp'),
    (re.compile(r'flann/'), 'src/photon/flann_index.cpp'),
    (re.compile(r'(OpenEXR/|Imath/|Imf|Imath|Iex|half\.h)'), 'src/image/exr.cpp'),
    (re.compile(r'(oneapi/)?tbb/'), 'src/base/parallel_tbb.cpp'),
    (re.compile(r'nlohmann/json\.hpp'), 'src/base/json.h'),
]

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def reachable(room):
    rooms = {room}
    for below in BELOW[room]:
        rooms |= reachable(below)
    return rooms


def room_of(path):
    """The room of a file, given its path from the project's folder or from src; None if it has none."""
    parts = Path(path).parts
    if parts[0] == 'src':
        parts = parts[1:]
    if parts[0] != 'passes':
        return parts[0] if parts[0] in BELOW and len(parts) > 1 else None
    if len(parts) > 2:
        return parts[1] if parts[1] in BELOW else None
    return 'main' if parts[1] == 'main.cpp' or parts[1].startswith('cli') else 'stages'


def check_include(file, quote, included):
    """What is wrong with one include, or None."""
    for pattern, owner in OWNERS:
        if pattern.match(included) and file != owner:
            return f'only {owner} may include this library'
    if quote == '<':
        return None
    own, other = room_of(file), room_of(included)
    if other is None:
        return 'not of the form "room/file.h"'
    if other not in reachable(own):
        return f'{own} may not use {other}, only {", ".join(sorted(reachable(own) - {own})) or "nothing"}'
    return None


def violations(root):
    files = sorted(p for top in ('src', 'passes') for p in (root / top).rglob('*') if p.suffix in ('.h', '.cpp'))
    found = [] if files else [f'{root}: no sources']
    for path in files:
        file = path.relative_to(root).as_posix()
        if room_of(file) is None:
            found.append(f'{file}: in no room of {", ".join(BELOW)}')
            continue
        for number, line in enumerate(path.read_text(encoding='utf-8').splitlines(), 1):
            match = INCLUDE.match(line)
            problem = match and check_include(file, *match.groups())
            if problem:
                found.append(f'{file}:{number}: {line.strip()}: {problem}')
    return found


SOUND = {
    'src/base/math.h': '#include <vector>',
    'src/base/parallel_tbb.cpp': '#include <tbb/parallel_for.h>',
    'src/bsdf/bsdf.h': '#include "path/event.h"\n#include "base/math.h"',
    'src/photon/map_file.cpp': '#include "photon/map_file.h"\n#include "store/container.h"',
    'src/transport/walk.cpp': '#include "photon/photon.h"\n#include "scene/scene.h"',
    'passes/camera.cpp': '#include "transport/walk.h"\n#include "passes/camera.h"',
    'passes/integrators/photon.cpp': '#include "passes/camera.h"',
    'passes/main.cpp': '#include "passes/integrators/registry.h"',
}
SEEDED = [
    ('src/photon/density.cpp', '#include "scene/scene.h"', 'photon may not use scene'),
    ('src/base/ray.h', '  #  include "path/event.h"', 'base may not use path'),
    ('passes/camera.cpp', '#include "passes/integrators/registry.h"', 'stages may not use integrators'),
    ('src/photon/map_header.cpp', '#include <nlohmann/json.hpp>', 'only src/base/json.h'),
    ('src/sampling/warp.cpp', '#include "warp.h"', 'not of the form'),
    ('src/scene/scene.cpp', '#include <embree3/rtcore.h>', 'only src/scene/accel.cpp'),
    ('src/photon/kd_index.cpp', '#include <tbb/parallel_sort.h>', 'only src/base/parallel_tbb.cpp'),
    ('passes/compare.cpp', '#include <ImfInputFile.h>', 'only src/image/exr.cpp'),
    ('src/helpers/odd.h', '', 'in no room'),
]


def violations_of(files):
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files.items():
            path = Path(folder) / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding='utf-8')
        return violations(Path(folder))


def self_test():
    assert violations_of(SOUND) == [], violations_of(SOUND)
    assert len(violations_of({})) == 1
    for name, line, expected in SEEDED:
        found = violations_of(SOUND | {name: line})
        assert len(found) == 1 and found[0].startswith(name) and expected in found[0], (name, line, found)
    print(f'{len(SEEDED)} seeded violations found')


def main(arguments):
    if arguments == ['--self-test']:
        return self_test()
    if len(arguments) != 1:
        sys.exit(__doc__)
    root = Path(arguments[0])
    found = violations(root)
    print('\n'.join(found) or f'includes of {root.resolve().name} point downwards')
    return sys.exit(1 if found else 0)


if __name__ == '__main__':
    main(sys.argv[1:])
