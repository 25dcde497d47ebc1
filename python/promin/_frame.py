# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Pictures."""

from __future__ import annotations

import os
import re
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from promin import _promin
from promin._arrays import round_once, to_numbers
from promin._errors import UsageError
from promin._records import Display, to_dict

_MATTES = {"cryptomatte_object": "CryptoObject", "cryptomatte_material": "CryptoMaterial"}
"""Names of the Cryptomatte arrays, and of their layers in an EXR."""


@dataclass(frozen=True)
class Frame:
    """A picture with its AOVs and metadata."""

    rgb: NDArray[np.float32] = field(repr=False)
    """The picture in linear light, (rows, columns, 3); row 0 is the top."""
    aovs: Mapping[str, NDArray[Any]] = field(repr=False)
    """The AOVs as arrays (rows, columns) or (rows, columns, components). The keys are the names of
    include/promin/aovs.h. The AOV "cryptomatte" is two arrays, "cryptomatte_object" and "cryptomatte_material", (rows,
    columns, 6, 2) float32. They hold six ranks, sorted by descending share. A rank has the id (see `cryptomatte_id`)
    and its share of the pixel, as in an EXR; both are 0 in unused ranks."""
    metadata: Mapping[str, str]
    """The metadata for the header of an EXR: scene, device, size and options."""
    display: Display = Display()
    """The transform to 8 bits for display; the same as `promin render` uses."""
    error: Mapping[str, float] | None = None
    """The accuracy of a picture with an error target: `target`, `largest_claim`, `unmet_pixels` and `samples` of the
    whole picture. None without an error target."""
    rays: Mapping[str, int] = field(default_factory=dict)
    """Numbers of rays that were traced, by kind of ray."""
    trace_ms: float = 0.0
    """Time of the dispatches on the device, in milliseconds."""
    placement: tuple[tuple[int, int], tuple[int, int]] | None = None
    """The position of a crop: its upper left pixel in the whole picture, and the size of the whole picture. None
    without a crop."""
    unlit: NDArray[np.float32] | None = field(default=None, repr=False)
    """The colours of the picture that `display` does not change, (rows, columns, 4): the AOV "unlit" of
    include/promin/aovs.h. None unless the scene has both unlit and lit materials."""

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the picture in pixels."""
        return self.rgb.shape[1], self.rgb.shape[0]

    def save(
        self,
        path: str | os.PathLike[str],
        display: Display | None = None,
        *,
        half: bool = False,
        compression: str = "zip",
    ) -> None:
        """Writes the picture: an .exr with all AOVs or a .hdr in linear light, or a .png, .jpg, .webp or .tif after the
        transform `display`. display: the transform; None: the picture's own. The file is written completely or not at
        all. These options apply to an .exr. half: store colours, normals and coverage as 16-bit floats. compression:
        "none", "rle", "zips", "zip" or "piz", always lossless. Raises UsageError for another extension, RunError if the
        file cannot be written."""
        file = os.fsdecode(path)
        if _promin.has_named_channels(file):
            channels = list_channels(self.aovs)
        else:
            showing = {"alpha": self.aovs.get("alpha"), "unlit": self.unlit}
            channels = list_channels({name: values for name, values in showing.items() if values is not None})
        exr = {"is_half": bool(half), "compression": compression}
        shown = to_dict(display or self.display)
        _promin.write_image(file, self.rgb, list(self.metadata.items()), self.placement, channels, shown, exr)

    def matte(self, name: str, of: str = "object") -> NDArray[np.float32]:
        """Returns the fraction of each pixel that objects of this name cover, as (rows, columns) float32, 0...1. With
        of="material" it returns the fraction that materials of this name cover. The picture needs the AOV
        "cryptomatte". The name of an object without a name is made of its number: "object 3". For an unknown name all
        fractions are 0."""
        layer = self.aovs.get(f"cryptomatte_{of}")
        if layer is None:
            raise UsageError(
                f'there are no mattes of {of!r:.80}; render with aovs=("cryptomatte",) and use '
                'of="object" or of="material"'
            )
        ids, shares = layer[..., 0], layer[..., 1]
        return np.asarray(np.where(ids == cryptomatte_id(name), shares, 0).sum(axis=-1), np.float32)

    def srgb(self, display: Display | None = None) -> NDArray[np.uint8]:
        """Returns the picture as a screen displays it, in 8-bit sRGB (rows, columns, 3), without noise."""
        shown = _promin.show(self.rgb, to_dict(display or self.display), self.unlit)
        return np.asarray(np.floor(shown * 255.0 + 0.5), np.uint8)

    def __repr__(self) -> str:
        words = [f"{self.size[0]}x{self.size[1]}"]
        words += [f"aovs {', '.join(self.aovs)}"] if self.aovs else []
        words += [f"{self.trace_ms / 1e3:.2f} s of tracing"] if self.trace_ms else []
        return f"<promin.Frame {', '.join(words)}>"

    def _repr_png_(self) -> bytes:
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "frame.png"
            self.save(file)
            return file.read_bytes()


def cryptomatte_id(name: str) -> np.float32:
    """Returns the Cryptomatte id of objects or materials with this name."""
    return np.float32(_promin.cryptomatte_id(str(name)))


def to_mattes(channels: list[tuple[str, NDArray[Any]]]) -> dict[str, NDArray[np.float32]]:
    """Returns the Cryptomatte arrays of Frame.aovs; empty if there are none. The argument holds an EXR's channels in
    order, as float32 or as the bits of float32."""
    mattes = {}
    for name, layer in _MATTES.items():
        planes = [values for channel, values in channels if channel.startswith(layer)]
        if planes:
            stack = np.stack(planes, axis=-1).view(np.float32)
            mattes[name] = stack.reshape(*stack.shape[:2], -1, 2)
    return mattes


def list_channels(aovs: Mapping[str, NDArray[Any]]) -> list[tuple[str, bool, NDArray[np.uint32]]]:
    """Returns the channels of an EXR in the order of the table. A channel is its name, whether its values are integers,
    and the bits of the values."""
    channels = []
    for name, channel, letters in _promin.list_aovs():
        if name not in aovs:
            continue
        values = np.asarray(aovs[name])
        is_integer = values.dtype == np.uint32
        if values.dtype.kind == "f":
            values = round_once(values)
        planes = [values] if values.ndim == 2 else [values[..., i] for i in range(values.shape[2])]
        names = [channel] if values.ndim == 2 else [f"{channel}.{letter}" for letter in letters]
        channels += [(n, is_integer, np.ascontiguousarray(p).view(np.uint32)) for n, p in zip(names, planes)]
    for name, layer in _MATTES.items():
        if name in aovs:
            values = round_once(aovs[name]).view(np.uint32)
            planes = [values[..., rank, i] for rank in range(values.shape[2]) for i in (0, 1)]
            names = [f"{layer}{i // 4:02}.{'RGBA'[i % 4]}" for i in range(len(planes))]
            channels += [(n, False, np.ascontiguousarray(p)) for n, p in zip(names, planes)]
    return channels


def read_image(path: str | os.PathLike[str]) -> NDArray[np.float32]:
    """Reads R, G and B of a picture file of any format that OpenImageIO supports. Returns (rows, columns, 3) float32
    without conversion: linear light from EXR and Radiance files, sRGB values in 0...1 from others. Colours of EXR and
    WebP files are multiplied by alpha (`read_aovs` reads alpha); colours of other files are not. Raises InputError,
    RunError."""
    return _promin.read_image(os.fsdecode(path))


def read_aovs(path: str | os.PathLike[str]) -> dict[str, NDArray[Any]]:
    """Reads all channels of a picture file except R, G and B. Returns arrays with the names of Frame.aovs: "alpha" from
    any format, and all AOVs from an .exr that promin has written. Channels from other programs keep their names in the
    file and are (rows, columns) float32 or uint32. Raises InputError, RunError."""
    channels = {
        name: values if is_integer else values.view(np.float32)
        for name, is_integer, values in _promin.read_channels(os.fsdecode(path))
    }
    aovs: dict[str, NDArray[Any]] = {}
    for name, channel, letters in _promin.list_aovs():
        if not letters and channel in channels:
            aovs[name] = channels.pop(channel)
        elif letters and all(f"{channel}.{letter}" in channels for letter in letters):
            aovs[name] = np.stack([channels.pop(f"{channel}.{letter}") for letter in letters], axis=-1)
    planes = [channel for channel in channels if re.fullmatch(rf"({'|'.join(_MATTES.values())})\d\d\.[RGBA]", channel)]
    # The order R, G, B, A is not alphabetical.
    planes.sort(key=lambda channel: (channel[:-1], "RGBA".index(channel[-1])))
    aovs.update(to_mattes([(channel, channels.pop(channel)) for channel in planes]))
    return {**aovs, **{name: values for name, values in channels.items() if name not in ("R", "G", "B")}}


def write_image(path: str | os.PathLike[str], rgb: Frame | ArrayLike, display: Display = Display()) -> None:
    """Writes linear light (rows, columns, 3), or grey (rows, columns), as .exr or .hdr, or after the transform `display` as .png, .jpg, .webp or
    .tif. Raises UsageError, RunError."""
    file = os.fsdecode(path)
    unlit = None if _promin.has_named_channels(file) else unlit_of(rgb)
    channels = [] if unlit is None else list_channels({"unlit": unlit})
    _promin.write_image(file, to_picture(rgb), [], None, channels, to_dict(display), None)


def unlit_of(picture: object) -> NDArray[np.float32] | None:
    """Returns the colours of a Frame that its display does not change; None for an array."""
    return picture.unlit if isinstance(picture, Frame) else None


def to_picture(rgb: object) -> NDArray[np.float32]:
    """Returns the pixels of a picture for the native module. The argument is an array or a Frame."""
    if isinstance(rgb, Frame):
        return rgb.rgb
    array = to_numbers(rgb, "the pixels")
    if array.ndim == 2:
        array = np.repeat(array[..., None], 3, axis=-1)
    if array.ndim != 3 or array.shape[2] != 3 or not 0 < array.size < 3 * 2**28:
        raise UsageError(
            f"the pixels have the shape {array.shape}; give (rows, columns, 3) or (rows, columns), with 1 to 2^28 pixels"
        )
    return round_once(array)
