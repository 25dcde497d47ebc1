# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Walks a promin glTF scene for the programs that write it in another renderer's language.

Those renderers have only the classic features of a scene in common. Anything else is refused (vertex colours,
metallic-roughness materials, falloff, spots, coloured specular factors, a source with two powers), so that a difference
between the pictures is a difference between the renderers.
"""

import argparse
import base64
import json
import math
import pathlib
import struct
import sys
from dataclasses import dataclass

_COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
_FORMATS = {5121: "B", 5123: "H", 5125: "I", 5126: "f"}


class Unsupported(Exception):
    pass


@dataclass
class Material:
    """Holds linear RGB colours, except for the specular factor, which is grey."""

    index: int
    diffuse: list
    ambient: list
    emission: list
    specular: float
    shininess: float
    reflection: list
    transmission: float  # a grey factor
    ior: float


@dataclass
class Triangles:
    positions: list
    normals: list  # empty for flat triangles
    faces: list


@dataclass
class Camera:
    """Holds a camera. The axes are unit vectors; height is that of the view at distance 1, or of an orthographic
    camera's view."""

    is_orthographic: bool
    height: float
    eye: list
    right: list
    up: list
    look: list


def multiply(a, b):
    """Returns the product of two affine 3x4 matrices, given as rows."""
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


def unit(v):
    length = math.sqrt(sum(x * x for x in v))
    return [x / length for x in v]


