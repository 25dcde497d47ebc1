# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Objects that share a geometry (docs/instances.md)."""

from __future__ import annotations

import pickle
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import promin

VERTICES = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)])
FACES = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]


def make_transforms(count: int, center: float = 0.0) -> NDArray[np.float64]:
    """Returns transforms that place objects along the x axis, each second one mirrored."""
    transforms = np.tile(np.eye(4), (count, 1, 1))
    transforms[:, 0, 3] = center + 3.0 * np.arange(count)
    transforms[1::2, 1, 1] = -1.0
    return transforms


def rays_at(transforms: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns a ray from z = 5 at a point inside each tetrahedron."""
    rays = np.zeros((len(transforms), 8))
    rays[:, :3] = (transforms @ [0.2, 0.3, 0.1, 1.0])[:, :3]
    rays[:, 2] = 5.0
    rays[:, 6] = -1.0
    rays[:, 7] = np.inf
    return rays


@pytest.mark.parametrize("instances", ["none", "all"])
@pytest.mark.parametrize("center", [0.0, 1e7])
def test_instances_are_objects_with_their_own_numbers(instances: str, center: float) -> None:
    scene = promin.Scene()
    scene.add_sphere((0, -9, 0))
    first = scene.add_triangles(VERTICES + (center, 0, 0), FACES, name="tetrahedron")
    # The transforms apply to the vertices as they were given.
    transforms = make_transforms(5, 3.0)
    numbers = scene.add_instances(first, transforms)
    assert numbers == range(2, 7)
    assert scene.add_sphere((0, 9, 0)) == 7
    assert [each.name for each in scene.objects][1:7] == ["tetrahedron"] * 6
    rays = rays_at(np.concatenate([np.eye(4)[None], transforms]))
    rays[:, 0] += center
    hits = promin.Caster(scene, instances=instances).cast(rays)
    assert hits["object"].tolist() == [1, *numbers]
    assert (hits["primitive"] == 3).all()
    points = scene.positions(rays, hits)
    assert np.abs(points[:, 2] - (1 - 0.2 - 0.3)).max() < 1e-7, "in float64"


def test_instances_of_instances_and_of_shapes() -> None:
    scene = promin.Scene()
    ball = scene.add_sphere()
    more = scene.add_instances(ball, make_transforms(2, 3.0))
    last = scene.add_instances(more[0], make_transforms(1, 30.0))
    assert (list(more), list(last)) == ([1, 2], [3])
    rays = rays_at(make_transforms(1, 30.0))
    assert promin.Caster(scene).cast(rays)["object"][0] == 3
    twin = pickle.loads(pickle.dumps(scene))
    assert [each.primitive_count for each in twin.objects] == [1] * 4
    assert not scene.add_instances(ball, np.zeros((0, 4, 4)))


ONE = make_transforms(1)


@pytest.mark.parametrize("wrong", [(5, ONE), (-1, ONE), (True, ONE), (0, np.eye(4))])
def test_wrong_instances_are_refused(wrong: Any) -> None:
    scene = promin.Scene()
    scene.add_sphere()
    with pytest.raises(promin.UsageError):
        scene.add_instances(*wrong)
    with pytest.raises(promin.UsageError):
        promin.Caster(scene, instances="some")


def make_scene(transforms: NDArray[np.float64], center: float) -> promin.Scene:
    """Returns a scene with tetrahedra at these transforms, of which the last is not an instance, and a ball."""
    scene = promin.Scene(center=(center, 0, 0))
    first = scene.add_triangles(VERTICES, FACES, transform=transforms[0])
    scene.add_instances(first, transforms[1:-1])
    scene.add_triangles(VERTICES, FACES, transform=transforms[-1])
    scene.add_sphere((center, 0, -5), 0.5)
    return scene


@pytest.mark.parametrize("instances", ["none", "all"])
@pytest.mark.parametrize("center", [0.0, 1e7])
def test_moved_objects_have_the_hits_of_a_new_caster(instances: str, center: float) -> None:
    transforms = make_transforms(6, center)
    caster = promin.Caster(make_scene(transforms, center), instances=instances)
    for moved in ({2: 4.0}, {0: -2.0, 4: 1.0, 5: 3.0}):
        for number, y in moved.items():
            transforms[number, 1, 3] = y
        caster.update(transforms={number: transforms[number] for number in moved})
        rays = rays_at(transforms)
        hits = caster.cast(rays)
        assert hits["object"].tolist() == list(range(6))
        assert (hits == promin.Caster(make_scene(transforms, center), instances=instances).cast(rays)).all()
    again = pickle.loads(pickle.dumps(caster))
    assert (again.cast(rays) == hits).all()


def test_moved_objects_in_pictures() -> None:
    transforms = make_transforms(6)
    view = promin.View(size=(48, 16), camera=promin.Camera(eye=(7, 0, 30)))
    renderer = promin.Renderer(make_scene(transforms, 0.0), instances="all", light="headlight", aovs=("object",))
    lamp = promin.Light(position=(0, 9, 9), diffuse=(1, 0, 0))
    renderer.update(lights=[lamp])
    before = renderer.render(view)
    transforms[[1, 5], 1, 3] = 2.0
    # The sphere is not an instance, so the tree is built again.
    for moved in ({1: transforms[1], 5: transforms[5]}, {6: np.eye(4)}):
        renderer.update(transforms=moved)
    frame = renderer.render(view)
    fresh = promin.Renderer(make_scene(transforms, 0.0), instances="all", light="headlight", aovs=("object",))
    fresh.update(lights=[lamp])
    assert (frame.rgb == fresh.render(view).rgb).all() and (frame.rgb != before.rgb).any()
    assert (pickle.loads(pickle.dumps(renderer)).render(view).rgb == frame.rgb).all()


@pytest.mark.parametrize(
    ("wrong", "error"),
    [
        ({7: np.eye(4)}, promin.UsageError),
        ({-1: np.eye(4)}, promin.UsageError),
        ({"ball": np.eye(4)}, promin.UsageError),
        ({1: np.eye(3)}, promin.UsageError),
        ({1: np.zeros((4, 4))}, promin.InputError),
        ({1: np.full((4, 4), np.nan)}, promin.InputError),
        # A sphere is not an instance, and this transform distorts it.
        ({6: np.diag([1.0, 2.0, 3.0, 1.0])}, promin.InputError),
    ],
)
def test_wrong_transforms_change_nothing(wrong: Any, error: type[promin.Error]) -> None:
    transforms = make_transforms(6)
    scene = make_scene(transforms, 0.0)
    caster = promin.Caster(scene, instances="all")
    renderer = promin.Renderer(scene, instances="all")
    view = promin.View(size=(16, 16))
    before = renderer.render(view)
    with pytest.raises(error):
        caster.update(transforms={2: transforms[3], **wrong})
    with pytest.raises(error):
        renderer.update(transforms={2: transforms[3], **wrong}, lights=[promin.Light()])
    assert caster.cast(rays_at(transforms))["object"].tolist() == list(range(6))
    assert (renderer.render(view).rgb == before.rgb).all()
