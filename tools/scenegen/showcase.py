# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Makes the picture at the top of the README: every primitive, mirrors, and hard shadows of coloured sources."""

import math

from . import meshes
from .gltf import Gltf
from .vectors import axis_rotation, quaternion_about

BACKGROUND = (0.1, 0.17, 0.22)
AMBIENT = (0.16, 0.18, 0.21)


def showcase():
    g = Gltf()
    g.sky(BACKGROUND, AMBIENT)
    _floor_and_light(g)
    _knot_on_pedestal(g)
    _mirror_sphere(g)
    _folding_mirror(g)
    _solids(g)
    _pearls(g)
    g.camera("main", (0.9, 2.55, 9.6), (0.1, 1.22, 0.0), yfov_deg=27.0)
    g.camera("knot", (2.2, 3.1, 4.0), (-0.05, 2.0, 0.0), yfov_deg=38.0)
    g.camera("low", (-4.2, 0.55, 4.6), (-0.2, 1.15, -0.4), yfov_deg=38.0)
    return g


def _polished(g, name, color, specular=0.45, shininess=60.0, reflection=0.08):
    return g.material(name, color, specular=specular, shininess=shininess, reflection=reflection)


def _floor_and_light(g):
    # Far away, the point sources light the floor at a grazing angle, so only the directional source contributes. With
    # these factors the floor fades into the background at the horizon.
    reflection = 0.18
    sun = 0.22
    elevation = math.cos(math.radians(40.0))
    diffuse = tuple((1.0 - reflection) * b / (a + sun * elevation) for a, b in zip(AMBIENT, BACKGROUND))
    floor = g.material("floor", diffuse, reflection=reflection)
    g.node("floor", mesh=g.plane("floor", floor))
    tilt = math.tan(math.radians(40.0))
    g.directional_light("sun", (0.8 * tilt, -1.0, -0.6 * tilt), intensity=sun)
    g.point_light("warm", (-5.0, 6.5, 5.0), color=(0.78, 0.6, 0.42))
    g.point_light("cool", (6.0, 5.0, 4.0), color=(0.14, 0.26, 0.42))
    g.point_light("rose", (1.5, 7.0, -6.0), color=(0.38, 0.14, 0.2))


def _knot_on_pedestal(g):
    stone = _polished(g, "stone", (0.2, 0.21, 0.25), specular=0.3, shininess=30.0, reflection=0.12)
    g.node("pedestal foot", mesh=g.cylinder("pedestal foot", 0.16, 0.95, stone), translation=(0.0, 0.08, 0.0))
    g.node("pedestal", mesh=g.frustum("pedestal", 0.7, 0.75, 0.5, stone), translation=(0.0, 0.51, 0.0))
    coral = _polished(g, "coral", (0.82, 0.2, 0.1), specular=0.5, shininess=70.0, reflection=0.1)
    knot = meshes.torus_knot(2, 3, 0.72, 0.33, 0.19, 5, 12, 0.16, 448, 60)
    g.node(
        "knot",
        mesh=g.mesh("knot", knot, coral),
        translation=(0.0, 1.98, 0.0),
        rotation=quaternion_about((1.0, 0.0, 0.0), 72.0),
    )


def _mirror_sphere(g):
    chrome = g.material("chrome", (0.06, 0.06, 0.06), specular=0.7, shininess=250.0, reflection=(0.9, 0.84, 0.74))
    g.node("mirror sphere", mesh=g.sphere("mirror sphere", 1.05, chrome), translation=(-2.6, 1.05, -0.7))


def _folding_mirror(g):
    mirror = g.material("mirror", (0.02, 0.02, 0.03), reflection=(0.8, 0.84, 0.86))
    frame = _polished(g, "frame", (0.5, 0.33, 0.12), specular=0.5, shininess=40.0, reflection=0.1)
    pane, panel = g.mesh("mirror pane", meshes.box(1.44, 2.64, 0.02), mirror), g.mesh(
        "frame", meshes.box(1.6, 2.8, 0.1), frame
    )
    hinge = (2.45, -2.15)
    for name, side, yaw in (("left", -1.0, -16.0), ("right", 1.0, -42.0)):
        sine, cosine = math.sin(math.radians(yaw)), math.cos(math.radians(yaw))
        x, z = hinge[0] + side * 0.81 * cosine, hinge[1] - side * 0.81 * sine
        rotation = quaternion_about((0.0, 1.0, 0.0), yaw)
        g.node(f"{name} frame", mesh=panel, translation=(x, 1.4, z), rotation=rotation)
        g.node(f"{name} pane", mesh=pane, translation=(x + 0.045 * sine, 1.4, z + 0.045 * cosine), rotation=rotation)


def _solids(g):
    teal = _polished(g, "teal", (0.04, 0.42, 0.42))
    g.node("cone", mesh=g.cone("cone", 1.5, 0.55, teal), translation=(3.1, 0.75, 0.1))
    gold = _polished(g, "gold", (0.8, 0.5, 0.12), specular=0.55, shininess=45.0, reflection=0.15)
    star = g.mesh("star", meshes.stellated(meshes.icosahedron(0.4), 0.5), gold)
    g.node("star", mesh=star, translation=(1.85, 0.58, 1.3), rotation=quaternion_about((0.3, 1.0, 0.2), 40.0))
    plum = _polished(g, "plum", (0.32, 0.1, 0.42))
    gem = g.mesh("icosahedron", meshes.icosahedron(0.45), plum)
    g.node("icosahedron", mesh=gem, translation=(-1.8, 0.36, 1.2), rotation=quaternion_about((0.5, 1.0, 0.0), 62.0))
    ivory = _polished(g, "ivory", (0.72, 0.66, 0.54), reflection=0.06)
    rod = g.cylinder("rod", 0.95, 0.2, ivory)
    g.node("rod", mesh=rod, translation=(-2.85, 0.2, 0.85), rotation=axis_rotation((1.0, 0.0, -0.45)))


def _pearls(g):
    """Adds a row of small spheres that curves around the pedestal."""
    colors = (
        (0.8, 0.2, 0.1),
        (0.85, 0.48, 0.08),
        (0.72, 0.66, 0.54),
        (0.2, 0.5, 0.18),
        (0.04, 0.42, 0.42),
        (0.1, 0.26, 0.62),
        (0.32, 0.1, 0.42),
    )
    for i, color in enumerate(colors):
        angle = math.radians(-39.0 + 13.0 * i)
        pearl = g.sphere(f"pearl {i}", 0.17, _polished(g, f"pearl {i}", color, shininess=90.0))
        g.node(f"pearl {i}", mesh=pearl, translation=(1.9 * math.sin(angle), 0.17, 0.15 + 1.9 * math.cos(angle)))
