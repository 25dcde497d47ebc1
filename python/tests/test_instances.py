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
