# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Tests that the code in README.md and docs/python.md can be pasted, that the tutorial works as written, and that the
examples run."""

from __future__ import annotations

import os
import re
import runpy
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from conftest import REPOSITORY

import promin


@pytest.mark.parametrize("document", ["README.md", pytest.param("docs/python.md", marks=pytest.mark.long)])
def test_code_in_documents_works(document: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    blocks = re.findall(r"```python\n(.*?)```", (REPOSITORY / document).read_text(), re.DOTALL)
    assert blocks
    (tmp_path / "scenes").symlink_to(REPOSITORY / "scenes")
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    for block in blocks:
        exec(compile(block, document, "exec"), names)
    assert (tmp_path / "showcase.png").exists()


def test_rays_of_the_manual_hit(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    found = re.search(r"```python\n(import numpy\n.*?)```", (REPOSITORY / "docs/usage.md").read_text(), re.DOTALL)
    assert found
    monkeypatch.chdir(tmp_path)
    exec(compile(found[1], "docs/usage.md", "exec"), {})
    scene = promin.Scene.load(REPOSITORY / "scenes/sphere.gltf")
    rays = np.load("rays.npy")
    assert rays.shape == (100, 8) and (rays[:, 3] < rays[:, 7]).all()
    assert (promin.Caster(scene).cast(rays)["object"] >= 0).any()


@pytest.mark.long
def test_tutorial_works_as_it_stands(tmp_path: Path) -> None:
    document = (REPOSITORY / "docs/tutorial.md").read_text()
    program = Path(os.environ.get("PROMIN_PROGRAM", REPOSITORY / "build/release/bin/promin"))
    folders = [str(program.parent), str(Path(sys.executable).parent), os.environ["PATH"]]
    environment = {**os.environ, "PATH": os.pathsep.join(folders)}
    for language, block in re.findall(r"^```(\w+)\n(.*?)^```", document, re.MULTILINE | re.DOTALL):
        if name := re.match(r"# (\w+\.\w+)\n", block):
            (tmp_path / name[1]).write_text(block)
        elif language == "sh":
            subprocess.run(["bash", "-e", "-c", block], cwd=tmp_path, env=environment, check=True)
    pictures = re.findall(r"\(tutorial/([^)]*)\)", document)
    assert len(pictures) == 9
    for name in pictures:
        made, shown = promin.read_image(tmp_path / name), promin.read_image(REPOSITORY / "docs/tutorial" / name)
        assert made.shape == shown.shape and np.abs(made - shown).mean() < 0.01, name


def run_example(name: str, monkeypatch: pytest.MonkeyPatch, *words: object) -> None:
    monkeypatch.setattr(sys, "argv", [name, *map(str, words)])
    runpy.run_path(str(REPOSITORY / "python/examples" / name), run_name="__main__")


def test_examples(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    cloud, thickness, sheet = tmp_path / "cloud.ply", tmp_path / "thickness.npy", tmp_path / "sheet.png"
    run_example(
        "lidar.py", monkeypatch, REPOSITORY / "scenes/showcase.gltf", "-o", cloud, "--picture", tmp_path / "c.png"
    )
    assert cloud.stat().st_size > 10000 and (tmp_path / "c.png").exists()
    scene = REPOSITORY / "scenes/sphere.gltf"
    run_example("thickness.py", monkeypatch, scene, "-o", thickness, "--picture", tmp_path / "t.png", "--columns", 65)
    assert np.load(thickness).max() == pytest.approx(2.0, rel=1e-3)  # The scene's only ball has a radius of 1.
    run_example("turntable.py", monkeypatch, REPOSITORY / "scenes/box.gltf", "-o", sheet, "--views", 3)
    assert promin.read_image(sheet).shape == (400, 400, 3)