class SceneReader:
    """Base class of writers. A writer appends to `lines` in add_triangles(), add_shape() and the two functions for
    lights."""

    def __init__(self, file):
        self.folder = file.parent
        self.gltf = json.loads(file.read_text(encoding="utf-8"))
        self.buffers = [self._read_buffer(buffer["uri"]) for buffer in self.gltf.get("buffers", [])]
        self.lines = []
        self._cameras = []

    def add_triangles(self, triangles, material, world):
        raise NotImplementedError

    def add_shape(self, kind, size, material, world):
        """Adds a shape of KHR_implicit_shapes; `size` is its object in that extension."""
        raise NotImplementedError

    def add_point_light(self, position, color):
        raise NotImplementedError

    def add_directional_light(self, back, color):
        """Adds a directional light; `back` is the unit vector to it."""
        raise NotImplementedError

    def read(self):
        identity = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]
        for index in self.gltf["scenes"][self.gltf.get("scene", 0)]["nodes"]:
            self._add_node(index, identity)

    def sky(self):
        """Reads the background and the ambient brightness."""
        scene = self.gltf["scenes"][self.gltf.get("scene", 0)]
        skies = self._extension(self.gltf, "OMI_environment_sky", {"skies": []})["skies"]
        if not skies:
            return (0, 0, 0), (0, 0, 0)
        sky = skies[self._extension(scene, "OMI_environment_sky", {"sky": 0})["sky"]]
        color, ambient = sky["plain"]["color"], sky.get("ambientLightColor", (0, 0, 0))
        share = sky.get("ambientSkyContribution", 1)
        return color, [a * (1 - share) + c * share for a, c in zip(ambient, color)]

    def camera(self, wanted):
        """Returns the camera with this name or number. Its square picture shows at least everything that the camera
        sees."""
        found = [c for i, c in enumerate(self._cameras) if wanted in (c[0], str(i))]
        if not found:
            raise Unsupported(f"camera {wanted}: there is none of that name or number")
        _, lens, world = found[0]
        right, up, back = (unit(transform(world, axis, 0.0)) for axis in ((1, 0, 0), (0, 1, 0), (0, 0, 1)))
        is_orthographic = lens["type"] == "orthographic"
        height = 2 * (lens["orthographic"]["ymag"] if is_orthographic else math.tan(lens["perspective"]["yfov"] / 2))
        if is_orthographic:
            aspect_ratio = lens["orthographic"]["xmag"] / lens["orthographic"]["ymag"]
        else:
            aspect_ratio = lens["perspective"].get("aspectRatio", 1.0)
        height *= max(1.0, aspect_ratio)
        return Camera(is_orthographic, height, transform(world, (0, 0, 0)), right, up, [-x for x in back])

    def _read_buffer(self, uri):
        if uri.startswith("data:"):
            return base64.b64decode(uri.split(",", 1)[1])
        return (self.folder / uri).read_bytes()

    def _extension(self, owner, name, default=None):
        return owner.get("extensions", {}).get(name, default)

    def _accessor(self, index):
        accessor = self.gltf["accessors"][index]
        view = self.gltf["bufferViews"][accessor["bufferView"]]
        if "sparse" in accessor or "byteStride" in view or accessor.get("normalized"):
            raise Unsupported("sparse, interleaved and normalised accessors")
        size = _COMPONENTS[accessor["type"]]
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        code = f"<{accessor['count'] * size}{_FORMATS[accessor['componentType']]}"
        values = struct.unpack_from(code, self.buffers[view["buffer"]], start)
        return [values[i : i + size] for i in range(0, len(values), size)]

    def _material(self, index):
        material = self.gltf["materials"][index]
        phong = self._extension(material, "PROMIN_materials_phong")
        if phong is None:
            raise Unsupported(f"material {index}, which is not classic Phong")
        base = material.get("pbrMetallicRoughness", {}).get("baseColorFactor", (1, 1, 1, 1))[:3]
        diffuse = phong.get("diffuseFactor", base)
        specular = phong.get("specularFactor", (0, 0, 0))
        if len(set(specular)) > 1:
            raise Unsupported(f"material {index}: specularFactor is not grey")
        transmission = phong.get("transmissionFactor", (0, 0, 0))
        if len(set(transmission)) > 1 or phong.get("fresnel", False):
            raise Unsupported(f"material {index}: glass that is not grey or hangs on the angle")
        return Material(
            index,
            diffuse,
            phong.get("ambientFactor", diffuse),
            material.get("emissiveFactor", (0, 0, 0)),
            specular[0],
            phong.get("shininess", 0),
            phong.get("reflectionFactor", (0, 0, 0)),
            transmission[0],
            phong.get("ior", 1),
        )

    def _triangles(self, primitive):
        if primitive.get("mode", 4) != 4 or "COLOR_0" in primitive["attributes"]:
            raise Unsupported("strips, fans, points, lines and vertex colours")
        positions = self._accessor(primitive["attributes"]["POSITION"])
        corners = range(len(positions))
        if "indices" in primitive:
            corners = [i for (i,) in self._accessor(primitive["indices"])]
        normals = self._accessor(primitive["attributes"]["NORMAL"]) if "NORMAL" in primitive["attributes"] else []
        return Triangles(positions, normals, [corners[i : i + 3] for i in range(0, len(corners), 3)])

    def _add_mesh(self, mesh, world):
        for primitive in mesh["primitives"]:
            link = self._extension(primitive, "PROMIN_mesh_primitive_implicit_shape")
            material = self._material(primitive["material"])
            if link is None:
                self.add_triangles(self._triangles(primitive), material, world)
            else:
                shape = self._extension(self.gltf, "KHR_implicit_shapes")["shapes"][link["shape"]]
                self.add_shape(shape["type"], shape.get(shape["type"], {}), material, world)

    def _add_light(self, light, world):
        classic = self._extension(light, "PROMIN_lights_phong")
        if classic is None or classic.get("attenuation", "none") != "none" or light["type"] == "spot":
            raise Unsupported("light sources with falloff or a cone")
        color = [c * light.get("intensity", 1) for c in light.get("color", (1, 1, 1))]
        if classic.get("diffuseColor", color) != classic.get("specularColor", color):
            raise Unsupported("a light source with two powers")
        color = classic.get("diffuseColor", color)
        if light["type"] == "point":
            self.add_point_light(transform(world, (0, 0, 0)), color)
        elif light["type"] == "directional":
            self.add_directional_light(unit(transform(world, (0, 0, 1), 0.0)), color)
        else:
            raise Unsupported(f"light sources of type {light['type']}")

    def _add_node(self, index, parent):
        node = self.gltf["nodes"][index]
        world = multiply(parent, local_transform(node))
        if "camera" in node:
            self._cameras.append((node.get("name", ""), self.gltf["cameras"][node["camera"]], world))
        if "mesh" in node:
            self._add_mesh(self.gltf["meshes"][node["mesh"]], world)
        light = self._extension(node, "KHR_lights_punctual")
        if light is not None:
            lights = self._extension(self.gltf, "KHR_lights_punctual")["lights"]
            self._add_light(lights[light["light"]], world)
        for child in node.get("children", []):
            self._add_node(child, world)


def convert(description, writer, ending):
    """Runs a program that writes a scene; writer(file, camera, max_depth) returns its text."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", type=pathlib.Path, help="a .gltf file")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True, help=f"the {ending} file")
    parser.add_argument("--camera", default="0", help="name or number (default: the first)")
    parser.add_argument("--max-depth", type=int, default=6, help="number of bounces (default 6)")
    arguments = parser.parse_args()
    try:
        text = writer(arguments.scene, arguments.camera, arguments.max_depth)
    except Unsupported as problem:
        sys.exit(f"{parser.prog}: error: there is no equivalent, {arguments.scene}: {problem}")
    arguments.output.write_text(text, encoding="utf-8")
