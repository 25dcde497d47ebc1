# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Arrays in the layout that the device uses. Rays are rounded to float32 once; hits have the layout of HITS.npy."""

from __future__ import annotations

import math
import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any, TypeAlias, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from promin._errors import UsageError

Float32s: TypeAlias = NDArray[np.float32]
Float64s: TypeAlias = NDArray[np.float64]

HIT_DTYPE = np.dtype(
    [("t", "<f4"), ("object", "<i4"), ("primitive", "<i4"), ("u", "<f4"), ("v", "<f4"), ("normal", "<f4", (3,))]
)
"""The type of a hit, as `promin cast` writes it: see `Caster.cast`."""



class Hits(np.ndarray[Any, np.dtype[Any]]):
    """An array of HIT_DTYPE whose repr is one line. Its fields are plain arrays."""

    def __getitem__(self, key: Any) -> Any:
        part = super().__getitem__(key)
        return part.view(np.ndarray) if isinstance(part, Hits) and part.dtype != HIT_DTYPE else part

    def __repr__(self) -> str:
        if self.dtype != HIT_DTYPE:
            return repr(self.view(np.ndarray))
        t = self["t"][self["object"] >= 0]
        near = f", t from {t.min():.6g} to {t.max():.6g}" if t.size else ""
        return f"<promin.Hits {self.shape}: {t.size} of {self.size} rays hit{near}>"

    __str__ = __repr__


RaysLike: TypeAlias = Union[ArrayLike, "tuple[ArrayLike, ...]"]
"""Rays in one of three forms: an array (..., 8) of origin xyz, tmin, direction xyz, tmax; a tuple (origins (..., 3),
directions (..., 3)); or a tuple (origins, directions, tmin, tmax). The leading shapes of a tuple's arrays are
broadcast. By default tmin is 0 and tmax infinite."""


_RAYS_A_PART = 2**15
"""Number of rays that a thread packs at a time. The rays and their sources fit into the core's cache."""


def to_numbers(value: object, what: str) -> NDArray[Any]:
    """Returns an array of real numbers. float32 and float64 keep their type; all others become float64."""
    try:
        array = np.asarray(value)
        if array.dtype.kind in "biuf":
            return array if array.dtype in (np.float32, np.float64) else array.astype(np.float64)
    except (TypeError, ValueError, OverflowError) as error:
        raise UsageError(f"{what} are not an array of numbers ({error})") from None
    raise UsageError(f"{what} have the type {array.dtype}, not real numbers")


def to_vectors(value: object, what: str, width: int = 3) -> NDArray[Any]:
    """Returns an array of real numbers. Raises UsageError if its last axis does not have this width."""
    array = to_numbers(value, what)
    if array.ndim == 0 or array.shape[-1] != width:
        raise UsageError(f"{what} have the shape {array.shape}; give (..., {width})")
    return array


def round_once(array: NDArray[Any]) -> Float32s:
    """Returns the numbers rounded to float32, without a warning. Numbers beyond the range of float32 become
    infinite."""
    with np.errstate(over="ignore", invalid="ignore"):
        return np.ascontiguousarray(array, dtype=np.float32)


def join_rays(
    rays: RaysLike, directions: ArrayLike | None, tmin: ArrayLike | None, tmax: ArrayLike | None
) -> object:
    """Returns rays in one of the forms of RaysLike. The arguments may hold the parts of rays separately. Raises
    UsageError."""
    if directions is None and tmin is None and tmax is None:
        return rays
    if directions is None and isinstance(rays, tuple) and len(rays) == 2:
        rays, directions = rays
    if directions is None:
        raise UsageError("tmin and tmax need origins and directions; give (origins, directions, tmin=..., tmax=...)")
    if isinstance(rays, tuple) and len(rays) != 3:
        raise UsageError(
            "rays is a tuple, but directions are given too; "
            "give only the tuple, or origins (..., 3) and directions (..., 3)"
        )
    return rays, directions, 0.0 if tmin is None else tmin, np.inf if tmax is None else tmax


def split_rays(rays: object) -> tuple[NDArray[Any], NDArray[Any], NDArray[Any], NDArray[Any]]:
    """Returns origins, tmin, directions and tmax of rays in any form. Their leading shapes may differ."""
    if isinstance(rays, tuple) and 2 <= len(rays) <= 4 and not np.isscalar(rays[0]):
        origins = to_vectors(rays[0], "origins")
        directions = to_vectors(rays[1], "directions")
        tmin = to_numbers(rays[2] if len(rays) > 2 else 0.0, "tmin")
        tmax = to_numbers(rays[3] if len(rays) > 3 else np.inf, "tmax")
        return origins, tmin, directions, tmax
    array = to_whole_rays(rays)
    return array[..., 0:3], array[..., 3], array[..., 4:7], array[..., 7]


