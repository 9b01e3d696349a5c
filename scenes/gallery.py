"""Scenes to look at, for generate.py: lengths as in the world, lamps where a photographer would put them."""
import math

import numpy as np

from gltf_writer import Node, camera, glass, lambert, lamp
from shapes import fan, heightfield, icosphere, join, quad, revolve, spline, square, strip, turned, welded

# ---- wine on a table; lengths in centimetres, scaled to metres below

FOOT = [(3.45, 0.04), (3.5, 0.1), (3.4, 0.17), (2.6, 0.25), (1.4, 0.42), (0.62, 0.9), (0.39, 1.7), (0.34, 3.2), (0.34, 5.4), (0.37, 6.9), (0.58, 7.8)]
# The bowl, from below: its outside and its inside, which the rim joins.
BOWL = [((1.4, 8.35), (1.3, 8.66)), ((2.7, 9.3), (2.6, 9.47)), ((3.72, 10.7), (3.59, 10.78)), ((4.15, 12.4), (4.02, 12.42)),
        ((4.05, 14.2), (3.92, 14.18)), ((3.65, 16.2), (3.53, 16.17)), ((3.2, 18.2), (3.09, 18.17))]
RIM, WELL, WINE_LEVEL = (3.16, 18.26), (0, 8.52), 12.9


def goblet():
    outside, inside = ([sides[i] for sides in BOWL] for i in (0, 1))
    wall = spline(FOOT + outside + [RIM] + inside[::-1] + [(0.4, 8.53), WELL], 6)
    return revolve([(0, 0), (3.35, 0)] + wall, 112, crease_degrees=60)


def wine():
    """Reaches half-way into the goblet's wall, whose priority is higher."""
    middle = [tuple(np.mean(sides, axis=0)) for sides in BOWL]
    side = [p for p in spline([(0, 8.42), (0.4, 8.43)] + middle, 6) if p[1] < WINE_LEVEL]
    return revolve(side + [(side[-1][0] + 0.005, WINE_LEVEL), (0, WINE_LEVEL)], 112)


def window(centre, toward, size, radiance, color):
    """Four panes with a cross between them: what is seen mirrored in glass."""
    middle, pane = np.array(centre, float), 0.46 * size
    back = (middle - toward) / np.linalg.norm(middle - toward)
    right = np.cross((0, 1, 0), back) / np.linalg.norm(np.cross((0, 1, 0), back))
    up = np.cross(back, right)
    corners = [middle + size / 2 * (i * right + j * up) for i, j in ((-1, 1), (1, 1), (-1, -1), (1, -1))]
    return [lamp(pane, tuple(c), tuple(c - back), radiance, f'window-{k + 1}', color) for k, c in enumerate(corners)]


def wine_glass():
    red = glass(1.345, absorption=((0.72, 0.045, 0.075), 0.018))
    table = revolve([(0, -3), (61, -3), (62, -2.7), (62.4, -1.5), (62, -0.3), (61, 0), (0, 0)], 128, crease_degrees=60)
    wall = quad((-3, -1, -1.1), (3, -1, -1.1), (3, 2, -1.1), (-3, 2, -1.1))
    cm, above = 0.01, (0, 0.0002, 0)
    return [camera((0.07, 0.3, 0.62), (0.055, 0.08, 0.02), 26), Node('table', scale=cm, mesh=table, material=lambert(0.78, 0.74, 0.68)),
            Node('wall', mesh=wall, material=lambert(0.16, 0.25, 0.27)),
            Node('glass', above, scale=cm, mesh=welded(goblet()), material=glass(1.5), extras=dict(priority=2)),
            Node('wine', above, scale=cm, mesh=welded(wine()), material=red, extras=dict(priority=1)),
            lamp(0.05, (-0.42, 0.62, -0.3), (0, 0.1, 0), 600, color=(1, 0.92, 0.8)),
            *window((-0.75, 0.6, 0.75), (0, 0.1, 0), 0.5, 2.6, (0.75, 0.88, 1))]


# ---- a pool under the sun

SIDE, DEPTH, BRIM = 4, 1.25, 1.4  # m: of the basin, of the water, and height of the basin's edge over its floor


