# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""The functions of trimesh's `mesh.ray`, implemented by promin:

    mesh.ray = promin.compat.trimesh.RayMeshIntersector(mesh)

Trimesh itself is not imported. All hits follow the rule of `Caster.count`: a ray that hits an edge or a corner of a
closed mesh crosses it once."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from promin._arrays import to_vectors
from promin._caster import PROBE, Caster
from promin._device import DeviceLike
from promin._errors import UsageError
from promin._scene import Scene, meet_planes


class RayMeshIntersector:
    """Casts rays at one mesh, with the interface of the RayMeshIntersector in `trimesh.ray.ray_pyembree` and
    `ray_triangle`. The mesh has `vertices` (n, 3) and `faces` (m, 3). Results follow changes of the mesh."""

    def __init__(self, mesh: Any, scale_to_box: bool = True, device: DeviceLike = None) -> None:
        """scale_to_box is ignored: promin needs no scale. device: as for `promin.Caster`."""
        self.mesh = mesh
        self._device = device
        self._made: tuple[object, Caster, NDArray[np.float64]] | None = None

    def intersects_location(
        self, ray_origins: ArrayLike, ray_directions: ArrayLike, multiple_hits: bool = True
    ) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int64]]:
        """Returns the hits as a tuple: locations (h, 3) float64 on the planes of the triangles, index_ray (h,) and
        index_tri (h,)."""
        triangles, rays, locations = self._intersect(ray_origins, ray_directions, multiple_hits)
        return locations, rays, triangles

    def intersects_id(
        self,
        ray_origins: ArrayLike,
        ray_directions: ArrayLike,
        multiple_hits: bool = True,
        max_hits: int = 100,
        return_locations: bool = False,
    ) -> Any:
        """Returns the triangles that rays hit: index_tri (h,), index_ray (h,) and, with return_locations, locations (h,
        3). The hits are sorted by ray and then by distance. There are at most max_hits for each ray."""
        triangles, rays, locations = self._intersect(ray_origins, ray_directions, multiple_hits, max_hits)
        return (triangles, rays, locations) if return_locations else (triangles, rays)

    def intersects_first(self, ray_origins: ArrayLike, ray_directions: ArrayLike) -> NDArray[np.int64]:
        """Returns the index of the first triangle that each ray hits, (n,); -1 on a miss."""
        origins, directions = _check(ray_origins, ray_directions)
        caster, _ = self._caster()
        return np.asarray(caster.cast((origins, directions))["primitive"], np.int64)

    def intersects_any(self, ray_origins: ArrayLike, ray_directions: ArrayLike) -> NDArray[np.bool_]:
        """Returns whether each ray hits the mesh, as bool (n,). The answer agrees with intersects_first."""
        return self.intersects_first(ray_origins, ray_directions) >= 0

    def contains_points(self, points: ArrayLike) -> NDArray[np.bool_]:
        """Returns whether points (n, 3) are inside a closed mesh, as bool (n,). The answer is the parity of the
        crossings of one ray. It is exact unless the distance of the point from the surface is within the bound on hits
        (docs/accuracy.md)."""
        places = to_vectors(points, "points")
        if places.ndim != 2:
            raise UsageError(f"points have the shape {places.shape}; give (n, 3)")
        caster, _ = self._caster()
        return np.asarray(caster.count(places, PROBE) % 2 == 1)

    def _intersect(
        self, ray_origins: ArrayLike, ray_directions: ArrayLike, multiple_hits: bool, max_hits: int | None = None
    ) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]:
        origins, directions = _check(ray_origins, ray_directions)
        caster, corners = self._caster()
        if multiple_hits:
            splits, hits = caster.list((origins, directions))
            rays = np.repeat(np.arange(len(origins)), np.diff(splits))
            if max_hits is not None:
                is_kept = np.arange(len(hits)) - splits[rays] < max_hits
                rays, hits = rays[is_kept], hits[is_kept]
        else:
            hits = caster.cast((origins, directions))
            rays = np.flatnonzero(hits["object"] >= 0)
            hits = hits[rays]
        triangles = hits["primitive"].astype(np.int64)
        along = origins[rays] + hits["t"].astype(np.float64)[:, None] * directions[rays]
        return triangles, rays, meet_planes(origins[rays], directions[rays], corners[triangles], along)

    def _caster(self) -> tuple[Caster, NDArray[np.float64]]:
        """Returns a Caster for the current mesh, and the corners of its triangles."""
        vertices = np.asarray(self.mesh.vertices, np.float64)
        faces = np.asarray(self.mesh.faces).reshape(-1, 3)
        # Meshes of trimesh have a hash of their content. Other meshes are hashed by their address.
        hashes: Any = type(self.mesh).__hash__
        key = (vertices.tobytes(), faces.tobytes()) if hashes is object.__hash__ else hash(self.mesh)
        if self._made is None or self._made[0] != key:
            scene = Scene()
            scene.add_triangles(vertices.reshape(-1, 3), faces)
            self._made = key, Caster(scene, self._device), vertices[faces] if len(faces) else np.zeros((0, 3, 3))
        return self._made[1], self._made[2]


def _check(ray_origins: ArrayLike, ray_directions: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Returns origins and directions as (n, 3) float64. The directions have length 1."""
    origins = to_vectors(ray_origins, "ray_origins").astype(np.float64)
    directions = to_vectors(ray_directions, "ray_directions").astype(np.float64)
    if origins.shape != directions.shape or origins.ndim != 2:
        raise UsageError(f"ray_origins {origins.shape} and ray_directions {directions.shape} are not both (n, 3)")
    with np.errstate(divide="ignore", invalid="ignore"):
        return origins, directions / np.linalg.norm(directions, axis=1, keepdims=True)
