#!/usr/bin/env python3
"""Writes the scenes of this folder. README.md says what each shows. Needs numpy.

usage: generate.py [NAME...]      without a name: all
"""
import math
import sys
from pathlib import Path

import numpy as np

from gltf_writer import Node, camera, emitter, glass, lambert, lamp, looking, metal, point_light, thin_glass, write_glb
from shapes import box_inside, flipped, heightfield, icosphere, join, quad, revolve, square

GREY = lambert(0.7, 0.7, 0.7)
GLASS = glass(1.5)


def ball(name, center, radius, material, level=4, **extras):
    return Node(name, center, scale=radius, mesh=icosphere(level), material=material, extras=extras)


def floor(size):
    return Node('floor', mesh=square(size), material=GREY)


# ---- the textbook scenes: their geometry and values are those of the pictures in tests/data


def sphere_over_floor(level, light):
    return [camera((0, 3.5, 8), (0, 0.6, 0), 35), floor(8), Node('sphere', (0, 1.2, 0), mesh=icosphere(level), material=GLASS), light]


def glass_sphere():
    return sphere_over_floor(6, lamp(1, (0, 5, 0), (0, 0, 0), 25))


def glass_sphere_small():
    return sphere_over_floor(4, lamp(1, (0, 5, 0), (0, 0, 0), 25))


def point_glass_small():
    return sphere_over_floor(4, point_light('point', (0, 5, 0), 25))


def pool_small():
    h = 1.5
    walls = join(quad((-2, 0, -2), (2, 0, -2), (2, h, -2), (-2, h, -2)), quad((2, 0, 2), (-2, 0, 2), (-2, h, 2), (2, h, 2)),
                 quad((-2, 0, 2), (-2, 0, -2), (-2, h, -2), (-2, h, 2)), quad((2, 0, -2), (2, 0, 2), (2, h, 2), (2, h, -2)))
    # An open sheet: front is above, so light that crosses it downwards enters the water.
    water = heightfield(4, 64, lambda x, z: 1 + 0.05 * np.sin(4 * x) * np.cos(4 * z),
                        lambda x, z: (-0.2 * np.cos(4 * x) * np.cos(4 * z), np.ones_like(x), 0.2 * np.sin(4 * x) * np.sin(4 * z)))
    return [camera((0, 5, 4.5), (0, 0.5, 0), 40), floor(4), Node('walls', mesh=walls, material=GREY),
            Node('water', mesh=water, material=glass(1.33)), lamp(1, (0.5, 5, 0.5), (0.5, 0, 0.5), 60)]


def ring():
    band = revolve([(1, 0), (1, 0.6)], 1024)
    return [camera((0, 3.6, 3.6), (0.15, 0.1, 0), 36), floor(8),
            Node('ring', mesh=band, material=metal(1, 1, 1, double_sided=True)), lamp(0.2, (-3, 3, 0), (0, 0, 0), 500)]


def cornell_small():
    white = join(quad((-1, 0, 1), (1, 0, 1), (1, 0, -1), (-1, 0, -1)), quad((-1, 2, -1), (1, 2, -1), (1, 2, 1), (-1, 2, 1)),
                 quad((-1, 0, -1), (1, 0, -1), (1, 2, -1), (-1, 2, -1)))
    return [camera((0, 1, 4.4), (0, 1, 0), 35), Node('white', mesh=white, material=lambert(0.73, 0.73, 0.73)),
            Node('left', mesh=quad((-1, 0, 1), (-1, 0, -1), (-1, 2, -1), (-1, 2, 1)), material=lambert(0.63, 0.065, 0.05)),
            Node('right', mesh=quad((1, 0, -1), (1, 0, 1), (1, 2, 1), (1, 2, -1)), material=lambert(0.14, 0.45, 0.091)),
            ball('mirror-sphere', (-0.45, 0.4, -0.35), 0.38, metal(1, 1, 1)), ball('glass-sphere', (0.42, 0.5, 0.3), 0.36, GLASS),
            lamp(0.5, (0, 1.99, 0), (0, 0, 0), 15)]


def lights():
    spot = dict(type='spot', color=[0.3, 0.6, 1], intensity=8,
                spot=dict(innerConeAngle=math.radians(17.999), outerConeAngle=math.radians(18)))
    sun = dict(type='directional', color=[1, 1, 0.8], intensity=0.4)
    return [camera((0, 3, 7), (0, 0.5, 0), 38), floor(8), ball('ball', (0, 0.7, 0), 0.7, lambert(0.8, 0.8, 0.8)),
            point_light('point', (-2, 1.5, 0.5), 3, (1, 0.5, 0.25)), Node('spot', **looking((2.2, 2.5, 1.2), (1.6, 0, 0.8)), light=spot),
            Node('sun', **looking((-1, 3, -2), (0, 0, 0)), light=sun)]


# ---- who owns a path


def pane():
    sheet = quad((-1, 0, 0), (1, 0, 0), (1, 1.6, 0), (-1, 1.6, 0))
    return [camera((1.2, 2.2, 4.5), (0, 0.4, 0), 35), floor(6), Node('pane', mesh=sheet, material=thin_glass(0.8, 0.95, 0.85)),
            lamp(0.3, (0, 1.4, -1.2), (0, 0, 0.8), 80)]


def pane_ball():
    return pane() + [ball('ball', (0.1, 0.45, 0.6), 0.35, GLASS)]


