"""Triangle meshes for generate.py. Counter-clockwise seen from the front; normals are unit and point to the front."""
from dataclasses import dataclass
from itertools import combinations, product

import numpy as np


@dataclass
class Mesh:
    positions: np.ndarray  # n x 3
    normals: np.ndarray  # n x 3
    triangles: np.ndarray  # m x 3


def _unit(v):
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def join(*meshes):
    starts = np.cumsum([0] + [len(m.positions) for m in meshes[:-1]])
    return Mesh(np.concatenate([m.positions for m in meshes]), np.concatenate([m.normals for m in meshes]),
                np.concatenate([m.triangles + s for m, s in zip(meshes, starts)]))


def flipped(mesh):
    """The same surface seen from its other side."""
    return Mesh(mesh.positions, -mesh.normals, mesh.triangles[:, ::-1])


def moved(mesh, by):
    return Mesh(mesh.positions + np.array(by), mesh.normals, mesh.triangles)


def scaled(mesh, factor):
    return Mesh(mesh.positions * factor, mesh.normals, mesh.triangles)


def turned(mesh, rotation):
    """By a rotation's matrix."""
    return Mesh(mesh.positions @ rotation.T, mesh.normals @ rotation.T, mesh.triangles)


def quad(a, b, c, d):
    corners = np.array([a, b, c, d], float)
    normal = _unit(np.cross(corners[1] - corners[0], corners[2] - corners[0]))
    return Mesh(corners, np.tile(normal, (4, 1)), np.array([[0, 1, 2], [0, 2, 3]]))


def square(size):
    """In the plane y = 0, around the origin, facing +Y."""
    h = size / 2
    return quad((-h, 0, h), (h, 0, h), (h, 0, -h), (-h, 0, -h))


def box_inside(size, height):
    """The six walls of a room on y = 0, facing inwards."""
    h = size / 2
    x = [(-h, 0, h), (h, 0, h), (h, 0, -h), (-h, 0, -h)]
    y = [(px, height, pz) for px, _, pz in x]
    walls = [quad(x[(i + 1) % 4], x[i], y[i], y[(i + 1) % 4]) for i in range(4)]
    return join(quad(*x), quad(*reversed(y)), *walls)


def _icosahedron():
    golden = (1 + 5 ** 0.5) / 2
    corner = [(a, b * golden, 0) for a, b in product((-1, 1), repeat=2)]
    v = np.array([np.roll(c, k) for c in corner for k in range(3)], float)
    edge = 2 + 1e-9  # the next longer distance between two corners is 3.2
    faces = [f for f in combinations(range(12), 3) if all(np.linalg.norm(v[i] - v[j]) < edge for i, j in combinations(f, 2))]
    outward = [f if np.linalg.det(v[list(f)]) > 0 else f[::-1] for f in faces]
    return _unit(v), np.array(outward)


def icosphere(level):
    """Unit sphere: 20 * 4^level triangles, exact normals."""
    vertices, faces = _icosahedron()
    for _ in range(level):
        edges = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
        unique, which = np.unique(edges, axis=0, return_inverse=True)
        ab, bc, ca = (len(vertices) + which.reshape(3, -1))
        vertices = np.concatenate([vertices, _unit(vertices[unique].sum(axis=1))])
        a, b, c = faces.T
        faces = np.concatenate([np.stack(t, axis=1) for t in ((a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca))])
    return Mesh(vertices, vertices, faces)


def _cells(rows, columns, wrap=False):
    """Two triangles for each cell of a lattice of rows x columns vertices, front where rows x columns points."""
    last = columns if wrap else columns - 1
    i, j = (k.ravel() for k in np.meshgrid(np.arange(rows - 1), np.arange(last), indexing='ij'))
    a, b = i * columns + j, i * columns + (j + 1) % columns
    c, d = b + columns, a + columns
    return np.concatenate([np.stack([a, d, c], axis=1), np.stack([a, c, b], axis=1)])


def fan(centre, line):
    """Flat triangles from one point to the pieces of a line, seen with the line running clockwise about the point."""
    corners = np.concatenate([[centre], line])
    normal = _unit(np.cross(corners[2] - corners[0], corners[1] - corners[0]))
    return Mesh(corners, np.tile(normal, (len(corners), 1)), np.array([[0, i + 1, i] for i in range(1, len(line))]))


