#!/usr/bin/env python3
# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Writes a promin glTF scene as a POV-Ray 3.7 scene that POV-Ray shades by the same formulas.

Features that POV-Ray cannot express in the same way are refused. Render with:
    povray +Iout.pov +Oout.exr +FE +W1024 +H1024 -A -D
"""

import math

from scene_reader import SceneReader, Unsupported, convert

# POV-Ray also multiplies its ambient and emission terms by the pigment, so no channel of the pigment may be 0.
_MIN_PIGMENT = 1e-6
# POV-Ray's directional source has a position, which must lie outside every scene.
_FAR = 1e4


def vector(v):
    return "<" + ",".join(f"{x:.9g}" for x in v) + ">"


def matrix(m):
    """Writes the transposed matrix, because POV-Ray multiplies row vectors."""
    return "matrix " + vector(m[row][column] for column in range(4) for row in range(3))


def texture(material):
    pigment = [max(c, _MIN_PIGMENT) for c in material.diffuse]
    # POV-Ray's surface scatters the light that it does not transmit.
    opaque = 1 - material.transmission
    if opaque < _MIN_PIGMENT:
        raise Unsupported(f"material {material.index}: glass that lets all light through")
    ambient = [a / p / opaque for a, p in zip(material.ambient, pigment)]
    emission = [e / p / opaque for e, p in zip(material.emission, pigment)]
    phong = f"phong {material.specular:.9g} phong_size {material.shininess:.9g}"
    highlight = phong if material.shininess > 0 else "phong 0"
    reflection = f"reflection {{ rgb {vector(material.reflection)} }}"
    own = f"ambient rgb {vector(ambient)} emission rgb {vector(emission)}"
    finish = f"{own} diffuse {1 / opaque:.9g} {highlight} {reflection}"
    color = "rgb " + vector(pigment) if opaque == 1 else "rgbt " + vector([*pigment, material.transmission])
    glass = "" if opaque == 1 else f" interior {{ ior {material.ior:.9g} }}"
    return f"texture {{ pigment {{ {color} }} finish {{ {finish} }} }}{glass}"


def _capsule_parts(size):
    """Writes both spheres and the frustum of the cone that touches them, without the disks, which are inside."""
    half, bottom, top = size.get("height", 0.5) / 2, size.get("radiusBottom", 0.25), size.get("radiusTop", 0.25)
    for y, radius in ((-half, bottom), (half, top)):
        if radius > 0:
            yield f"sphere {{ {y:.9g} * y, {radius:.9g} }}"
    if 2 * half > abs(bottom - top):
        sine = (bottom - top) / (2 * half)
        cosine = math.sqrt(1 - sine * sine)
        low, high = f"{-half + bottom * sine:.9g} * y", f"{half + top * sine:.9g} * y"
        yield f"cone {{ {low}, {bottom * cosine:.9g}, {high}, {top * cosine:.9g} open }}"


class PovWriter(SceneReader):
    has_glass = False

    def add_triangles(self, triangles, material, world):
        parts = [("vertex_vectors", triangles.positions)]
        if triangles.normals:
            parts.append(("normal_vectors", triangles.normals))
        parts.append(("face_indices", triangles.faces))
        lists = (f"{name} {{ {len(values)}, {','.join(map(vector, values))} }}" for name, values in parts)
        self._add("mesh2 { " + "\n  ".join(lists), material, world)

    def add_shape(self, kind, size, material, world):
        if kind == "sphere":
            body = f"sphere {{ 0, {size.get('radius', 0.5):.9g}"
        elif kind == "plane" and not size:
            body = "plane { y, 0"
        elif kind == "cylinder":
            half, bottom, top = size.get("height", 0.5) / 2, size.get("radiusBottom", 0.25), size.get("radiusTop", 0.25)
            body = f"cone {{ {half:.9g} * -y, {bottom:.9g}, {half:.9g} * y, {top:.9g}"
            if bottom == top:
                body = f"cylinder {{ {half:.9g} * -y, {half:.9g} * y, {top:.9g}"
        elif kind == "box":
            corner = vector(0.5 * length for length in size.get("size", (1, 1, 1)))
            body = f"box {{ -{corner}, {corner}"
        elif kind == "capsule":
            body = "union { " + " ".join(_capsule_parts(size))
        else:
            raise Unsupported(f"a shape of KHR_implicit_shapes ({kind})")
        self._add(body, material, world)

    def add_point_light(self, position, color):
        self.lines.append(f"light_source {{ {vector(position)} rgb {vector(color)} }}")

    def add_directional_light(self, back, color):
        self.lines.append(f"light_source {{ {_FAR:g} * {vector(back)} rgb {vector(color)} parallel point_at 0 }}")

    def _add(self, body, material, world):
        self.has_glass = self.has_glass or material.transmission > 0
        self.lines.append(f"{body} {texture(material)} {matrix(world)} }}")


def camera_block(camera):
    """Writes the camera by its own axes, so that it is right-handed like the scene."""
    kind = "orthographic" if camera.is_orthographic else "perspective"
    right = f"{camera.height:.9g} * image_width / image_height * {vector(camera.right)}"
    axes = f"right {right} up {camera.height:.9g} * {vector(camera.up)}"
    return f"camera {{ {kind} location {vector(camera.eye)} direction {vector(camera.look)} {axes} }}"


def write_pov(file, camera, max_depth):
    """Returns the scene as text. max_depth is the number of bounces, as promin counts them."""
    scene = PovWriter(file)
    scene.read()
    background, ambient = scene.sky()
    # This is the smallest weight of a ray that promin traces in a scene with glass.
    least = 1 / 512 if scene.has_glass else 0
    limits = f"max_trace_level {max_depth + 1} adc_bailout {least}"
    settings = f"assumed_gamma 1 {limits} ambient_light rgb {vector(ambient)}"
    head = ["#version 3.7;", f"global_settings {{ {settings} }}", f"background {{ rgb {vector(background)} }}"]
    return "\n".join([*head, camera_block(scene.camera(camera)), *scene.lines, ""])


if __name__ == "__main__":
    convert(__doc__, write_pov, ".pov")
