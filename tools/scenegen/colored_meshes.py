# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Writes scenes in formats of meshes: a PLY with colours of faces and two pictures, an STL with colours of facets."""

import itertools
import struct

from .gltf import png

# These are the corners of a square of texture coordinates, anticlockwise, and the cube's faces, anticlockwise from
# outside.
_SQUARE = ((0, 0), (1, 0), (1, 1), (0, 1))
_CUBE = [(-1, 0, 1), (1, 0, 1), (1, 0, -1), (-1, 0, -1), (-1, 2, 1), (1, 2, 1), (1, 2, -1), (-1, 2, -1)]
_GROUND = [(-3, 0, 2.5), (3, 0, 2.5), (3, 0, -2.5), (-3, 0, -2.5)]
_WHITE = (255, 255, 255)
# Each face has its corners, its texture (-1 for none), the number of times the texture repeats, and the colour.
_FACES = [
    ((0, 1, 5, 4), 0, 1, _WHITE),
    ((1, 2, 6, 5), 0, 2, (255, 160, 60)),
    ((4, 5, 6, 7), -1, 1, (60, 120, 255)),
    ((2, 3, 7, 6), -1, 1, (90, 200, 90)),
    ((3, 0, 4, 7), 1, 1, (255, 90, 90)),
    ((8, 9, 10, 11), 1, 3, (200, 220, 200)),
]


def _arrow_row(y, size=16):
    """Returns a row of a picture of an arrow that points up. No turned or mirrored arrow looks the same."""
    inside = [abs(x - 8) <= (y - 2) // 2 if y < 9 else 5 <= x < 9 for x in range(size)]
    return bytes(itertools.chain.from_iterable((230, 60, 40) if i and y >= 2 else (240, 225, 170) for i in inside))


def _checker_row(y, size=8):
    colors = ((40, 40, 60), (235, 235, 235))
    return bytes(itertools.chain.from_iterable(colors[(x // 4 + y // 4) % 2] for x in range(size)))


def _write_ply(folder):
    corners = _CUBE + _GROUND
    lines = ["ply", "format ascii 1.0", "comment Written by tools/make_scenes.py"]
    lines += ["comment TextureFile ply_arrow.png", "comment TextureFile ply_checker.png"]
    lines += [f"element vertex {len(corners)}"] + [f"property float {axis}" for axis in "xyz"]
    lines += [f"element face {len(_FACES)}", "property list uchar int vertex_indices"]
    lines += ["property list uchar float texcoord", "property int texnumber"]
    lines += [f"property uchar {channel}" for channel in ("red", "green", "blue")] + ["end_header"]
    lines += [f"{x} {y} {z}" for x, y, z in corners]
    for face, texture, repeats, color in _FACES:
        uvs = [repeats * value for uv in _SQUARE for value in uv]
        lines.append(" ".join(map(str, (4, *face, 8, *uvs, texture, *color))))
    (folder / "ply_faces.ply").write_text("\n".join(lines) + "\n", encoding="utf-8")
    (folder / "ply_arrow.png").write_bytes(png([_arrow_row(y) for y in range(16)]))
    (folder / "ply_checker.png").write_bytes(png([_checker_row(y) for y in range(8)]))


def _facet(corners, color):
    """Returns a facet. `color` has 5 bits of red, green and blue, as Magics has them; None means the header's
    colour."""
    code = 0x8000 if color is None else color[0] | color[1] << 5 | color[2] << 10
    return struct.pack("<12fH", 0, 0, 0, *itertools.chain.from_iterable(corners), code)


def _write_stl(folder):
    """Writes an octahedron, with a colour for each facet, over a square of the header's colour."""
    facets = []
    for sx, sy, sz in itertools.product((1, -1), repeat=3):
        corners = [(1.5 * sx, 1.5, 0), (0, 1.5 + 1.5 * sy, 0), (0, 1.5, 1.5 * sz)]
        if sx * sy * sz < 0:
            corners.reverse()
        facets.append(_facet(corners, (28 if sx > 0 else 6, 28 if sy > 0 else 6, 28 if sz > 0 else 6)))
    for corners in ((0, 1, 2), (0, 2, 3)):
        facets.append(_facet([_GROUND[i] for i in corners], None))
    header = b"Written by tools/make_scenes.py COLOR=" + bytes((190, 170, 130, 255))
    (folder / "stl_colors.stl").write_bytes(header.ljust(80) + struct.pack("<I", len(facets)) + b"".join(facets))


def write_colored_meshes(folder):
    """Writes ply_faces.ply with its pictures, and stl_colors.stl."""
    _write_ply(folder)
    _write_stl(folder)
