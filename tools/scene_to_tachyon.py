#!/usr/bin/env python3
# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Writes a promin glTF scene as a Tachyon scene that Tachyon shades by the same formulas.

Features that Tachyon cannot express in the same way are refused: cones, cylinders with end caps, vertex normals,
coloured reflection, emission, ambient light that is not grey. A mirror ray beyond the last bounce returns the
background in Tachyon, and black in promin. Render with:
    tachyon out.dat -fullshade -shade_phong -format PPM48 -o out.ppm
"""

import math

from scene_reader import SceneReader, Unsupported, convert, transform


# The width and height of the picture in pixels.
_SIDE = 1024


def numbers(v):
    return " ".join(f"{x:.9g}" for x in v)


def place(v):
    """Returns a point or a direction in Tachyon's left-handed space."""
    x, y, z = v
    return numbers((x, y, -z))


class TachyonWriter(SceneReader):
    def __init__(self, file):
        super().__init__(file)
        self._ambient = self.sky()[1]
        if len(set(self._ambient)) > 1:
            raise Unsupported("ambient light that is not grey")

    def add_triangles(self, triangles, material, world):
        if triangles.normals:
            raise Unsupported("vertex normals")
        corners = [place(transform(world, position)) for position in triangles.positions]
        texture = self._texture(material)
        for a, b, c in triangles.faces:
            self.lines.append(f"TRI V0 {corners[a]} V1 {corners[b]} V2 {corners[c]} {texture}")

    def add_shape(self, kind, size, material, world):
        if kind == "sphere":
            radius = size.get("radius", 0.5) * math.dist(transform(world, (1, 0, 0), 0.0), (0, 0, 0))
            shape = f"SPHERE CENTER {place(transform(world, (0, 0, 0)))} RAD {radius:.9g}"
        elif kind == "plane" and not size:
            normal = transform(world, (0, 1, 0), 0.0)
            shape = f"PLANE CENTER {place(transform(world, (0, 0, 0)))} NORMAL {place(normal)}"
        else:
            raise Unsupported(f"a shape of KHR_implicit_shapes ({kind})")
        self.lines.append(f"{shape} {self._texture(material)}")

    def add_point_light(self, position, color):
        self.lines.append(f"LIGHT CENTER {place(position)} RAD 0 COLOR {numbers(color)}")

    def add_directional_light(self, back, color):
        self.lines.append(f"DIRECTIONAL_LIGHT DIRECTION {place(-x for x in back)} COLOR {numbers(color)}")

    def _texture(self, material):
        if material.transmission > 0:
            raise Unsupported(f"material {material.index}: glass")
        if any(material.emission) or len(set(material.reflection)) > 1:
            raise Unsupported(f"material {material.index}: emission or coloured reflection")
        if any(self._ambient) and list(material.ambient) != list(material.diffuse):
            raise Unsupported(f"material {material.index}: an ambient factor of its own")
        phong = ""
        if material.specular > 0 and material.shininess > 0:
            phong = f"PHONG PLASTIC {material.specular:.9g} PHONG_SIZE {material.shininess:.9g} "
        return (
            f"TEXTURE AMBIENT {self._ambient[0]:.9g} DIFFUSE 1 SPECULAR {material.reflection[0]:.9g} OPACITY 1 "
            f"{phong}COLOR {numbers(material.diffuse)} TEXFUNC 0"
        )


def camera_block(camera, max_depth, side):
    if camera.is_orthographic:
        raise Unsupported("orthographic cameras")
    # Tachyon's rays go through the corners of pixels, so its picture is shifted by half a pixel.
    half = camera.height / 2
    shift = half / side
    low, high = -half - shift, half - shift
    return (
        f"CAMERA PROJECTION PERSPECTIVE ZOOM {1 / camera.height:.9g} ASPECTRATIO 1 ANTIALIASING 0 "
        f"RAYDEPTH {max_depth + 1} CENTER {place(camera.eye)} VIEWDIR {place(camera.look)} "
        f"UPDIR {place(camera.up)} FRUSTUM {numbers((low, high, low, high))} END_CAMERA"
    )


def write_tachyon(file, camera, max_depth, side=_SIDE):
    """Returns the scene as text. max_depth is the number of bounces, as promin counts them; `side` is the width and
    height of the picture in pixels."""
    scene = TachyonWriter(file)
    scene.read()
    background = f"BACKGROUND {numbers(scene.sky()[0])}"
    head = [f"BEGIN_SCENE RESOLUTION {side} {side}", camera_block(scene.camera(camera), max_depth, side), background]
    return "\n".join([*head, *scene.lines, "END_SCENE", ""])


if __name__ == "__main__":
    convert(__doc__, write_tachyon, ".dat")
