# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Tests of the adapter for Open3D. They use the shapes and answers of Open3D's documentation and tests, and Open3D
itself if it is installed."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from conftest import make_box

import promin
from promin.compat.open3d import RaycastingScene


def make_scene() -> RaycastingScene:
    scene = RaycastingScene()
    assert (
        scene.add_triangles(np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0]], np.float32), np.array([[0, 1, 2]], np.uint32))
        == 0
    )
    assert scene.add_triangles(np.array([[0, 0, 2], [1, 0, 2], [1, 1, 2]], np.float32), np.array([[0, 1, 2]])) == 1
    return scene


def give(value: object) -> np.ndarray[tuple[int, ...], np.dtype[np.generic]]:
    return value.numpy() if hasattr(value, "numpy") else value  # type: ignore[return-value]


def test_cast_rays() -> None:
    rays = np.array([[0.6, 0.3, -1, 0, 0, 2], [0.6, 0.3, 1, 0, 0, 1], [9, 0, 0, 0, 0, 1]], np.float32)
    answer = {name: give(value) for name, value in make_scene().cast_rays(rays).items()}
    assert answer["t_hit"].tolist() == [0.5, 1, np.inf]
    assert answer["geometry_ids"].tolist() == [0, 1, RaycastingScene.INVALID_ID]
    assert answer["primitive_ids"].tolist() == [0, 0, RaycastingScene.INVALID_ID]
    assert answer["geometry_ids"].dtype == np.uint32
    assert np.allclose(answer["primitive_uvs"][0], (0.3, 0.3)) and answer["primitive_normals"][0].tolist() == [0, 0, 1]


@pytest.mark.parametrize("shape", [(11,), (1, 2, 3), (32, 14), (0,)])
def test_shapes(shape: tuple[int, ...]) -> None:
    scene = make_scene()
    rays = np.random.default_rng(0).random((*shape, 6))
    answer = {name: give(value).shape for name, value in scene.cast_rays(rays).items()}
    assert answer == {
        "t_hit": shape,
        "geometry_ids": shape,
        "primitive_ids": shape,
        "primitive_uvs": (*shape, 2),
        "primitive_normals": (*shape, 3),
    }
    assert give(scene.count_intersections(rays)).shape == shape == give(scene.test_occlusions(rays)).shape


def test_occlusions_between_tnear_and_tfar() -> None:
    ray = [[0.6, 0.3, -1, 0, 0, 1]]
    scene = make_scene()
    for tnear, tfar, expected in ((0, np.inf, True), (0, 0.5, False), (1.5, np.inf, True), (1.5, 2.5, False)):
        assert give(scene.test_occlusions(ray, tnear, tfar)).tolist() == [expected]


def test_counts_and_lists() -> None:
    rays = np.array([[0.6, 0.3, -1, 0, 0, 1], [9, 0, 0, 0, 0, 1], [0.6, 0.3, 1, 0, 0, 1]], np.float32)
    scene = make_scene()
    assert give(scene.count_intersections(rays)).tolist() == [2, 0, 1]
    answer = {name: give(value) for name, value in scene.list_intersections(rays).items()}
    assert answer["ray_splits"].tolist() == [0, 2, 2, 3] and answer["ray_ids"].tolist() == [0, 0, 2]
    assert answer["t_hit"].tolist() == [1, 3, 1] and answer["geometry_ids"].tolist() == [0, 1, 1]
    assert answer["primitive_uvs"].shape == (3, 2)


def test_occupancy_is_exact_on_rays_through_edges_and_corners() -> None:
    scene = RaycastingScene()
    scene.add_triangles(*make_box())
    points = np.random.default_rng(1).uniform(-2, 2, (2000, 3)).astype(np.float32)
    assert (give(scene.compute_occupancy(points)) == (np.abs(points) < 1).all(axis=1)).all()
    for closest in (scene.compute_closest_points, scene.compute_distance, scene.compute_signed_distance):
        with pytest.raises(NotImplementedError, match="closest points"):
            closest(points)


