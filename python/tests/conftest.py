# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Fixtures that the tests share: scenes of the repository, the program for comparisons, a box."""

from __future__ import annotations

import contextlib
import os
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Callable, Iterator, Optional

import numpy as np
import pytest
from numpy.typing import NDArray

import promin
from promin._device import find_device

REPOSITORY = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session", autouse=True)
def default_device() -> Iterator[Optional[promin.Device]]:
    """The default device, or None if there is none. It stays open for all tests, so that kernels that one test compiled
    serve the next."""
    try:
        yield find_device(None)
    except promin.DeviceError:
        yield None


@pytest.fixture(scope="session")
def scenes() -> Path:
    return REPOSITORY / "scenes"


@pytest.fixture(scope="session")
def run_promin() -> Callable[..., None]:
    """Runs the program promin, which PROMIN_PROGRAM names or the release build holds."""
    program = Path(os.environ.get("PROMIN_PROGRAM", REPOSITORY / "build/release/bin/promin"))
    if not program.exists():
        pytest.skip(f"{program} is not built")

    def run(*words: object) -> None:
        subprocess.run([str(program), *map(str, words), "--quiet"], check=True, timeout=300)

    return run


@contextlib.contextmanager
def fails(kind: type[promin.Error], code: str, *words: str) -> Iterator[pytest.ExceptionInfo[promin.Error]]:
    """Expects an error with a problem of this code. The problem's sentence must contain the words."""
    with pytest.raises(kind) as caught:
        yield caught
    problems = caught.value.problems
    assert any(problem.code == code and all(word in str(problem) for word in words) for problem in problems), problems


def make_box(center: object = (0, 0, 0), size: float = 2.0) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Returns the corners and faces of a cube. The corners of a face run counter-clockwise as seen from outside."""
    bits = np.array([[i & 1, i >> 1 & 1, i >> 2 & 1] for i in range(8)], np.float64)
    quads = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]
    faces = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    return (bits - 0.5) * size + np.asarray(center, np.float64), np.array(faces)


@pytest.fixture
def box() -> promin.Scene:
    """Returns a scene with a cube of edge 2 around the origin."""
    scene = promin.Scene()
    scene.add_triangles(*make_box())
    return scene


@pytest.fixture(scope="session")
def box_caster() -> promin.Caster:
    scene = promin.Scene()
    scene.add_triangles(*make_box())
    return promin.Caster(scene)


def make_rays(count: int, seed: int = 1, spread: float = 3.0) -> NDArray[np.float32]:
    """Returns random rays that start around the origin and run towards it."""
    random = np.random.default_rng(seed)
    rays = np.zeros((count, 8), np.float32)
    rays[:, 0:3] = spread * random.normal(size=(count, 3))
    rays[:, 4:7] = random.normal(size=(count, 3)) - rays[:, 0:3]
    rays[:, 7] = np.inf
    return rays
