"""Scenes to look at, for generate.py: lengths as in the world, lamps where a photographer would put them."""
import math

import numpy as np

from gltf_writer import Node, camera, emitter, glass, lambert, lamp, metal, quaternion, spot_light
from shapes import (box_inside, convex, fan, flipped, heightfield, icosphere, join, moved, quad, revolve, scaled, spline, square, strip,
                    turned, welded)

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


# ---- a chandelier of fifty lamps

TIERS = [(24, 0.52, 2.05), (16, 0.36, 2.22), (10, 0.2, 2.39)]  # lamps, radius and height of each ring, m
ROOM, CEILING = 4.6, 3.2  # m: side and height of the room; it hangs in its middle


def tube(a, b, radius):
    a, b = (np.array(p, float) for p in (a, b))
    length = np.linalg.norm(b - a)
    side = revolve([(0, 0), (radius, 0), (radius, length), (0, length)], 12)
    y = (b - a) / length
    x = np.cross(y, (0.3, 0.2, 1)) / np.linalg.norm(np.cross(y, (0.3, 0.2, 1)))
    return moved(turned(side, np.stack([x, y, np.cross(x, y)], axis=1)), a)


def torus(radius, thickness, y):
    angle = np.linspace(0, 2 * math.pi, 13)
    return revolve([(radius + thickness * math.cos(a), y + thickness * math.sin(a)) for a in angle], 72)


def cut_drop(radius, half_length):
    """An ellipsoid's facets: five staggered rows of eight, and a point cut flat at each end."""
    rows = [(math.radians(-62 + 31 * row), (np.arange(8) + 0.5 * row) * math.pi / 4) for row in range(5)]
    normals = [(math.cos(t) * math.cos(a), math.sin(t), math.cos(t) * math.sin(a)) for t, angles in rows for a in angles]
    return convex([(n, math.hypot(radius * math.hypot(n[0], n[2]), half_length * n[1])) for n in normals + [(0, 1, 0), (0, -1, 0)]])


def cut_stone(radius):
    """A table, eight crown facets, and sixteen below so steep that they turn most light from above back up."""
    crown = [(math.radians(56), np.arange(8) * math.pi / 4, 0.05)]
    pavilion = [(math.radians(-46), np.arange(8) * math.pi / 4, -0.03), (math.radians(-50), (np.arange(8) + 0.5) * math.pi / 4, -0.03)]
    planes = [((math.cos(t) * math.cos(a), math.sin(t), math.cos(t) * math.sin(a)), radius * (math.cos(t) + math.sin(t) * y))
              for t, angles, y in crown + pavilion for a in angles]
    return convex(planes + [((0, 1, 0), 0.38 * radius)])


