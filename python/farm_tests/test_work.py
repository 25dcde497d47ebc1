# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Tests of `promin-farm work`, which does the same work without Dask, for any queue."""

from __future__ import annotations

import hashlib
import json
import os
import signal
import socket
import time
from pathlib import Path

import pytest
from conftest import Farm, wait_for


def test_tasks_of_an_array_share_the_pieces_and_take_what_others_leave(farm: Farm) -> None:
    farm.write_scene(30)
    assert "30 pieces in" in farm.render("--prepare") and not farm.ledger()
    said = farm.run("work", farm.job, "--array-task", "1/3")
    # The task makes its own third first. Then it makes all other pieces, because no other task runs, starting from its
    # position in the list.
    made = farm.events("done")
    assert made[:10] == list(range(1, 30, 3)) and made[10] == 11 and sorted(made) == list(range(30))
    assert "30 pieces made; all pieces are made" in said
    assert "0 pieces made" in farm.run("work", farm.job, "--array-task", "0/3")
    assert farm.run("resume", farm.job).strip().endswith(f"30 pieces: {farm.out}")
    assert farm.out.read_bytes() == farm.expected()


def test_two_at_once_make_each_piece_once(farm: Farm) -> None:
    farm.write_scene(40, ms=50)
    farm.create()
    both = [farm.start("work", farm.job, "--array-task", f"{i}/2") for i in range(2)]
    for process in both:
        assert process.wait(60) == 0
    made = farm.events("done")
    assert sorted(set(made)) == list(range(40)) and len(made) <= 42


def test_what_a_killed_one_has_begun_is_made_by_the_other(farm: Farm) -> None:
    farm.write_scene(12, ms=150)
    farm.create()
    first = farm.start("work", farm.job, "--array-task", "0/2")
    wait_for(lambda: farm.events("begun"))
    first.kill()
    first.wait()
    (at_hand,) = set(farm.events("begun")) - set(farm.events("done"))
    farm.run("work", farm.job, "--array-task", "1/2")
    assert at_hand in farm.events("done")
    status = farm.status()
    assert status["done"] == 12 and status["tries"][farm.create().pieces[at_hand].name]["deaths"] == 1


def test_what_another_is_at_is_left_to_it(farm: Farm) -> None:
    farm.write_scene(2, ms=300)
    farm.create()
    first = farm.start("work", farm.job, "--array-task", "0/2")
    wait_for(lambda: farm.events("begun"))
    first.send_signal(signal.SIGSTOP)  # The process is alive but does not continue.
    try:
        said = farm.run("work", farm.job, "--array-task", "1/2")
    finally:
        first.send_signal(signal.SIGCONT)
    assert "1 piece made; 1 of 2 are missing or made by others" in said
    assert first.wait(30) == 0 and sorted(farm.events("done")) == [0, 1] == sorted(farm.events("begun"))


def test_a_signal_lets_the_piece_at_hand_be_made(farm: Farm) -> None:
    farm.write_scene(10, ms=300)
    farm.create()
    process = farm.start("work", farm.job)
    wait_for(lambda: farm.events("begun"))
    process.send_signal(signal.SIGTERM)
    out, err = process.communicate(timeout=20)
    assert process.returncode == 1 and f"promin-farm work {farm.job} continues" in err
    assert farm.events("begun") == farm.events("done") and len(farm.events("done")) == 1


def test_two_signals_leave_it(farm: Farm) -> None:
    farm.write_scene(3, ms=20000)
    farm.create()
    process = farm.start("work", farm.job)
    wait_for(lambda: farm.events("begun"))
    for _ in range(2):
        process.send_signal(signal.SIGINT)
        time.sleep(0.2)
    process.communicate(timeout=10)
    assert process.returncode == 1 and farm.events("stopped") == [0] and not farm.events("done")


def test_slurms_array_tells_the_share(farm: Farm) -> None:
    farm.write_scene(9)
    farm.create()
    array = {"SLURM_ARRAY_TASK_ID": "6", "SLURM_ARRAY_TASK_MIN": "2", "SLURM_ARRAY_TASK_STEP": "2"}
    farm.run("work", farm.job, SLURM_ARRAY_TASK_COUNT="3", **array)
    assert farm.events("done")[:3] == [2, 5, 8]


@pytest.mark.parametrize("pieces", [1, 9])
def test_an_array_with_gaps_makes_all(farm: Farm, pieces: int) -> None:
    farm.write_scene(pieces)
    farm.create()
    farm.run("work", farm.job, SLURM_ARRAY_TASK_ID="4", SLURM_ARRAY_TASK_MIN="0", SLURM_ARRAY_TASK_COUNT="3")
    assert sorted(farm.events("done")) == list(range(pieces))