def waves(x, z):
    """Height and slopes of ripples from many sides, curved so that most of their crests focus near the floor."""
    height, dx, dz = np.zeros_like(x), np.zeros_like(x), np.zeros_like(x)
    for i in range(18):
        k = 2 * math.pi / (0.3 * 1.075 ** i)  # wavelengths from 0.3 to 1.03 m
        kx, kz = k * math.cos(2.4 * i), k * math.sin(2.4 * i)  # nearly the golden angle: no two alike
        amplitude, phase = 0.85 / k ** 2, 1.7 * i * i
        height += amplitude * np.sin(kx * x + kz * z + phase)
        dx += amplitude * kx * np.cos(kx * x + kz * z + phase)
        dz += amplitude * kz * np.cos(kx * x + kz * z + phase)
    return height, dx, dz


def basin_water():
    """A closed body that reaches into the walls and below the floor, so that it ends nowhere in sight."""
    size = SIDE + 0.02
    top = heightfield(size, 140, lambda x, z: DEPTH + waves(x, z)[0], lambda x, z: (-waves(x, z)[1], np.ones_like(x), -waves(x, z)[2]))
    edge = np.linspace(-size / 2, size / 2, 141)
    half = np.full_like(edge, size / 2)
    around = [np.stack([x, DEPTH + waves(x, z)[0], z], axis=1) for x, z in ((edge, half), (half, -edge), (-edge, -half), (-half, edge))]
    below = [upper * (1, 0, 1) - (0, 0.01, 0) for upper in around]
    return join(top, *(strip(*pair) for pair in zip(below, around)), *(fan((0, -0.01, 0), line) for line in below))


def tiles(origin, u, v, columns, rows, gap, tints):
    """Squares on a lattice, in so many meshes of tints that take turns without order."""
    origin, u, v = (np.array(a, float) for a in (origin, u, v))
    parts = [[] for _ in range(tints)]
    for i in range(columns):
        for j in range(rows):
            low, high = (origin + (i + a) * u + (j + a) * v for a in (gap, 1 - gap))
            along = (1 - 2 * gap) * u
            parts[(7 * i * i + 5 * j * j + 3 * i * j + i) % 11 % tints].append(quad(low, low + along, high, high - along))
    return [join(*part) for part in parts]


def rotation_y(degrees):
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])


def slabs_around(inner, outer, low, top):
    """Four level slabs around a square, with their inner edges."""
    side = join(quad((-inner, top, inner), (-outer, top, outer), (outer, top, outer), (inner, top, inner)),
                quad((inner, low, inner), (-inner, low, inner), (-inner, top, inner), (inner, top, inner)))
    return join(*(turned(side, rotation_y(90 * t)) for t in range(4)))


def pool_net():
    h, rise = SIDE / 2, 0.004  # tiles lie so high on their mortar
    sheets = [tiles((-h, rise, h), (0.25, 0, 0), (0, 0, -0.25), 16, 16, 0.02, 3)]
    side = tiles((-h, 0, -h + rise), (0.25, 0, 0), (0, 0.2, 0), 16, 7, 0.02, 3)
    sheets += [[turned(part, rotation_y(90 * t)) for part in side] for t in range(4)]
    colors = [(0.5, 0.72, 0.75), (0.42, 0.66, 0.74), (0.6, 0.77, 0.76)]
    tile_nodes = [Node(f'tiles-{k + 1}', mesh=join(*(sheet[k] for sheet in sheets)), material=lambert(*colors[k])) for k in range(3)]
    wall = quad((-h, 0, -h), (h, 0, -h), (h, BRIM, -h), (-h, BRIM, -h))
    mortar = join(square(SIDE), *(turned(wall, rotation_y(90 * t)) for t in range(4)))
    return [camera((0.5, 4.4, 3.9), (0.05, 0.82, -0.1), 39), Node('mortar', mesh=mortar, material=lambert(0.62, 0.62, 0.58)), *tile_nodes,
            Node('water', mesh=welded(basin_water()), material=glass(1.333, absorption=((0.4, 0.8, 0.87), 3))),
            Node('coping', mesh=slabs_around(h, h + 0.35, BRIM, BRIM + 0.04), material=lambert(0.72, 0.68, 0.6)),
            Node('deck', mesh=slabs_around(h + 0.35, h + 3, BRIM, BRIM + 0.035), material=lambert(0.36, 0.24, 0.15)),
            Node('ball', (-0.75, DEPTH + 0.12, -0.7), scale=0.28, mesh=icosphere(4), material=lambert(0.8, 0.16, 0.08))]


GALLERY = [wine_glass, pool_net]