def make_ball(radius: float, count: int = 20) -> tuple[np.ndarray, np.ndarray]:  # type: ignore[type-arg]
    """Returns a sphere of meridians and parallels, with as many as Open3D's create_sphere has."""
    heights, turns = np.arange(1, count) * np.pi / count, np.arange(2 * count) * np.pi / count
    around = np.stack([np.cos(turns), np.sin(turns), np.zeros_like(turns)], axis=-1)
    rings = np.sin(heights)[:, None, None] * around + np.cos(heights)[:, None, None] * (0, 0, 1)
    vertices = np.concatenate([[(0, 0, 1), (0, 0, -1)], rings.reshape(-1, 3)]) * radius
    number = 2 + np.arange(rings.size // 3).reshape(count - 1, -1)
    beside = np.roll(number, -1, axis=1)
    caps = [np.stack([np.full(2 * count, 0), number[0], beside[0]], axis=-1)]
    caps += [np.stack([np.full(2 * count, 1), beside[-1], number[-1]], axis=-1)]
    upper = np.stack([number[:-1], number[1:], beside[:-1]], axis=-1).reshape(-1, 3)
    lower = np.stack([beside[:-1], number[1:], beside[1:]], axis=-1).reshape(-1, 3)
    return vertices.astype(np.float32), np.concatenate([*caps, upper, lower])


def test_sphere_wrong_occupancy() -> None:
    scene = RaycastingScene()
    scene.add_triangles(*make_ball(0.8))
    points = np.stack(np.meshgrid(*3 * [np.linspace(-0.88, 0.88, 6)]), axis=-1)
    expected = np.linalg.norm(points, axis=-1) < 0.8
    assert (give(scene.compute_occupancy(points)) == expected).all() and expected.sum() == 56


def make_cube() -> RaycastingScene:
    """Distances from 0 to 1."""
    scene = RaycastingScene()
    scene.add_triangles(*make_box((0.5, 0.5, 0.5), 1.0))
    return scene


def make_lots(count: int) -> np.ndarray:  # type: ignore[type-arg]
    return np.random.RandomState(123).rand(count, 6).astype(np.float32)


def test_count_lots_of_intersections() -> None:
    # Each ray starts inside the cube.
    assert (give(make_cube().count_intersections(make_lots(1234567))) == 1).all()


def test_list_lots_of_intersections() -> None:
    answer = make_cube().list_intersections(make_lots(123456))
    assert (give(answer["ray_splits"]) == np.arange(123457)).all()
    assert (give(answer["ray_ids"]) == np.arange(123456)).all() and (give(answer["t_hit"]) > 0).all()


@pytest.mark.long
def test_cast_lots_of_rays() -> None:
    # No ray hits the triangle's plane at z = 0. Each ray hits a triangle of the cube, except two rays that start on it.
    rays = make_lots(7654321)
    assert (give(make_scene().cast_rays(rays)["geometry_ids"]) != 0).all()
    begins_inside = (rays[:, :3] < 1).all(axis=1)
    assert begins_inside.sum() == 7654319
    cube = make_cube()
    assert give(cube.test_occlusions(rays))[begins_inside].all()
    assert np.isfinite(give(cube.cast_rays(rays)["t_hit"]))[begins_inside].all()


THEIRS = Path(os.environ.get("PROMIN_OPEN3D_TESTS", "/nonexistent"), "test_raycasting_scene.py")


@pytest.mark.long
def test_theirs() -> None:
    """Runs Open3D's own test file with only the class replaced. Tests that need closest points are skipped."""
    pytest.importorskip("open3d")
    if not THEIRS.exists():
        pytest.skip("PROMIN_OPEN3D_TESTS names no folder with Open3D's test_raycasting_scene.py")
    words = [sys.executable, "-m", "pytest", "-q", "-rs", "-p", "no:cacheprovider", "-p", "replace_open3d", str(THEIRS)]
    paths = os.pathsep.join([str(Path(__file__).parent), os.environ.get("PYTHONPATH", "")])
    done = subprocess.run(words, env={**os.environ, "PYTHONPATH": paths}, capture_output=True, text=True, timeout=1200)
    assert done.returncode == 0, done.stdout + done.stderr
    print(done.stdout)


def test_pinhole_rays() -> None:
    rays = give(RaycastingScene.create_rays_pinhole(90, [0, 0, 0], [0, 0, 4], [0, 1, 0], 8, 6))
    assert rays.shape == (6, 8, 6) and rays.dtype == np.float32
    assert (rays[..., :3] == (0, 0, 4)).all() and np.allclose(rays[..., 5], -1)
    # The camera looks along -Z and +Y is up, so the first pixel is at the upper left.
    assert np.allclose(rays[0, 0, 3:], (-3.5 / 4, 2.5 / 4, -1))
    again = give(
        RaycastingScene.create_rays_lookat(
            fov_deg=90, center=[0, 0, 0], eye=[0, 0, 4], up=[0, 1, 0], width_px=8, height_px=6
        )
    )
    assert (again == rays).all()
    intrinsic, extrinsic = np.array([[4, 0, 4], [0, 4, 3], [0, 0, 1.0]]), np.diag([1.0, -1, -1, 1])
    extrinsic[2, 3] = 4
    assert np.allclose(give(RaycastingScene.create_rays_pinhole(intrinsic, extrinsic, 8, 6)), rays)
    with pytest.raises(TypeError):
        RaycastingScene.create_rays_pinhole(90, [0, 0, 0])
    with pytest.raises(promin.UsageError):
        RaycastingScene.create_rays_pinhole(np.eye(2), extrinsic, 8, 6)


def test_hits_agree_with_open3d() -> None:
    o3d = pytest.importorskip("open3d")
    random = np.random.default_rng(2)
    corners = (random.normal(size=(3000, 1, 3)) + 0.1 * random.normal(size=(3000, 3, 3))).astype(np.float32)
    mesh = corners.reshape(-1, 3), np.arange(9000, dtype=np.uint32).reshape(-1, 3)
    rays = np.concatenate([3 * random.normal(size=(20000, 3)), random.normal(size=(20000, 3))], axis=1).astype(
        np.float32
    )
    rays[:, 3:] -= rays[:, :3]
    theirs, ours = o3d.t.geometry.RaycastingScene(), RaycastingScene()
    theirs.add_triangles(*(o3d.core.Tensor(a) for a in mesh))
    ours.add_triangles(*mesh)
    expected, answer = theirs.cast_rays(o3d.core.Tensor(rays)), ours.cast_rays(o3d.core.Tensor(rays))
    same = answer["primitive_ids"].numpy() == expected["primitive_ids"].numpy()
    assert same.mean() > 0.9999
    hit = same & np.isfinite(expected["t_hit"].numpy())
    assert hit.sum() > 10000
    # K of t for the difference of the two hits: the distance along the ray, converted to a distance across the
    # triangle, in units of u S (docs/glossary.md).
    triangles = corners[expected["primitive_ids"].numpy()[hit]].astype(np.float64)
    low, high = triangles.min(axis=1), triangles.max(axis=1)
    scale = np.linalg.norm(rays[hit, :3] - (low + high) / 2, axis=1) + np.linalg.norm(high - low, axis=1) / 2
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    slopes = np.abs(np.einsum("ij,ij->i", normals, rays[hit, 3:])) / np.linalg.norm(normals, axis=1)
    apart = np.abs(answer["t_hit"].numpy()[hit].astype(np.float64) - expected["t_hit"].numpy()[hit])
    assert (apart * slopes / (2.0**-24 * scale)).max() < 8
