#!/usr/bin/env python3
"""Writes the scenes of this folder. README.md says what each shows. Needs numpy.

usage: generate.py [NAME...]      without a name: all
"""
import math
import sys
from pathlib import Path

import numpy as np

from gallery import GALLERY
from gltf_writer import (Node, camera, emitter, glass, lambert, lamp, looking, metal, point_light, spot_light, sun, thin_glass, upright,
                         write_glb)
from shapes import (box_inside, convex, facets, flipped, heightfield, icosphere, join, level_with_holes, quad, revolve, square)

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


ABOVE = (0, 0.005, 0)  # keeps the solids off the floor


def tumbler_and_water(water_mesh, priorities):
    # The inside has a ring at the water's surface, so that water can share its triangles.
    inside = [(WALL, RIM), (INNER, RIM), (INNER, SURFACE), (INNER, BASE), (0, BASE)]
    tumbler = revolve([(0, 0), (WALL, 0)] + inside, 96)
    extras = [dict(priority=p) for p in priorities] or [{}, {}]
    return [floor(6), Node('tumbler', ABOVE, mesh=tumbler, material=GLASS, extras=extras[0]),
            Node('water', ABOVE, mesh=water_mesh, material=WATER, extras=extras[1]), lamp(0.5, (1.5, 2.5, 0.5), (0, 0.4, 0), 40)]


def water_against_the_tumbler():
    return flipped(revolve([(INNER, SURFACE), (INNER, BASE), (0, BASE)], 96))  # the tumbler's own triangles, turned round


def water_into_the_tumbler():
    radius, bottom = INNER + 0.02, BASE - 0.03
    return revolve([(0, bottom), (radius, bottom), (radius, SURFACE), (0, SURFACE)], 96)


def water_glass_exact():
    water = join(water_against_the_tumbler(), revolve([(INNER, SURFACE), (0, SURFACE)], 96))
    return [camera((0, 1.7, 3.4), (0, 0.4, 0), 32)] + tumbler_and_water(water, ())


def water_glass_overlap():
    return [camera((0, 1.7, 3.4), (0, 0.4, 0), 32)] + tumbler_and_water(water_into_the_tumbler(), (2, 1))


def ice_cubes():
    """Two, the planes of each: afloat, askew, off each other and off the glass."""
    for centre, turn, tilt in (((-0.15, 0.66, 0.05), 20, 12), ((0.16, 0.65, -0.04), 65, 25)):
        turned = rotation((0, 1, 0), turn) @ rotation((0.6, 0, 0.8), tilt)
        yield [(s * axis, s * axis @ centre + 0.11) for axis in turned.T for s in (1, -1)]


def iced(water_mesh, ice_meshes, priorities):
    ice = [Node(f'ice{i}', ABOVE, mesh=mesh, material=glass(1.31), extras=dict(priority=priorities[2]) if priorities else {})
           for i, mesh in enumerate(ice_meshes)]
    return [camera((-0.6, 1.7, 1.9), (0.05, 0.48, 0), 40)] + tumbler_and_water(water_mesh, priorities[:2]) + ice


def iced_water_exact():
    # Above and below water the ice has faces of its own. Those below are the water's as well, whose surface is cut to fit.
    wet, dry, outlines = [], [], []
    for cube in ice_cubes():
        *below, cap = facets(cube + [((0, 1, 0), SURFACE)])
        wet.append(join(*below))
        dry.append(join(*facets(cube + [((0, -1, 0), -SURFACE)])[:-1]))
        outlines.append(cap.positions)
    angles = np.arange(96) * (2 * math.pi / 96)
    circle = np.stack([INNER * np.cos(angles), np.full(96, SURFACE), -INNER * np.sin(angles)], axis=1)
    water = join(water_against_the_tumbler(), level_with_holes(circle, outlines), *(flipped(w) for w in wet))
    return iced(water, [join(w, d) for w, d in zip(wet, dry)], ())


def iced_water_overlap():
    return iced(water_into_the_tumbler(), [convex(cube) for cube in ice_cubes()], (3, 1, 2))


