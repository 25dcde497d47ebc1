# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Makes the sphereflake, "balls" of Eric Haines' Standard Procedural Databases (IEEE CG&A 7(11), 1987).

Every sphere carries nine spheres of a third of its radius: six around its equator and three above, at the corners of a
cuboctahedron. There are 1 + 9 + ... + 9^level spheres. Camera, sources and colours are the database's, turned to Y up.
"""

import math

from . import meshes
from .gltf import Gltf
from .vectors import add, axis_rotation, cross, normalize, scale


def _child_directions():
    equator = [(math.cos(math.radians(60.0 * i)), 0.0, math.sin(math.radians(60.0 * i))) for i in range(6)]
    height = math.sqrt(2.0 / 3.0)
    ring = math.sqrt(1.0 / 3.0)
    angles = (math.radians(30.0 + 120.0 * i) for i in range(3))
    return equator + [(ring * math.cos(a), height, ring * math.sin(a)) for a in angles]


def _rotate(quaternion, vector):
    axis = quaternion[:3]
    twice = scale(cross(axis, vector), 2.0)
    return add(add(vector, scale(twice, quaternion[3])), cross(axis, twice))


def spheres(level, center=(0.0, 0.0, 0.0), radius=0.5, axis=(0.0, 1.0, 0.0)):
    """Yields (center, radius) of each sphere, parents before their children."""
    yield center, radius
    if level == 0:
        return
    rotation = axis_rotation(axis)
    for direction in _child_directions():
        outward = normalize(_rotate(rotation, direction))
        yield from spheres(level - 1, add(center, scale(outward, radius * 4.0 / 3.0)), radius / 3.0, outward)


def _y_up(x, y, z):
    return (x, z, -y)


def sphereflake(level, has_endless_ground=False):
    """Returns a sphereflake on the database's square, or on an endless plane in its place."""
    g = Gltf()
    g.sky((0.078, 0.361, 0.753), (0.0, 0.0, 0.0))
    ground = g.material("ground", (0.8, 0.6, 0.264))
    mesh = g.plane("ground", ground) if has_endless_ground else g.mesh("ground", meshes.rectangle(24.0, 24.0), ground)
    g.node("ground", mesh=mesh, translation=(0.0, -0.5, 0.0))
    mirror = g.material("mirror", (0.5, 0.45, 0.35), specular=0.5, shininess=3.0827, reflection=0.5)
    ball = g.sphere("ball", 1.0, mirror)
    for i, (center, radius) in enumerate(spheres(level)):
        g.node(f"ball {i}", mesh=ball, translation=center, scale=radius)
    power = math.sqrt(3.0) / 6.0
    for name, position in (("first", (4.0, 3.0, 2.0)), ("second", (1.0, -4.0, 4.0)), ("third", (-3.0, 1.0, 5.0))):
        g.point_light(name, _y_up(*position), intensity=power)
    g.camera("camera", _y_up(2.1, 1.3, 1.7), (0.0, 0.0, 0.0), yfov_deg=45.0, aspect_ratio=1.0)
    return g
