# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Tests with workers of this machine and with real Dask clusters on it, whose processes are killed."""

from __future__ import annotations

import json
import os
import random
import re
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest
from conftest import Farm, wait_for


def kill_workers(farm: Farm, process: subprocess.Popen[str], mean_s: float, most: int) -> int:
    """Kills a worker at random times from the first finished piece until the command ends. Returns the number of killed
    workers."""
    dice = random.Random(1)
    killed = 0
    while process.poll() is None and not farm.events("done"):
        time.sleep(0.01)
    while process.poll() is None:
        time.sleep(dice.expovariate(1.0 / mean_s))
        pids = farm.worker_pids()
        if pids and killed < most and process.poll() is None:
            try:
                os.kill(dice.choice(pids), signal.SIGKILL)
                killed += 1
            except ProcessLookupError:
                pass
    return killed


def render_under_fire(
    farm: Farm, *words: object, mean_s: float, most: int, command: str = "render", **environment: str
) -> int:
    process = farm.start(command, farm.scene, "-o", farm.out, "--job", farm.job, *words, **environment)
    killed = kill_workers(farm, process, mean_s, most)
    out, err = process.communicate(timeout=60)
    assert process.returncode == 0, (out, err)
    assert farm.written() == farm.expected()
    return killed


def test_killed_workers_lose_nothing_and_all_have_their_seats(farm: Farm) -> None:
    farm.write_scene(30, ms=60)
    killed = render_under_fire(farm, mean_s=0.6, most=2, FAKE_GPUS="A B")
    made = farm.events("done")
    assert killed > 0 and set(made) == set(range(30))
    # A killed worker causes at most two repeated pieces: the one that it was making, and one whose answer was lost.
    assert len(made) <= 30 + 2 * killed
    assert "30 of 30 pieces" in (farm.job / "index.html").read_text()
    assert {line["made_on"] for line in farm.ledger() if line["event"] == "done"} == {"fake A", "fake B"}
    seats = [json.loads(file.read_text()) for file in farm.job.glob("farm/workers/*.json")]
    assert {seat["threads"] for seat in seats} == {str(max(1, len(os.sched_getaffinity(0)) // 2))}


@pytest.mark.long
@pytest.mark.parametrize("kind, pieces, names", [("render", 240, "frames"), ("render", 64, "y"), ("cast", 300, "y")])
def test_many_killed_workers_lose_nothing(farm: Farm, kind: str, pieces: int, names: str) -> None:
    farm.write_scene(pieces, ms=100, names=names)
    farm.out = farm.root / ("out.####.exr" if names == "frames" else "out.npy" if kind == "cast" else "out.exr")
    killed = render_under_fire(farm, "--workers", 2, mean_s=1.0, most=1000, command=kind)
    made = farm.events("done")
    assert killed >= 3 and set(made) == set(range(pieces)) and len(made) <= pieces + 2 * killed


def test_a_killed_command_is_resumed_beside_a_second_resume_and_work(farm: Farm) -> None:
    farm.write_scene(40, ms=50)
    process = farm.start("render", farm.scene, "-o", farm.out, "--job", farm.job, "--workers", "1")
    wait_for(lambda: len(farm.events("done")) > 4)
    workers = farm.worker_pids()
    process.kill()
    process.communicate()
    assert len(farm.events("done")) < 40
    both = [farm.start("resume", farm.job), farm.start("resume", farm.job), farm.start("work", farm.job)]
    for process in both:
        out, err = process.communicate(timeout=60)
        assert process.returncode == 0, (out, err)
    assert farm.out.read_bytes() == farm.expected()
    # Workers end when the command that started them ends.
    wait_for(lambda: not any(Path(f"/proc/{pid}").exists() for pid in workers), 60)


@pytest.mark.parametrize("count", [1, 2])
def test_ctrl_c_lets_pieces_be_made_and_a_second_one_leaves_them(farm: Farm, count: int) -> None:
    """Sends Ctrl-C as a terminal does: to the command and its workers."""
    farm.write_scene(40, ms=1500 if count == 1 else 60_000)
    process = farm.start("render", farm.scene, "-o", farm.out, "--job", farm.job, "--workers", 2)
    wait_for(lambda: len(farm.events("begun")) >= 2, 60)
    for _ in range(count):
        os.killpg(process.pid, signal.SIGINT)
        time.sleep(0.3)
    out, err = process.communicate(timeout=40)
    assert process.returncode == 1 and "resume" in err and "continues" in err, (out, err)
    made = 0 if count == 2 else len(farm.events("begun"))
    assert len(farm.events("done")) == made and not farm.events("failed")


def test_a_worker_that_cannot_run_the_farm_says_so() -> None:
    from promin_farm.crews import _refusal_of

    said = _refusal_of(ModuleNotFoundError("No module named 'promin_farm'"))
    assert said is not None and "No module named" in said["refused"] and "install" in said["refused"]


def test_threads_and_devices_are_dealt_out() -> None:
    from promin_farm.processes import Seat, count_cores, deal_seats

    cores = count_cores()
    assert deal_seats([], None) == [Seat(None, None)]
    assert deal_seats([], 2 * cores) == [Seat(None, 1)] * (2 * cores)
    assert [seat.device for seat in deal_seats(["A", "B"], None)] == ["A", "B"]
    assert [seat.device for seat in deal_seats(["A", "B"], 3)] == ["A", "B", "A"]
    assert Seat("uuid:1", 3).environment == {"PROMIN_DEVICE": "uuid:1", "LP_NUM_THREADS": "3"}


@pytest.mark.long
def test_without_a_device_it_ends_with_4(farm: Farm) -> None:
    farm.write_scene(4)
    assert "there is no Vulkan device" in farm.render("--workers", 2, code=4, FAKE_NO_DEVICE="1", timeout=30)


class Cluster:
    """Starts a scheduler and workers by hand, as users do on machines that share a folder."""

    def __init__(self, farm: Farm) -> None:
        self.farm = farm
        self.scheduler = self._start("scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard")
        assert self.scheduler.stderr is not None
        for line in self.scheduler.stderr:
            found = re.search(r"Scheduler at:\s*(tcp://\S+)", line)
            if found:
                self.address = found[1]
                break
        self.workers: list[subprocess.Popen[str]] = []

    def add_worker(self, **environment: str) -> None:
        words = ("worker", self.address, "--nthreads", "1", "--memory-limit", "0", "--no-dashboard")
        self.workers.append(self._start(*words, **environment))

    def _start(self, *words: str, **environment: str) -> subprocess.Popen[str]:
        return subprocess.Popen(
            [sys.executable, "-m", "distributed.cli.dask_" + words[0], *words[1:]],
            cwd=self.farm.root,
            env=self.farm.environment(**environment),
            stderr=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            text=True,
        )

    def close(self) -> None:
        for process in [*self.workers, self.scheduler]:
            process.terminate()
        for process in [*self.workers, self.scheduler]:
            try:
                process.wait(10)
            except subprocess.TimeoutExpired:
                process.kill()


@pytest.fixture
def cluster(farm: Farm):  # type: ignore[no-untyped-def]
    pytest.importorskip("distributed")
    cluster = Cluster(farm)
    yield cluster
    cluster.close()


@pytest.mark.long
def test_workers_of_a_cluster_with_one_that_gives_other_bits_and_one_without_a_device(
    farm: Farm, cluster: Cluster
) -> None:
    gate = farm.root / "gate"
    farm.write_scene(20, gate=str(gate))
    gate.touch()
    farm.create()
    farm.run("work", farm.job, "--array-task", "0/1")
    for piece in farm.create().pieces[5:]:
        Path(piece.file).unlink()
    gate.unlink()
    cluster.add_worker()
    cluster.add_worker(FAKE_FINGERPRINT="two")
    cluster.add_worker(FAKE_NO_DEVICE="1")
    process = farm.start("resume", farm.job, "-o", farm.out, "--scheduler", cluster.address)
    # The gate keeps the good worker at its first piece until the other workers have reported why they make no pieces.
    assert process.stderr is not None
    awaited = {"this worker gives other bits", "there is no Vulkan device"}
    # If a reason does not come, the gate opens later, and then the test fails.
    deadline = threading.Timer(120.0, gate.touch)
    deadline.start()
    for line in process.stderr:
        awaited = {words for words in awaited if words not in line}
        if not awaited:
            break
    deadline.cancel()
    gate.touch()
    out, err = process.communicate(timeout=60)
    assert process.returncode == 0 and not awaited, (out, err)
    assert farm.out.read_bytes() == farm.expected()
    assert len({line["fingerprint"] for line in farm.ledger()}) == 1


class Gone:
    """Returns a client whose scheduler has disappeared."""

    def nthreads(self) -> dict[str, int]:
        raise OSError("Timed out trying to connect")


def test_a_scheduler_that_has_gone_is_told(farm: Farm) -> None:
    from promin import jobs

    from promin_farm.crews import DaskCrew

    farm.write_scene(3)
    with pytest.raises(jobs.RunError, match=r"the connection to the scheduler is lost .*; finished pieces are kept"):
        DaskCrew(Gone(), farm.create(), 1.0).members()


@pytest.mark.long
def test_a_scheduler_that_goes_ends_the_run_and_resume_goes_on(farm: Farm, cluster: Cluster) -> None:
    farm.write_scene(60, ms=60)
    cluster.add_worker()
    words = ("render", farm.scene, "-o", farm.out, "--job", farm.job, "--scheduler", cluster.address)
    process = farm.start(*words)
    wait_for(lambda: farm.events("done"))
    cluster.scheduler.kill()
    out, err = process.communicate(timeout=60)
    assert process.returncode == 1, err
    assert "the connection to the scheduler is lost" in err and "promin-farm resume continues" in err, err
    assert farm.status()["done"] < 60
    farm.run("resume", farm.job, "--workers", 2)
    assert farm.out.read_bytes() == farm.expected()


@pytest.mark.long
def test_where_no_scheduler_answers(farm: Farm) -> None:
    farm.write_scene(3)
    said = farm.render("--scheduler", "tcp://127.0.0.1:1", code=1, timeout=60)
    assert "the scheduler does not respond" in said and "tcp://127.0.0.1:1" in said


@pytest.mark.long
def test_many_small_pieces_take_little_memory(farm: Farm) -> None:
    farm.write_scene(20_000)
    process = farm.start("render", farm.scene, "-o", farm.out, "--job", farm.job, "--workers", 2)
    most_kib = 0
    while process.poll() is None:
        found = re.search(r"VmHWM:\s+(\d+) kB", Path(f"/proc/{process.pid}/status").read_text())
        most_kib = max(most_kib, int(found[1]) if found else 0)
        time.sleep(0.2)
    process.communicate()
    assert process.returncode == 0 and farm.out.read_bytes() == farm.expected()
    assert 20_000 < most_kib < 500_000


def test_fewer_pieces_than_workers_are_told(farm: Farm) -> None:
    farm.write_scene(1)
    said = farm.render("--workers", 2)
    assert "1 of 1 piece to make, by 2 workers on this machine" in said
    assert "1 piece for 2 workers: some workers get no work; " in said and said.startswith("1 piece: ")
    farm.write_scene(2)
    farm.job = farm.job.with_name("other")
    assert "some workers get no work" not in farm.render("--workers", 2)


def test_workers_tell_what_they_are_at(farm: Farm) -> None:
    farm.write_scene(4)
    said = farm.render("--workers", 1)
    lines = [line.split(" ", 2)[2] for line in said.splitlines() if line.startswith("promin-farm: ")]
    assert lines[0].startswith("of 4 pieces to make, by 1 worker on this machine")
    assert lines[1:5] == ["loads the scene", "compiles", "checks its device", "makes pieces"], said
    Path(farm.create().pieces[0].file).unlink()
    assert "this process compiles" in farm.run("work", farm.job)
    Path(farm.create().pieces[0].file).unlink()
    assert farm.run("resume", farm.job, "--quiet") == ""
