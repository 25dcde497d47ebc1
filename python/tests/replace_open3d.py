# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""A plugin of pytest's that has Open3D's test_raycasting_scene.py test promin's class (test_open3d.py)."""

from __future__ import annotations

import sys
import types
from collections.abc import Generator
from typing import Any

import open3d
import pytest

from promin.compat.open3d import RaycastingScene

open3d.t.geometry.RaycastingScene = RaycastingScene
# Their helper, which is beside their file.
helpers = types.ModuleType("open3d_test")
helpers.__dict__["list_devices"] = lambda **_: [open3d.core.Device("CPU:0")]
sys.modules["open3d_test"] = helpers


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call() -> Generator[None, Any, Any]:
    try:
        return (yield)
    except NotImplementedError as error:
        pytest.skip(str(error))
