# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Fixtures of the farm's tests, which run on the fake promin in the folder `fake`. This folder is the first one on
Python's path."""

from __future__ import annotations

import hashlib
import json
import os
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

HERE = Path(__file__).resolve().parent
PATHS = [str(HERE / "fake"), str(HERE.parent)]
sys.path[:0] = PATHS


class Farm:
    """A folder with a scene, and the farm's commands for it."""

    def __init__(self, root: Path) -> None:
        self.root = root
        self.scene = root / "scene.json"
        self.job = root / "job"
        self.out = root / "out.exr"

    def write_scene(self, pieces: int, **values: Any) -> None:
        """Writes the scene, which describes the fake's pieces (fake/promin/jobs.py)."""
        self.values: dict[str, Any] = {"pieces": pieces, "ms": 0, "bytes": 100, "seed": 1, **values}
        self.scene.write_text(json.dumps(self.values))

    def expected(self) -> bytes:
        """Returns the bytes that one process would write."""
        size = self.values["bytes"]
        blocks = [hashlib.sha256(f"{self.values['seed']} {n} ".encode()).digest() for n in range(self.values["pieces"])]
        return b"".join((block * (size // 32 + 1))[:size] for block in blocks)

    def written(self) -> bytes:
        """Returns the content of the output, or of the numbered files of all frames, one after the other."""
        if "####" not in self.out.name:
            return self.out.read_bytes()
        return b"".join(file.read_bytes() for file in sorted(self.root.glob(self.out.name.replace("####", "*"))))

    def create(self) -> Any:
        """Creates the job without running it and returns it."""
        from promin import jobs

        return jobs.create("render", {"scene": str(self.scene)}, self.job)

    def environment(self, **values: str) -> dict[str, str]:
        return {**os.environ, "PYTHONPATH": os.pathsep.join(PATHS), **values}

    def start(self, *words: object, **environment: str) -> subprocess.Popen[str]:
        """Starts a command that runs beside the test, in a session of its own."""
        return subprocess.Popen(
            [sys.executable, "-m", "promin_farm", *map(str, words)],
            cwd=self.root,
            env=self.environment(**environment),
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,
        )

    def run(self, *words: object, code: int = 0, timeout: float = 120.0, **environment: str) -> str:
        """Runs a command, expects this exit code, and returns the command's output."""
        process = self.start(*words, **environment)
        try:
            out, err = process.communicate(timeout=timeout)
        except subprocess.TimeoutExpired:
            process.kill()
            raise
        assert process.returncode == code, (process.returncode, out, err)
        return out + err

    def render(self, *words: object, **options: Any) -> str:
        return self.run("render", self.scene, "-o", self.out, "--job", self.job, *words, **options)

    def status(self) -> dict[str, Any]:
        value: dict[str, Any] = json.loads(self.run("status", self.job, "--json"))
        return value

    def ledger(self) -> list[dict[str, Any]]:
        """Returns the lines of the ledgers of all processes."""
        lines = [line for file in self.job.glob("ledger/*.jsonl") for line in file.read_text().splitlines()]
        return [json.loads(line) for line in lines]

    def events(self, event: str) -> list[int]:
        """Returns the numbers of the pieces for which the ledgers have this event."""
        return [line["number"] for line in self.ledger() if line["event"] == event]

    def worker_pids(self) -> list[int]:
        """Returns the process ids of the workers that have reported their presence and are alive."""
        pids = [json.loads(file.read_text())["pid"] for file in self.job.glob("farm/workers/*.json")]
        return [pid for pid in pids if Path(f"/proc/{pid}/cmdline").exists()]


def wait_for(condition: Callable[[], object], timeout_s: float = 60.0) -> None:
    until = time.monotonic() + timeout_s
    while not condition():
        assert time.monotonic() < until
        time.sleep(0.02)


@pytest.fixture
def farm(tmp_path: Path) -> Farm:
    return Farm(tmp_path)
