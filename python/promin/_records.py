# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Lights, materials, cameras and environments: the structs of include/promin as dataclasses. The comments there say
more.

Colours are linear RGB, angles are in radians, lengths in world units. Ranges are checked when a record is used."""

from __future__ import annotations

import dataclasses
import difflib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from math import inf
from typing import Any, TypeVar, Union

import numpy as np
from numpy.typing import NDArray

from promin._errors import UsageError

Record = TypeVar("Record")
Vec3 = tuple[float, float, float]
"""Three numbers, or an array of three."""


@dataclass(frozen=True)
class Light:
    """A light (promin/lights.h). The default is a classic point light of power 1 at the origin."""

    kind: str = "point"
    """"point", "directional", "spot" or "headlight", which shines in the direction of view."""
    position: Vec3 = (0.0, 0.0, 0.0)
    """Position of point and spot lights."""
    direction: Vec3 = (0.0, 0.0, -1.0)
    """Unit vector in which the light of directional and spot lights travels."""
    diffuse: Vec3 = (1.0, 1.0, 1.0)
    """Power in the diffuse term; in candela for lights with attenuation."""
    specular: Vec3 = (1.0, 1.0, 1.0)
    """Power in the specular term."""
    attenuation: str = "none"
    """"none" or "inverse_square"."""
    range: float = inf
    """Distance beyond which a light with attenuation contributes nothing."""
    inner_cone_angle: float = 0.0
    """Half the angle of the cone in which a spot has its full power."""
    outer_cone_angle: float = 0.785398163
    """Half the angle of the cone outside of which a spot contributes nothing, at most pi / 2."""
    is_on: bool = True
    """Whether the light is on. A light that is off keeps its index."""
    name: str = ""
    """For people."""


@dataclass(frozen=True)
class TextureSlot:
    """A reference from a material to a texture of the scene's file (promin/textures.h)."""

    texture: int
    """Index of the scene's texture."""
    uv_set: int = 0
    """The set of the mesh's texture coordinates, 0 or 1."""
    to_u: Vec3 = (1.0, 0.0, 0.0)
    """u = to_u . (s, t, 1)."""
    to_v: Vec3 = (0.0, 1.0, 0.0)
    """v = to_v . (s, t, 1)."""


@dataclass(frozen=True, kw_only=True)
class Material:
    """The fields that all material models share (promin/materials.h). Use Phong, MetallicRoughness or Unlit."""

    name: str = ""
    """For people."""
    emissive: Vec3 = (0.0, 0.0, 0.0)
    """Light that the surface emits."""
    emissive_texture: TextureSlot | None = None
    """Factors of it."""
    alpha_mode: str = "opaque"
    """"opaque", "mask" or "blend". Casts ignore alpha."""
    alpha: float = 1.0
    """Opacity of the surface, 0...1."""
    alpha_cutoff: float = 0.5
    """The smallest alpha at which a masked surface is present."""
    is_double_sided: bool = True
    """Whether pictures show both sides of triangles."""


@dataclass(frozen=True, kw_only=True)
class Phong(Material):
    """Phong's model (docs/model.md, "Phong"). The default is a matt light grey."""

    ambient: Vec3 = (0.8, 0.8, 0.8)
    """Weight of ambient light."""
    diffuse: Vec3 = (0.8, 0.8, 0.8)
    """Weight of N.L times a light's diffuse power."""
    specular: Vec3 = (0.0, 0.0, 0.0)
    """Weight of the highlight."""
    shininess: float = 0.0
    """Phong's exponent; 0 or less: no highlight."""
    reflection: Vec3 = (0.0, 0.0, 0.0)
    """Weight of the mirror ray's radiance."""
    transmission: Vec3 = (0.0, 0.0, 0.0)
    """Weight of the refracted ray's radiance."""
    ior: float = 1.0
    """Index of refraction."""
    fresnel: bool = False
    """Whether Fresnel's reflectance weights both."""
    diffuse_texture: TextureSlot | None = None
    """Factors of ambient and diffuse."""
    specular_texture: TextureSlot | None = None
    """Factors of specular and reflection."""
    normal_texture: TextureSlot | None = None
    """Normals in the mesh's tangent space."""


