# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Makes a still life on a table: wood, velvet, glazed china, fruit, glass, gold, brushed steel and a lantern of
paper."""

import itertools
import math
import random

from . import meshes
from .gltf import Gltf
from .vectors import quaternion_about

# A lamp with a surface is a grid of point sources, so that its shadows have soft edges.
_LAMP_SIDE = 3


def still_life():
    g = Gltf()
    _table(g)
    _runner(g)
    _bowl_of_fruit(g)
    _bottle(g)
    _armillary(g)
    _lantern(g)
    _small_things(g)
    _lamp(g, "key", (-5.2, 5.8, 2.6), 1.1, (1.0, 0.92, 0.82), 1250.0)
    _lamp(g, "rim", (6.4, 4.2, 1.2), 0.8, (0.72, 0.86, 1.0), 190.0)
    g.camera("main", (0.5, 2.7, 10.4), (0.1, 1.1, 0.0), yfov_deg=23.5)
    return g


def _spline(points, steps):
    """Returns a smooth line through points of any dimension (Catmull and Rom), with `steps` steps between two
    points."""
    padded = [points[0], *points, points[-1]]
    line = []
    for a, b, c, d in zip(padded, padded[1:], padded[2:], padded[3:]):
        for i in range(steps):
            t = i / steps
            weights = (
                0.5 * (-t + 2 * t * t - t**3),
                0.5 * (2 - 5 * t * t + 3 * t**3),
                0.5 * (t + 4 * t * t - 3 * t**3),
                0.5 * (-t * t + t**3),
            )
            line.append(tuple(sum(w * p[k] for w, p in zip(weights, (a, b, c, d))) for k in range(len(a))))
    return [*line, points[-1]]


def _turned(profile, columns, flutes=0, depth=0.0):
    """Returns a closed surface about the Y axis. The profile of (radius, height) begins and ends on the axis; the
    inside is to the left of the profile's direction. `flutes` grooves of a relative `depth` run along it."""
    rows = len(profile)
    positions, places = [], []
    for radius, y in profile:
        places.append([len(positions) + (j % columns if radius > 0.0 else 0) for j in range(columns + 1)])
        for j in range(columns if radius > 0.0 else 1):
            angle = math.tau * j / columns
            r = radius * (1.0 + depth * math.cos(flutes * angle))
            positions.append((r * math.sin(angle), y, r * math.cos(angle)))
    indices = []
    for (i, lower), j in itertools.product(enumerate(places[:-1]), range(columns)):
        upper = places[i + 1]
        if profile[i][0] > 0.0:
            indices += [lower[j], lower[j + 1], upper[j + 1]]
        if profile[i + 1][0] > 0.0:
            indices += [lower[j], upper[j + 1], upper[j]]
    closed = meshes.smooth(meshes.Mesh(positions, indices))
    # The first and the last column are at the same place, with different texture coordinates.
    seam = [k for row in places for k in row]
    stride = columns + 1
    first_of = {k: at for at, k in reversed(list(enumerate(seam)))}
    uvs = [(j / columns, 1.0 - i / (rows - 1)) for i in range(rows) for j in range(stride)]
    corners = []
    for at in range(0, len(indices), 3):
        some = [first_of[k] for k in indices[at : at + 3]]
        is_last = max(k % stride for k in some) == columns - 1
        corners += [k + columns if is_last and k % stride == 0 else k for k in some]
    return meshes.Mesh([closed.positions[k] for k in seam], corners, [closed.normals[k] for k in seam], uvs=uvs)


def _noise(seed, size):
    """Returns a smooth function of two numbers with the period `size` and values from -1 to 1."""
    values = random.Random(seed)
    grid = [[values.uniform(-1.0, 1.0) for _ in range(size)] for _ in range(size)]

    def at(x, y):
        i, j = math.floor(x), math.floor(y)
        u, v = (t * t * (3.0 - 2.0 * t) for t in (x - i, y - j))
        a, b = grid[j % size], grid[(j + 1) % size]
        left, right = i % size, (i + 1) % size
        return (a[left] * (1 - u) + a[right] * u) * (1 - v) + (b[left] * (1 - u) + b[right] * u) * v

    return at


