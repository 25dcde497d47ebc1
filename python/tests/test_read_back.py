# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Tests that files of Frame.save can be read again: alpha from any format, all AOVs from an EXR."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from conftest import fails

import promin

AOVS = ("alpha", "cryptomatte", "depth", "error", "material", "normal", "object", "unlit", "uv")


@pytest.fixture(scope="module")
def frame(scenes: Path) -> promin.Frame:
    # The box has oblique edges, so it covers some pixels partly.
    return promin.render(scenes / "box.gltf", size=(48, 32), roll=10, aovs=AOVS)


def test_aovs_of_an_exr_come_back_bit_for_bit(frame: promin.Frame, tmp_path: Path) -> None:
    frame.save(tmp_path / "a.exr")
    back = promin.read_aovs(tmp_path / "a.exr")
    assert back.keys() == frame.aovs.keys() and len(back) == len(AOVS) + 1
    for name, values in frame.aovs.items():
        assert back[name].dtype == values.dtype and np.array_equal(back[name], values, equal_nan=True), name
    assert (promin.read_image(tmp_path / "a.exr") == frame.rgb).all()


@pytest.mark.parametrize("ending", ["png", "tif", "webp"])
def test_alpha_comes_back_with_colours_beside_it(frame: promin.Frame, ending: str, tmp_path: Path) -> None:
    frame.save(tmp_path / f"a.{ending}")
    back = promin.read_aovs(tmp_path / f"a.{ending}")
    assert back.keys() == {"alpha"}
    alpha = frame.aovs["alpha"]
    partly = (alpha > 0.3) & (alpha < 0.9)
    assert partly.sum() > 10 and np.abs(back["alpha"] - alpha).max() <= 0.5 / 255 + 1e-6
    if ending == "webp":
        return  # This format does not store colours exactly.
    straight = np.zeros_like(frame.rgb)
    straight[partly] = frame.rgb[partly] / alpha[partly][:, None]
    shown = promin.Frame(rgb=straight, aovs={}, metadata={}, display=frame.display).srgb()
    codes = np.round(promin.read_image(tmp_path / f"a.{ending}") * 255)
    assert np.abs(codes[partly] - shown[partly]).max() <= 1


def test_other_channels_have_their_own_names(frame: promin.Frame, tmp_path: Path) -> None:
    frame.save(tmp_path / "a.jpg")
    assert promin.read_aovs(tmp_path / "a.jpg") == {}
    with fails(promin.InputError, "file.missing"):
        promin.read_aovs(tmp_path / "none.png")
