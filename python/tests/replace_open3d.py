# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""A pytest plugin that lets Open3D's test_raycasting_scene.py test promin's class (test_open3d.py)."""

from __future__ import annotations

import sys
import types
from collections.abc import Generator
from typing import Any

import open3d
import pytest

from promin.compat.open3d import RaycastingScene

Theirs = open3d.t.geometry.RaycastingScene


class WithTheirPoints(RaycastingScene):
    """The class for a test that casts rays and finds closest points. Open3D's own class finds the closest points."""

    def __init__(self) -> None:
        super().__init__()
        self._theirs = Theirs()
        for name in ("compute_closest_points", "compute_distance", "compute_signed_distance"):
            setattr(self, name, getattr(self._theirs, name))

    def add_triangles(self, vertex_positions: Any, triangle_indices: Any = None) -> int:
        self._theirs.add_triangles(vertex_positions, triangle_indices)
        return super().add_triangles(vertex_positions, triangle_indices)


# Replaces a helper module of Open3D's tests, which is in the folder of its tests.
helpers = types.ModuleType("open3d_test")
helpers.__dict__["list_devices"] = lambda **_: [open3d.core.Device("CPU:0")]
sys.modules["open3d_test"] = helpers


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item: pytest.Function) -> Generator[None, Any, Any]:
    asks_for_both = item.originalname == "test_output_shapes"
    open3d.t.geometry.RaycastingScene = WithTheirPoints if asks_for_both else RaycastingScene
    try:
        return (yield)
    except NotImplementedError as error:
        pytest.skip(str(error))