def _picture(width, height, color_of):
    """Returns rows of RGB bytes. `color_of` returns codes of sRGB, 0 to 255, rounded to steps of 4, which compress
    well."""

    def code(value):
        return 4 * min(63, max(0, round(value / 4.0)))

    return [bytes(code(c) for x in range(width) for c in color_of(x, y)) for y in range(height)]


def _table(g):
    coarse, fine = _noise(1, 16), _noise(2, 64)
    size, planks = 512, 5

    def wood(x, y):
        plank = y * planks // size
        within = y * planks % size / size
        along = x / size + 0.37 * plank
        bend = 0.45 * coarse(16.0 * along, 3.0 * plank)
        rings = math.sin(13.0 * (within + 0.3 * bend) + 1.7 * plank + 0.5 * coarse(16.0 * along, 5.0 * within + plank))
        grain = fine(16.0 * along, 64.0 * y * planks / size) + fine(32.0 * along + 9.0, 128.0 * y / size)
        shade = 1.0 + 0.07 * rings + 0.035 * grain + 0.1 * coarse(3.0, plank * 5.0)
        gap = 0.4 if within < 0.014 else 1.0
        return tuple(shade * gap * c for c in (122.0, 76.0, 43.0))

    top = g.textured("wood", _picture(size, size, wood), roughness=0.38)
    board = meshes.tiled(meshes.box(12.0, 0.3, 6.0), 4.0)
    g.node("table", mesh=g.mesh("table", board, top), translation=(0.0, -0.15, -0.2))
    plaster = g.metallic_roughness("plaster", (0.13, 0.2, 0.21), 0.0, 0.95)
    turned = quaternion_about((1.0, 0.0, 0.0), 90.0)
    wall = meshes.rectangle(30.0, 20.0)
    g.node("wall", mesh=g.mesh("wall", wall, plaster), translation=(0.0, 4.0, -3.9), rotation=turned)


def _runner(g):
    """Adds a cloth across the table, with folds."""
    columns, rows = 110, 64
    folds = _noise(5, 32)

    def place(i, j):
        x, z = 5.6 * (i / columns - 0.5), 2.5 * (j / rows - 0.5)
        y = 0.055 + 0.03 * folds(1.5 * x + 0.6 * z + 8.0, 0.8 * z + 3.0)
        y += 0.026 * math.sin(2.1 * x + 1.6 * z + 1.8 * folds(0.9 * x + 9.0, 0.7 * z + 12.0))
        frayed = 0.025 * math.sin(11.0 * z) * abs(2.0 * i / columns - 1.0) ** 8
        return (x + frayed, y, z)

    positions = [place(i, j) for j in range(rows + 1) for i in range(columns + 1)]
    indices = []
    for j, i in itertools.product(range(rows), range(columns)):
        a = j * (columns + 1) + i
        b, c, d = a + 1, a + columns + 2, a + columns + 1
        indices += [a, d, c, a, c, b]
    velvet = g.velvet("velvet", (0.15, 0.01, 0.025), (0.42, 0.09, 0.15))
    cloth = meshes.smooth(meshes.Mesh(positions, indices))
    g.node("runner", mesh=g.mesh("runner", cloth, velvet), rotation=quaternion_about((0.0, 1.0, 0.0), -9.0))


def _glaze(x, y):
    """Returns the texture of the bowl: white with blue bands and a frieze of leaves. The bowl's rim is in the
    middle."""
    white, blue = (236.0, 236.0, 230.0), (30.0, 58.0, 150.0)
    v, phase = y / 256.0, math.tau * x / 512.0 * 16.0
    stem = 0.62 + 0.012 * math.sin(phase)
    leaf = abs(v - stem) < 0.026 * abs(math.sin(phase)) ** 0.7 and abs(v - stem - 0.002) > 0.0045
    band = 0.534 < v < 0.55 or 0.564 < v < 0.57 or 0.673 < v < 0.679 or 0.69 < v < 0.712
    return blue if leaf or band else white