@pytest.mark.parametrize("words", ["3/3", "1", "-1/2", "a/b", "1/0"])
def test_a_wrong_share_is_refused(farm: Farm, words: str) -> None:
    farm.write_scene(3)
    farm.create()
    assert "give I/N with I from 0 to N - 1" in farm.run("work", farm.job, f"--array-task={words}", code=2)


def test_without_a_device_it_says_so(farm: Farm) -> None:
    farm.write_scene(3)
    farm.create()
    assert "there is no Vulkan device" in farm.run("work", farm.job, code=4, FAKE_NO_DEVICE="1")


def test_other_bits_are_refused_and_left_alone(farm: Farm) -> None:
    farm.write_scene(6)
    farm.create()
    farm.run("work", farm.job)
    for piece in farm.create().pieces[:3]:
        os.unlink(piece.file)
    said = farm.run("work", farm.job, code=1, FAKE_FINGERPRINT="two")
    assert "this worker gives other bits" in said and "--allow-mixed" in said
    assert farm.status()["done"] == 3


def test_a_survey_of_what_makers_tell(farm: Farm) -> None:
    """Failures and deaths before the last `resume` do not count. Pieces that were stopped never count. If a maker
    begins another piece without an end of the last one, the last one counts as a death."""
    from promin_farm.settings import Settings
    from promin_farm.survey import take_survey

    farm.write_scene(7)
    job = farm.create()
    job.runner().run(6)
    for file in farm.job.glob("ledger/*"):
        file.unlink()
    Settings(retries_from=100.0).write(farm.job)

    def tell(pid: int, *events: tuple[str, int, float]) -> None:
        """Writes events of a process of this machine that has ended."""
        lines = [{"event": e, "number": n, "time_s": t, "fingerprint": "f", "why": "lost"} for e, n, t in events]
        file = farm.job / "ledger" / f"{socket.gethostname()}-{pid}.jsonl"
        file.write_text("".join(json.dumps(line) + "\n" for line in lines))

    tell(99999991, ("begun", 0, 10.0), ("failed", 0, 11.0), ("begun", 0, 110.0), ("failed", 0, 111.0))
    tell(99999992, ("begun", 1, 112.0), ("stopped", 1, 113.0))
    tell(99999993, ("begun", 2, 20.0), ("begun", 3, 114.0), ("begun", 4, 115.0))
    tell(99999994, ("begun", 5, 30.0))
    # The piece was written, but its maker ended before it could record that.
    tell(99999995, ("begun", 6, 116.0))
    survey = take_survey(job)
    tries = {number: (one.failures, one.deaths) for number, one in sorted(survey.tries.items())}
    assert tries == {0: (1, 0), 3: (0, 1), 4: (0, 1), 6: (0, 1)}
    assert survey.done == {6} and not survey.running and not survey.failed and survey.fingerprints == {6: "f"}


def test_it_needs_no_dask(farm: Farm) -> None:
    farm.write_scene(3)
    farm.create()
    for name in ("dask", "distributed"):
        blocked = farm.root / "blocked" / name
        blocked.mkdir(parents=True)
        (blocked / "__init__.py").write_text("raise ImportError('it is blocked')\n")
    paths = os.pathsep.join([str(farm.root / "blocked"), farm.environment()["PYTHONPATH"]])
    farm.run("work", farm.job, PYTHONPATH=paths)
    Path(farm.create().pieces[0].file).unlink()
    elsewhere = ("--scheduler", "tcp://127.0.0.1:1")
    assert "pip install 'promin[farm]'" in farm.run("resume", farm.job, *elsewhere, code=2, PYTHONPATH=paths)
    assert "3 pieces are in" in farm.run("resume", farm.job, PYTHONPATH=paths)


def test_frames_of_two_kinds_of_devices_stay_apart(farm: Farm) -> None:
    from promin_farm.settings import Settings, claim_group

    farm.write_scene(8, names="frames")
    farm.create()
    Settings(outputs=[str(farm.out)], allow_mixed=True).write(farm.job)
    claim_group(farm.job, "frame000001", hashlib.sha256(b"two").hexdigest())
    said = farm.run("work", farm.job, FAKE_FINGERPRINT="one")
    assert "6 pieces made; 2 of 8 are missing or made by others" in said and sorted(farm.events("done")) == [
        0,
        1,
        4,
        5,
        6,
        7,
    ]
    assert "2 pieces made; all pieces are made" in farm.run("work", farm.job, FAKE_FINGERPRINT="two")
    # A process whose fingerprint belongs to no frame makes nothing.
    Path(farm.create().pieces[0].file).unlink()
    assert "0 pieces made" in farm.run("work", farm.job, FAKE_FINGERPRINT="three")
    assert len(farm.status()["fingerprints"]) == 2