@dataclass(frozen=True, kw_only=True)
class MetallicRoughness(Material):
    """glTF's metallic-roughness model (docs/model.md, "Metallic-roughness"). The default is a rough white metal."""

    base_color: Vec3 = (1.0, 1.0, 1.0)
    """Albedo of the dielectric and reflectance of the metal, 0...1."""
    metallic: float = 1.0
    """Weight of the metal, 0...1."""
    roughness: float = 1.0
    """Perceptual roughness, 0...1."""
    ior: float = 1.5
    """Of the dielectric."""
    specular: float = 1.0
    """Strength of the dielectric's reflection, 0...1."""
    specular_color: Vec3 = (1.0, 1.0, 1.0)
    """Its colour."""
    transmission: float = 0.0
    """The part of the light that is transmitted, 0...1."""
    thickness: float = 0.0
    """0 for a thin wall; else the surface bounds a volume."""
    attenuation_color: Vec3 = (1.0, 1.0, 1.0)
    """The colour that white light has after attenuation_distance."""
    attenuation_distance: float = inf
    """See attenuation_color."""
    dispersion: float = 0.0
    """20 divided by the Abbe number."""
    normal_scale: float = 1.0
    """Factor of x and y of the texture's normals."""
    occlusion_strength: float = 1.0
    """0...1."""
    diffuse_transmission: float = 0.0
    """The part of the scattered light that leaves on the other side, 0...1."""
    diffuse_transmission_color: Vec3 = (1.0, 1.0, 1.0)
    """The colour of the light that leaves on the other side, 0...1, in place of the base colour."""
    clearcoat: float = 0.0
    """Weight of the clear coat, 0...1."""
    clearcoat_roughness: float = 0.0
    """0...1."""
    clearcoat_normal_scale: float = 1.0
    """Factor of x and y of the coat's normals."""
    sheen_color: Vec3 = (0.0, 0.0, 0.0)
    """Colour of the sheen of cloth; 0 for no sheen."""
    sheen_roughness: float = 0.0
    """0...1."""
    iridescence: float = 0.0
    """Weight of a thin film that colours the reflection, 0...1."""
    iridescence_ior: float = 1.3
    """The film's index of refraction, 1 or more."""
    iridescence_thickness_minimum: float = 100.0
    """The film's thickness in nanometres where its texture is 0, not negative."""
    iridescence_thickness_maximum: float = 400.0
    """The same where its texture is 1, and without a texture."""
    anisotropy: float = 0.0
    """How much highlights are stretched, 0...1, on meshes with texture coordinates."""
    anisotropy_rotation: float = 0.0
    """Direction of the stretch in radians, counterclockwise from the tangent."""
    base_color_texture: TextureSlot | None = None
    metallic_roughness_texture: TextureSlot | None = None
    normal_texture: TextureSlot | None = None
    occlusion_texture: TextureSlot | None = None
    specular_texture: TextureSlot | None = None
    specular_color_texture: TextureSlot | None = None
    transmission_texture: TextureSlot | None = None
    diffuse_transmission_texture: TextureSlot | None = None
    diffuse_transmission_color_texture: TextureSlot | None = None
    clearcoat_texture: TextureSlot | None = None
    clearcoat_roughness_texture: TextureSlot | None = None
    clearcoat_normal_texture: TextureSlot | None = None
    sheen_color_texture: TextureSlot | None = None
    sheen_roughness_texture: TextureSlot | None = None
    iridescence_texture: TextureSlot | None = None
    iridescence_thickness_texture: TextureSlot | None = None
    anisotropy_texture: TextureSlot | None = None


@dataclass(frozen=True, kw_only=True)
class Unlit(Material):
    """A material whose colour does not depend on light."""

    color: Vec3 = (1.0, 1.0, 1.0)
    """What is seen."""
    color_texture: TextureSlot | None = None
    """Factors of it."""


