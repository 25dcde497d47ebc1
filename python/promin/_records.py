# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Lights, materials, cameras and environments: the structs of include/promin as dataclasses. The comments in
include/promin say more.

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
    """The kind of the light: "point", "directional", "spot", "rect", "disk" or "headlight". A headlight shines in
    the direction of view. Rectangles and disks are flat and shine from one side."""
    position: Vec3 = (0.0, 0.0, 0.0)
    """Position of point and spot lights."""
    direction: Vec3 = (0.0, 0.0, -1.0)
    """Unit vector: the direction in which the light of directional and spot lights travels."""
    diffuse: Vec3 = (1.0, 1.0, 1.0)
    """Power for the diffuse term; in candela for lights with attenuation."""
    specular: Vec3 = (1.0, 1.0, 1.0)
    """Power for the specular term, in the same units."""
    attenuation: str = "none"
    """The decrease of the power with the distance: "none" or "inverse_square"."""
    range: float = inf
    """Distance beyond which a light with attenuation contributes nothing, in world units."""
    inner_cone_angle: float = 0.0
    """Half the angle of the cone in which a spot light has its full power."""
    outer_cone_angle: float = 0.785398163
    """Half the angle of the cone outside which a spot light contributes nothing, at most pi / 2."""
    radius: float = 0.0
    """Radius of point and spot lights in world units. A light with a radius is a ball with soft shadows."""
    angle: float = 0.0
    """The full angle of directional lights in radians, at most pi. A light with an angle is a disc in the sky with soft
    shadows."""
    size: tuple[float, float] = (1.0, 1.0)
    """Width and height of flat lights in world units; a disk has two equal diameters."""
    right: Vec3 = (1.0, 0.0, 0.0)
    """Unit vector along the width of flat lights, at a right angle to `direction`."""
    is_on: bool = True
    """True if the light is on. A light that is off keeps its index."""
    name: str = ""
    """The display name."""


@dataclass(frozen=True)
class TextureSlot:
    """A reference from a material to a texture of the scene's file (promin/textures.h)."""

    texture: int
    """Index of the texture in the scene."""
    uv_set: int = 0
    """The set of the mesh's texture coordinates, 0 or 1."""
    to_u: Vec3 = (1.0, 0.0, 0.0)
    """The first row of the transform of texture coordinates (s, t): u = to_u . (s, t, 1)."""
    to_v: Vec3 = (0.0, 1.0, 0.0)
    """The second row of the transform: v = to_v . (s, t, 1)."""


@dataclass(frozen=True, kw_only=True)
class Material:
    """The fields that all material models share (promin/materials.h). Use Phong, MetallicRoughness or Unlit."""

    name: str = ""
    """The display name."""
    emissive: Vec3 = (0.0, 0.0, 0.0)
    """Light that the surface emits."""
    emissive_texture: TextureSlot | None = None
    """Texture whose values multiply `emissive`."""
    alpha_mode: str = "opaque"
    """The effect of alpha on pictures: "opaque", "mask" or "blend". Casts ignore alpha."""
    alpha: float = 1.0
    """Opacity of the surface, 0...1."""
    alpha_cutoff: float = 0.5
    """The smallest alpha at which a surface with alpha_mode "mask" is present."""
    is_double_sided: bool = True
    """True if pictures show both sides of the material's triangles."""


@dataclass(frozen=True, kw_only=True)
class Phong(Material):
    """Phong's model (docs/model.md, "Phong"). The default is a matt light grey."""

    ambient: Vec3 = (0.8, 0.8, 0.8)
    """Factor of ambient light."""
    diffuse: Vec3 = (0.8, 0.8, 0.8)
    """Factor of N.L times a light's diffuse power."""
    specular: Vec3 = (0.0, 0.0, 0.0)
    """Factor of the highlight times a light's specular power."""
    shininess: float = 0.0
    """Phong's exponent. There is no highlight if it is 0 or less."""
    reflection: Vec3 = (0.0, 0.0, 0.0)
    """Factor of the mirror ray's radiance."""
    transmission: Vec3 = (0.0, 0.0, 0.0)
    """Factor of the refracted ray's radiance."""
    ior: float = 1.0
    """Index of refraction."""
    fresnel: bool = False
    """True if Fresnel's reflectance multiplies `reflection`, and 1 minus the reflectance multiplies `transmission`."""
    diffuse_texture: TextureSlot | None = None
    """Texture whose values multiply `ambient` and `diffuse`."""
    specular_texture: TextureSlot | None = None
    """Texture whose values multiply `specular` and `reflection`."""
    normal_texture: TextureSlot | None = None
    """Texture of normals in the mesh's tangent space."""


