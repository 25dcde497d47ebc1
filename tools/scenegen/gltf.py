# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Builds a glTF 2.0 file with the extensions that promin reads."""

import base64
import json
import math
import struct
import zlib

from . import meshes
from .vectors import look_rotation, sub

_BYTE_BUFFER, _ELEMENT_BUFFER = 34962, 34963
_UNSIGNED_BYTE, _UNSIGNED_SHORT, _UNSIGNED_INT, _FLOAT = 5121, 5123, 5125, 5126
_INDEX_FORMATS = {_UNSIGNED_BYTE: "B", _UNSIGNED_SHORT: "H", _UNSIGNED_INT: "I"}
TRIANGLES, TRIANGLE_STRIP, TRIANGLE_FAN = 4, 5, 6


def to_float32(x):
    return struct.unpack("<f", struct.pack("<f", x))[0]


def shortest(x):
    """Returns the number with the fewest digits that rounds to the same fp32 number; integers become int."""
    wanted = to_float32(x)
    if wanted == int(wanted) and abs(wanted) < 1e6:
        return int(wanted)
    return next(n for n in (float(f"{wanted:.{digits}g}") for digits in range(1, 10)) if to_float32(n) == wanted)


def png(rows):
    """Returns a PNG file of rows of RGB bytes."""

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", len(rows[0]) // 3, len(rows), 8, 2, 0, 0, 0)
    lines = b"".join(b"\0" + row for row in rows)
    data = zlib.compress(lines, 9)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", data) + chunk(b"IEND", b"")


def _numbers(values):
    return [shortest(v) for v in values]