@dataclass(frozen=True)
class Camera:
    """A pose and a projection (promin/camera.h). The default camera stands at the origin and looks along -Z."""

    eye: Vec3 = (0.0, 0.0, 0.0)
    """Where it is."""
    look: Vec3 = (0.0, 0.0, -1.0)
    """Unit vector in the direction of view."""
    up: Vec3 = (0.0, 1.0, 0.0)
    """Unit vector towards the top of the picture, at a right angle to `look`."""
    yfov: float = 0.7
    """Vertical field of view of a perspective camera, in (0, pi)."""
    projection: str = "perspective"
    """"perspective" or "orthographic"."""
    ymag: float = 1.0
    """Half the height of an orthographic camera's view."""
    near: float = 0.0
    """Distance of the near plane. Nothing nearer is drawn."""
    aspect_ratio: float = 0.0
    """Width over height that the scene's file requests; 0 if it requests none."""
    resolution: tuple[int, int] = (0, 0)
    """The size in pixels that the scene's file requests; 0 if it requests none."""
    name: str = ""
    """For people."""

    @staticmethod
    def look_at(
        eye: Iterable[float], target: Iterable[float], up: Iterable[float] = (0.0, 1.0, 0.0), **other: Any
    ) -> Camera:
        """Returns a camera at `eye` with `target` in the middle of its picture and `up` upwards. `other` are its
        further fields. If `up` is parallel to the view, another direction is used."""
        start = np.array(tuple(eye), np.float64)
        look = np.array(tuple(target), np.float64) - start
        look /= np.linalg.norm(look)
        right = np.cross(look, np.array(tuple(up), np.float64))
        if np.linalg.norm(right) < 1e-9:
            right = np.cross(look, (0.0, 0.0, 1.0) if abs(look[2]) < 0.9 else (1.0, 0.0, 0.0))
        right /= np.linalg.norm(right)
        return Camera(eye=_vec3(start), look=_vec3(look), up=_vec3(np.cross(right, look)), **other)


@dataclass(frozen=True)
class Studio:
    """The built-in surroundings for scenes without light."""

    front: float = 0.0
    """The azimuth from which the viewer looks at the scene, about +Y from +Z."""


@dataclass(frozen=True)
class GradientSky:
    """A gradient over the elevation (promin/environment.h)."""

    top: Vec3 = (0.3, 0.5, 1.0)
    horizon: Vec3 = (0.8, 0.8, 0.9)
    bottom: Vec3 = (0.2, 0.2, 0.2)
    top_curve: float = 0.15
    bottom_curve: float = 0.02


@dataclass(frozen=True)
class Panorama:
    """An equirectangular picture of all directions, its middle at -Z; see `promin.read_image`."""

    image: NDArray[np.float32] = field(repr=False, compare=False)
    """Linear RGB, (rows, columns, 3) float32."""


@dataclass(frozen=True)
class Backdrop:
    """The background that the camera sees: a gradient from the picture's upper edge to its lower edge, linear RGB,
    displayed unchanged."""

    top: Vec3 = (1.0, 1.0, 1.0)
    bottom: Vec3 = (1.0, 1.0, 1.0)
    radiance: float = 1.0
    """Factor that turns its colours into radiance in mirrors and behind glass."""


@dataclass(frozen=True)
class Environment:
    """The surroundings of the scene: everything except objects and lights (promin/environment.h)."""

    ambient: Vec3 = (0.0, 0.0, 0.0)
    """Ambient radiance from all directions, if there is no sky."""
    background: Vec3 = (0.0, 0.0, 0.0)
    """Radiance of rays that leave the scene."""
    sky: Union[Studio, GradientSky, Panorama, None] = None
    """The sky, which replaces ambient light."""
    shows_sky: bool = False
    """Whether the camera sees the sky in place of the background."""
    rotation: float = 0.0
    """Rotation of the sky about +Y."""
    intensity: float = 1.0
    """Factor of the sky's radiance."""
    backdrop: Union[Backdrop, None] = None
    """Replaces the background in pictures without alpha."""