@dataclass(frozen=True, kw_only=True)
class MetallicRoughness(Material):
    """glTF's metallic-roughness model (docs/model.md, "Metallic-roughness"). The default is a rough white metal."""

    base_color: Vec3 = (1.0, 1.0, 1.0)
    """Albedo of the dielectric and reflectance of the metal, 0...1."""
    metallic: float = 1.0
    """Weight of the metal in the mixture of dielectric and metal, 0...1."""
    roughness: float = 1.0
    """Perceptual roughness, 0...1."""
    ior: float = 1.5
    """Index of refraction of the dielectric."""
    specular: float = 1.0
    """Strength of the dielectric's reflection, 0...1."""
    specular_color: Vec3 = (1.0, 1.0, 1.0)
    """Colour of the dielectric's reflection."""
    transmission: float = 0.0
    """The fraction of the light that is transmitted, 0...1."""
    thickness: float = 0.0
    """0 for a thin wall. With any other value the surface is the boundary of a volume."""
    attenuation_color: Vec3 = (1.0, 1.0, 1.0)
    """The colour that white light has after the distance attenuation_distance in the volume."""
    attenuation_distance: float = inf
    """The distance to which attenuation_color refers, in world units."""
    dispersion: float = 0.0
    """20 divided by the Abbe number of the volume's glass."""
    normal_scale: float = 1.0
    """Factor of x and y of the normal texture's normals."""
    occlusion_strength: float = 1.0
    """Strength of the occlusion texture, 0...1."""
    diffuse_transmission: float = 0.0
    """The fraction of the scattered light that leaves on the other side, 0...1."""
    diffuse_transmission_color: Vec3 = (1.0, 1.0, 1.0)
    """The colour of the light that leaves on the other side, 0...1; it replaces the base colour for this light."""
    clearcoat: float = 0.0
    """Weight of the clear coat, 0...1."""
    clearcoat_roughness: float = 0.0
    """Perceptual roughness of the clear coat, 0...1."""
    clearcoat_normal_scale: float = 1.0
    """Factor of x and y of the coat's normals."""
    sheen_color: Vec3 = (0.0, 0.0, 0.0)
    """Colour of the sheen of cloth; 0 for no sheen."""
    sheen_roughness: float = 0.0
    """Perceptual roughness of the sheen, 0...1."""
    iridescence: float = 0.0
    """Weight of a thin film that colours the reflection, 0...1."""
    iridescence_ior: float = 1.3
    """The film's index of refraction, 1 or more."""
    iridescence_thickness_minimum: float = 100.0
    """The film's thickness in nanometres where its texture is 0, not negative."""
    iridescence_thickness_maximum: float = 400.0
    """The film's thickness in nanometres where its texture is 1, and everywhere without a texture."""
    anisotropy: float = 0.0
    """Strength with which highlights are stretched, 0...1, on meshes with texture coordinates."""
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
    """The colour that pictures show."""
    color_texture: TextureSlot | None = None
    """Texture whose values multiply `color`."""
    catches_shadows: bool = False
    """True if the surface shows only the shadows on it. `color` is then the irradiance without shadows, divided by
    pi."""


