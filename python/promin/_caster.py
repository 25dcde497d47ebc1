# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Casting rays at a scene."""

from __future__ import annotations

import os
import threading
import warnings
from collections.abc import Callable, Iterator
from typing import Any, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from promin import _promin
from promin._arrays import HIT_DTYPE, Hits, RaysLike, join_rays, pack_rays, to_vectors
from promin._device import Device, DeviceLike, find_device
from promin._errors import UsageError
from promin._scene import Scene, SceneLike, to_scene

PROBE = np.array((0.4375, 0.625, 0.65625), np.float32)
"""The direction of rays that find what is inside: no component is small or a simple ratio of another."""
_RAYS_AT_A_TIME = 2**20
"""The number of rays that the library requests at a time."""

Progress = Union[Callable[[float], object], None]
"""Receives the fraction that is done about twenty times a second, on the caller's thread. If it returns False, the call
raises `promin.Cancelled`; if it raises an exception, the call raises that."""


class Caster:
    """Casts rays at a scene on a device.

    The constructor builds a bounding volume hierarchy. The scene may change afterwards; the Caster keeps its own
    snapshot. Any thread may use a Caster, one at a time. It releases Python's lock, so other threads run meanwhile.
    Ctrl-C ends a call before its next dispatch and leaves the Caster usable. A pickled Caster holds the scene, the
    options and the choice of the device, and opens them at its first use. After a fork, every use in the child raises
    RuntimeError."""

    _opened: tuple[Device, _promin.Caster, NDArray[np.float64]] | None

    def __init__(
        self,
        scene: SceneLike,
        device: DeviceLike = None,
        *,
        bvh: str | os.PathLike[str] | None = None,
        builder: str = "sah",
        progress: Progress = None,
    ) -> None:
        """device: a Device, a part of a name, an index, or None for the default one. bvh: a file of `promin-bvh build`
        to read the tree from. builder: "sah", "median" or "spatial"; hits are the same. Raises UsageError, InputError
        for an invalid scene, DeviceError, RunError, Cancelled."""
        self._scene = to_scene(scene).snapshot()
        self._options = (str(builder), None if bvh is None else os.fsdecode(bvh))
        self._chosen = device
        self._make_private()
        self._open(progress)

    @property
    def scene(self) -> Scene:
        """The scene as it was when the Caster was made. Changing it has no effect."""
        return self._scene

    @property
    def device(self) -> Device:
        """The device that it runs on."""
        return self._open()[0]

    @property
    def setup(self) -> dict[str, Any]:
        """The cost of construction, with the names of include/promin/setup_stats.h: milliseconds, bytes, nodes,
        warnings."""
        return self._open()[1].setup()

    def cast(
        self,
        rays: RaysLike,
        directions: ArrayLike | None = None,
        tmin: ArrayLike | None = None,
        tmax: ArrayLike | None = None,
        *,
        out: NDArray[Any] | None = None,
        progress: Progress = None,
    ) -> NDArray[Any]:
        """Returns the nearest hit of each ray.

        rays, directions, tmin, tmax: origins (..., 3), directions (..., 3) and optionally tmin and tmax (...), 0 and
        infinity by default, broadcast together; or one array (..., 8) of origin xyz, tmin, direction xyz, tmax; or a
        tuple (origins, directions) or (origins, directions, tmin, tmax). Arrays may have any strides and real types.
        Numbers are rounded to float32 once; C-contiguous float32 of shape (..., 8) is not copied. Directions have any
        length except 0, t is in units of the direction as given, and a hit has tmin < t < tmax. A ray with a NaN misses
        everything. out: an array to fill and return, C-contiguous and of the result's shape and type; reusing memory is
        faster than allocating it.

        Returns an array (...) of `promin.HIT_DTYPE`, which `promin cast` writes too: t (infinite on a miss), object and
        primitive (-1 on a miss), u and v (weights of a triangle's second and third corner), normal (geometric, unit, as
        wound or outward, never flipped to the ray; 0 on a miss). At equal t the lower (object, primitive) wins; a
        triangle's edges belong to it. Raises UsageError, RunError, Cancelled."""
        _, native, center = self._open()
        packed, shape = pack_rays(join_rays(rays, directions, tmin, tmax), center)
        hits = prepare_answers(out, shape, HIT_DTYPE, packed)
        native.cast(packed, as_bytes(hits), progress)
        return hits if out is not None else hits.view(Hits)

    def occluded(
        self,
        rays: RaysLike,
        directions: ArrayLike | None = None,
        tmin: ArrayLike | None = None,
        tmax: ArrayLike | None = None,
        *,
        out: NDArray[np.bool_] | None = None,
        progress: Progress = None,
    ) -> NDArray[np.bool_]:
        """Returns for each ray whether it hits anything, as bool (...); this is faster than `cast`. rays to tmax and
        out: as for `cast`."""
        _, native, center = self._open()
        packed, shape = pack_rays(join_rays(rays, directions, tmin, tmax), center)
        answers = prepare_answers(out, shape, np.dtype(np.bool_), packed)
        native.occluded(packed, answers.reshape(-1), progress)
        return answers

    def count(
        self,
        rays: RaysLike,
        directions: ArrayLike | None = None,
        tmin: ArrayLike | None = None,
        tmax: ArrayLike | None = None,
        *,
        out: NDArray[np.int32] | None = None,
        progress: Progress = None,
    ) -> NDArray[np.int32]:
        """Returns the number of surfaces that each ray crosses, as int32 (...). rays to tmax and out: as for `cast`.

        A ray that hits an edge or a corner of a closed mesh crosses exactly one of the triangles there, and a ray along
        a silhouette crosses none or two. The count is therefore odd exactly if the ray starts inside
        (include/promin/caster.h has the rule). For `cast` an edge belongs to each of its triangles. Raises UsageError,
        RunError, Cancelled."""
        _, native, center = self._open()
        packed, shape = pack_rays(join_rays(rays, directions, tmin, tmax), center)
        counts = prepare_answers(out, shape, np.dtype(np.int32), packed)
        native.count(packed, counts.reshape(-1), progress)
        return counts

    def inside(self, points: ArrayLike) -> NDArray[np.bool_]:
        """Returns for each of the points (..., 3) whether it is inside a closed surface, as bool (...). The surface is
        the scene as a whole.

        A point is inside if a ray from it crosses the surface an odd number of times. Edges and corners count once, as
        for `count`. The opposite ray must agree. If it does not, the point is on the surface, or the surface is not
        closed. Such a point counts as outside, and a Python warning reports their number. A point in two overlapping
        solids counts as outside; make a Caster for each solid. Raises UsageError, RunError, Cancelled."""
        places = to_vectors(points, "points")
        is_odd, agrees = (self.count(places, way) % 2 == 1 for way in (PROBE, -PROBE))
        doubtful = int((is_odd != agrees).sum())
        if doubtful:
            verb = "is" if doubtful == 1 else "are"
            warnings.warn(
                f"{doubtful} of {is_odd.size} points {verb} on the surface, or the surface is not closed: the rays in "
                "both directions disagree; such points count as outside",
                stacklevel=2,
            )
        return np.asarray(is_odd & agrees)

    def list(
        self,
        rays: RaysLike,
        directions: ArrayLike | None = None,
        tmin: ArrayLike | None = None,
        tmax: ArrayLike | None = None,
        *,
        progress: Progress = None,
    ) -> tuple[NDArray[np.int64], NDArray[Any]]:
        """Returns all crossings of each ray, by the rule of `count`, as (splits, hits). splits is int64 (n + 1) for the
        n rays in C order; hits is an array of `promin.HIT_DTYPE`. The hits of ray i are hits[splits[i]:splits[i + 1]],
        sorted by t, then by (object, primitive). All of them are kept in memory; see `iter_list`. rays to tmax: as for
        `cast`. Raises as it does."""
        _, native, center = self._open()
        packed, _ = pack_rays(join_rays(rays, directions, tmin, tmax), center)
        splits, rows = native.list(packed, None, progress)
        return splits, _to_hits(rows)

    def iter_list(
        self,
        rays: RaysLike,
        directions: ArrayLike | None = None,
        tmin: ArrayLike | None = None,
        tmax: ArrayLike | None = None,
        *,
        budget: int = 256 << 20,
        progress: Progress = None,
    ) -> Iterator[tuple[int, NDArray[np.int64], NDArray[Any]]]:
        """Does the same as `list` in parts, for more hits than memory can hold. Yields (first, splits, hits), where
        hits[splits[i]:splits[i + 1]] are the hits of ray first + i in C order. Each part has as many rays as have hits
        of `budget` bytes together, but at least one. progress: receives the progress of each part separately."""
        if not isinstance(budget, (int, np.integer)) or not 0 < budget < 2**63:
            raise UsageError(f"budget is {budget!r:.80}; give a positive number of bytes")
        _, native, center = self._open()
        packed, _ = pack_rays(join_rays(rays, directions, tmin, tmax), center)
        return _list_parts(native, packed, int(budget), progress)

    def _open(self, progress: Progress = None) -> tuple[Device, _promin.Caster, NDArray[np.float64]]:
        opened = self._opened
        if opened is not None:
            return opened
        with self._lock:
            if self._opened is None:
                device = find_device(self._chosen)
                scene = self._scene.native()
                native = _promin.Caster(device._native, scene, *self._options, progress)
                self._opened = device, native, self._scene.native_center
            return self._opened

    def _make_private(self) -> None:
        """Creates the members that are not pickled: open objects and their locks."""
        self._lock = threading.RLock()
        self._opened = None

    def __getstate__(self) -> dict[str, Any]:
        return {key: value for key, value in self.__dict__.items() if key not in ("_lock", "_opened")}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._make_private()