def strip(lower, upper):
    """Flat-shaded band between two polylines of as many points, seen with lower below and running to the right."""
    return join(*(quad(lower[i], lower[i + 1], upper[i + 1], upper[i]) for i in range(len(lower) - 1)))


def heightfield(size, cells, height, normal):
    """y = height(x, z) over a square around the origin; normal(x, z) may differ from the geometry's."""
    axis = np.linspace(-size / 2, size / 2, cells + 1)
    z, x = (k.ravel() for k in np.meshgrid(axis, axis, indexing='ij'))
    return Mesh(np.stack([x, height(x, z), z], axis=1), _unit(np.stack(normal(x, z), axis=1)), _cells(cells + 1, cells + 1))


def facets(planes):
    """The faces of the solid n . p <= d, flat, one for each (n, d) of planes in their order; n need not be unit.

    A plane that bounds nothing of the solid has an empty mesh.
    """
    planes = [(np.array(n, float) / np.linalg.norm(n), d / np.linalg.norm(n)) for n, d in planes]
    faces = []
    for k, (n, d) in enumerate(planes):
        u = _unit(np.cross(n, np.eye(3)[np.argmin(abs(n))]))
        v = np.cross(n, u)
        far = 1e3  # wider than any solid here
        outline = [d * n + far * (i * u + j * v) for i, j in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        for other, (m, e) in enumerate(planes):
            if other != k:
                outline = _clipped(outline, m, e)
        # Facets that meet at a corner find it each by itself: rounded, it is one.
        corners = [p for i, p in enumerate(np.round(outline, 7)) if np.linalg.norm(p - np.round(outline, 7)[i - 1]) > 1e-6]
        fan = [[0, i, i + 1] for i in range(1, len(corners) - 1)]
        faces.append(Mesh(np.array(corners), np.tile(n, (len(corners), 1)), np.array(fan)) if fan else
                     Mesh(np.zeros((0, 3)), np.zeros((0, 3)), np.zeros((0, 3), int)))
    return faces


def convex(planes):
    """The solid of facets(), as one mesh."""
    return join(*facets(planes))


def _clipped(outline, n, d):
    """The part of a polygon where n . p <= d (Sutherland & Hodgman 1974)."""
    kept = []
    for p, q in zip(outline, outline[1:] + outline[:1]):
        a, b = n @ p - d, n @ q - d
        if a <= 0:
            kept.append(p)
        if (a <= 0) != (b <= 0):
            kept.append(p + (q - p) * (a / (a - b)))
    return kept


def _left(a, b, c):
    """Twice the area of a triangle in the plane, > 0 if its corners turn to the left."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _crosses(a, b, c, d):
    """Whether the inner parts of two segments meet."""
    return _left(a, b, c) * _left(a, b, d) < 0 and _left(c, d, a) * _left(c, d, b) < 0


def _bridged(outline, holes, points):
    """One outline, of indices, for all: each hole is reached by the shortest cut that crosses nothing."""
    edges = [e for loop in (outline, *holes) for e in zip(loop, loop[1:] + loop[:1])]
    for hole in holes:
        once = [i for i, k in enumerate(outline) if outline.count(k) == 1]  # where a cut ends already, sides would be mixed up
        cuts = sorted(product(once, range(len(hole))),
                      key=lambda ij: np.linalg.norm(points[outline[ij[0]]] - points[hole[ij[1]]]))
        i, j = next((i, j) for i, j in cuts
                    if not any(_crosses(points[outline[i]], points[hole[j]], points[a], points[b]) for a, b in edges))
        edges.append((outline[i], hole[j]))
        outline = outline[:i + 1] + hole[j:] + hole[:j + 1] + outline[i:]
    return outline


def level_with_holes(outline, holes):
    """The level surface that faces +Y inside of an outline and outside of holes in it (corners n x 3, either way round)."""
    def turned(loop, left):
        area = sum(_left((0, 0), p, q) for p, q in zip(loop[:, [2, 0]], np.roll(loop[:, [2, 0]], -1, axis=0)))
        return loop if (area > 0) == left else loop[::-1]

    loops = [turned(np.array(outline), True)] + [turned(np.array(h), False) for h in holes]
    positions = np.concatenate(loops)
    points = positions[:, [2, 0]]  # z, x: a right-handed plane with +Y towards the viewer
    starts = np.cumsum([0] + [len(loop) for loop in loops])
    indices = [list(range(a, b)) for a, b in zip(starts, starts[1:])]
    rest, triangles = _bridged(indices[0], indices[1:], points), []
    while len(rest) > 2:  # cut off an ear (Meisters 1975)
        for i in range(len(rest)):
            ear = rest[i - 1], rest[i], rest[(i + 1) % len(rest)]
            a, b, c = points[list(ear)]
            inside = (_left(a, b, p) >= 0 and _left(b, c, p) >= 0 and _left(c, a, p) >= 0 for p in (points[k] for k in rest if k not in ear))
            if _left(a, b, c) > 1e-12 and not any(inside):
                break
        else:
            raise ValueError('outlines that cross')
        triangles.append(ear)
        del rest[i]
    return Mesh(positions, np.tile((0.0, 1.0, 0.0), (len(positions), 1)), np.array(triangles))


def _ring(radius, y, normal, segments):
    """Vertices and normals of one circle; normal is (outward, up)."""
    angle = np.arange(segments) * (2 * np.pi / segments)
    c, s, one = np.cos(angle), np.sin(angle), np.ones(segments)
    return np.stack([radius * c, y * one, -radius * s], axis=1), np.stack([normal[0] * c, normal[1] * one, -normal[0] * s], axis=1)


def revolve(profile, segments, crease_degrees=30):
    """Solid or band of revolution about Y. profile: (radius, y), walked so that the front is on the right-hand side.

    Normals are averaged across corners blunter than crease_degrees. Points on the axis close the surface.
    """
    points = np.array(profile, float)
    along = _unit(np.diff(points, axis=0))
    facing = np.stack([along[:, 1], -along[:, 0]], axis=1)  # right-hand side of each piece
    smooth = (facing[:-1] * facing[1:]).sum(axis=1) > np.cos(np.radians(crease_degrees))
    bands = []
    for k in range(len(facing)):
        start = facing[k - 1] + facing[k] if k > 0 and smooth[k - 1] else facing[k]
        end = facing[k] + facing[k + 1] if k < len(smooth) and smooth[k] else facing[k]
        rings = [_ring(*points[k + i], _unit(n), segments) for i, n in ((0, start), (1, end))]
        positions, normals = (np.concatenate(part) for part in zip(*rings))
        triangles = _cells(2, segments, wrap=True)[:, ::-1]
        keep = np.linalg.norm(np.cross(positions[triangles[:, 1]] - positions[triangles[:, 0]],
                                       positions[triangles[:, 2]] - positions[triangles[:, 0]]), axis=1) > 1e-12
        bands.append(Mesh(positions, normals, triangles[keep]))
    return join(*bands)


def welded(mesh):
    """The same mesh, its equal vertices (position and normal to 1e-6) stored once."""
    rows, index = np.unique(np.round(np.hstack([mesh.positions, mesh.normals]), 6) + 0.0, axis=0, return_inverse=True)
    return Mesh(rows[:, :3], rows[:, 3:], index.reshape(-1)[mesh.triangles])


def spline(points, pieces):
    """Points of a smooth curve through the given ones, that many for each gap (Catmull-Rom, centripetal by Barry & Goldman 1988)."""
    p = np.array(points, float)
    p = np.concatenate([[2 * p[0] - p[1]], p, [2 * p[-1] - p[-2]]])
    knots = np.concatenate([[0], np.cumsum(np.sqrt(np.linalg.norm(np.diff(p, axis=0), axis=1)))])

    def between(k, low, high, t, a, b):
        return ((knots[k + high] - t) * a + (t - knots[k + low]) * b) / (knots[k + high] - knots[k + low])

    curve = []
    for k in range(len(p) - 3):
        for t in np.linspace(knots[k + 1], knots[k + 2], pieces, endpoint=False):
            a, b, c = (between(k, i, i + 1, t, p[k + i], p[k + i + 1]) for i in range(3))
            curve.append(tuple(between(k, 1, 2, t, between(k, 0, 2, t, a, b), between(k, 1, 3, t, b, c))))
    return curve + [tuple(p[-2])]
