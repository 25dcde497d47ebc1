# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Makes a venv with promin, the packages that its tests need, and trimesh's own tests. If the venv exists, only updates
promin.

    make_venv.py VENV --build FOLDER [--library BUILD] [--compiler CXX]

With --library the module is built over the libraries of that build, and nothing is done if no source is newer than the
last installation. Without it, the libraries are built too. The script needs python3-venv, python3-dev and PyPI."""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tarfile
import time
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
NEEDED = ["numpy", "nanobind>=2.4", "scikit-build-core>=0.11"]
# Files that are installed, or compiled into the module.
PACKAGE_SOURCES = ("CMakeLists.txt", "LICENSE", "README", "app/", "cmake/", "engine/", "include/", "pyproject.toml", "python/")
FARM_WITH = ["distributed", "dask-jobqueue", "zarr"]
TESTS_WITH = [
    *FARM_WITH,
    "pytest",
    "hypothesis",
    "mypy",
    "scipy",
    "rtree",
    "networkx",
    "shapely",
    "manifold3d",
    "trimesh",
]


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("venv", type=Path)
    parser.add_argument("--build", type=Path, required=True)
    parser.add_argument("--library", type=Path)
    parser.add_argument("--compiler")
    options = parser.parse_args()
    stamp = options.venv / "installed"
    start = time.time()
    if options.library is not None and is_newest(stamp, options.library):
        return
    python = options.venv / "bin/python"
    if not python.exists():
        made = subprocess.run([sys.executable, "-m", "venv", options.venv], capture_output=True, text=True)
        if made.returncode != 0:
            sys.exit(f"no venv can be made; run: apt install python3-venv python3-dev\n{made.stdout}{made.stderr}")
    pip = [str(python), "-m", "pip", "--disable-pip-version-check", "--quiet"]
    run([*pip, "install", *NEEDED, *([] if options.library is None else TESTS_WITH)])
    settings = [f"build-dir={options.build}"]
    if options.library is not None:
        settings += ["cmake.source-dir=python", f"cmake.define.PROMIN_BUILD={options.library}"]
    words = [f"--config-settings={setting}" for setting in settings]
    # The compiler has the same name as in the project's own build, so that ccache finds what it has compiled.
    environment = {**os.environ, **({"CXX": options.compiler} if options.compiler else {})}
    run([*pip, "install", "--no-build-isolation", "--no-deps", *words, str(REPOSITORY)], environment)
    run([str(python), "-c", "import promin; print('promin', promin.__version__)"])
    if options.library is not None and not (options.venv / "trimesh").exists():
        fetch_trimesh_tests(pip, options.venv)
    stamp.touch()
    # The stamp gets the time of the start, so that a source that changes during the installation is newer.
    os.utime(stamp, (start, start))


def is_newest(stamp: Path, library: Path) -> bool:
    """Returns whether the stamp exists and is newer than every source of the package and every library of the build."""
    if not stamp.exists():
        return False
    listed = subprocess.run(["git", "ls-files"], cwd=REPOSITORY, capture_output=True, text=True)
    sources = [REPOSITORY / name for name in listed.stdout.splitlines() if name.startswith(PACKAGE_SOURCES)]
    libraries = [*library.glob("*/*.a"), *library.glob("lib/*/*")]
    files = [file for file in sources + libraries if file.is_file()]
    return listed.returncode == 0 and max(file.stat().st_mtime for file in files) < stamp.stat().st_mtime


def fetch_trimesh_tests(pip: list[str], venv: Path) -> None:
    """Copies trimesh's tests from its source distribution to VENV/trimesh/tests."""
    downloads = venv / "downloads"
    run([*pip, "download", "--no-deps", "--no-binary", ":all:", "-d", str(downloads), "trimesh"])
    (archive,) = downloads.glob("trimesh-*.tar.gz")
    folder = venv / "trimesh/tests"
    folder.mkdir(parents=True)
    with tarfile.open(archive) as tar:
        for member in tar.getmembers():
            name = Path(member.name)
            if member.isfile() and name.parent.name == "tests" and name.name.startswith("test_ray"):
                stream = tar.extractfile(member)
                assert stream is not None
                (folder / name.name).write_bytes(stream.read())


def run(words: list[str], environment: dict[str, str] | None = None) -> None:
    done = subprocess.run(words, env=environment)
    if done.returncode != 0:
        sys.exit(f"failed: {' '.join(words)}")


if __name__ == "__main__":
    main()
