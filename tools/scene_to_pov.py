#!/usr/bin/env python3
# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Writes a promin glTF scene as a POV-Ray 3.7 scene that POV-Ray shades by the same formulas.

What POV-Ray cannot say in the same way (vertex colours, metallic-roughness materials, falloff, spots, coloured specular
factors, a source with two powers) is refused, so that a difference between the pictures is a difference between the
renderers. Render with:
    povray +Iout.pov +Oout.exr +FE +W1024 +H1024 -A -D
"""

import argparse
import base64
import json
import math
import pathlib
import struct
import sys

# POV-Ray multiplies its ambient and emission terms by the pigment too, so no channel of it may be 0.
_MIN_PIGMENT = 1e-6
# POV-Ray's directional source stands somewhere: far enough to be outside of every scene here.
_FAR = 1e4
_COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
_FORMATS = {5121: "B", 5123: "H", 5125: "I", 5126: "f"}


class Unsupported(Exception):
    pass


def multiply(a, b):
    """The product of two affine 3x4 matrices, given as rows."""
    rows = []
    for row in a:
        columns = [sum(row[k] * b[k][j] for k in range(3)) for j in range(4)]
        columns[3] += row[3]
        rows.append(columns)
    return rows


def transform(m, p, w=1.0):
    return [sum(m[i][k] * p[k] for k in range(3)) + w * m[i][3] for i in range(3)]


def local_transform(node):
    if "matrix" in node:
        m = node["matrix"]
        return [[m[column * 4 + row] for column in range(4)] for row in range(3)]
    t, s = node.get("translation", (0, 0, 0)), node.get("scale", (1, 1, 1))
    x, y, z, w = node.get("rotation", (0, 0, 0, 1))
    r = (
        (1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
        (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
        (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)),
    )
    return [[r[i][0] * s[0], r[i][1] * s[1], r[i][2] * s[2], t[i]] for i in range(3)]


def vector(v):
    return "<" + ",".join(f"{x:.9g}" for x in v) + ">"


def matrix(m):
    """POV-Ray multiplies row vectors: the transposed matrix."""
    return "matrix " + vector(m[row][column] for column in range(4) for row in range(3))


def unit(v):
    length = math.sqrt(sum(x * x for x in v))
    return [x / length for x in v]


class Converter:
    def __init__(self, file):
        self.folder = file.parent
        self.gltf = json.loads(file.read_text(encoding="utf-8"))
        self.buffers = [self.read_buffer(buffer["uri"]) for buffer in self.gltf.get("buffers", [])]
        self.lines = []
        self.cameras = []

    def read_buffer(self, uri):
        if uri.startswith("data:"):
            return base64.b64decode(uri.split(",", 1)[1])
        return (self.folder / uri).read_bytes()

    def extension(self, owner, name, default=None):
        return owner.get("extensions", {}).get(name, default)

    def accessor(self, index):
        accessor = self.gltf["accessors"][index]
        view = self.gltf["bufferViews"][accessor["bufferView"]]
        if "sparse" in accessor or "byteStride" in view or accessor.get("normalized"):
            raise Unsupported("sparse, interleaved and normalised accessors")
        size = _COMPONENTS[accessor["type"]]
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        code = f"<{accessor['count'] * size}{_FORMATS[accessor['componentType']]}"
        values = struct.unpack_from(code, self.buffers[view["buffer"]], start)
        return [values[i : i + size] for i in range(0, len(values), size)]

    def texture(self, index):
        """The texture block of a classic Phong material."""
        material = self.gltf["materials"][index]
        phong = self.extension(material, "PROMIN_materials_phong")
        if phong is None:
            raise Unsupported(f"material {index}, which is not classic Phong")
        base = material.get("pbrMetallicRoughness", {}).get("baseColorFactor", (1, 1, 1, 1))[:3]
        diffuse = phong.get("diffuseFactor", base)
        pigment = [max(c, _MIN_PIGMENT) for c in diffuse]
        ambient = [a / p for a, p in zip(phong.get("ambientFactor", diffuse), pigment)]
        emission = [e / p for e, p in zip(material.get("emissiveFactor", (0, 0, 0)), pigment)]
        specular, shininess = phong.get("specularFactor", (0, 0, 0)), phong.get("shininess", 0)
        if len(set(specular)) > 1:
            raise Unsupported(f"material {index}: specularFactor is not grey")
        highlight = f"phong {specular[0]:.9g} phong_size {shininess:.9g}" if shininess > 0 else "phong 0"
        reflection = f"reflection {{ rgb {vector(phong.get('reflectionFactor', (0, 0, 0)))} }}"
        finish = f"ambient rgb {vector(ambient)} emission rgb {vector(emission)} diffuse 1 {highlight} {reflection}"
        return f"texture {{ pigment {{ rgb {vector(pigment)} }} finish {{ {finish} }} }}"

    def shape(self, index):
        shape = self.extension(self.gltf, "KHR_implicit_shapes")["shapes"][index]
        size = shape.get(shape["type"], {})
        if shape["type"] == "sphere":
            return f"sphere {{ 0, {size.get('radius', 0.5):.9g}"
        if shape["type"] == "plane" and not size:
            return "plane { y, 0"
        if shape["type"] == "cylinder":
            half, bottom, top = size.get("height", 0.5) / 2, size.get("radiusBottom", 0.25), size.get("radiusTop", 0.25)
            if bottom == top:
                return f"cylinder {{ {half:.9g} * -y, {half:.9g} * y, {top:.9g}"
            return f"cone {{ {half:.9g} * -y, {bottom:.9g}, {half:.9g} * y, {top:.9g}"
        raise Unsupported(f"shape {index} of KHR_implicit_shapes ({shape['type']})")

    def triangles(self, primitive):
        if primitive.get("mode", 4) != 4 or "COLOR_0" in primitive["attributes"]:
            raise Unsupported("strips, fans, points, lines and vertex colours")
        positions = self.accessor(primitive["attributes"]["POSITION"])
        corners = range(len(positions))
        if "indices" in primitive:
            corners = [i for (i,) in self.accessor(primitive["indices"])]
        faces = [corners[i : i + 3] for i in range(0, len(corners), 3)]
        parts = [("vertex_vectors", positions)]
        if "NORMAL" in primitive["attributes"]:
            parts.append(("normal_vectors", self.accessor(primitive["attributes"]["NORMAL"])))
        parts.append(("face_indices", faces))
        lists = (f"{name} {{ {len(values)}, {','.join(map(vector, values))} }}" for name, values in parts)
        return "mesh2 { " + "\n  ".join(lists)

    def add_mesh(self, mesh, world):
        for primitive in mesh["primitives"]:
            link = self.extension(primitive, "PROMIN_mesh_primitive_implicit_shape")
            body = self.triangles(primitive) if link is None else self.shape(link["shape"])
            self.lines.append(f"{body} {self.texture(primitive['material'])} {matrix(world)} }}")

    def add_light(self, light, world):
        classic = self.extension(light, "PROMIN_lights_phong")
        if classic is None or classic.get("attenuation", "none") != "none" or light["type"] == "spot":
            raise Unsupported("light sources with falloff or a cone")
        color = [c * light.get("intensity", 1) for c in light.get("color", (1, 1, 1))]
        if classic.get("diffuseColor", color) != classic.get("specularColor", color):
            raise Unsupported("a light source with two powers")
        color = classic.get("diffuseColor", color)
        position = transform(world, (0, 0, 0))
        if light["type"] == "point":
            self.lines.append(f"light_source {{ {vector(position)} rgb {vector(color)} }}")
        else:
            back = unit(transform(world, (0, 0, 1), 0.0))
            self.lines.append(f"light_source {{ {_FAR:g} * {vector(back)} rgb {vector(color)} parallel point_at 0 }}")

    def add_node(self, index, parent):
        node = self.gltf["nodes"][index]
        world = multiply(parent, local_transform(node))
        if "camera" in node:
            self.cameras.append((node.get("name", ""), self.gltf["cameras"][node["camera"]], world))
        if "mesh" in node:
            self.add_mesh(self.gltf["meshes"][node["mesh"]], world)
        light = self.extension(node, "KHR_lights_punctual")
        if light is not None:
            lights = self.extension(self.gltf, "KHR_lights_punctual")["lights"]
            self.add_light(lights[light["light"]], world)
        for child in node.get("children", []):
            self.add_node(child, world)

    def sky(self):
        """Background and ambient brightness."""
        scene = self.gltf["scenes"][self.gltf.get("scene", 0)]
        skies = self.extension(self.gltf, "OMI_environment_sky", {"skies": []})["skies"]
        if not skies:
            return (0, 0, 0), (0, 0, 0)
        sky = skies[self.extension(scene, "OMI_environment_sky", {"sky": 0})["sky"]]
        color, ambient = sky["plain"]["color"], sky.get("ambientLightColor", (0, 0, 0))
        share = sky.get("ambientSkyContribution", 1)
        return color, [a * (1 - share) + c * share for a, c in zip(ambient, color)]

    def camera(self, wanted):
        """The chosen camera by name or number. Given by its own axes, it is right-handed as the scene is."""
        found = [c for i, c in enumerate(self.cameras) if wanted in (c[0], str(i))]
        if not found:
            raise Unsupported(f"camera {wanted}: there is none of that name or number")
        _, lens, world = found[0]
        eye = transform(world, (0, 0, 0))
        right, up, back = (unit(transform(world, axis, 0.0)) for axis in ((1, 0, 0), (0, 1, 0), (0, 0, 1)))
        look = [-x for x in back]
        aspect = "image_width / image_height"
        if lens["type"] == "orthographic":
            height = 2 * lens["orthographic"]["ymag"]
            kind = "orthographic"
        else:
            height = 2 * math.tan(lens["perspective"]["yfov"] / 2)
            kind = "perspective"
        axes = f"right {height:.9g} * {aspect} * {vector(right)} up {height:.9g} * {vector(up)}"
        return f"camera {{ {kind} location {vector(eye)} direction {vector(look)} {axes} }}"

    def convert(self, camera, max_depth):
        """The scene as text. max_depth is the number of bounces, as promin counts them."""
        identity = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]
        for index in self.gltf["scenes"][self.gltf.get("scene", 0)]["nodes"]:
            self.add_node(index, identity)
        background, ambient = self.sky()
        settings = f"assumed_gamma 1 max_trace_level {max_depth + 1} adc_bailout 0 ambient_light rgb {vector(ambient)}"
        head = ["#version 3.7;", f"global_settings {{ {settings} }}", f"background {{ rgb {vector(background)} }}"]
        return "\n".join([*head, self.camera(camera), *self.lines, ""])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", type=pathlib.Path, help="a .gltf file")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True, help="the .pov file")
    parser.add_argument("--camera", default="0", help="name or number (default: the first)")
    parser.add_argument("--max-depth", type=int, default=6, help="number of bounces (default 6)")
    arguments = parser.parse_args()
    try:
        text = Converter(arguments.scene).convert(arguments.camera, arguments.max_depth)
    except Unsupported as problem:
        sys.exit(f"scene_to_pov: error: POV-Ray has no equivalent, {arguments.scene}: {problem}")
    arguments.output.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