def _bowl_of_fruit(g):
    outside = [(0.0, 0.0), (0.52, 0.0), (0.56, 0.06), (0.52, 0.15), (0.95, 0.34), (1.24, 0.68), (1.36, 1.02)]
    inside = [(1.33, 1.045), (1.29, 1.02), (1.16, 0.68), (0.86, 0.38), (0.42, 0.2), (0.0, 0.17)]
    rows = _picture(512, 256, _glaze)
    china = g.coat(g.textured("china", rows, roughness=0.5), roughness=0.03)
    bowl = _turned(_spline(outside + inside, 5), 96)
    where = (0.1, 0.08, 0.1)
    g.node("bowl", mesh=g.mesh("bowl", bowl, china), translation=where)
    # The profile of an apple has a dimple above and below.
    lower = [(0.0, -0.33), (0.1, -0.37), (0.27, -0.36), (0.42, -0.2), (0.47, 0.06)]
    upper = [(0.42, 0.27), (0.28, 0.4), (0.12, 0.4), (0.05, 0.33), (0.0, 0.27)]
    apple = _turned(_spline(lower + upper, 5), 56, flutes=5, depth=0.012)
    stem = _turned(_spline([(0.0, 0.2), (0.022, 0.22), (0.018, 0.4), (0.034, 0.56), (0.0, 0.57)], 3), 10)
    wood = g.metallic_roughness("stem", (0.09, 0.05, 0.025), 0.0, 0.7)
    speckles = _noise(9, 64)

    def skin(x, y):
        streak = 0.5 + 0.5 * speckles(x * 0.5, y * 0.06)
        ripe = min(1.0, max(0.0, 1.15 * streak + 0.5 * math.sin(math.pi * y / 64.0) - 0.25))
        return tuple(a + ripe * (b - a) for a, b in zip((214.0, 178.0, 72.0), (168.0, 18.0, 26.0)))

    red = g.coat(g.textured("red apple", _picture(128, 64, skin), roughness=0.4), roughness=0.12, factor=0.8)
    green = g.coat(g.metallic_roughness("green apple", (0.36, 0.52, 0.05), 0.0, 0.4), roughness=0.12, factor=0.8)
    apples, stems = {}, g.mesh("stem", stem, wood)
    for name, material in (("red", red), ("green", green)):
        apples[name] = g.mesh(f"{name} apple", apple, material)
    places = (
        ("red", (-0.48, 0.78, 0.3), (0.6, 0.2, 0.7), 24.0),
        ("green", (0.5, 0.82, 0.36), (0.9, 0.0, -0.5), 34.0),
        ("red", (0.06, 0.8, -0.5), (1.0, 0.0, 0.1), -28.0),
        ("red", (0.02, 1.36, 0.04), (0.7, 0.0, 0.9), 16.0),
    )
    for number, (kind, (x, y, z), axis, angle) in enumerate(places):
        pose = {"translation": (where[0] + x, where[1] + y, where[2] + z), "rotation": quaternion_about(axis, angle)}
        fruit = g.node(f"apple {number}", mesh=apples[kind], **pose)
        g.node(f"stem {number}", parent=fruit, mesh=stems)
    outline = [(0.0, -0.46), (0.06, -0.42), (0.25, -0.28), (0.33, 0.0), (0.25, 0.28), (0.06, 0.42), (0.0, 0.47)]
    lemon = _turned(_spline(outline, 6), 48)
    zest = g.coat(g.metallic_roughness("lemon", (0.84, 0.6, 0.03), 0.0, 0.45), roughness=0.25, factor=0.5)
    pose = {"translation": (2.05, 0.4, 0.85), "rotation": quaternion_about((0.35, 0.5, 1.0), 82.0)}
    g.node("lemon", mesh=g.mesh("lemon", lemon, zest), **pose)


