# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Makes the OBJ scenes: faces with any number of corners, also concave ones, with several materials in an MTL file; and
height maps."""

import math

from .gltf import png

_MATERIALS = {
    "ground": "Ka 0.42 0.4 0.36\nKd 0.62 0.58 0.5\nKs 0 0 0\nNs 0\nillum 1\n",
    "gold": "Ka 0.5 0.32 0.06\nKd 0.75 0.48 0.1\nKs 0.5 0.5 0.4\nNs 40\nillum 2\n",
    "brick": "Ka 0.4 0.12 0.08\nKd 0.65 0.18 0.12\nKs 0.1 0.1 0.1\nNs 10\nillum 2\n",
    "lagoon": "Ka 0.03 0.25 0.25\nKd 0.06 0.42 0.42\nKs 0.4 0.4 0.4\nNs 60\nillum 2\n",
    "mirror": "Ka 0.05 0.05 0.05\nKd 0.1 0.1 0.1\nKs 0.7 0.7 0.7\nNs 200\nillum 3\n",
}


_HEIGHTS = "Kd 0.6 0.5 0.3\nKs 0.3 0.3 0.3\nNs 30\nillum 2\n"
_HEIGHT_MATERIALS = {
    "flat": _HEIGHTS,
    "raised": _HEIGHTS + "map_Bump -bm 6 height_maps.png\n",
    "sunk": _HEIGHTS + "bump -bm -6 -s 2 2 height_maps.png\n",
}


class _Obj:
    def __init__(self, name):
        self.lines = ["# Written by tools/make_scenes.py", f"mtllib {name}.mtl"]
        self.count = 0

    def prism(self, name, outline, bottom, top, side_material, cap_material):
        """Adds a prism on `outline`, (x, z) anticlockwise seen from above; each cap is one face."""
        n = len(outline)
        self.lines.append(f"o {name}")
        for y in (bottom, top):
            self.lines += [f"v {x:.5g} {y:.5g} {z:.5g}" for x, z in outline]
        low = [self.count + 1 + i for i in range(n)]
        high = [i + n for i in low]
        self.count += 2 * n
        self.lines.append(f"usemtl {side_material}")
        for i in range(n):
            j = (i + 1) % n
            self.lines.append(f"f {low[i]} {low[j]} {high[j]} {high[i]}")
        self.lines.append(f"usemtl {cap_material}")
        self.lines.append("f " + " ".join(map(str, high)))
        self.lines.append("f " + " ".join(map(str, reversed(low))))

    def quad(self, name, corners, material):
        self.lines.append(f"o {name}")
        self.lines += [f"v {x:.5g} {y:.5g} {z:.5g}" for x, y, z in corners]
        # These indices count from the end, as OBJ allows.
        self.lines += [f"usemtl {material}", "f -4 -3 -2 -1"]
        self.count += 4

    def tile(self, name, x, material):
        """Adds a square with texture coordinates, seen from +z."""
        self.lines.append(f"o {name}")
        self.lines += [f"v {x + u:.5g} {v} 0\nvt {u} {v}" for u, v in ((0, 0), (1, 0), (1, 1), (0, 1))]
        self.lines += [f"usemtl {material}", "f -4/-4 -3/-3 -2/-2 -1/-1"]

    def write(self, folder, name, materials):
        (folder / f"{name}.obj").write_text("\n".join(self.lines) + "\n", encoding="utf-8")
        texts = (f"newmtl {material}\n{text}" for material, text in materials.items())
        (folder / f"{name}.mtl").write_text("\n".join(texts), encoding="utf-8")


def _regular(corners, radius, x, z, inner_radius=None):
    """Returns a regular outline around (x, z); an inner radius makes it a star with twice the corners."""
    radii = [radius] if inner_radius is None else [radius, inner_radius]
    count = corners * len(radii)
    outline = []
    for i in range(count):
        angle, r = math.tau * i / count, radii[i % len(radii)]
        outline.append((x + r * math.sin(angle), z + r * math.cos(angle)))
    return outline


def _write_materials(folder):
    obj = _Obj("obj_materials")
    obj.quad("ground", [(-2.8, 0, 1.8), (2.4, 0, 1.8), (2.4, 0, -1.6), (-2.8, 0, -1.6)], "ground")
    obj.prism("star", _regular(5, 0.95, -1.55, 0.4, inner_radius=0.42), 0.0, 0.7, "gold", "brick")
    corner = [(0.1, 1.5), (1.0, 1.5), (1.0, 0.5), (1.9, 0.5), (1.9, -0.4), (0.1, -0.4)]
    obj.prism("corner", corner, 0.0, 0.55, "brick", "gold")
    obj.prism("hexagon", _regular(6, 0.5, 0.85, 0.2), 0.55, 1.3, "lagoon", "lagoon")
    obj.quad("mirror", [(-2.7, 0.0, -1.5), (2.3, 0.0, -1.5), (2.3, 1.5, -1.3), (-2.7, 1.5, -1.3)], "mirror")
    obj.write(folder, "obj_materials", _MATERIALS)


def _dome_row(y, size=16):
    """Returns a row of a picture of one dome, in integers."""
    heights = [max(0, 255 - ((2 * x + 1 - size) ** 2 + (2 * y + 1 - size) ** 2) * 255 // (size * size)) for x in range(size)]
    return bytes(channel for height in heights for channel in (height, height, height))


def _write_heights(folder):
    obj = _Obj("height_maps")
    for i, material in enumerate(_HEIGHT_MATERIALS):
        obj.tile(material, 1.1 * i, material)
    obj.write(folder, "height_maps", _HEIGHT_MATERIALS)
    (folder / "height_maps.png").write_bytes(png([_dome_row(y) for y in range(16)]))


def write_obj_scenes(folder):
    """Writes obj_materials and height_maps, each with its MTL."""
    _write_materials(folder)
    _write_heights(folder)
