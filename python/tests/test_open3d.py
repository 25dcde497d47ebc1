# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""The adapter for Open3D, by the shapes and answers that its documentation and tests have; beside Open3D itself where
it is installed."""

from __future__ import annotations

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


def test_pinhole_rays() -> None:
    rays = give(RaycastingScene.create_rays_pinhole(90, [0, 0, 0], [0, 0, 4], [0, 1, 0], 8, 6))
    assert rays.shape == (6, 8, 6) and rays.dtype == np.float32
    assert (rays[..., :3] == (0, 0, 4)).all() and np.allclose(rays[..., 5], -1)
    # Seen along -Z with +Y up, the first pixel is at the left and the top.
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
    t = expected["t_hit"].numpy()[same]
    hit = np.isfinite(t)
    # 8 u S over the cosine, of which few are small.
    assert np.quantile(np.abs(answer["t_hit"].numpy()[same][hit] - t[hit]), 0.999) < 1e-4