def _bottle(g):
    """Adds a bottle of glass with some thickness; a stopper closes it."""
    outer = [(0.0, 0.0), (0.5, 0.0), (0.64, 0.07), (0.7, 0.4), (0.68, 0.95), (0.5, 1.4), (0.22, 1.72), (0.17, 2.05)]
    rim = [(0.2, 2.2), (0.26, 2.26), (0.2, 2.3), (0.14, 2.26)]
    inner = [(0.11, 2.0), (0.15, 1.72), (0.42, 1.37), (0.6, 0.95), (0.62, 0.42), (0.55, 0.17), (0.4, 0.11), (0.0, 0.14)]
    glass = g.glass("bottle", absorbed=((0.35, 0.8, 0.68), 0.55))
    body = _turned(_spline(outer + rim + inner, 4), 80)
    where = {"translation": (-2.35, 0.0, -0.75)}
    g.node("bottle", mesh=g.mesh("bottle", body, glass), **where)
    clear = g.glass("stopper", ior=1.55, absorbed=((0.6, 0.9, 0.85), 1.0))
    g.node("stopper", mesh=g.sphere("stopper", 0.27, clear), translation=(-2.35, 2.57, -0.75))


def _armillary(g):
    gold = g.metallic_roughness("gold", (1.0, 0.72, 0.31), 1.0, 0.12)
    foot = [(0.0, 0.0), (0.62, 0.0), (0.66, 0.05), (0.6, 0.11), (0.3, 0.17), (0.11, 0.3), (0.08, 0.46), (0.15, 0.56)]
    stand = _turned(_spline([*foot, (0.09, 0.66), (0.06, 0.78), (0.0, 0.8)], 6), 72)
    x, z = 2.65, -0.85
    g.node("stand", mesh=g.mesh("stand", stand, gold), translation=(x, 0.0, z))
    center = (x, 1.72, z)
    turns = (((1.0, 0.0, 0.0), 90.0), ((0.0, 0.0, 1.0), 66.0), ((1.0, 0.0, 0.35), 24.0), ((0.2, 0.0, 1.0), -38.0))
    for number, (axis, angle) in enumerate(turns):
        ring = meshes.torus(0.95 - 0.055 * number, 0.032, 96, 14)
        pose = {"translation": center, "rotation": quaternion_about(axis, angle)}
        g.node(f"ring {number}", mesh=g.mesh(f"ring {number}", ring, gold), **pose)
    lapis = _noise(12, 32)

    def stone(px, py):
        vein = abs(lapis(px * 0.25, py * 0.25) + 0.5 * lapis(px * 0.5 + 7.0, py * 0.5))
        base = 1.0 + 0.35 * lapis(px * 0.125, py * 0.125 + 3.0)
        return (214.0, 178.0, 104.0) if vein < 0.045 else (24.0 * base, 44.0 * base, 128.0 * base)

    ball = meshes.Mesh(*_globe(0.4, 32, 64))
    blue = g.coat(g.textured("lapis", _picture(256, 128, stone), roughness=0.5), roughness=0.03)
    g.node("globe", mesh=g.mesh("globe", ball, blue), translation=center)


def _globe(radius, rows, columns):
    """Returns positions, indices, normals, no colours, and texture coordinates."""
    profile = [(math.sin(math.pi * i / rows), -math.cos(math.pi * i / rows)) for i in range(rows + 1)]
    profile[0], profile[-1] = (0.0, -1.0), (0.0, 1.0)
    sphere = _turned(profile, columns)
    normals = sphere.positions
    positions = [tuple(radius * x for x in p) for p in sphere.positions]
    return positions, sphere.indices, normals, [], sphere.uvs


