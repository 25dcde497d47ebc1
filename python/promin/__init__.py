# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""promin renders 3D scenes and casts rays at them, with NumPy arrays, on any Vulkan device.

    import promin

    promin.render("scene.gltf", size=640).save("picture.png")
    hits = promin.Caster("scene.gltf").cast(origins, directions)

Importing the package needs no Vulkan driver. docs/python.md describes all of it."""

from promin._arrays import HIT_DTYPE, Hits, RaysLike, positions
from promin._caster import Caster, Progress
from promin._device import Device, DeviceInfo, DeviceLike
from promin._errors import Cancelled, DeviceError, DifferenceError, Error, InputError, Problem, RunError, UsageError
from promin._frame import Frame, cryptomatte_id, read_aovs, read_image, write_image
from promin._promin import __version__
from promin._records import (
    Backdrop,
    Camera,
    Display,
    Environment,
    GradientSky,
    Light,
    Material,
    MetallicRoughness,
    Panorama,
    Phong,
    Studio,
    TextureSlot,
    Unlit,
)
from promin._renderer import Background, Renderer, render
from promin._scene import AnimationInfo, ObjectInfo, Scene, SceneLike
from promin._view import CameraLike, Size, View

__all__ = [
    "HIT_DTYPE",
    "AnimationInfo",
    "Backdrop",
    "Background",
    "Camera",
    "CameraLike",
    "Cancelled",
    "Caster",
    "Device",
    "DeviceError",
    "DeviceInfo",
    "DeviceLike",
    "DifferenceError",
    "Display",
    "Environment",
    "Error",
    "Frame",
    "GradientSky",
    "Hits",
    "InputError",
    "Light",
    "Material",
    "MetallicRoughness",
    "ObjectInfo",
    "Panorama",
    "Phong",
    "Problem",
    "Progress",
    "RaysLike",
    "Renderer",
    "RunError",
    "Scene",
    "SceneLike",
    "Size",
    "Studio",
    "TextureSlot",
    "Unlit",
    "UsageError",
    "View",
    "__version__",
    "cryptomatte_id",
    "positions",
    "read_aovs",
    "read_image",
    "render",
    "write_image",
]