def nested():
    angle = np.linspace(-90, 35, 13) * np.pi / 180
    bowl = [(0.36 * math.cos(a), 0.95 + 0.42 * math.sin(a)) for a in angle]
    inside = [(0.335 * math.cos(a), 0.95 + 0.395 * math.sin(a)) for a in angle]
    foot = [(0, 0), (0.32, 0), (0.33, 0.012), (0.32, 0.025), (0.06, 0.05), (0.035, 0.1), (0.03, 0.3), (0.035, 0.45)]
    goblet = revolve(foot + bowl[2:] + inside[::-1][:-1] + [(0, inside[0][1])], 96, crease_degrees=60)
    middle = [(0.347 * math.cos(a), 0.95 + 0.407 * math.sin(a)) for a in angle[:9]]  # half-way into the wall
    wine = revolve([(0, middle[0][1])] + middle[1:] + [(0, middle[-1][1])], 96)
    red = glass(1.34, absorption=((0.6, 0.05, 0.1), 0.25))
    return [camera((0, 2, 4), (0, 0.6, 0), 34), floor(6), Node('goblet', ABOVE, mesh=goblet, material=GLASS, extras=dict(priority=3)),
            Node('wine', ABOVE, mesh=wine, material=red, extras=dict(priority=1)),
            ball('ice', (0.08, 0.93, 0.03), 0.12, glass(1.31), level=4, priority=2), lamp(0.5, (-1.6, 2.6, -0.4), (0, 0.5, 0), 50)]


# ---- dispersion

FLINT = dict(ior=1.78472, abbe=25.68)  # SCHOTT N-SF11
DIAMOND = dict(ior=2.4175, abbe=55.3)  # and polycarbonate: textbook figures
POLYCARBONATE = dict(ior=1.5855, abbe=29.9)


def rotation(axis, degrees):
    """Matrix, right-handed about a unit axis."""
    x, y, z = axis
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    a = math.radians(degrees)
    return np.eye(3) + math.sin(a) * k + (1 - math.cos(a)) * k @ k


def upright_prism(side, height, centre, turned_degrees):
    """Equilateral, its base's outward normal turned from +Z."""
    outward = [(math.sin(a), 0, math.cos(a)) for a in np.radians([turned_degrees, turned_degrees + 120, turned_degrees - 120])]
    inradius = side / math.sqrt(12)
    return convex([(n, np.dot(n, centre) + inradius) for n in outward] + [((0, 1, 0), height), ((0, -1, 0), -0.002)])


def prism():
    elevation, slit, x = math.radians(8), 0.05, -1.1
    # A ray of the d line that runs level through the middle is turned by least: 66 degrees, half of it at each face.
    turn = math.degrees(math.asin(FLINT['ior'] / 2)) - 30
    glass_prism = upright_prism(0.6, 0.5, (0.1, 0, 0), 180 + turn)
    baffle = join(*(quad((x, 0, z - 4), (x, 0, z), (x, 1.4, z), (x, 1.4, z - 4)) for z in (-slit / 2, 4 + slit / 2)))
    return [camera((0.55, 2.3, 2.2), (0.3, 0, 0.35), 38, 512, 384), floor(8), Node('prism', mesh=glass_prism, material=glass(**FLINT)),
            Node('baffle', mesh=baffle, material=lambert(0.05, 0.05, 0.05)), sun(120, (math.cos(elevation), -math.sin(elevation), 0)),
            lamp(1, (0, 4, 0), (0, 0, 0), 1.2)]


def prism_small():
    turn = math.degrees(math.asin(FLINT['ior'] / 2)) - 30
    out = np.array([math.cos(math.radians(2 * turn)), 0, math.sin(math.radians(2 * turn))])
    aside = np.array([-out[2], 0, out[0]])
    middle = np.array([0, 0.25, 0]) + 1.2 * out
    corners = [middle + 0.7 * s * aside + (0, t, 0) for s, t in ((1, -0.25), (-1, -0.25), (-1, 0.4), (1, 0.4))]
    small_prism = upright_prism(0.6, 0.5, (0, 0, -0.05), 180 + turn)
    return [camera((0, 0.9, 0.2), tuple(middle), 45, 256, 256), floor(4), Node('prism', mesh=small_prism, material=glass(**FLINT)),
            Node('screen', mesh=quad(*corners), material=GREY), spot_light('spot', (-2.5, 0.28, 0), (0, 0.25, 0), 300, 0.9999, 1)]


def flint_ball():
    return [camera((0, 2.2, 3), (0, 0.4, 0), 40, 256, 256), floor(4), ball('ball', (0, 0.7, 0), 0.6, glass(**FLINT)),
            lamp(1.6, (0.8, 3, 0), (0, 0.5, 0), 5)]


