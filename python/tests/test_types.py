# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Tests that the whole package has types: mypy --strict, stubtest, and a comparison of the native module with its
stub."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import pytest

import promin
from promin import _promin

PACKAGE = Path(promin.__file__).parent


def run(folder: Path, *words: object) -> None:
    done = subprocess.run([sys.executable, *map(str, words)], cwd=folder, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stdout + done.stderr


def test_mypy_strict(tmp_path: Path) -> None:
    pytest.importorskip("mypy")
    use = tmp_path / "use.py"
    use.write_text(
        "import numpy as np\nimport promin\nscene = promin.Scene()\nnumber: int = scene.add_sphere((0, 0, 0), 1.0)\n"
        "hits = promin.Caster(scene).cast((np.zeros(3), np.ones((2, 3))))\nt: float = hits['t'][0]\n"
        "frame: promin.Frame = promin.Renderer(scene).render(size=(8, 8), aovs=('depth',))\n"
    )
    run(tmp_path, "-m", "mypy", "--strict", "-p", "promin")
    run(tmp_path, "-m", "mypy", "--strict", use)


@pytest.mark.long  # This test is long, because mypy reads NumPy's types without a cache.
def test_stubtest(tmp_path: Path) -> None:
    pytest.importorskip("mypy")
    allowed = Path(__file__).with_name("stubtest_allowlist.txt")
    # Some entries of the list apply only to some versions of NumPy, so unused entries are allowed.
    run(tmp_path, "-m", "mypy.stubtest", "promin", "--allowlist", allowed, "--ignore-unused-allowlist")


def test_the_native_stub_has_the_names_of_the_module() -> None:
    assert (PACKAGE / "py.typed").exists()
    tree = ast.parse((PACKAGE / "_promin.pyi").read_text())
    own = {n.name for n in tree.body if isinstance(n, (ast.FunctionDef, ast.ClassDef))} | {"__version__"}
    assert own == {name for name in dir(_promin) if not name.startswith("__")} | {"__version__"}
    for node in tree.body:
        if isinstance(node, ast.ClassDef):
            stubbed = {n.name for n in node.body if isinstance(n, ast.FunctionDef)} - {"__init__"}
            kind = getattr(_promin, node.name)
            assert stubbed == {name for name in vars(kind) if not name.startswith("_")}, node.name


def test_every_public_name_has_a_docstring() -> None:
    for name in promin.__all__:
        value = getattr(promin, name)
        if isinstance(value, type):
            assert value.__doc__, name
            for member, function in vars(value).items():
                if callable(function) and not member.startswith("_"):
                    assert function.__doc__, f"{name}.{member}"


def test_the_version_is_that_of_the_project() -> None:
    from importlib.metadata import version

    from conftest import REPOSITORY

    assert promin.__version__ == version("promin")
    assert f"project(promin VERSION {promin.__version__} " in (REPOSITORY / "CMakeLists.txt").read_text()