def _lantern(g):
    """Adds a fluted shade of paper, which scatters the light of a lamp inside it to the outside."""
    paper = g.paper("paper", (0.86, 0.8, 0.68), 0.6, (1.0, 0.86, 0.6))
    outline = [(0.34, 0.12), (0.62, 0.42), (0.72, 0.95), (0.62, 1.48), (0.34, 1.78)]
    rows, columns, flutes = 32, 160, 16
    profile = _spline(outline, rows // 4)
    positions = []
    for radius, y in profile:
        for j in range(columns):
            angle = math.tau * j / columns
            r = radius * (1.0 + 0.075 * abs(math.sin(0.5 * flutes * angle)))
            positions.append((r * math.sin(angle), y, r * math.cos(angle)))
    indices = []
    for i, j in itertools.product(range(len(profile) - 1), range(columns)):
        a, b = i * columns + j, i * columns + (j + 1) % columns
        indices += [a, b, b + columns, a, b + columns, a + columns]
    where = (0.95, 0.0, -2.05)
    shade = meshes.smooth(meshes.Mesh(positions, indices))
    g.node("shade", mesh=g.mesh("shade", shade, paper), translation=where)
    iron = g.metallic_roughness("iron", (0.09, 0.085, 0.08), 1.0, 0.4)
    for name, y, height, radius in (("foot", 0.06, 0.12, 0.4), ("cap", 1.82, 0.1, 0.36)):
        disk = g.cylinder(f"lantern {name}", height, radius, iron)
        g.node(f"lantern {name}", mesh=disk, translation=(where[0], y, where[2]))
    g.point_light("lantern", (where[0], 0.95, where[2]), (1.0, 0.66, 0.34), 17.0, classic=False)


def _small_things(g):
    steel = g.brushed("brushed steel", (0.75, 0.76, 0.78), 0.3, 0.8)
    top = [(0.0, 0.0), (0.04, 0.06), (0.2, 0.2), (0.46, 0.36), (0.5, 0.44), (0.44, 0.5), (0.14, 0.56), (0.07, 0.64)]
    spin = _turned(_spline([*top, (0.055, 0.86), (0.075, 0.93), (0.0, 0.97)], 6), 72)
    lying = {"translation": (-1.75, 0.36, 1.05), "rotation": quaternion_about((1.0, 0.2, -0.55), 62.0)}
    g.node("spinning top", mesh=g.mesh("spinning top", spin, steel), **lying)
    marbles = (
        ("clear", ((0.95, 0.98, 1.0), 1.0), 0.27, (1.35, 1.62)),
        ("amber", ((0.98, 0.5, 0.08), 0.3), 0.21, (0.72, 1.95)),
        ("rose", ((0.95, 0.2, 0.35), 0.4), 0.17, (1.75, 2.05)),
    )
    for name, absorbed, radius, (x, z) in marbles:
        glass = g.glass(f"{name} marble", absorbed=absorbed)
        g.node(f"{name} marble", mesh=g.sphere(f"{name} marble", radius, glass), translation=(x, radius + 0.001, z))
    pearl = g.filmed("pearl", (0.09, 0.085, 0.1), 1.0, 430.0, ior=1.8, roughness=0.06)
    g.node("pearl", mesh=g.sphere("pearl", 0.24, pearl), translation=(-0.85, 0.241, 1.95))


def _lamp(g, name, center, side, color, candela):
    """Adds a square of point sources that faces the middle of the table."""
    toward = meshes.normalize(tuple(-c for c in center))
    right = meshes.normalize((toward[2], 0.0, -toward[0]))
    up = (
        right[1] * toward[2] - right[2] * toward[1],
        right[2] * toward[0] - right[0] * toward[2],
        right[0] * toward[1] - right[1] * toward[0],
    )
    for i, j in itertools.product(range(_LAMP_SIDE), repeat=2):
        u, v = (side * ((k + 0.5) / _LAMP_SIDE - 0.5) for k in (i, j))
        place = tuple(c + u * r + v * w for c, r, w in zip(center, right, up))
        g.point_light(f"{name} {i} {j}", place, color, candela / _LAMP_SIDE**2, classic=False)
