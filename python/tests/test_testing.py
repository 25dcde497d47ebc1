# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path
from typing import Callable

import numpy as np
import pytest
from conftest import REPOSITORY

import promin
from promin import testing


@pytest.fixture(scope="module")
def frame() -> promin.Frame:
    scene = promin.Scene()
    scene.add_sphere()
    return promin.Renderer(scene, background="linear:0.2,0.2,0.2").render(size=(32, 24))


@pytest.mark.parametrize("ending", ["exr", "png"])
def test_a_picture_is_held_against_its_baseline(
    frame: promin.Frame, ending: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    baseline = tmp_path / f"ball.{ending}"
    with pytest.raises(promin.InputError, match="PROMIN_UPDATE_BASELINES=1"):
        testing.assert_same_picture(frame, baseline)
    monkeypatch.setenv("PROMIN_UPDATE_BASELINES", "1")
    testing.assert_same_picture(frame, baseline)
    monkeypatch.setenv("PROMIN_UPDATE_BASELINES", "0")
    testing.assert_same_picture(frame, baseline)
    other = frame.rgb.copy()
    other[7, 5] += 0.25
    with pytest.raises(
        promin.DifferenceError, match="1 pixel differs by more than 0.01, with the largest difference at pixel 5 7"
    ) as caught:
        testing.assert_same_picture(promin.Frame(other, {}, {}, frame.display), baseline, fail=0.01)
    assert isinstance(caught.value, AssertionError)
    assert (promin.read_image(tmp_path / "ball.actual.exr") == other).all()
    assert (tmp_path / "ball.difference.png").exists()
    testing.assert_same_picture(promin.Frame(other, {}, {}, frame.display), baseline, fail=0.01, fail_percent=1.0)


def test_a_device_may_have_a_baseline_of_its_own(frame: promin.Frame, tmp_path: Path) -> None:
    device = promin.Device()
    baseline = tmp_path / "ball.exr"
    testing.assert_same_picture(frame.rgb + np.float32(1), baseline, update=True)
    with pytest.raises(promin.DifferenceError):
        testing.assert_same_picture(frame, baseline, device=device)
    testing.assert_same_picture(frame, baseline, device=device, update=True)
    testing.assert_same_picture(frame, baseline, device=device)
    assert (tmp_path / f"ball.{testing.fingerprint(device)}.exr").exists()


def test_the_figures_are_those_of_promin_compare(
    frame: promin.Frame, tmp_path: Path, run_promin: Callable[..., None]
) -> None:
    other = frame.rgb * np.float32(1.01)
    promin.write_image(tmp_path / "a.exr", frame.rgb)
    promin.write_image(tmp_path / "b.exr", other)
    found = testing.compare(frame, other, fail=0.005)
    assert 0 < found.different_count < found.pixel_count == 32 * 24
    program = os.environ.get("PROMIN_PROGRAM", str(REPOSITORY / "build/release/bin/promin"))
    done = subprocess.run(
        [program, "compare", tmp_path / "a.exr", tmp_path / "b.exr", "--json", "--fail", "1"],
        capture_output=True,
        check=True,
    )
    told = json.loads(done.stdout)
    for name in ("mean", "rmse", "flip", "largest", "psnr_db"):
        assert getattr(found, name) == pytest.approx(told[name])
    assert testing.compare(tmp_path / "a.exr", frame).psnr_db == np.inf
    with pytest.raises(promin.InputError):
        testing.compare(frame, other[:4])