def brilliant(radius):
    """Round brilliant cut: table 56% of the width, crown at 34.5 and pavilion at 40.75 degrees (Tolkowsky 1919)."""
    girdle = 0.02  # half of its thickness, of the radius
    table = girdle + 0.44 * math.tan(math.radians(34.5))

    def ring(count, first, slope, r, y):
        """Facets through the points at radius r and height y; slope in degrees against the horizontal, below it if y < 0."""
        s, c = math.sin(math.radians(slope)), math.copysign(math.cos(math.radians(slope)), y)
        angles = (first + np.arange(count) * (360 / count)) * math.pi / 180
        return [((s * math.cos(a), c, s * math.sin(a)), radius * (s * r + c * y)) for a in angles]

    return (ring(8, 0, 34.5, 1, girdle) + ring(16, 11.25, 41, 0.99, girdle) + ring(8, 22.5, 21, 0.56 * math.cos(math.pi / 8), table) +
            ring(8, 0, 40.75, 1, -girdle) + ring(16, 11.25, 42.2, 0.99, -girdle) + ring(32, 0, 90, 0.985, girdle) +
            [((0, 1, 0), radius * table)])


def gem():
    # It lies on one of its pavilion's facets, the table towards the light.
    lying = rotation((0, 1, 0), 115) @ rotation((0, 0, 1), -40.75)
    stone = convex([(lying @ n, d) for n, d in brilliant(0.5)])
    above = (0, 0.002 - stone.positions[:, 1].min(), 0)
    return [camera((-1.4, 1.7, 2.3), (-0.05, 0.12, 0.15), 32, 512, 384), floor(12), Node('gem', above, mesh=stone, material=glass(**DIAMOND)),
            spot_light('spot', (-1, 4, 2.5), (0, 0.3, 0), 120, 8, 9), lamp(1.5, (3, 4, -2), (0, 0, 0), 1)]


def lens(aperture, curvature):
    """Biconvex, about Y: radii of its outline and of its faces."""
    sag = curvature - math.sqrt(curvature ** 2 - aperture ** 2)
    arc = [(aperture * t, sag - (curvature - math.sqrt(curvature ** 2 - (aperture * t) ** 2))) for t in np.linspace(0, 1, 13)]
    return revolve([(r, -y - 0.015) for r, y in arc] + [(r, y + 0.015) for r, y in arc[::-1]], 96)


def magnifier():
    aperture, curvature, n = 0.45, 1.3, POLYCARBONATE['ior']
    height = 0.72 * curvature / (2 * (n - 1))  # of the lens over the paper: short of its focal length
    rim = revolve([(aperture + 0.002, -0.03), (aperture + 0.05, -0.03), (aperture + 0.05, 0.03), (aperture + 0.002, 0.03), (aperture + 0.002, -0.03)], 96)
    grip = revolve([(0, 0), (0.04, 0), (0.05, 0.1), (0.035, 0.6), (0, 0.6)], 32)
    light = np.array([0.3, -1, 0.1]) / math.sqrt(1.1)
    centre = tuple(-height * light)
    tilt = upright(-light)
    aside = np.cross(light, (0.3, 0, 1))
    aside /= np.linalg.norm(aside)
    return [camera((-0.5, 2.5, 2.3), (-0.05, 0.3, 0), 34, 512, 384), floor(12), Node('lens', centre, tilt, mesh=lens(aperture, curvature), material=glass(**POLYCARBONATE)),
            Node('rim', centre, tilt, mesh=rim, material=metal(0.8, 0.65, 0.4, roughness=0.3)),
            Node('grip', tuple(np.array(centre) + (aperture + 0.04) * aside), upright(aside), mesh=grip, material=lambert(0.25, 0.1, 0.05)),
            sun(2.2, tuple(light)), lamp(2, (-2, 4, 2), (0, 0, 0), 0.7)]


def lens_small():
    light, centre = (0.6, 4, 0), (0, 0.65, 0)  # short of the focus
    tilt = upright(np.subtract(light, centre))
    return [camera((-0.2, 1.5, 2.4), (-0.12, 0, 0), 11, 128, 128), floor(4),
            Node('lens', centre, tilt, mesh=lens(0.45, 1.3), material=glass(**FLINT)), spot_light('spot', light, centre, 30, 11, 12)]


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
          rough_metal_area, bent_normals, water_glass_exact, water_glass_overlap, iced_water_exact, iced_water_overlap, nested, prism, prism_small, flint_ball, gem, magnifier, lens_small, floor_lamp, furnace,
          furnace_glass,
          *GALLERY]


def main(wanted):
    scenes = {f.__name__.replace('_', '-'): f for f in SCENES}
    for name in wanted or scenes:
        path = Path(__file__).parent / f'{name}.glb'
        write_glb(path, name, scenes[name]())
        print(f'{path.name}: {path.stat().st_size} bytes')


if __name__ == '__main__':
    main(sys.argv[1:])
