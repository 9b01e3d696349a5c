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


def heightfield(size, cells, height, normal):
    """y = height(x, z) over a square around the origin; normal(x, z) may differ from the geometry's."""
    axis = np.linspace(-size / 2, size / 2, cells + 1)
    z, x = (k.ravel() for k in np.meshgrid(axis, axis, indexing='ij'))
    return Mesh(np.stack([x, height(x, z), z], axis=1), _unit(np.stack(normal(x, z), axis=1)), _cells(cells + 1, cells + 1))


def convex(planes):
    """The solid n . p <= d for each (n, d) of planes, flat facets; n need not be unit."""
    planes = [(np.array(n, float) / np.linalg.norm(n), d / np.linalg.norm(n)) for n, d in planes]
    facets = []
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
        if len(corners) > 2:
            fan = [[0, i, i + 1] for i in range(1, len(corners) - 1)]
            facets.append(Mesh(np.array(corners), np.tile(n, (len(corners), 1)), np.array(fan)))
    return join(*facets)


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
