# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Tests of the farm with the installed promin. Its files equal those of one process, whichever processes are killed."""

from __future__ import annotations

import json
import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from conftest import HERE, wait_for

SCENES = HERE.parents[1] / "scenes"
PROGRAM = Path(os.environ.get("PROMIN_PROGRAM", HERE.parents[1] / "build/release/bin/promin"))
ENVIRONMENT = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}


def start(folder: Path, *words: object) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-m", "promin_farm", *map(str, words)],
        cwd=folder,
        env=ENVIRONMENT,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )


@pytest.fixture(autouse=True)
def needs_promin(tmp_path: Path) -> None:
    pytest.importorskip("distributed")
    words = [sys.executable, "-c", "import promin_farm, promin.jobs"]
    if subprocess.run(words, cwd=tmp_path, env=ENVIRONMENT, capture_output=True).returncode != 0:
        pytest.skip("promin is not installed in this Python")
    if not PROGRAM.exists():
        pytest.skip(f"{PROGRAM} is not built")


def of_one_process(folder: Path, *words: object) -> None:
    subprocess.run([str(PROGRAM), *map(str, words), "--quiet"], cwd=folder, check=True, timeout=1200)


def workers_of(job: Path) -> list[int]:
    pids = [json.loads(file.read_text())["pid"] for file in job.glob("farm/workers/*.json")]
    return [pid for pid in pids if Path(f"/proc/{pid}/cmdline").exists()]


def done_of(job: Path) -> list[int]:
    lines = [json.loads(line) for file in job.glob("ledger/*.jsonl") for line in file.read_text().splitlines()]
    return [line["number"] for line in lines if line["event"] == "done"]


def made_of(job: Path) -> list[int]:
    """Returns the pieces that the ledgers report as made, or as begun by a process that was killed. Such a process may
    have written the piece but not its line in the ledger; the piece is then not made again."""
    ends = [json.loads(file.read_text().splitlines()[-1]) for file in job.glob("ledger/*.jsonl")]
    return done_of(job) + [line["number"] for line in ends if line["event"] == "begun"]


def kill_a_worker(job: Path, dice: random.Random) -> bool:
    pids = workers_of(job)
    if pids:
        os.kill(dice.choice(pids), signal.SIGKILL)
    return bool(pids)


def test_a_picture_in_tiles_whose_worker_is_killed(tmp_path: Path) -> None:
    job = tmp_path / "job"
    common = (SCENES / "showcase.gltf", "--size", 96, 54, "-o", "out.exr", "-o", "out.png")
    process = start(tmp_path, "render", *common, "--tiles", 4, 3, "--job", job, "--workers", 1)
    wait_for(lambda: done_of(job), 60)
    is_killed = kill_a_worker(job, random.Random(1))
    out, err = process.communicate(timeout=120)
    assert process.returncode == 0 and is_killed, (out, err)
    (tmp_path / "one").mkdir()
    of_one_process(tmp_path / "one", "render", *common)
    for name in ("out.exr", "out.png"):
        assert (tmp_path / name).read_bytes() == (tmp_path / "one" / name).read_bytes()
    assert sorted(set(made_of(job))) == list(range(12)) and len(list((job / "pieces").glob("*.piece"))) == 12
    assert "12 of 12 pieces" in (job / "index.html").read_text() and len(list(job.glob("farm/pictures/*.png"))) == 12


def run_under_fire(folder: Path, job: Path, mean_pieces: float, *words: object) -> int:
    """Kills workers, and the command itself, until the job is done. Returns the number of kills. About `mean_pieces`
    pieces are made between two kills on average, so the number of kills does not depend on the machine's speed, and
    every process makes something before it is killed."""
    dice = random.Random(2)
    killed = 0
    process = start(folder, *words, "--job", job, "--workers", 2)
    next_kill = 1.0
    until = time.monotonic() + 1500
    while True:
        time.sleep(0.05)
        assert time.monotonic() < until
        if process.poll() is not None:
            out, err = process.communicate()
            assert process.returncode in (0, -signal.SIGKILL), (out, err)
            if process.returncode == 0:
                return killed
            process = start(folder, "resume", job, "--workers", 2)
        elif len(done_of(job)) >= next_kill:
            if dice.random() < 0.1:
                process.kill()
                killed += 1
            else:
                killed += kill_a_worker(job, dice)
            next_kill = len(done_of(job)) + 1 + dice.expovariate(1.0 / mean_pieces)


@pytest.mark.long
def test_an_animation_under_fire(tmp_path: Path) -> None:
    """A film of 240 small frames."""
    poses = [{"time_s": 9.56 * n, "eye": [4 - 8 * n, 2, 8], "look": [n - 0.5, -0.2, -1]} for n in (0, 1)]
    frames = [{**pose, "up": [0, 1, 0], "fov_deg": 45} for pose in poses]
    path = tmp_path / "path.json"
    path.write_text(json.dumps({"format": "promin camera path", "version": 1, "fps": 25, "frames": frames}))
    common = (SCENES / "showcase.gltf", "--size", 64, 36, "--path", path, "--frames", "0-239")
    killed = run_under_fire(tmp_path, tmp_path / "job", 12.0, "render", *common, "-o", "f.####.exr")
    (tmp_path / "one").mkdir()
    of_one_process(tmp_path / "one", "render", *common, "-o", "f.####.exr")
    files = sorted((tmp_path / "one").glob("f.*.exr"))
    process = start(tmp_path, "audit", tmp_path / "job", "--share", "5%")
    assert "12 of 12 pieces of this fingerprint have equal bits" in process.communicate(timeout=300)[0]
    assert len(files) == 240 and killed >= 5
    assert all(file.read_bytes() == (tmp_path / file.name).read_bytes() for file in files)


@pytest.mark.long
def test_a_large_picture_under_fire(tmp_path: Path) -> None:
    """A picture of 64 tiles."""
    common = (SCENES / "showcase.gltf", "--size", 1920, 1080, "--spp", 16, "-o", "out.exr")
    killed = run_under_fire(tmp_path, tmp_path / "job", 5.0, "render", *common, "--tiles", 8, 8)
    (tmp_path / "one").mkdir()
    of_one_process(tmp_path / "one", "render", *common)
    assert (tmp_path / "out.exr").read_bytes() == (tmp_path / "one/out.exr").read_bytes() and killed >= 5


@pytest.mark.long
def test_ten_million_rays_under_fire(tmp_path: Path) -> None:
    random_ = np.random.default_rng(3)
    rays = np.zeros((10_000_000, 8), np.float32)
    rays[:, 0:3] = (0, 2, 8)
    rays[:, 4:7] = random_.normal(size=(len(rays), 3))
    rays[:, 7] = np.inf
    np.save(tmp_path / "rays.npy", rays)
    common = (SCENES / "showcase.gltf", "rays.npy", "-o")
    killed = run_under_fire(tmp_path, tmp_path / "job", 4.0, "cast", *common, "hits.npy", "--pieces", 40)
    of_one_process(tmp_path, "cast", *common, "one.npy")
    is_equal = (tmp_path / "hits.npy").read_bytes() == (tmp_path / "one.npy").read_bytes()  # Too large for a message.
    assert is_equal and killed >= 5
