# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Makes scenes with more detail than pixels, which serve to check pictures with a known error (docs/performance.md).

These scenes are made on demand. They are not in scenes/, where each scene shows a feature.
"""

import math
import random

from . import meshes
from .features import AMBER, SKY, SLATE, STONE
from .gltf import Gltf
from .vectors import axis_rotation

WIRES = 48
# _HALF_HEIGHT is half the height of the visible area; _ROWS is the number of picture rows at which the wires have the
# stated width.
_HALF_HEIGHT = 1.0
_ROWS = 360
_TEXTURE_SIZE = 256


def wires():
    """Makes wires of 1/8 to 1 pixel in front of a dark wall, at 360 rows. Each wire has a different direction."""
    g = Gltf()
    g.sky(SKY, (0.3,) * 3)
    g.directional_light("sun", (0.4, -0.6, -1.0), intensity=0.8)
    wall = g.plane("wall", g.material("wall", SLATE))
    g.node("wall", mesh=wall, translation=(0.0, 0.0, -1.0), rotation=axis_rotation((0.0, 0.0, 1.0)))
    brass = g.material("brass", AMBER, specular=0.4, shininess=20.0)
    pixel = 2.0 * _HALF_HEIGHT / _ROWS
    for i in range(WIRES):
        width = pixel * (1.0 + 7.0 * i / (WIRES - 1)) / 8.0
        angle = math.pi * (i * 0.618034 % 1.0)
        place = ((i + 0.5) / WIRES * 3.2 - 1.6, 0.5 * math.sin(1.7 * i), 0.0)
        wire = g.cylinder(f"wire {i}", 1.2, width / 2.0, brass)
        g.node(f"wire {i}", mesh=wire, translation=place, rotation=axis_rotation((math.cos(angle), math.sin(angle), 0.0)))
    g.orthographic_camera("camera", (0.0, 0.0, 5.0), (0.0, 0.0, 0.0), ymag=_HALF_HEIGHT)
    return g


def _texels(color_of, seed):
    """Returns rows of RGB bytes, codes of sRGB, with noise of +-24 codes."""
    noise = random.Random(seed)
    rows = []
    for y in range(_TEXTURE_SIZE):
        row = bytearray()
        for x in range(_TEXTURE_SIZE):
            offset = noise.randrange(-24, 25)
            row += bytes(min(max(code + offset, 0), 255) for code in color_of(x, y))
        rows.append(bytes(row))
    return rows


def _chequer(x, y):
    return (225, 220, 205) if (x // 32 + y // 32) % 2 else (60, 62, 70)


def _brick(x, y):
    course = y // 32
    is_mortar = y % 32 < 4 or (x + 32 * (course % 2)) % 64 < 4
    return (190, 185, 175) if is_mortar else (160, 70, 50)


def textures():
    """Makes a chequered floor that extends to the horizon, and a box of bricks. Each texel has its own noise."""
    g = Gltf()
    g.sky(SKY, (0.3,) * 3)
    g.directional_light("sun", (0.5, -1.0, -0.6), intensity=3.0, classic=False)
    chequers = g.textured("chequers", _texels(_chequer, 1))
    g.node("floor", mesh=g.mesh("floor", meshes.tiled(meshes.rectangle(60.0, 60.0), 0.5), chequers))
    bricks = g.textured("bricks", _texels(_brick, 2))
    box = meshes.tiled(meshes.box(1.6, 1.2, 1.6), 0.8)
    g.node("box", mesh=g.mesh("box", box, bricks), translation=(0.0, 0.6, 0.0))
    ball = g.sphere("ball", 0.5, g.metallic_roughness("ball", STONE, 0.0, 0.4))
    g.node("ball", mesh=ball, translation=(1.6, 0.5, 0.6))
    g.camera("camera", (1.6, 1.5, 4.2), (0.2, 0.55, 0.0))
    return g


SCENES = (textures, wires)
