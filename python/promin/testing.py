# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Functions for picture tests: they compare a picture with a baseline file and use the measures of `promin compare`.

    def test_part():
        frame = promin.Renderer(scene).render(size=(320, 240))
        promin.testing.assert_same_picture(frame, "tests/baselines/part.exr")

If the environment has PROMIN_UPDATE_BASELINES=1, the functions write baselines and compare nothing."""

from __future__ import annotations

import hashlib
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from promin import _promin
from promin._device import Device
from promin._errors import DifferenceError, InputError, UsageError
from promin._frame import Frame, read_image, to_picture, unlit_of, write_image
from promin._records import Display, to_dict

PictureLike = Union[Frame, ArrayLike, "os.PathLike[str]", str]
"""A picture: a Frame, linear light (rows, columns, 3), or a picture file."""

UPDATE_VARIABLE = "PROMIN_UPDATE_BASELINES"

_HEAT = np.array([[0, 0, 4], [81, 18, 124], [183, 55, 121], [252, 137, 97], [252, 253, 191]]) / 255.0


@dataclass(frozen=True)
class Difference:
    """The difference of two pictures (include/promin/compare.h), in the units of their values."""

    pixel_count: int
    mean: float
    """Mean absolute difference over all channels."""
    rmse: float
    psnr_db: float
    """Peak signal-to-noise ratio in decibels; infinite if the pictures are equal."""
    largest: float
    largest_at: tuple[int, int]
    """Column and row of the pixel with the largest difference."""
    different_count: int
    """Number of pixels with a channel that differs by more than `fail`."""
    non_finite_count: int
    flip: float
    """The mean of FLIP, 0...1."""
    flip_map: NDArray[np.float32]
    """FLIP of each pixel, (rows, columns), 0...1."""

    @property
    def percent(self) -> float:
        """Percentage of pixels that differ by more than `fail`."""
        return 100.0 * self.different_count / self.pixel_count


def compare(reference: PictureLike, picture: PictureLike, *, fail: float = 0.0, linear: bool = True) -> Difference:
    """Returns the measures of `promin compare`. fail: a pixel differs if one of its channels differs by more than this.
    linear: whether the values are linear light; otherwise they are sRGB values in 0...1. Only FLIP depends on `linear`.
    Raises InputError if the sizes differ."""
    first, second = _pixels(reference), _pixels(picture)
    return Difference(**_promin.compare(first, second, bool(linear), float(fail)))


def fingerprint(device: Device | None = None) -> str:
    """Returns eight letters that identify the name and driver of a device, to be used in the names of the device's
    baselines. Pictures have the same bits on the same device."""
    return hashlib.sha256((device or Device()).fingerprint.encode()).hexdigest()[:8]


def assert_same_picture(
    picture: Union[Frame, ArrayLike],
    baseline: str | os.PathLike[str],
    *,
    fail: float = 0.0,
    fail_percent: float = 0.0,
    device: Device | None = None,
    update: bool | None = None,
    display: Display = Display(),
) -> None:
    """Raises DifferenceError, an AssertionError, if more than fail_percent percent of the pixels differ from the
    baseline by more than `fail`.

    picture: a Frame or linear light (rows, columns, 3). baseline: an .exr, which stores full precision, or a .png,
    which stores 8 bits after the transform `display` (by default the Frame's own); both pictures are then compared as
    8-bit values in 0...1. device: if given, a file NAME.FINGERPRINT.exr beside the baseline replaces it if it exists,
    and `update` writes that file: one for each driver whose bits differ. update: whether to write the baseline; None:
    write it if PROMIN_UPDATE_BASELINES is set and not "0".

    If the pictures differ, NAME.actual.exr (linear light) and NAME.difference.png (FLIP from black to white) are
    written beside the baseline, or into PROMIN_TEST_OUTPUT. Raises InputError if the baseline is missing."""
    shared = Path(os.fsdecode(baseline))
    if shared.suffix not in (".exr", ".png"):
        raise UsageError(f"a baseline is an .exr or a .png, not {shared}")
    own = shared if device is None else shared.with_name(f"{shared.stem}.{fingerprint(device)}{shared.suffix}")
    shown = picture.display if isinstance(picture, Frame) else display
    linear = pixels = to_picture(picture)
    if update if update is not None else os.environ.get(UPDATE_VARIABLE, "0") not in ("", "0"):
        own.parent.mkdir(parents=True, exist_ok=True)
        write_image(own, picture, shown)
        return
    file = own if own.exists() else shared
    if not file.exists():
        raise InputError(f"there is no baseline, {own}; set {UPDATE_VARIABLE}=1 to write it")
    reference = read_image(file)
    is_linear = _promin.encoding_is_linear(str(file))
    if not is_linear:
        reference = _to_codes(reference)
        pixels = _to_codes(_promin.show(linear, to_dict(shown), unlit_of(picture)))
    found = compare(reference, pixels, fail=fail, linear=is_linear)
    if found.percent <= fail_percent:
        return
    folder = Path(os.environ.get("PROMIN_TEST_OUTPUT", file.parent))
    folder.mkdir(parents=True, exist_ok=True)
    actual, shows = folder / f"{file.stem}.actual.exr", folder / f"{file.stem}.difference.png"
    write_image(actual, linear)
    write_image(shows, heat(found.flip_map))
    differing = "1 pixel differs" if found.different_count == 1 else f"{found.different_count} pixels differ"
    raise DifferenceError(
        f"{differing} by more than {fail:g}, with the largest difference at pixel {found.largest_at[0]} "
        f"{found.largest_at[1]} ({found.largest:.6g}), {actual} compared with {file}; {shows} shows where"
    )


def heat(flip_map: NDArray[np.float32]) -> NDArray[np.float32]:
    """Returns colours for errors 0...1 (rows, columns), as linear light: from black through violet and orange to
    white."""
    places = np.clip(np.nan_to_num(flip_map, nan=1.0), 0.0, 1.0) * (len(_HEAT) - 1)
    codes = np.stack([np.interp(places, np.arange(len(_HEAT)), _HEAT[:, i]) for i in range(3)], axis=-1)
    linear = np.where(codes <= 0.04045, codes / 12.92, ((codes + 0.055) / 1.055) ** 2.4)
    return np.ascontiguousarray(linear, np.float32)


def _to_codes(srgb: NDArray[np.float32]) -> NDArray[np.float32]:
    """Returns values rounded to 8 bits. Two results are equal if the 8-bit values are equal."""
    return np.asarray(np.floor(srgb * 255.0 + 0.5) / 255.0, np.float32)


def _pixels(picture: PictureLike) -> NDArray[np.float32]:
    if isinstance(picture, (str, os.PathLike)):
        return read_image(picture)
    return to_picture(picture)
