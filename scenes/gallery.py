"""Scenes to look at, for generate.py: lengths as in the world, lamps where a photographer would put them."""
import math

import numpy as np

from gltf_writer import Node, camera, glass, lambert, lamp
from shapes import quad, revolve, spline, welded

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


GALLERY = [wine_glass]