def to_whole_rays(rays: object) -> NDArray[Any]:
    """Returns rays as one array (..., 8). Raises UsageError."""
    array = to_numbers(rays, "rays")
    if array.ndim == 0 or array.shape[-1] != 8:
        points = "these are points without directions; " if array.ndim and array.shape[-1] == 3 else ""
        raise UsageError(
            f"rays have the shape {array.shape}; {points}give origins and directions, as cast(origins, directions), or "
            "(..., 8) of origin, tmin, direction, tmax"
        )
    return array


def pack_rays(rays: object, center: Float64s) -> tuple[Float32s, tuple[int, ...]]:
    """Returns rays as (n, 8) float32 in C order, and their leading shape. The function subtracts the center from the
    origins in float64 before it rounds them. An array that needs no change is not copied."""
    is_moved = bool(center.any())
    if isinstance(rays, np.ndarray) and rays.dtype == np.float32 and not is_moved:
        array = to_whole_rays(rays)
        return np.ascontiguousarray(array).reshape(-1, 8), array.shape[:-1]
    origins, tmin, directions, tmax = split_rays(rays)
    try:
        shape = np.broadcast_shapes(origins.shape[:-1], directions.shape[:-1], tmin.shape, tmax.shape)
    except ValueError:
        raise UsageError(
            f"origins {origins.shape}, directions {directions.shape}, tmin {tmin.shape} and tmax {tmax.shape} "
            "have different shapes; their leading shapes must broadcast"
        ) from None
    packed = np.empty((*shape, 8), np.float32)
    origins, directions = np.broadcast_to(origins, (*shape, 3)), np.broadcast_to(directions, (*shape, 3))
    tmin, tmax = np.broadcast_to(tmin, shape), np.broadcast_to(tmax, shape)

    def fill(part: tuple[slice, ...]) -> None:
        into, begins, along = packed[part], origins[part], directions[part]
        with np.errstate(over="ignore", invalid="ignore"):
            for i in range(3):
                begin = begins[..., i]
                into[..., i] = np.subtract(begin, center[i], dtype=np.float64) if is_moved else begin
                into[..., 4 + i] = along[..., i]
            into[..., 3] = tmin[part]
            into[..., 7] = tmax[part]

    _for_each_part(shape, fill)
    return packed.reshape(-1, 8), shape


def _for_each_part(shape: tuple[int, ...], task: Callable[[tuple[slice, ...]], None]) -> None:
    """Divides an array along its longest axis and calls task(part) for each part. Parts of a large array run on
    threads, one per core, because NumPy releases Python's lock while it copies."""
    count = math.prod(shape)
    if count <= _RAYS_A_PART:
        task(())
        return
    axis = shape.index(max(shape))
    length = max(1, _RAYS_A_PART * shape[axis] // count)
    parts = [axis * (slice(None),) + (slice(at, at + length),) for at in range(0, shape[axis], length)]
    with ThreadPoolExecutor(os.cpu_count()) as threads:
        # Raises the exception of a part in this thread.
        for _ in threads.map(task, parts):
            pass


def positions(rays: RaysLike, hits: NDArray[Any]) -> Float64s:
    """Returns the hit points (..., 3) in float64: origin + t * direction, with the rays as the caller gave them.

    rays: the argument of `Caster.cast`. hits: its result, of shape (...). A point is NaN on a miss. The hit's t is a
    float32, so the error of a point is up to 2^-24 of the distance along the ray plus the bound on hits
    (docs/accuracy.md). `promin.compat.trimesh` and `Scene.positions` return points on the plane of the triangle. Raises
    UsageError if the shapes do not match."""
    origins, _, directions, _ = split_rays(rays)
    hits = check_hits(hits)
    t = np.where(hits["object"] >= 0, hits["t"].astype(np.float64), np.nan)
    try:
        return np.asarray(origins + t[..., None] * directions, np.float64)
    except ValueError:
        raise UsageError(f"hits of the shape {hits.shape} do not match the rays") from None


def check_hits(hits: object) -> NDArray[Any]:
    """Returns the hits if they are an array of HIT_DTYPE."""
    if not isinstance(hits, np.ndarray) or hits.dtype != HIT_DTYPE:
        raise UsageError("hits are not an array of promin.HIT_DTYPE; give the array that Caster.cast returned")
    return hits