@dataclass(frozen=True)
class Camera:
    """A pose and a projection (promin/camera.h). The default camera stands at the origin and looks along -Z."""

    eye: Vec3 = (0.0, 0.0, 0.0)
    """Position of the camera in the world."""
    look: Vec3 = (0.0, 0.0, -1.0)
    """Unit vector in the direction of view."""
    up: Vec3 = (0.0, 1.0, 0.0)
    """Unit vector towards the top of the picture, at a right angle to `look`."""
    yfov: float = 0.7
    """Vertical field of view of a perspective camera, in (0, pi)."""
    projection: str = "perspective"
    """The projection: "perspective" or "orthographic"."""
    ymag: float = 1.0
    """Half the height of an orthographic camera's view, in world units."""
    near: float = 0.0
    """Distance of the near plane in world units. Nothing nearer than this plane is drawn."""
    aperture_radius: float = 0.0
    """Radius of the lens in world units; 0 for a camera without a lens, which shows everything sharp."""
    focus_distance: float = 0.0
    """Distance of the plane in focus from the eye, along `look`, in world units. It is positive if there is a lens."""
    aspect_ratio: float = 0.0
    """Ratio of width to height that the scene's file requests; 0 if the file requests no ratio."""
    resolution: tuple[int, int] = (0, 0)
    """The size in pixels that the scene's file requests; 0 if the file requests no size."""
    name: str = ""
    """The display name."""

    @staticmethod
    def look_at(
        eye: Iterable[float], target: Iterable[float], up: Iterable[float] = (0.0, 1.0, 0.0), **other: Any
    ) -> Camera:
        """Returns a camera at `eye` that has `target` in the middle of its picture and `up` pointing upwards. `other`
        sets further fields. If `up` is parallel to the direction of view, the camera uses another up direction."""
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
    """The azimuth from which the viewer looks at the scene, in radians about +Y from +Z towards +X."""


@dataclass(frozen=True)
class GradientSky:
    """A gradient of colours over the elevation angle (promin/environment.h)."""

    top: Vec3 = (0.3, 0.5, 1.0)
    horizon: Vec3 = (0.8, 0.8, 0.9)
    bottom: Vec3 = (0.2, 0.2, 0.2)
    top_curve: float = 0.15
    bottom_curve: float = 0.02


@dataclass(frozen=True)
class Panorama:
    """An equirectangular picture of all directions; the middle of the picture is -Z. `promin.read_image` reads such
    pictures."""

    image: NDArray[np.float32] = field(repr=False, compare=False)
    """The picture in linear RGB, (rows, columns, 3) float32."""


@dataclass(frozen=True)
class Backdrop:
    """The background that the camera sees: a gradient from the picture's upper edge to its lower edge, linear RGB.
    Exposure and tone mapping do not change it."""

    top: Vec3 = (1.0, 1.0, 1.0)
    bottom: Vec3 = (1.0, 1.0, 1.0)
    radiance: float = 1.0
    """Factor from the backdrop's colours to radiance in mirrors and behind glass."""


@dataclass(frozen=True)
class Environment:
    """The surroundings of the scene: everything except objects and lights (promin/environment.h)."""

    ambient: Vec3 = (0.0, 0.0, 0.0)
    """Radiance of the ambient light from all directions; used if there is no sky."""
    background: Vec3 = (0.0, 0.0, 0.0)
    """Radiance that rays return if they leave the scene."""
    sky: Union[Studio, GradientSky, Panorama, None] = None
    """The sky, which replaces ambient light."""
    shows_sky: bool = False
    """True if the camera sees the sky in place of the background."""
    up: Vec3 = (0.0, 1.0, 0.0)
    """The direction of the world that the sky's +Y has, a unit vector. The studio's light and a ground take it too."""
    rotation: float = 0.0
    """Rotation of the sky about `up`, in radians."""
    intensity: float = 1.0
    """Factor by which the sky's radiance is multiplied."""
    backdrop: Union[Backdrop, None] = None
    """The backdrop, which replaces the background in pictures without alpha."""


@dataclass(frozen=True)
class Display:
    """The conversion of linear light to 8 bits for display (promin/display.h)."""

    exposure_ev: float = 0.0
    """Exposure in stops."""
    tone_mapping: str = "none"
    """The tone mapping: "none", "neutral", "aces", "reinhard" or "agx"."""
    dithers: bool = False
    """True if 8-bit values get noise before they are rounded."""


def change(record: Record, fields: Mapping[str, Any]) -> Record:
    """Returns the record with other values for some fields. Raises UsageError for a field that the record does not
    have."""
    assert dataclasses.is_dataclass(record)
    known = [f.name for f in dataclasses.fields(record)]
    for name in fields:
        if name not in known:
            raise UsageError(f"a {type(record).__name__} has no field {name!r}; {suggest(name, known)}")
    return dataclasses.replace(record, **fields)  # type: ignore[type-var]


def suggest(name: str, known: list[str]) -> str:
    """Returns a suggestion for an unknown name."""
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
    """Returns a record from a dict of the native module. For a Material it returns the class of the material's
    model."""
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
