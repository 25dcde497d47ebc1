# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""The ray functions of `open3d.t.geometry.RaycastingScene`, implemented by promin.

Open3D itself is not imported. Arguments with a method `numpy()`, such as its Tensors, are accepted. Results are NumPy
arrays, or Tensors if the program has imported open3d. In `count_intersections` and `list_intersections` a ray that hits
an edge or a corner crosses the mesh once."""

from __future__ import annotations

import sys
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from promin._arrays import round_once, to_numbers, to_vectors
from promin._caster import PROBE, Caster
from promin._device import DeviceLike
from promin._errors import UsageError
from promin._scene import Scene


class RaycastingScene:
    """Meshes to cast rays at. Rays are arrays (..., 6) of origin and direction. Results have the leading shape of the
    rays."""

    INVALID_ID = 0xFFFFFFFF
    """The value of geometry_ids and primitive_ids on a miss."""

    def __init__(self, nthreads: int = 0, device: Any = None) -> None:
        """nthreads is ignored here and in all other methods. device: an argument of `promin.Caster`; a device of Open3D
        is ignored."""
        self._scene = Scene(center=(0, 0, 0))
        self._device: DeviceLike = None if type(device).__module__.startswith("open3d") else device
        self._caster: Caster | None = None

    def add_triangles(self, vertex_positions: Any, triangle_indices: Any = None) -> int:
        """Adds a mesh and returns its geometry id. The mesh is (n, 3) float32 vertices and (m, 3) indices, or an
        `open3d.t.geometry.TriangleMesh`."""
        if triangle_indices is None:
            mesh = vertex_positions
            vertex_positions, triangle_indices = mesh.vertex.positions, mesh.triangle.indices
        vertices = round_once(to_vectors(_to_numpy(vertex_positions), "vertex_positions"))
        number = self._scene.add_triangles(vertices, _to_numpy(triangle_indices))
        self._caster = None
        return number

    def cast_rays(self, rays: Any, nthreads: int = 0) -> dict[str, Any]:
        """Returns the nearest hits as a dict: t_hit (infinite on a miss), geometry_ids, primitive_ids, primitive_uvs
        (..., 2), primitive_normals (..., 3)."""
        hits = self._open().cast(_split(rays))
        return {
            "t_hit": _give(hits["t"]),
            "geometry_ids": _give(hits["object"].astype(np.uint32)),
            "primitive_ids": _give(hits["primitive"].astype(np.uint32)),
            "primitive_uvs": _give(np.stack([hits["u"], hits["v"]], axis=-1)),
            "primitive_normals": _give(hits["normal"]),
        }

    def test_occlusions(self, rays: Any, tnear: float = 0.0, tfar: float = np.inf, nthreads: int = 0) -> Any:
        """Returns whether each ray hits anything between tnear and tfar, as bool (...)."""
        return _give(self._open().occluded((*_split(rays), tnear, tfar)))

    def count_intersections(self, rays: Any, nthreads: int = 0) -> Any:
        """Returns the number of surfaces that each ray crosses, as int32 (...)."""
        return _give(self._open().count(_split(rays)))

    def list_intersections(self, rays: Any, nthreads: int = 0) -> dict[str, Any]:
        """Returns all crossings as a dict: ray_splits (n + 1), ray_ids, t_hit, geometry_ids, primitive_ids (h,),
        primitive_uvs (h, 2). The crossings of ray i are those from ray_splits[i] up to, but without, ray_splits[i +
        1]."""
        splits, hits = self._open().list(_split(rays))
        return {
            "ray_splits": _give(splits),
            "ray_ids": _give(np.repeat(np.arange(len(splits) - 1), np.diff(splits))),
            "t_hit": _give(hits["t"]),
            "geometry_ids": _give(hits["object"].astype(np.uint32)),
            "primitive_ids": _give(hits["primitive"].astype(np.uint32)),
            "primitive_uvs": _give(np.stack([hits["u"], hits["v"]], axis=-1)),
        }

    def compute_closest_points(self, query_points: Any, nthreads: int = 0) -> NoReturn:
        """Not supported, because promin only traces rays."""
        raise NotImplementedError("promin traces rays and finds no closest points; use Open3D's own scene for these")

    def compute_distance(self, query_points: Any, nthreads: int = 0) -> NoReturn:
        """Not supported, because promin only traces rays."""
        self.compute_closest_points(query_points)

    def compute_signed_distance(self, query_points: Any, nthreads: int = 0, nsamples: int = 1) -> NoReturn:
        """Not supported, because promin only traces rays."""
        self.compute_closest_points(query_points)

    def compute_occupancy(self, query_points: Any, nthreads: int = 0, nsamples: int = 1) -> Any:
        """Returns 1 for points (..., 3) inside closed meshes and 0 for other points, as float32 (...). One ray per
        point is enough, so nsamples is ignored."""
        points = to_vectors(_to_numpy(query_points), "query_points")
        counts = self._open().count(points, PROBE)
        return _give((counts % 2).astype(np.float32))

    @staticmethod
    def create_rays_pinhole(*args: Any, **kwargs: Any) -> Any:
        """Returns the rays of a pinhole camera through the centres of pixels, (height_px, width_px, 6) float32. A
        direction ends on the plane at the distance 1 in front of the camera. The arguments are either (intrinsic_matrix
        (3, 3), extrinsic_matrix (4, 4), width_px, height_px), or (fov_deg, center, eye, up, width_px, height_px), where
        the field of view is horizontal."""
        names: tuple[str, ...] = ("intrinsic_matrix", "extrinsic_matrix", "width_px", "height_px")
        if len(args) + len(kwargs) == 4:
            intrinsic, extrinsic, width, height = _arguments(names, args, kwargs)
            inner, outer = _to_array(intrinsic, (3, 3)), _to_array(extrinsic, (4, 4))
        else:
            names = ("fov_deg", "center", "eye", "up", "width_px", "height_px")
            fov, center, eye, up, width, height = _arguments(names, args, kwargs)
            focal = 0.5 * width / np.tan(0.5 * np.deg2rad(float(fov)))
            inner = np.array([[focal, 0, 0.5 * width], [0, focal, 0.5 * height], [0, 0, 1]])
            outer = _look_at(_to_array(center, (3,)), _to_array(eye, (3,)), _to_array(up, (3,)))
        x, y = np.meshgrid(np.arange(int(width)) + 0.5, np.arange(int(height)) + 0.5)
        in_camera = np.stack([x, y, np.ones_like(x)], axis=-1) @ np.linalg.inv(inner).T
        turn = outer[:3, :3]
        rays = np.empty((*x.shape, 6), np.float32)
        rays[..., :3] = -turn.T @ outer[:3, 3]
        rays[..., 3:] = in_camera @ turn
        return _give(rays)

    @staticmethod
    def create_rays_lookat(fov_deg: float, center: Any, eye: Any, up: Any, width_px: int, height_px: int) -> Any:
        """Has the arguments of the second form of create_rays_pinhole."""
        return RaycastingScene.create_rays_pinhole(fov_deg, center, eye, up, width_px, height_px)

    def _open(self) -> Caster:
        if self._caster is None:
            self._caster = Caster(self._scene, self._device)
        return self._caster


def _to_numpy(value: Any) -> Any:
    return value.numpy() if hasattr(value, "numpy") else value


def _give(array: NDArray[Any]) -> Any:
    """Returns the array; returns a Tensor if the program has imported open3d."""
    array = np.ascontiguousarray(array)
    open3d = sys.modules.get("open3d")
    return array if open3d is None else open3d.core.Tensor.from_numpy(array)


def _split(rays: Any) -> tuple[NDArray[Any], NDArray[Any]]:
    array = to_vectors(_to_numpy(rays), "rays", 6)
    return array[..., :3], array[..., 3:]


def _to_array(value: Any, shape: tuple[int, ...]) -> NDArray[np.float64]:
    array = to_numbers(_to_numpy(value), "the numbers").astype(np.float64)
    if array.shape != shape:
        raise UsageError(f"an array of the shape {array.shape} is given instead of the shape {shape}")
    return array


def _arguments(names: tuple[str, ...], args: tuple[Any, ...], kwargs: dict[str, Any]) -> list[Any]:
    given = {**dict(zip(names, args)), **kwargs}
    if len(args) > len(names) or set(given) != set(names):
        raise TypeError(f"create_rays_pinhole() takes {', '.join(names)}")
    return [given[name] for name in names]


def _look_at(center: NDArray[np.float64], eye: NDArray[np.float64], up: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns the matrix from the world to a camera whose x axis points to the right, y downwards and z in the
    direction of view."""
    z = center - eye
    z /= np.linalg.norm(z)
    x = np.cross(z, up)
    x /= np.linalg.norm(x)
    turn = np.stack([x, np.cross(z, x), z])
    matrix = np.eye(4)
    matrix[:3, :3] = turn
    matrix[:3, 3] = -turn @ eye
    return matrix