def chandelier():
    """Narrow spots in black sockets light one piece of crystal each; the bulbs are what is seen of them."""
    socket = revolve([(0.011, 0), (0.011, 0.03), (0.008, 0.04), (0, 0.043)], 24, crease_degrees=50)
    shapes, bulb = (cut_stone(0.027), cut_drop(0.024, 0.036)), icosphere(1)
    brass, crystal = metal(0.85, 0.62, 0.3, 0.35, double_sided=True), glass(1.6)
    metalwork, sockets, bulbs, lamps, drops = [tube((0, 2.0, 0), (0, CEILING, 0), 0.008)], [], [], [], []
    for count, radius, y in TIERS:
        metalwork.append(torus(radius, 0.007, y + 0.04))
        metalwork += [tube((0, y + 0.11, 0), (radius * math.cos(a), y + 0.04, radius * math.sin(a)), 0.004)
                      for a in np.arange(8) * math.pi / 4]
        for a in (np.arange(count) + 0.5) * 2 * math.pi / count:
            place = np.array((radius * math.cos(a), y, radius * math.sin(a)))
            sockets.append(moved(socket, place))
            bulbs.append(moved(scaled(bulb, 0.009), place - (0, 0.005, 0)))
            lamps.append(spot_light(f'lamp-{len(lamps) + 1:02}', tuple(place - (0, 0.015, 0)), tuple(place - (0, 1, 0)), 14, 8.5, 9,
                                    (1, 0.85, 0.65)))
            drops.append(moved(turned(shapes[len(drops) % 2], rotation_y(math.degrees(1.3 * len(drops)))), place - (0, 0.11, 0)))
    ball = turned(convex([(n, 0.06) for n in icosphere(1).positions]), rotation_y(10))
    return [camera((0.4, 1.5, 1.75), (0.02, 2.3, 0), 58), Node('room', mesh=box_inside(ROOM, CEILING), material=lambert(0.56, 0.26, 0.18)),
            Node('floor', (0, 0.002, 0), mesh=square(ROOM), material=lambert(0.2, 0.12, 0.07)),
            Node('ceiling', (0, CEILING - 0.002, 0), mesh=flipped(square(ROOM)), material=lambert(0.6, 0.56, 0.5)),
            Node('brass', mesh=welded(join(*metalwork)), material=brass),
            Node('sockets', mesh=welded(join(*sockets)), material=lambert(0.02, 0.02, 0.02)),
            Node('bulbs', mesh=welded(join(*bulbs)), material=emitter(60, color=(1, 0.8, 0.55))),
            Node('drops', mesh=join(*drops), material=crystal), Node('ball', (0, 1.94, 0), mesh=ball, material=crystal), *lamps]


# ---- a room behind glass blocks

BLOCK, THICK, JOINT = 0.19, 0.08, 0.012  # m: pitch of the blocks, their thickness, the mortar between them
COUNT, SILL = 7, 0.7  # blocks along each side of the window; m: height of its lower edge
LONG, HIGH = 3.6, 2.6  # m: of the room


def glass_block():
    """Closed, flat towards its rim, and with a swell inside of it on both faces; y is across."""
    size = BLOCK - JOINT - 0.001

    def bump(x, z):
        u, v = 2 * x / size, 2 * z / size
        return 0.0028 * ((1 - u ** 4) * (1 - v ** 4)) ** 2 * (0.5 * np.cos(5.2 * u + 1.2 * v) + 0.5 * np.cos(4.1 * v - 2.1 * u + 0.7) - 0.6)

    def normal(x, z):
        e = 1e-4
        return (bump(x - e, z) - bump(x + e, z)) / (2 * e), np.ones_like(x), (bump(x, z - e) - bump(x, z + e)) / (2 * e)

    face = moved(heightfield(size, 24, bump, normal), (0, THICK / 2, 0))
    back = turned(face, np.diag([1, -1, -1]))
    edge = np.stack([np.linspace(-size / 2, size / 2, 25), np.full(25, THICK / 2), np.full(25, size / 2)], axis=1)
    side = strip(edge * (1, -1, 1), edge)
    return welded(join(face, back, *(turned(side, rotation_y(90 * t)) for t in range(4))))


def slab(low, high):
    """An axis-parallel box."""
    return convex([(np.eye(3)[k] * s, (high if s > 0 else low)[k] * s) for k in range(3) for s in (1, -1)])


def window_wall(x):
    """The wall at x with its opening, and the bars of mortar in it."""
    w, half = COUNT * BLOCK / 2, LONG / 2
    top = SILL + 2 * w
    parts = [((0, -half), (SILL, half)), ((top, -half), (HIGH, half)), ((SILL, -half), (top, -w)), ((SILL, w), (top, half))]
    faces = [quad((at, y0, z1), (at, y0, z0), (at, y1, z0), (at, y1, z1)) for (y0, z0), (y1, z1) in parts for at in (x, x - 0.15)]
    rims = [[(SILL, -w), (SILL, w), (top, w), (top, -w)], [(0, -half), (HIGH, -half), (HIGH, half), (0, half)]]  # height and z
    edges = [quad((x, *p), (x - 0.15, *p), (x - 0.15, *q), (x, *q)) for rim in rims for p, q in zip(rim, rim[1:] + rim[:1])]
    wall = join(*faces, *edges)
    middle, deep = x - 0.07, 0.85 * THICK / 2
    lines = [k * BLOCK - w for k in range(COUNT + 1)]
    upright_bars = [slab((middle - deep, SILL, z - JOINT / 2), (middle + deep, top, z + JOINT / 2)) for z in lines]
    level_bars = [slab((middle - deep, SILL + w + y - JOINT / 2, -w), (middle + deep, SILL + w + y + JOINT / 2, w)) for y in lines]
    return wall, join(*upright_bars, *level_bars)