def rough_metal_under(light):
    plate = quad((-0.8, 0, 1.2), (-0.8, 0, -1), (-0.8, 1.6, -1), (-0.8, 1.6, 1.2))
    return [camera((1.6, 1.3, 2.2), (-0.4, 0.45, 0.2), 45), floor(4),
            Node('plate', mesh=plate, material=metal(0.95, 0.8, 0.5, roughness=0.15)), light]


def rough_metal():
    return rough_metal_under(point_light('point', (1, 1, 0), 6))


def rough_metal_area():
    return rough_metal_under(lamp(0.3, (1, 1, 0), (-0.8, 0.6, 0), 60))


def bent_normals():
    tilt = math.tan(math.radians(25))  # largest tilt of a vertex normal against the flat floor
    receiver = heightfield(4, 64, lambda x, z: 0 * x,
                           lambda x, z: (tilt * np.sin(5 * x) * np.cos(4 * z), np.ones_like(x), tilt * np.sin(4 * z) * np.cos(5 * x)))
    return [camera((0, 2.5, 4), (0, 0.3, 0), 35), Node('floor', mesh=receiver, material=GREY), ball('ball', (0, 0.8, 0), 0.5, GLASS),
            lamp(0.4, (0.5, 3, 0), (0, 0, 0), 60)]


# ---- solids in solids

WATER = glass(1.33, absorption=((0.55, 0.8, 0.9), 1))
WALL, INNER, BASE, SURFACE, RIM = 0.4, 0.35, 0.08, 0.7, 1  # m: radii and heights of the tumbler and of the water's surface


def tumbler_scene(water_mesh, priorities):
    # The inside has a ring at the water's surface, so that water can share its triangles.
    inside = [(WALL, RIM), (INNER, RIM), (INNER, SURFACE), (INNER, BASE), (0, BASE)]
    tumbler = revolve([(0, 0), (WALL, 0)] + inside, 96)
    above = (0, 0.005, 0)  # keeps the solids off the floor
    extras = [dict(priority=p) for p in priorities] or [{}, {}]
    return [camera((0, 1.7, 3.4), (0, 0.4, 0), 32), floor(6), Node('tumbler', above, mesh=tumbler, material=GLASS, extras=extras[0]),
            Node('water', above, mesh=water_mesh, material=WATER, extras=extras[1]), lamp(0.5, (1.5, 2.5, 0.5), (0, 0.4, 0), 40)]


def water_glass_exact():
    side = flipped(revolve([(INNER, SURFACE), (INNER, BASE), (0, BASE)], 96))  # the tumbler's own triangles, turned round
    return tumbler_scene(join(side, revolve([(INNER, SURFACE), (0, SURFACE)], 96)), ())


def water_glass_overlap():
    radius, bottom = INNER + 0.02, BASE - 0.03
    return tumbler_scene(revolve([(0, bottom), (radius, bottom), (radius, SURFACE), (0, SURFACE)], 96), (2, 1))


def nested():
    angle = np.linspace(-90, 35, 13) * np.pi / 180
    bowl = [(0.36 * math.cos(a), 0.95 + 0.42 * math.sin(a)) for a in angle]
    inside = [(0.335 * math.cos(a), 0.95 + 0.395 * math.sin(a)) for a in angle]
    foot = [(0, 0), (0.32, 0), (0.33, 0.012), (0.32, 0.025), (0.06, 0.05), (0.035, 0.1), (0.03, 0.3), (0.035, 0.45)]
    goblet = revolve(foot + bowl[2:] + inside[::-1][:-1] + [(0, inside[0][1])], 96, crease_degrees=60)
    middle = [(0.347 * math.cos(a), 0.95 + 0.407 * math.sin(a)) for a in angle[:9]]  # half-way into the wall
    wine = revolve([(0, middle[0][1])] + middle[1:] + [(0, middle[-1][1])], 96)
    red = glass(1.34, absorption=((0.6, 0.05, 0.1), 0.25))
    above = (0, 0.005, 0)
    return [camera((0, 2, 4), (0, 0.6, 0), 34), floor(6), Node('goblet', above, mesh=goblet, material=GLASS, extras=dict(priority=3)),
            Node('wine', above, mesh=wine, material=red, extras=dict(priority=1)),
            ball('ice', (0.08, 0.93, 0.03), 0.12, glass(1.31), level=4, priority=2), lamp(0.5, (-1.6, 2.6, -0.4), (0, 0.5, 0), 50)]


# ---- known answers


def floor_lamp():
    return [camera((0, 2.5, 5), (0, 0.3, 0), 35), floor(4), lamp(0.5, (0, 2, 0), (0, 0, 0), 20)]


def room(*inside):
    return [camera((0, 1, 0.9), (0, 0.9, -1), 60), Node('walls', mesh=box_inside(2, 2), material=emitter(1, albedo=0.5)), *inside]


def furnace():
    return room()


def furnace_glass():
    return room(ball('glass', (-0.4, 0.6, -0.4), 0.3, GLASS), ball('mirror', (0.4, 1.2, -0.4), 0.3, metal(1, 1, 1)))


SCENES = [glass_sphere, glass_sphere_small, point_glass_small, pool_small, ring, cornell_small, lights, pane, pane_ball, rough_metal,
          rough_metal_area, bent_normals, water_glass_exact, water_glass_overlap, nested, floor_lamp, furnace, furnace_glass]


def main(wanted):
    scenes = {f.__name__.replace('_', '-'): f for f in SCENES}
    for name in wanted or scenes:
        path = Path(__file__).parent / f'{name}.glb'
        write_glb(path, name, scenes[name]())
        print(f'{path.name}: {path.stat().st_size} bytes')


if __name__ == '__main__':
    main(sys.argv[1:])
