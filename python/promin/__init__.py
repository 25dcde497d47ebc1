# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""promin: a Whitted ray tracer in Vulkan compute shaders, for NumPy.

    import promin

    scene = promin.Scene.load("scene.gltf")
    hits = promin.Caster(scene).cast((origins, directions))
    promin.Renderer(scene).render(size=(640, 360)).save("picture.png")

Importing it needs no Vulkan driver. docs/python.md tells the rest."""

from promin._arrays import HIT_DTYPE, RaysLike, positions
from promin._caster import Caster, Progress
from promin._device import Device, DeviceInfo, DeviceLike
from promin._errors import Cancelled, DeviceError, DifferenceError, Error, InputError, RunError, UsageError
from promin._frame import Frame, cryptomatte_id, read_image, write_image
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
from promin._renderer import Renderer
from promin._scene import ObjectInfo, Scene
from promin._view import CameraLike, View

__all__ = [
    "HIT_DTYPE",
    "Backdrop",
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
    "InputError",
    "Light",
    "Material",
    "MetallicRoughness",
    "ObjectInfo",
    "Panorama",
    "Phong",
    "Progress",
    "RaysLike",
    "Renderer",
    "RunError",
    "Scene",
    "Studio",
    "TextureSlot",
    "Unlit",
    "UsageError",
    "View",
    "__version__",
    "cryptomatte_id",
    "positions",
    "read_image",
    "write_image",
]