def checkers(size, count):
    """The squares of a floor, of each colour, all on y = 0."""
    step, parts = size / count, ([], [])
    for i in range(count):
        for j in range(count):
            corner = np.array((i * step - size / 2, 0, (j + 1) * step - size / 2))
            parts[(i + j) % 2].append(quad(corner, corner + (step, 0, 0), corner + (step, 0, -step), corner - (0, 0, step)))
    return parts


def blocks_in(x):
    """All of one mesh, turned by quarters so that no pattern shows."""
    block, inwards = glass_block(), np.array([[0, 1, 0], [0, 0, 1], [1, 0, 0]])
    blocks = []
    for row in range(COUNT):
        for column in range(COUNT):
            place = (x - 0.07, SILL + (row + 0.5) * BLOCK, (column + 0.5 - COUNT / 2) * BLOCK)
            turn = inwards @ rotation_y(90 * ((row * row + 3 * column + row * column) % 4))
            blocks.append(Node(f'block-{row + 1}-{column + 1}', place, quaternion(*turn.T), mesh=block,
                               material=glass(1.52, ((0.7, 0.9, 0.85), 0.3))))
    return blocks


def vase():
    line = [(0.001, 0.004)] + spline([(0.075, 0.004), (0.085, 0.02), (0.14, 0.16), (0.15, 0.25), (0.1, 0.38), (0.05, 0.47), (0.065, 0.55)], 5)
    return revolve(line + [(r - 0.008, y) for r, y in line[:5:-1]], 64, crease_degrees=70)


def glass_blocks():
    x, half = -LONG / 2, LONG / 2
    wall, mortar = window_wall(x)
    light, dark = (join(*part) for part in checkers(LONG, 12))
    white = lambert(0.76, 0.74, 0.7)
    walls = join(quad((x, 0, -half), (half, 0, -half), (half, HIGH, -half), (x, HIGH, -half)),
                 quad((half, 0, half), (x, 0, half), (x, HIGH, half), (half, HIGH, half)),
                 quad((half, 0, -half), (half, 0, half), (half, HIGH, half), (half, HIGH, -half)),
                 quad((x, HIGH, -half), (half, HIGH, -half), (half, HIGH, half), (x, HIGH, half)))
    bench = join(slab((-0.75, 0.4, -1.6), (0.45, 0.45, -1.2)), *(slab((a, 0.001, -1.55), (a + 0.06, 0.4, -1.25)) for a in (-0.7, 0.34)))
    return [camera((1.5, 1.45, 1.65), (-0.6, 0.85, -0.55), 58), Node('walls', mesh=walls, material=white),
            Node('window-wall', mesh=wall, material=white),
            Node('mortar', mesh=mortar, material=lambert(0.5, 0.5, 0.48)), Node('tiles-light', mesh=light, material=white),
            Node('tiles-dark', mesh=dark, material=lambert(0.12, 0.16, 0.17)), Node('bench', mesh=bench, material=lambert(0.4, 0.24, 0.12)),
            Node('vase', (-0.45, 0.451, -1.4), mesh=welded(vase()), material=lambert(0.1, 0.25, 0.5)), *blocks_in(x)]


GALLERY = [wine_glass, pool_net, chandelier, glass_blocks]
