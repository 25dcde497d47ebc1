# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""The OBJ scene: faces of any number of corners, concave ones too, and several materials in an MTL file."""

import math

_MATERIALS = {
    "ground": "Ka 0.42 0.4 0.36\nKd 0.62 0.58 0.5\nKs 0 0 0\nNs 0\nillum 1\n",
    "gold": "Ka 0.5 0.32 0.06\nKd 0.75 0.48 0.1\nKs 0.5 0.5 0.4\nNs 40\nillum 2\n",
    "brick": "Ka 0.4 0.12 0.08\nKd 0.65 0.18 0.12\nKs 0.1 0.1 0.1\nNs 10\nillum 2\n",
    "lagoon": "Ka 0.03 0.25 0.25\nKd 0.06 0.42 0.42\nKs 0.4 0.4 0.4\nNs 60\nillum 2\n",
    "mirror": "Ka 0.05 0.05 0.05\nKd 0.1 0.1 0.1\nKs 0.7 0.7 0.7\nNs 200\nillum 3\n",
}


class _Obj:
    def __init__(self):
        self.lines = ["# Written by tools/make_scenes.py", "mtllib obj_materials.mtl"]
        self.count = 0

    def prism(self, name, outline, bottom, top, side_material, cap_material):
        """Stands on `outline`, (x, z) anticlockwise seen from above; each cap is one face."""
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
        # Counted from the end, as OBJ allows.
        self.lines += [f"usemtl {material}", "f -4 -3 -2 -1"]
        self.count += 4


def _regular(corners, radius, x, z, inner_radius=None):
    """A regular outline around (x, z); with an inner radius a star of twice the corners."""
    radii = [radius] if inner_radius is None else [radius, inner_radius]
    count = corners * len(radii)
    outline = []
    for i in range(count):
        angle, r = math.tau * i / count, radii[i % len(radii)]
        outline.append((x + r * math.sin(angle), z + r * math.cos(angle)))
    return outline


def write_obj_scene(folder):
    """Writes obj_materials.obj and .mtl."""
    obj = _Obj()
    obj.quad("ground", [(-2.8, 0, 1.8), (2.4, 0, 1.8), (2.4, 0, -1.6), (-2.8, 0, -1.6)], "ground")
    obj.prism("star", _regular(5, 0.95, -1.55, 0.4, inner_radius=0.42), 0.0, 0.7, "gold", "brick")
    corner = [(0.1, 1.5), (1.0, 1.5), (1.0, 0.5), (1.9, 0.5), (1.9, -0.4), (0.1, -0.4)]
    obj.prism("corner", corner, 0.0, 0.55, "brick", "gold")
    obj.prism("hexagon", _regular(6, 0.5, 0.85, 0.2), 0.55, 1.3, "lagoon", "lagoon")
    obj.quad("mirror", [(-2.7, 0.0, -1.5), (2.3, 0.0, -1.5), (2.3, 1.5, -1.3), (-2.7, 1.5, -1.3)], "mirror")
    (folder / "obj_materials.obj").write_text("\n".join(obj.lines) + "\n", encoding="utf-8")
    materials = (f"newmtl {name}\n{text}" for name, text in _MATERIALS.items())
    (folder / "obj_materials.mtl").write_text("\n".join(materials), encoding="utf-8")
