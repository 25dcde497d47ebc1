# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Rays in, hits out."""

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
"""As many as the library asks for at a time."""

Progress = Union[Callable[[float], object], None]
"""Is told the fraction that is done about twenty times a second, on the caller's thread; where it returns False the
call ends with `promin.Cancelled`, and where it raises with that."""


class Caster:
    """A scene on a device that answers rays.

    Making one builds a bounding volume hierarchy. The scene may change afterwards: the Caster keeps what it was. Any
    threads may use it, one at a time; without Python's lock, so others run meanwhile. Ctrl-C ends a call before its
    next dispatch and leaves the Caster usable. It is pickled as scene, options and choice of device, and opens these at
    its first use. After a fork, use raises RuntimeError in the child."""

    _opened: tuple[Device, _promin.Caster, NDArray[np.float64], NDArray[np.int32]] | None

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
        to take the tree from. builder: "sah", "median" or "spatial"; hits are the same. Raises UsageError, InputError
        for a scene that is not valid, DeviceError, RunError, Cancelled."""
        self._scene = to_scene(scene).snapshot()
        self._options = (str(builder), None if bvh is None else os.fsdecode(bvh))
        self._chosen = device
        self._make_private()
        self._open(progress)

    @property
    def scene(self) -> Scene:
        """The scene as it was when the Caster was made; change another."""
        return self._scene

    @property
    def device(self) -> Device:
        """What it runs on."""
        return self._open()[0]

    @property
    def setup(self) -> dict[str, Any]:
        """What making it has cost, by the names of include/promin/setup_stats.h: milliseconds, bytes, nodes,
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
        """The nearest hit of each ray.

        rays, directions, tmin, tmax: origins (..., 3), directions (..., 3) and, where they are not 0 and infinity, tmin
        and tmax (...), broadcast together; or one array (..., 8) of origin xyz, tmin, direction xyz, tmax; or a tuple
        (origins, directions) or (origins, directions, tmin, tmax). Any strides and real types; all is rounded to
        float32 once, and C-contiguous float32 of the first form is not copied. Directions have any length but 0, t is
        in units of the direction as given, and a hit has tmin < t < tmax. A ray with a NaN misses everything. out: the
        array to fill and return, C-contiguous, of the answer's shape and type; what is there is touched faster than
        new memory.

        Returns an array (...) of `promin.HIT_DTYPE`, what `promin cast` writes: t (infinite on a miss), object and
        primitive (-1 on a miss), u and v (weights of a triangle's second and third corner), normal (geometric, unit, as
        wound or outward, never flipped to the ray; 0 on a miss). At equal t the lower (object, primitive) wins; a
        triangle's edges belong to it. Raises UsageError, RunError, Cancelled."""
        _, native, center, numbers = self._open()
        packed, shape = pack_rays(join_rays(rays, directions, tmin, tmax), center)
        hits = prepare_answers(out, shape, HIT_DTYPE, packed)
        native.cast(packed, as_bytes(hits), progress)
        if len(numbers):
            number_as_in_file(hits.reshape(-1), numbers)
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
        """Whether each ray hits anything, which is answered faster. rays to tmax and out as for `cast`; returns bool (...)."""
        _, native, center, _ = self._open()
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
        """How often each ray crosses the scene: int32 (...). rays to tmax and out as for `cast`.

        A ray that meets an edge or a corner of a closed mesh crosses one of the triangles there, and a ray along a
        silhouette none or two, so the count is odd exactly where the ray begins inside (include/promin/caster.h has the
        rule). `cast` takes edges as the triangle's instead. Raises UsageError, RunError, Cancelled."""
        _, native, center, _ = self._open()
        packed, shape = pack_rays(join_rays(rays, directions, tmin, tmax), center)
        counts = prepare_answers(out, shape, np.dtype(np.int32), packed)
        native.count(packed, counts.reshape(-1), progress)
        return counts

    def inside(self, points: ArrayLike) -> NDArray[np.bool_]:
        """Whether points (..., 3) are inside of a closed surface, the scene as a whole: bool (...).

        A point is inside where a ray from it crosses the surface an odd number of times, by the rule of `count`: edges
        and corners count once. The ray the other way must agree. Where it does not, the point lies on the surface, or
        the surface is not closed: it counts as outside, and a Python warning says of how many points that is so. A
        point in two solids that overlap is outside; give each solid a Caster of its own. Raises UsageError, RunError,
        Cancelled."""
        places = to_vectors(points, "points")
        is_odd, agrees = (self.count(places, way) % 2 == 1 for way in (PROBE, -PROBE))
        doubtful = int((is_odd != agrees).sum())
        if doubtful:
            verb = "is" if doubtful == 1 else "are"
            warnings.warn(
                f"{doubtful} of {is_odd.size} points {verb} on the surface, or the surface is not closed: rays both "
                "ways disagree; such points count as outside",
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
        """All crossings of each ray, by the rule of `count`: splits, int64 (n + 1) for the n rays in C order, and hits
        of `promin.HIT_DTYPE`, where those of ray i are hits[splits[i]:splits[i + 1]], by t, then by (object,
        primitive). Memory is needed for all of them; see `iter_list`. rays to tmax as for `cast`; raises as it does."""
        _, native, center, numbers = self._open()
        packed, _ = pack_rays(join_rays(rays, directions, tmin, tmax), center)
        splits, rows = native.list(packed, None, progress)
        return splits, _to_hits(rows, numbers)

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
        """`list` part by part, for more hits than memory holds: yields (first, splits, hits), where hits[splits[i]:
        splits[i + 1]] are those of ray first + i in C order, of as many rays as have hits of `budget` bytes together,
        or of one. progress is told of each part by itself."""
        if not isinstance(budget, (int, np.integer)) or not 0 < budget < 2**63:
            raise UsageError(f"budget is {budget!r:.80}; give a positive number of bytes")
        _, native, center, numbers = self._open()
        packed, _ = pack_rays(join_rays(rays, directions, tmin, tmax), center)
        return _list_parts(native, packed, int(budget), numbers, progress)

    def _open(self, progress: Progress = None) -> tuple[Device, _promin.Caster, NDArray[np.float64], NDArray[np.int32]]:
        opened = self._opened
        if opened is not None:
            return opened
        with self._lock:
            if self._opened is None:
                device = find_device(self._chosen)
                scene = self._scene.native()
                native = _promin.Caster(device._native, scene, *self._options, progress)
                numbers = np.array(scene.object_numbers(), np.int32)
                self._opened = device, native, self._scene.native_center, numbers
            return self._opened

    def _make_private(self) -> None:
        """What is not pickled: what is open, and what guards it."""
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
    """The array that answers go to: the caller's, or a new one. Raises UsageError where the caller's does not suit."""
    if out is None:
        return np.empty(shape, dtype)
    if not isinstance(out, np.ndarray) or out.dtype != dtype or out.shape != shape:
        given = f"{out.dtype} {out.shape}" if isinstance(out, np.ndarray) else repr(out)[:80]
        raise UsageError(f"out is {given}; give an array of {dtype} and the shape {shape}")
    if not out.flags.c_contiguous or not out.flags.writeable or np.may_share_memory(out, rays):
        raise UsageError("out is not C-contiguous, cannot be written or shares memory with the rays; give another")
    return out


def as_bytes(hits: NDArray[Any]) -> NDArray[np.uint8]:
    """The same memory as (n, 32) bytes."""
    return hits.reshape(-1).view(np.uint8).reshape(hits.size, HIT_DTYPE.itemsize)


def number_as_in_file(hits: NDArray[Any], numbers: NDArray[np.int32]) -> None:
    """Gives hits (n,) the numbers that the scene's file has for its objects."""
    is_hit = hits["object"] >= 0
    hits["object"][is_hit] = numbers[hits["object"][is_hit]]


def _to_hits(rows: NDArray[np.uint8], numbers: NDArray[np.int32]) -> NDArray[Any]:
    """Bytes (n, 32) of the library as hits (n,)."""
    hits: NDArray[Any] = rows.view(HIT_DTYPE).reshape(-1).view(Hits)
    if len(numbers):
        number_as_in_file(hits, numbers)
    return hits


def _list_parts(
    native: _promin.Caster, packed: NDArray[np.float32], budget: int, numbers: NDArray[np.int32], progress: Progress
) -> Iterator[tuple[int, NDArray[np.int64], NDArray[Any]]]:
    first, count = 0, _RAYS_AT_A_TIME
    while first < len(packed):
        splits, rows = native.list(packed[first : first + count], budget, progress)
        yield first, splits, _to_hits(rows, numbers)
        first += len(splits) - 1
        # What is asked of more rays than there is a budget for is asked again.
        count = min(2 * (len(splits) - 1), _RAYS_AT_A_TIME)