@dataclass(frozen=True)
class Display:
    """How linear light is displayed in 8 bits (promin/display.h)."""

    exposure_ev: float = 0.0
    """Stops."""
    tone_mapping: str = "none"
    """"none", "neutral", "aces", "reinhard" or "agx"."""
    dithers: bool = False
    """Whether 8-bit values get noise before they are rounded."""


def change(record: Record, fields: Mapping[str, Any]) -> Record:
    """Returns the record with other values of some fields. Raises UsageError for a field that it does not have."""
    assert dataclasses.is_dataclass(record)
    known = [f.name for f in dataclasses.fields(record)]
    for name in fields:
        if name not in known:
            raise UsageError(f"a {type(record).__name__} has no field {name!r}; {suggest(name, known)}")
    return dataclasses.replace(record, **fields)  # type: ignore[type-var]


def suggest(name: str, known: list[str]) -> str:
    """Returns the cure for an unknown name."""
    near = [one for one in known if name in one.split("_") or name in one]
    near = sorted(near, key=len)[:1] or difflib.get_close_matches(name, known, 1)
    return f"did you mean {near[0]}?" if near else f"known: {', '.join(known)}"


def _refuse_assignment(record: object, name: str, value: object) -> None:
    raise dataclasses.FrozenInstanceError(
        f"cannot assign to field {name!r} of a {type(record).__name__}: it is a copy; "
        f"change a scene by scene.set_material(name, {name}=...) or scene.set_light, "
        "and other records by dataclasses.replace"
    )


for _kind in (Light, Material, Phong, MetallicRoughness, Unlit, Camera, Environment):
    _kind.__setattr__ = _refuse_assignment  # type: ignore[method-assign]

_MODELS: dict[str, type[Material]] = {"phong": Phong, "metallic_roughness": MetallicRoughness, "unlit": Unlit}
_SKIES: dict[str, type[Any]] = {"studio": Studio, "gradient": GradientSky, "panorama": Panorama}
_NAMES = {kind: name for name, kind in (*_MODELS.items(), *_SKIES.items())}
_KEYS = {
    Phong: "model",
    MetallicRoughness: "model",
    Unlit: "model",
    Studio: "kind",
    GradientSky: "kind",
    Panorama: "kind",
}


def to_dict(record: object) -> dict[str, Any]:
    """Returns a record as a dict for the native module."""
    assert dataclasses.is_dataclass(record)
    result = {f.name: _plain(getattr(record, f.name)) for f in dataclasses.fields(record)}
    kind = type(record)
    if kind in _KEYS:
        result[_KEYS[kind]] = _NAMES[kind]
    return result


def from_dict(kind: type[Record], values: Mapping[str, Any]) -> Record:
    """Returns a record from a dict of the native module; for a Material the class of its model."""
    fields = dict(values)
    if kind is Material:
        kind = _MODELS[fields.pop("model")]  # type: ignore[assignment]
    for name, value in fields.items():
        if name == "sky" and value is not None:
            sky = dict(value)
            fields[name] = _SKIES[sky.pop("kind")](**sky)
        elif name.endswith("_texture") and value is not None:
            fields[name] = TextureSlot(**value)
        elif name == "backdrop" and value is not None:
            fields[name] = Backdrop(**value)
    return kind(**fields)


def _plain(value: object) -> Any:
    if dataclasses.is_dataclass(value):
        return to_dict(value)
    if isinstance(value, np.ndarray):
        return np.ascontiguousarray(value, np.float32) if value.ndim == 3 else tuple(value.tolist())
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, (list, tuple)):
        return tuple(_plain(one) for one in value)
    return value


def _vec3(values: NDArray[np.float64]) -> Vec3:
    return float(values[0]), float(values[1]), float(values[2])