def prepare_answers(
    out: NDArray[Any] | None, shape: tuple[int, ...], dtype: np.dtype[Any], rays: NDArray[np.float32]
) -> NDArray[Any]:
    """Returns the array for the results: the caller's, or a new one. Raises UsageError if the caller's does not fit."""
    if out is None:
        return np.empty(shape, dtype)
    if not isinstance(out, np.ndarray) or out.dtype != dtype or out.shape != shape:
        given = f"{out.dtype} {out.shape}" if isinstance(out, np.ndarray) else repr(out)[:80]
        raise UsageError(f"out is {given}; give an array of {dtype} and the shape {shape}")
    if not out.flags.c_contiguous or not out.flags.writeable or np.may_share_memory(out, rays):
        raise UsageError("out is not C-contiguous, cannot be written or shares memory with the rays; give another")
    return out


def as_bytes(hits: NDArray[Any]) -> NDArray[np.uint8]:
    """Returns a view of the same memory as (n, 32) bytes."""
    return hits.reshape(-1).view(np.uint8).reshape(hits.size, HIT_DTYPE.itemsize)


def _to_hits(rows: NDArray[np.uint8]) -> NDArray[Any]:
    """Returns bytes (n, 32) from the library as hits (n,)."""
    hits: NDArray[Any] = rows.view(HIT_DTYPE).reshape(-1).view(Hits)
    return hits


def _list_parts(
    native: _promin.Caster, packed: NDArray[np.float32], budget: int, progress: Progress
) -> Iterator[tuple[int, NDArray[np.int64], NDArray[Any]]]:
    first, count = 0, _RAYS_AT_A_TIME
    while first < len(packed):
        splits, rows = native.list(packed[first : first + count], budget, progress)
        yield first, splits, _to_hits(rows)
        first += len(splits) - 1
        # Rays whose hits exceed the budget are requested again.
        count = min(2 * (len(splits) - 1), _RAYS_AT_A_TIME)
