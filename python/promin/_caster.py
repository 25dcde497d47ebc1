# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Casting rays at a scene."""

from __future__ import annotations

import os
import threading
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from promin import _promin
from promin._arrays import HIT_DTYPE, Hits, RaysLike, join_rays, pack_rays, to_vectors
from promin._device import Device, DeviceLike, find_device
from promin._errors import InputError, UsageError
from promin._scene import REMAKES, Scene, SceneLike, split_transforms, to_scene

PROBE = np.array((0.4375, 0.625, 0.65625), np.float32)
"""The direction of rays that test whether points are inside. No component is small or a simple ratio of another one."""
_RAYS_AT_A_TIME = 2**20
"""The largest number of rays in one call of the library."""

Progress = Union[Callable[[float], object], None]
"""A callable that receives the fraction that is done about twenty times a second, on the caller's thread. If it returns
False, the call raises `promin.Cancelled`. If it raises an exception, the call raises that exception."""


class Caster:
    """Casts rays at a scene on a device.

    The constructor builds a bounding volume hierarchy. The scene may change afterwards; the Caster keeps its own
    snapshot. Any thread may use a Caster, but only one at a time. A Caster releases Python's lock during a call, so
    other threads run meanwhile. Ctrl-C ends a call before its next dispatch and leaves the Caster usable. A pickled
    Caster holds the scene, the options and the choice of the device, and opens them at its first use. After a fork,
    every use in the child raises RuntimeError."""

    _opened: tuple[Device, _promin.Caster, NDArray[np.float64]] | None

    def __init__(
        self,
        scene: SceneLike,
        device: DeviceLike = None,
        *,
        bvh: str | os.PathLike[str] | None = None,
        builder: str = "sah",
        instances: str = "auto",
        progress: Progress = None,
    ) -> None:
        """device: a Device, a part of a device's name, an index, or None for the default device. bvh: a file that
        `promin-bvh build` has written, from which the tree is read. builder: "sah", "median" or "spatial"; the hits do
        not depend on it. The objects of `instances` share the triangles of their mesh: "auto" are those that save
        much memory, "all" those with a mesh, "none" no objects. The file of `bvh` belongs to one choice. Raises
        UsageError, InputError for an invalid scene, DeviceError, RunError, Cancelled."""
        self._scene = to_scene(scene).snapshot()
        self._options = (str(builder), None if bvh is None else os.fsdecode(bvh), str(instances))
        self._chosen = device
        # The scene in its current pose, and the transforms of the objects that have moved.
        self._posed = self._scene
        self._transforms: dict[int, NDArray[np.float64]] = {}
        self._make_private()
        self._open(progress)

    @property
    def scene(self) -> Scene:
        """The scene as it was when the Caster was created. Changes of this scene have no effect on the Caster."""
        return self._scene

    @property
    def device(self) -> Device:
        """The device on which the Caster runs."""
        return self._open()[0]

    @property
    def setup(self) -> dict[str, Any]:
        """The cost of construction: milliseconds, bytes, nodes and warnings. The keys are the names of
        include/promin/setup_stats.h."""
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

        rays, directions, tmin, tmax: the rays in one of three forms. Either origins (..., 3), directions (..., 3) and
        optionally tmin and tmax (...), which are broadcast together and are 0 and infinity by default; or one array
        (..., 8) of origin xyz, tmin, direction xyz, tmax; or a tuple (origins, directions) or (origins, directions,
        tmin, tmax). Arrays may have any strides and real types. Numbers are rounded to float32 once; a C-contiguous
        float32 array of shape (..., 8) is not copied. A direction may have any length except 0, t is in units of this
        length, and a hit has tmin < t < tmax. A ray with a NaN misses everything. out: an array that the call fills and
        returns. It is C-contiguous and has the result's shape and type. Reusing memory is faster than allocating it.

        Returns an array (...) of `promin.HIT_DTYPE`, which `promin cast` writes too: t (infinite on a miss), object and
        primitive (-1 on a miss), u and v (weights of a triangle's second and third corner), normal (the geometric unit
        normal; 0 on a miss). The normal points to the side from which a triangle's corners run counterclockwise, and
        outwards on a solid; it does not depend on the ray. At equal t the hit with the lower (object, primitive)
        counts. A ray through an edge of a triangle hits the triangle. Raises UsageError, RunError, Cancelled."""
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
        """Returns for each ray whether it hits anything, as bool (...). This is faster than `cast`. The arguments rays,
        directions, tmin, tmax and out are those of `cast`, as are the exceptions."""
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
        """Returns the number of surfaces that each ray crosses, as int32 (...). The arguments rays, directions, tmin,
        tmax and out are those of `cast`.

        A ray that hits an edge or a corner of a closed mesh crosses exactly one of the triangles at this place. A ray
        that touches a silhouette crosses no triangle or two. The count is therefore odd exactly if the ray starts
        inside (include/promin/caster.h has the rule). In `cast`, a ray through an edge hits each triangle of the edge.
        Raises UsageError, RunError, Cancelled."""
        _, native, center = self._open()
        packed, shape = pack_rays(join_rays(rays, directions, tmin, tmax), center)
        counts = prepare_answers(out, shape, np.dtype(np.int32), packed)
        native.count(packed, counts.reshape(-1), progress)
        return counts

    def inside(self, points: ArrayLike) -> NDArray[np.bool_]:
        """Returns for each of the points (..., 3) whether it is inside a closed surface, as bool (...). All objects of
        the scene together are the surface.

        A point is inside if a ray from it crosses the surface an odd number of times. Edges and corners count once, as
        for `count`. The ray in the opposite direction must give the same result. Otherwise the point is on the surface,
        or the surface is not closed. Such a point counts as outside, and a Python warning reports their number. A point
        in two overlapping solids counts as outside; make a Caster for each solid. Raises UsageError, RunError,
        Cancelled."""
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
        """Returns all crossings of each ray as (splits, hits). `count` describes what a crossing is. splits is int64 (n
        + 1) for the n rays in C order; hits is an array of `promin.HIT_DTYPE`. The hits of ray i are
        hits[splits[i]:splits[i + 1]], sorted by t, then by (object, primitive). All hits are in memory at once;
        `iter_list` avoids this. The arguments and the exceptions are those of `cast`."""
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
        """Yields the result of `list` in parts, for more hits than memory can hold. A part is (first, splits, hits),
        where hits[splits[i]:splits[i + 1]] are the hits of ray first + i in C order. Each part has as many rays as have
        `budget` bytes of hits together, but at least one ray. progress: receives the progress of each part
        separately."""
        if not isinstance(budget, (int, np.integer)) or not 0 < budget < 2**63:
            raise UsageError(f"budget is {budget!r:.80}; give a positive number of bytes")
        _, native, center = self._open()
        packed, _ = pack_rays(join_rays(rays, directions, tmin, tmax), center)
        return _list_parts(native, packed, int(budget), progress)

    def update(
        self,
        *,
        time: float | None = None,
        animation: str | int | Sequence[str | int] | None = 0,
        loop: bool = False,
        transforms: Mapping[int, ArrayLike] | None = None,
    ) -> None:
        """Shows another pose to all later rays, or moves objects.

        time, animation, loop: the pose, like the arguments of Scene.at; None leaves the pose as it is. transforms: new
        transforms (4, 4) by the objects' numbers, like those of Scene.add_instances. All other objects stay, and moved
        objects do not move with poses. Instances (docs/instances.md) move in milliseconds; to move other objects, the
        tree is built again. Hits have the same bits as those of a new Caster of the moved scene. `scene` stays that of
        the constructor. Raises UsageError and InputError for invalid arguments, and then changes nothing."""
        moved = {} if transforms is None else self._scene.native_transforms(transforms)
        posed = None if time is None else self._scene.at(time, animation, loop=loop)
        with self._lock:
            _, native, _ = self._open()
            shown = self._posed if posed is None else posed
            new = {**self._transforms, **moved}
            try:
                if posed is not None:
                    native.set_pose(posed.native())
                native.set_transforms(*split_transforms(new if posed is not None else moved))
            except InputError as error:
                if any(problem.code not in REMAKES for problem in error.problems):
                    if posed is not None:
                        # The next use makes the caster again.
                        self._opened = None
                    raise
                self._opened = self._make(shown, new, None)
            self._posed, self._transforms = shown, new

    def _open(self, progress: Progress = None) -> tuple[Device, _promin.Caster, NDArray[np.float64]]:
        opened = self._opened
        if opened is not None:
            return opened
        with self._lock:
            if self._opened is None:
                self._opened = self._make(self._posed, self._transforms, progress)
            return self._opened

    def _make(
        self, posed: Scene, transforms: dict[int, NDArray[np.float64]], progress: Progress
    ) -> tuple[Device, _promin.Caster, NDArray[np.float64]]:
        device = find_device(self._chosen)
        scene = posed.native()
        if transforms:
            scene = scene.moved(*split_transforms(transforms))
        native = _promin.Caster(device._native, scene, *self._options, progress)
        return device, native, self._scene.native_center

    def _make_private(self) -> None:
        """Creates the members that are not pickled: the native objects, and the lock that protects them."""
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
    """Returns the array for the results: the caller's array or a new one. Raises UsageError if the caller's array does
    not fit."""
    if out is None:
        return np.empty(shape, dtype)
    if not isinstance(out, np.ndarray) or out.dtype != dtype or out.shape != shape:
        given = f"{out.dtype} {out.shape}" if isinstance(out, np.ndarray) else repr(out)[:80]
        raise UsageError(f"out is {given}; give an array of {dtype} and the shape {shape}")
    if not out.flags.c_contiguous or not out.flags.writeable or np.may_share_memory(out, rays):
        raise UsageError("out is not C-contiguous, cannot be written or shares memory with the rays; give another")
    return out


def as_bytes(hits: NDArray[Any]) -> NDArray[np.uint8]:
    """Returns a view of the hits' memory as (n, 32) bytes."""
    return hits.reshape(-1).view(np.uint8).reshape(hits.size, HIT_DTYPE.itemsize)


def _to_hits(rows: NDArray[np.uint8]) -> NDArray[Any]:
    """Returns hits (n,) that share the memory of the library's bytes (n, 32)."""
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
        # If the hits of some rays exceed the budget, these rays are cast again in the next call.
        count = min(2 * (len(splits) - 1), _RAYS_AT_A_TIME)
