# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Tests of the adapter for trimesh: trimesh's own ray tests with only the class replaced, and tests of this project.

trimesh's tests are read from the folder `tests` of its source distribution, which PROMIN_TRIMESH_TESTS names (`pip
download --no-deps --no-binary trimesh trimesh`). The distribution has no models, so generated meshes replace them."""

from __future__ import annotations

import importlib.util
import logging
import os
import sys
import time
import types
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import make_box

import promin
from promin.compat.trimesh import RayMeshIntersector

trimesh = pytest.importorskip("trimesh")

FOLDER = Path(os.environ.get("PROMIN_TRIMESH_TESTS", "/nonexistent"))
SKIPPED = {
    "test_rays": "needs ray_data of their models",
    "test_embree_duplicate_hits": "asks for a hit at the ray's origin, and promin's are at t > 0",
}


def get_mesh(name: str, **_: Any) -> Any:
    """Returns a mesh that replaces a model of trimesh's tests."""
    made = {
        "unit_sphere.stl": trimesh.creation.icosphere,
        "unit_cube.stl": trimesh.creation.box,
        "teapot.stl": lambda: trimesh.creation.capsule(height=4, radius=3).slice_plane((0, 0, 1), (0, 0, -1)),
        "featuretype.stl": lambda: trimesh.creation.annulus(1, 3, 2),
        "7_8ths_cube.stl": make_notched_cube,
    }
    if name.lower() not in made:
        pytest.skip(f"needs their model {name}")
    mesh = made[name.lower()]()
    mesh.ray = RayMeshIntersector(mesh)
    return mesh


def make_notched_cube() -> Any:
    """Returns seven of the eight cubes with edge 20 around the origin. The cube with positive coordinates is
    missing."""
    corners: list[Any] = []
    filled = {(i, j, k) for i in (0, 1) for j in (0, 1) for k in (0, 1)} - {(1, 1, 1)}
    vertices, faces = make_box((0.5, 0.5, 0.5), 1.0)
    for cell in filled:
        for first in range(0, 12, 2):
            quad = vertices[faces[first : first + 2]]
            out = np.sign(np.round(quad.mean(axis=(0, 1)) - 0.5, 6)).astype(int)
            if tuple(np.add(cell, out)) not in filled:
                corners.append(20.0 * (quad + cell - 1.0))
    triangles = np.concatenate(corners)
    return trimesh.Trimesh(triangles.reshape(-1, 3), np.arange(3 * len(triangles)).reshape(-1, 3))


@pytest.fixture
def theirs(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Loads a test file of trimesh in which promin's class replaces trimesh's class."""
    # A module that replaces the helper module of trimesh's tests.
    generic = types.ModuleType("generic")
    generic.__dict__.update(
        np=np, trimesh=trimesh, get_mesh=get_mesh, random=np.random.default_rng(0).random, time=time
    )
    generic.__dict__["log"] = logging.getLogger("trimesh")
    embree = types.ModuleType("trimesh.ray.ray_pyembree")
    embree.__dict__["RayMeshIntersector"] = RayMeshIntersector
    monkeypatch.setitem(sys.modules, "generic", generic)
    monkeypatch.setitem(sys.modules, "trimesh.ray.ray_pyembree", embree)
    monkeypatch.setattr(trimesh.ray, "ray_pyembree", embree, raising=False)
    monkeypatch.setattr(trimesh.ray.ray_triangle, "RayMeshIntersector", RayMeshIntersector)
    monkeypatch.setattr(trimesh.ray, "has_embree", True)
    # The class that new meshes use by default.
    monkeypatch.setattr(trimesh.base, "RayMeshIntersector", RayMeshIntersector, raising=False)

    def load(file: str) -> types.ModuleType:
        spec = importlib.util.spec_from_file_location(file.removesuffix(".py"), FOLDER / file)
        assert spec is not None and spec.loader is not None
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        return module

    return load


def list_theirs() -> list[tuple[str, str]]:
    files = ["test_ray.py", "test_ray_upstream.py"]
    lines = [
        (file, line) for file in files if (FOLDER / file).exists() for line in (FOLDER / file).read_text().split("\n")
    ]
    return [(file, line[4:].split("(")[0]) for file, line in lines if line.startswith("def test_")]


@pytest.mark.parametrize("file, name", list_theirs() or [("none", "none")])
def test_theirs(file: str, name: str, theirs: Any) -> None:
    if file == "none":
        pytest.skip("PROMIN_TRIMESH_TESTS names no folder with trimesh's tests")
    if name in SKIPPED:
        pytest.skip(SKIPPED[name])
    if name == "test_contains_cavity":
        pytest.importorskip("manifold3d")
    getattr(theirs(file), name)()


class Mesh:
    """The members of a mesh that the adapter uses."""

    def __init__(self, vertices: Any, faces: Any) -> None:
        self.vertices, self.faces = vertices, faces


def test_all_hits_of_a_box_in_order() -> None:
    ray = RayMeshIntersector(Mesh(*make_box()))
    locations, rays, triangles = ray.intersects_location(
        [[0.2, 0.1, 5], [9, 9, 9], [0.2, 0.1, 0]], [[0, 0, -3], [0, 0, 1], [0, 0, 2]]
    )
    assert locations.tolist() == [[0.2, 0.1, 1], [0.2, 0.1, -1], [0.2, 0.1, 1]] and rays.tolist() == [0, 0, 2]
    assert (triangles[0] == triangles[2]) and locations.dtype == np.float64 and triangles.dtype == np.int64
    ids, rays = ray.intersects_id([[0.2, 0.1, 5]], [[0, 0, -1]], max_hits=1)
    assert len(ids) == 1 == len(rays)
    assert len(ray.intersects_id([[0.2, 0.1, 5]], [[0, 0, -1]], return_locations=True)[2]) == 2
    assert ray.intersects_first([[0.2, 0.1, 5], [9, 9, 9]], [[0, 0, -3], [0, 0, 1]]).tolist() == [triangles[0], -1]
    assert ray.intersects_any([[0.2, 0.1, 5], [9, 9, 9]], [[0, 0, -3], [0, 0, 1]]).tolist() == [True, False]


def test_no_copies_of_hits_at_any_scale() -> None:
    for scale in (1e-6, 1e-3, 1.0, 1e4, 1e8):
        vertices, faces = make_box((3 * scale, 0, 0), scale)
        ray = RayMeshIntersector(Mesh(vertices, faces))
        origins = np.array([[3 * scale, 0, 100 * scale]])
        assert len(ray.intersects_id(origins, [[0, 0, -1]])[0]) == 2
        inside = vertices + 1e-3 * (vertices.mean(axis=0) - vertices)
        outside = vertices - 1e-3 * (vertices.mean(axis=0) - vertices)
        assert ray.contains_points(inside).all() and not ray.contains_points(outside).any()


def test_a_changed_mesh_is_seen() -> None:
    mesh = Mesh(*make_box())
    ray = RayMeshIntersector(mesh)
    assert ray.contains_points([[0, 0, 0]])[0]
    mesh.vertices = mesh.vertices + [5, 0, 0]
    assert not ray.contains_points([[0, 0, 0]])[0] and ray.contains_points([[5, 0, 0]])[0]
    with pytest.raises(promin.UsageError, match="ray_origins"):
        ray.intersects_any([[0, 0, 0]], [[0, 0, 1], [1, 0, 0]])
