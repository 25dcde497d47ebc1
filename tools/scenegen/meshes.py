# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Makes triangle meshes. Corners run anticlockwise seen from outside."""

import itertools
import math
from dataclasses import dataclass, field

from .vectors import add, cross, dot, normalize, scale, sub

_GOLDEN = (1.0 + math.sqrt(5.0)) / 2.0


@dataclass
class Mesh:
    """Holds a mesh. Empty normals mean flat triangles."""

    positions: list
    indices: list
    normals: list = field(default_factory=list)
    colors: list = field(default_factory=list)
    uvs: list = field(default_factory=list)


def rectangle(width, depth):
    """Returns a rectangle in the plane y = 0 that faces +Y."""
    x, z = width / 2.0, depth / 2.0
    return Mesh([(-x, 0.0, z), (x, 0.0, z), (x, 0.0, -z), (-x, 0.0, -z)], [0, 1, 2, 0, 2, 3])


def box(width, height, depth):
    x, y, z = width / 2.0, height / 2.0, depth / 2.0
    positions = list(itertools.product((-x, x), (-y, y), (-z, z)))
    quads = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
    return Mesh(positions, [i for a, b, c, d in quads for i in (a, b, c, a, c, d)])


def tiled(mesh, tile_size):
    """Returns the flat triangles of a mesh. The texture coordinates of each triangle are its coordinates along the two
    axes with the smallest components of its normal."""
    positions, uvs = [], []
    for corners in zip(*[iter(mesh.indices)] * 3):
        a, b, c = (mesh.positions[i] for i in corners)
        normal = [abs(x) for x in cross(sub(b, a), sub(c, a))]
        u, v = ((2, 1), (0, 2), (0, 1))[normal.index(max(normal))]
        positions += [a, b, c]
        uvs += [(p[u] / tile_size, -p[v] / tile_size) for p in (a, b, c)]
    return Mesh(positions, list(range(len(positions))), uvs=uvs)


def frustum(height, radius_bottom, radius_top, sides):
    """Returns a closed frustum that stands along Y and is centred; a radius of 0 gives a cone."""
    positions, rings = [], []
    for y, radius in ((-height / 2.0, radius_bottom), (height / 2.0, radius_top)):
        corners = sides if radius > 0.0 else 1
        rings.append([len(positions) + i % corners for i in range(sides)])
        for i in range(corners):
            angle = math.tau * i / sides
            positions.append((radius * math.sin(angle), y, radius * math.cos(angle)))
    bottom, top = rings
    indices = []
    for i in range(sides):
        j = (i + 1) % sides
        indices += [bottom[i], bottom[j], top[j]] if radius_bottom > 0.0 else []
        indices += [bottom[i], top[j], top[i]] if radius_top > 0.0 else []
    for i in range(1, sides - 1):
        indices += [bottom[0], bottom[i + 1], bottom[i]] if radius_bottom > 0.0 else []
        indices += [top[0], top[i], top[i + 1]] if radius_top > 0.0 else []
    return Mesh(positions, indices)


def capsule(height, radius_bottom, radius_top, sides):
    """Returns the hull of two spheres around -+height / 2 along Y, as rings of corners between two poles."""
    sine = (radius_bottom - radius_top) / height
    touching = math.asin(sine)
    steps = sides // 4
    profile = []
    for y, radius, first, last in (
        (-height / 2.0, radius_bottom, -math.pi / 2.0, touching),
        (height / 2.0, radius_top, touching, math.pi / 2.0),
    ):
        for i in range(steps + 1):
            angle = first + (last - first) * i / steps
            profile.append((radius * math.cos(angle), y + radius * math.sin(angle)))
    rings = profile[1:-1]
    positions = [(0.0, profile[0][1], 0.0), (0.0, profile[-1][1], 0.0)]
    for radius, y in rings:
        turns = (math.tau * i / sides for i in range(sides))
        positions += [(radius * math.sin(turn), y, radius * math.cos(turn)) for turn in turns]
    indices = []
    for i in range(sides):
        j = (i + 1) % sides
        indices += [0, 2 + j, 2 + i]
        for ring in range(len(rings) - 1):
            low, high = 2 + ring * sides, 2 + (ring + 1) * sides
            indices += [low + i, low + j, high + j, low + i, high + j, high + i]
        last = 2 + (len(rings) - 1) * sides
        indices += [1, last + i, last + j]
    return Mesh(positions, indices)


def _convex_hull(points):
    """Returns the triangles of a small convex polyhedron. The search tries all triples of corners."""
    indices = []
    for a, b, c in itertools.permutations(range(len(points)), 3):
        if a < b and a < c:
            normal = cross(sub(points[b], points[a]), sub(points[c], points[a]))
            if all(dot(normal, sub(p, points[a])) < 1e-9 for p in points):
                indices += [a, b, c]
    return indices