class Gltf:
    """Holds one scene. Every method that adds something returns its index in the file."""

    def __init__(self):
        self._root = {"asset": {"version": "2.0", "generator": "promin tools/make_scenes.py"}}
        self._root["scene"] = 0
        self._root["scenes"] = [{"nodes": []}]
        self._bytes = bytearray()
        self._extensions = set()

    def _append(self, key, value):
        items = self._root.setdefault(key, [])
        items.append(value)
        return len(items) - 1

    def _append_to_extension(self, extension, key, value):
        self._extensions.add(extension)
        items = self._root.setdefault("extensions", {}).setdefault(extension, {}).setdefault(key, [])
        items.append(value)
        return len(items) - 1

    def _accessor(self, data, target, component_type, kind, count, **bounds):
        view = {"buffer": 0, "byteOffset": len(self._bytes), "byteLength": len(data), "target": target}
        self._bytes += data + bytes(-len(data) % 4)
        accessor = {"bufferView": self._append("bufferViews", view), "componentType": component_type}
        return self._append("accessors", {**accessor, "count": count, "type": kind, **bounds})

    def _vectors(self, vectors, with_bounds=False):
        vectors = [tuple(to_float32(x) for x in v) for v in vectors]
        size = len(vectors[0])
        bounds = {}
        if with_bounds:
            bounds = {"min": _numbers(map(min, zip(*vectors))), "max": _numbers(map(max, zip(*vectors)))}
        data = b"".join(struct.pack(f"<{size}f", *v) for v in vectors)
        return self._accessor(data, _BYTE_BUFFER, _FLOAT, f"VEC{size}", len(vectors), **bounds)

    def _indices(self, indices):
        largest = max(indices)
        kind = _UNSIGNED_BYTE if largest < 255 else _UNSIGNED_SHORT if largest < 65535 else _UNSIGNED_INT
        data = struct.pack(f"<{len(indices)}{_INDEX_FORMATS[kind]}", *indices)
        return self._accessor(data, _ELEMENT_BUFFER, kind, "SCALAR", len(indices))

    def _primitive(self, mesh, material, mode=TRIANGLES):
        attributes = {"POSITION": self._vectors(mesh.positions, with_bounds=True)}
        if mesh.normals:
            attributes["NORMAL"] = self._vectors(mesh.normals)
        if mesh.colors:
            attributes["COLOR_0"] = self._vectors(mesh.colors)
        if mesh.uvs:
            attributes["TEXCOORD_0"] = self._vectors(mesh.uvs)
        primitive = {"attributes": attributes, "indices": self._indices(mesh.indices), "material": material}
        if mode != TRIANGLES:
            primitive["mode"] = mode
        return primitive

    def material(self, name, diffuse, specular=0.0, shininess=0.0, reflection=0.0, ambient=None, emissive=None):
        """Adds a classic Phong material. Factors are linear RGB; one number means grey."""
        self._extensions.add("PROMIN_materials_phong")
        phong = {}
        for key, factor in (("ambientFactor", ambient), ("specularFactor", specular), ("reflectionFactor", reflection)):
            rgb = (factor,) * 3 if isinstance(factor, (int, float)) else factor
            if rgb and any(rgb) or key == "ambientFactor" and rgb:
                phong[key] = _numbers(rgb)
        if shininess:
            phong["shininess"] = shortest(shininess)
        # The base colour is Phong's diffuse factor; viewers that do not know Phong show it.
        pbr = {"baseColorFactor": _numbers((*diffuse, 1.0)), "metallicFactor": 0}
        material = {"name": name, "pbrMetallicRoughness": pbr, "extensions": {"PROMIN_materials_phong": phong}}
        if emissive:
            material["emissiveFactor"] = _numbers(emissive)
        return self._append("materials", material)

    def metallic_roughness(self, name, base_color, metallic, roughness):
        factors = {"metallicFactor": shortest(metallic), "roughnessFactor": shortest(roughness)}
        pbr = {"baseColorFactor": _numbers((*base_color, 1.0)), **factors}
        return self._append("materials", {"name": name, "pbrMetallicRoughness": pbr})

    def textured(self, name, rows, roughness=1.0):
        """Adds a material without metal and with a repeated texture: rows of RGB bytes, codes of sRGB."""
        uri = "data:image/png;base64," + base64.b64encode(png(rows)).decode()
        texture = self._append("textures", {"source": self._append("images", {"name": name, "uri": uri})})
        index = self.metallic_roughness(name, (1.0, 1.0, 1.0), 0.0, roughness)
        self._root["materials"][index]["pbrMetallicRoughness"]["baseColorTexture"] = {"index": texture}
        return index

    def glass(self, name, base_color=(1.0, 1.0, 1.0), ior=1.5, roughness=0.0, absorbed=None):
        """Adds a material of glass. It is a thin wall; `absorbed` makes it a volume: a colour, and the distance after
        which white light has this colour."""
        index = self.metallic_roughness(name, base_color, 0.0, roughness)
        extensions = {
            "KHR_materials_transmission": {"transmissionFactor": 1},
            "KHR_materials_ior": {"ior": shortest(ior)},
        }
        if absorbed:
            color, distance = absorbed
            volume = {"attenuationColor": _numbers(color), "attenuationDistance": shortest(distance)}
            extensions["KHR_materials_volume"] = {"thicknessFactor": 1, **volume}
        self._extensions.update(extensions)
        self._root["materials"][index]["extensions"] = extensions
        return index

    def _extend(self, index, extension, parameters):
        self._extensions.add(extension)
        self._root["materials"][index].setdefault("extensions", {})[extension] = parameters
        return index

    def coat(self, index, roughness, factor=1.0):
        """Adds a layer of varnish to the material."""
        parameters = {"clearcoatFactor": shortest(factor), "clearcoatRoughnessFactor": shortest(roughness)}
        return self._extend(index, "KHR_materials_clearcoat", parameters)

    def velvet(self, name, base_color, sheen_color):
        index = self.metallic_roughness(name, base_color, 0.0, 0.9)
        self._root["materials"][index]["doubleSided"] = True
        parameters = {"sheenColorFactor": _numbers(sheen_color), "sheenRoughnessFactor": shortest(0.45)}
        return self._extend(index, "KHR_materials_sheen", parameters)

    def paper(self, name, base_color, share, color):
        """Adds a matt wall that scatters a fraction of its light to the other side, in a separate colour."""
        index = self.metallic_roughness(name, base_color, 0.0, 0.8)
        self._root["materials"][index]["doubleSided"] = True
        parameters = {"diffuseTransmissionFactor": shortest(share), "diffuseTransmissionColorFactor": _numbers(color)}
        return self._extend(index, "KHR_materials_diffuse_transmission", parameters)

    def filmed(self, name, base_color, metallic, thickness, ior=1.3, roughness=0.05):
        """Adds a material under a thin film; its thickness is in nanometres."""
        index = self.metallic_roughness(name, base_color, metallic, roughness)
        parameters = {
            "iridescenceFactor": 1,
            "iridescenceIor": shortest(ior),
            "iridescenceThicknessMaximum": shortest(thickness),
        }
        return self._extend(index, "KHR_materials_iridescence", parameters)

    def brushed(self, name, base_color, roughness, strength, rotation=0.0):
        """Adds a metal whose grain is parallel to the texture coordinate u, or rotated by an angle."""
        index = self.metallic_roughness(name, base_color, 1.0, roughness)
        parameters = {"anisotropyStrength": shortest(strength), "anisotropyRotation": shortest(rotation)}
        return self._extend(index, "KHR_materials_anisotropy", parameters)

    def classic_glass(self, name, transmission, reflection, ior, fresnel=False):
        """Adds classic Phong without diffuse light."""
        index = self.material(name, (0.0, 0.0, 0.0), specular=0.5, shininess=200.0, reflection=reflection)
        phong = {"transmissionFactor": _numbers((transmission,) * 3), "ior": shortest(ior)}
        if fresnel:
            phong["fresnel"] = True
        self._root["materials"][index]["extensions"]["PROMIN_materials_phong"].update(phong)
        return index

    def mesh(self, name, mesh, material, mode=TRIANGLES):
        return self._append("meshes", {"name": name, "primitives": [self._primitive(mesh, material, mode)]})

    def _shape(self, name, kind, parameters, fallback, material):
        numbers = {
            key: shortest(value) if isinstance(value, float) else _numbers(value) for key, value in parameters.items()
        }
        shape = {"type": kind, kind: numbers}
        index = self._append_to_extension("KHR_implicit_shapes", "shapes", shape)
        self._extensions.add("PROMIN_mesh_primitive_implicit_shape")
        primitive = self._primitive(fallback, material)
        primitive["extensions"] = {"PROMIN_mesh_primitive_implicit_shape": {"shape": index}}
        return self._append("meshes", {"name": name, "primitives": [primitive]})

    def sphere(self, name, radius, material):
        return self._shape(name, "sphere", {"radius": radius}, meshes.icosphere(radius, 1), material)

    def cylinder(self, name, height, radius, material):
        return self.frustum(name, height, radius, radius, material)

    def cone(self, name, height, radius, material):
        return self.frustum(name, height, radius, 0.0, material)

    def frustum(self, name, height, radius_bottom, radius_top, material):
        parameters = {"height": height, "radiusBottom": radius_bottom, "radiusTop": radius_top}
        fallback = meshes.frustum(height, radius_bottom, radius_top, 16)
        return self._shape(name, "cylinder", parameters, fallback, material)

    def box(self, name, size, material):
        return self._shape(name, "box", {"size": size}, meshes.box(*size), material)

    def capsule(self, name, height, radius_bottom, radius_top, material):
        """Adds a capsule. `height` is the distance between the centres of the spheres."""
        parameters = {"height": height, "radiusBottom": radius_bottom, "radiusTop": radius_top}
        return self._shape(name, "capsule", parameters, meshes.capsule(height, radius_bottom, radius_top, 12), material)

    def plane(self, name, material, fallback_size=40.0):
        """Adds the infinite plane y = 0."""
        return self._shape(name, "plane", {}, meshes.rectangle(fallback_size, fallback_size), material)

    def node(self, name, parent=None, translation=None, rotation=None, scale=None, **links):
        """Adds a node. links: mesh=, camera=, light= with an index. A uniform scale may be one number."""
        node = {"name": name}
        if "light" in links:
            self._extensions.add("KHR_lights_punctual")
            node["extensions"] = {"KHR_lights_punctual": {"light": links.pop("light")}}
        node.update(links)
        if isinstance(scale, (int, float)):
            scale = (scale,) * 3
        for key, value in (("translation", translation), ("rotation", rotation), ("scale", scale)):
            if value is not None:
                node[key] = _numbers(value)
        index = self._append("nodes", node)
        siblings = self._root["scenes"][0]["nodes"]
        if parent is not None:
            siblings = self._root["nodes"][parent].setdefault("children", [])
        siblings.append(index)
        return index

    def camera(self, name, eye, target, yfov_deg=35.0, aspect_ratio=16.0 / 9.0, up=(0.0, 1.0, 0.0)):
        lens = {"yfov": shortest(math.radians(yfov_deg)), "aspectRatio": shortest(aspect_ratio), "znear": 0.01}
        return self._place_camera(name, {"type": "perspective", "perspective": lens}, eye, target, up)

    def orthographic_camera(self, name, eye, target, ymag, aspect_ratio=16.0 / 9.0, zfar=100.0):
        lens = {"xmag": shortest(ymag * aspect_ratio), "ymag": shortest(ymag), "znear": 0, "zfar": shortest(zfar)}
        return self._place_camera(name, {"type": "orthographic", "orthographic": lens}, eye, target, (0.0, 1.0, 0.0))

    def _place_camera(self, name, camera, eye, target, up):
        index = self._append("cameras", {"name": name, **camera})
        return self.node(name, translation=eye, rotation=look_rotation(sub(target, eye), up), camera=index)

    def _light(self, name, kind, color, intensity, classic, placement, **details):
        light = {"name": name, "type": kind, "color": _numbers(color), "intensity": shortest(intensity), **details}
        if classic:
            self._extensions.add("PROMIN_lights_phong")
            light["extensions"] = {"PROMIN_lights_phong": {}}
        index = self._append_to_extension("KHR_lights_punctual", "lights", light)
        return self.node(name, light=index, **placement)

    def point_light(self, name, position, color=(1.0, 1.0, 1.0), intensity=1.0, classic=True):
        return self._light(name, "point", color, intensity, classic, {"translation": position})

    def directional_light(self, name, direction, color=(1.0, 1.0, 1.0), intensity=1.0, classic=True):
        return self._light(name, "directional", color, intensity, classic, {"rotation": look_rotation(direction)})

    def spot_light(self, name, position, target, inner_deg, outer_deg, color=(1.0, 1.0, 1.0), intensity=1.0):
        angles = {"innerConeAngle": inner_deg, "outerConeAngle": outer_deg}
        spot = {key: shortest(math.radians(value)) for key, value in angles.items()}
        placement = {"translation": position, "rotation": look_rotation(sub(target, position))}
        return self._light(name, "spot", color, intensity, True, placement, spot=spot)

    def sky(self, background, ambient):
        """Sets the background's colour and the ambient brightness i_a, both linear RGB."""
        sky = {"type": "plain", "plain": {"color": _numbers(background)}, "ambientLightColor": _numbers(ambient)}
        index = self._append_to_extension("OMI_environment_sky", "skies", {**sky, "ambientSkyContribution": 0})
        self._root["scenes"][0]["extensions"] = {"OMI_environment_sky": {"sky": index}}

    def write(self, path, separate_buffer=False):
        """Writes PATH and, with separate_buffer, its .bin beside it; otherwise the buffer is a data URI."""
        root = dict(self._root)
        root["extensionsUsed"] = sorted(self._extensions)
        buffer = {"byteLength": len(self._bytes)}
        if separate_buffer:
            path.with_suffix(".bin").write_bytes(self._bytes)
            buffer["uri"] = path.with_suffix(".bin").name
        else:
            buffer["uri"] = "data:application/octet-stream;base64," + base64.b64encode(self._bytes).decode()
        root["buffers"] = [buffer]
        path.write_text(_format(root), encoding="utf-8")


def _format(root):
    """Returns JSON with one line for each entry of a top-level list, so that people can read and compare scenes line by
    line."""
    lines = []
    for key, value in root.items():
        if isinstance(value, list) and value and isinstance(value[0], dict):
            text = "[\n    " + ",\n    ".join(json.dumps(entry) for entry in value) + "\n  ]"
        else:
            text = json.dumps(value)
        lines.append(f"  {json.dumps(key)}: {text}")
    return "{\n" + ",\n".join(lines) + "\n}\n"
