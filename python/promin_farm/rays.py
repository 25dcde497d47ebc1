# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Converts the rays of a zarr array to the NumPy file that promin casts. The conversion runs once for each job, chunk
by chunk."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from promin import jobs

from promin_farm.crews import need

_ROWS = 1 << 20


def prepare_rays(spec: Mapping[str, Any], folder: Path) -> dict[str, Any]:
    """Returns the specification of a cast with DIR.rays.npy in place of rays in a zarr array. The file contains the
    same numbers as the array, so the identity of the job depends on the rays and not on their source. Raises UsageError
    and InputError."""
    rays, folder = Path(spec.get("rays", "")), folder.absolute()
    if rays.suffix != ".zarr":
        return dict(spec)
    return {**spec, "rays": str(_copy(rays, folder.with_name(f"{folder.name}.rays.npy")))}


def _copy(source: Path, target: Path) -> Path:
    zarr = need("zarr", "zarr")
    try:
        array = zarr.open_array(str(source), mode="r")
    except Exception as error:
        raise jobs.InputError(
            f"the zarr array cannot be opened ({error}), {source}; give an array of N x 8 float32 numbers"
        ) from error
    if array.ndim != 2 or array.shape[1] != 8 or array.dtype != np.float32:
        raise jobs.InputError(
            f"the array is {array.dtype} {array.shape}, {source}; give an array of N x 8 float32 numbers"
        )
    # Whole chunks are read at a time, because zarr can only unpack a whole chunk.
    step = max(1, _ROWS // array.chunks[0]) * array.chunks[0]
    parts = [slice(begin, begin + step) for begin in range(0, array.shape[0], step)]
    if target.exists():
        try:
            there = np.load(target, mmap_mode="r")
        except (OSError, ValueError, EOFError) as error:
            raise jobs.InputError(f"the copy of the rays is damaged ({error}), {target}; remove it") from error
        if there.shape != array.shape or not all(there[part].tobytes() == array[part].tobytes() for part in parts):
            raise jobs.InputError(f"the rays have changed since the start of the job, {source}; use another folder")
        return target
    temporary = target.with_name(f".{target.name}.{os.getpid()}.tmp")
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        with open(temporary, "wb") as stream:
            np.lib.format.write_array_header_1_0(
                stream, {"descr": "<f4", "fortran_order": False, "shape": tuple(map(int, array.shape))}
            )
            for part in parts:
                stream.write(np.ascontiguousarray(array[part], "<f4").tobytes())
            stream.flush()
            os.fsync(stream.fileno())
        os.replace(temporary, target)
    except OSError as error:
        raise jobs.RunError(f"cannot write ({error.strerror}), {target}; check the disk and permissions") from error
    finally:
        temporary.unlink(missing_ok=True)
    return target