def octahedron(radius):
    points = [scale(p, radius) for p in ((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1))]
    return Mesh(points, _convex_hull(points))


def icosahedron(radius):
    points = []
    for a, b in itertools.product((-1.0, 1.0), (-_GOLDEN, _GOLDEN)):
        points += [(0.0, a, b), (a, b, 0.0), (b, 0.0, a)]
    points = [scale(normalize(p), radius) for p in points]
    return Mesh(points, _convex_hull(points))


def stellated(mesh, height):
    """Puts a pyramid of this height, measured from the triangle's plane, on every triangle."""
    positions, indices = list(mesh.positions), []
    for i in range(0, len(mesh.indices), 3):
        corners = mesh.indices[i : i + 3]
        a, b, c = (mesh.positions[k] for k in corners)
        normal = normalize(cross(sub(b, a), sub(c, a)))
        apex = len(positions)
        positions.append(add(scale(add(add(a, b), c), 1.0 / 3.0), scale(normal, height)))
        for k in range(3):
            indices += [corners[k], corners[(k + 1) % 3], apex]
    return Mesh(positions, indices)


def icosphere(radius, subdivisions):
    """Returns a subdivided icosahedron without normals."""
    mesh = icosahedron(1.0)
    positions, indices = mesh.positions, mesh.indices
    for _ in range(subdivisions):
        middles, finer = {}, []

        def middle(a, b):
            key = (min(a, b), max(a, b))
            if key not in middles:
                middles[key] = len(positions)
                positions.append(normalize(add(positions[a], positions[b])))
            return middles[key]

        for i in range(0, len(indices), 3):
            a, b, c = indices[i : i + 3]
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            finer += [a, ab, ca, b, bc, ab, c, ca, bc, ab, bc, ca]
        indices = finer
    return Mesh([scale(p, radius) for p in positions], indices)


def smooth(mesh):
    """Returns the same mesh with vertex normals: the mean of the triangles' normals, weighted by area."""
    sums = [(0.0, 0.0, 0.0)] * len(mesh.positions)
    for i in range(0, len(mesh.indices), 3):
        corners = mesh.indices[i : i + 3]
        a, b, c = (mesh.positions[k] for k in corners)
        normal = cross(sub(b, a), sub(c, a))
        for k in corners:
            sums[k] = add(sums[k], normal)
    return Mesh(mesh.positions, mesh.indices, [normalize(n) for n in sums], mesh.colors)


def torus_grid(rows, columns, surface):
    """Returns a closed grid of the points surface(u, v), with smooth normals. u and v are in [0, 1) and periodic.

    du x dv must point outward.
    """
    positions = [surface(i / rows, j / columns) for i in range(rows) for j in range(columns)]
    indices = []
    for i, j in itertools.product(range(rows), range(columns)):
        a, b = i * columns + j, (i + 1) % rows * columns + j
        c, d = (i + 1) % rows * columns + (j + 1) % columns, i * columns + (j + 1) % columns
        indices += [a, b, c, a, c, d]
    return smooth(Mesh(positions, indices))


def torus(major, minor, rows, columns):
    def surface(u, v):
        ring = major + minor * math.cos(math.tau * v)
        return (ring * math.sin(math.tau * u), minor * math.sin(math.tau * v), ring * math.cos(math.tau * u))

    return torus_grid(rows, columns, surface)


def torus_knot(p, q, major, minor, tube, flutes, twists, depth, rows, columns):
    """Returns a (p, q) torus knot about the Y axis: a tube with a fluted, twisting section.

    The knot winds p times around the axis and q times through the hole. The tube has `flutes` grooves of relative
    `depth`, which make `twists` turns on the way.
    """

    def surface(u, v):
        around, through = math.tau * p * u, math.tau * q * u
        ring, ring_slope = major + minor * math.cos(through), -q * minor * math.sin(through)
        here = (ring * math.cos(around), minor * math.sin(through), ring * math.sin(around))
        tangent = normalize(
            (
                ring_slope * math.cos(around) - ring * p * math.sin(around),
                q * minor * math.cos(through),
                ring_slope * math.sin(around) + ring * p * math.cos(around),
            )
        )
        # The frame follows the torus: one axis points away from the middle of the torus' tube, so that the frame
        # closes.
        outward = sub(here, (major * math.cos(around), 0.0, major * math.sin(around)))
        side = normalize(sub(outward, scale(tangent, dot(outward, tangent))))
        other = cross(tangent, side)
        angle = math.tau * v
        radius = tube * (1.0 + depth * math.cos(flutes * angle + math.tau * twists * u))
        return add(here, add(scale(side, radius * math.cos(angle)), scale(other, -radius * math.sin(angle))))

    return torus_grid(rows, columns, surface)
