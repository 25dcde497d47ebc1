# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Faults of a job's folder, inputs and disk. `resume` repairs them or refuses the job with a sentence."""

from __future__ import annotations

import json
import resource
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import Farm


def cut(file: Path) -> None:
    file.write_bytes(file.read_bytes()[:-7])


def empty(file: Path) -> None:
    file.write_bytes(b"")


def flip(file: Path) -> None:
    data = bytearray(file.read_bytes())
    data[-3] ^= 4
    file.write_bytes(data)


def test_harmed_pieces_are_found_and_made_anew(farm: Farm) -> None:
    farm.write_scene(8)
    job = farm.create()
    farm.run("work", farm.job)
    assert "8 of 8 pieces are whole" in farm.run("verify", farm.job)
    for number, harm in ((1, cut), (3, empty), (5, flip), (7, Path.unlink)):
        harm(Path(job.pieces[number].file))
    said = farm.run("verify", farm.job, code=1)
    assert "4 of 8 pieces are whole, 3 bad, 1 missing" in said
    assert all(job.pieces[number].file in said for number in (1, 3, 5))
    farm.run("resume", farm.job, "-o", farm.out, "--device", "A")
    assert farm.out.read_bytes() == farm.expected()
    assert [line["made_on"] for line in farm.ledger() if line["event"] == "done"].count("fake A") == 4
    assert sorted(farm.events("done")) == sorted([*range(8), 1, 3, 5, 7])


def test_a_piece_that_is_altered_before_the_assembly_is_made_anew(farm: Farm) -> None:
    """Damages a piece after the run has checked it, so only the assembly detects the damage."""
    from promin import jobs

    from promin_farm import run
    from promin_farm.settings import Settings

    farm.write_scene(4)
    job = farm.create()
    runner = job.runner()
    for piece in job.pieces:
        runner.run(piece.number)
    merge, harmed = job.merge, []

    def harm_and_merge(outputs: list[str], *, allow_mixed: bool = False) -> None:
        if not harmed:
            harmed.append(True)
            flip(Path(job.pieces[2].file))
        merge(outputs)

    job.merge = harm_and_merge  # type: ignore[method-assign]
    made: list[list[int]] = []

    def make(job: jobs.Job, settings: Settings, options: run.Options, missing: list[int], *_: object) -> None:
        made.append(missing)
        for number in missing:
            runner.run(number)

    patch = pytest.MonkeyPatch()
    with patch.context() as context:
        context.setattr(run, "_make", make)
        assert run.carry_on(job, Settings(outputs=[str(farm.out)]), run.Options(is_quiet=True)) == 0
    assert made == [[2]] and farm.out.read_bytes() == farm.expected()


def test_a_scene_that_changes_between_the_beginning_and_the_work_is_refused(farm: Farm) -> None:
    farm.write_scene(4)
    farm.create()
    farm.scene.write_text(farm.scene.read_text() + "\n")
    assert f"the file has changed since the job was begun, {farm.scene}" in farm.run("work", farm.job, code=3)
    assert not farm.events("begun") and not farm.out.exists()


@pytest.mark.long
def test_a_scene_that_has_changed_is_refused_by_a_cluster(farm: Farm) -> None:
    farm.write_scene(4)
    farm.create()
    farm.scene.write_text(farm.scene.read_text() + "\n")
    said = farm.run("resume", farm.job, "-o", farm.out, "--workers", "2", code=3)
    assert f"the file has changed since the job was begun, {farm.scene}" in said and not farm.out.exists()


def test_another_job_in_the_folder_is_refused(farm: Farm) -> None:
    farm.write_scene(4)
    farm.create()
    farm.write_scene(4, seed=2)
    assert "the folder belongs to another job" in farm.render(code=2)


def test_folders_of_other_versions_are_refused(farm: Farm) -> None:
    farm.write_scene(4)
    farm.create()
    (farm.job / "farm").mkdir()
    settings = farm.job / "farm/farm.json"
    settings.write_text(json.dumps({"promin_farm": 99}))
    assert f"damaged or of another version, {settings}" in farm.run("resume", farm.job, code=3)
    for wrong in ({"outputs": 5}, {"retries_from": "x"}):
        settings.write_text(json.dumps({"promin_farm": 1, **wrong}))
        assert f"damaged or of another version, {settings}" in farm.run("resume", farm.job, code=3)
    settings.unlink()
    manifest = farm.job / "job.json"
    manifest.write_text(manifest.read_text().replace('"fake_job": 1', '"fake_job": 9'))
    for command in ("resume", "work"):
        assert "the job was made by another version of promin" in farm.run(command, farm.job, code=3)
    assert "there is no job in the folder" in farm.run("resume", farm.root, code=3)


def test_a_full_disk_ends_the_run_and_resume_goes_on_when_there_is_room(farm: Farm) -> None:
    """A limit on the size of files simulates a full disk."""
    farm.write_scene(30, bytes=100_000)

    def limit() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (50_000, 50_000))

    farm.create()
    words = ("work", farm.job)
    done = subprocess.run(
        [sys.executable, "-m", "promin_farm", *map(str, words)],
        env=farm.environment(),
        cwd=farm.root,
        preexec_fn=limit,
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert done.returncode == 1 and "the disk is full: cannot write" in done.stderr, done
    states = [line for line in done.stderr.splitlines() if line.startswith("promin-farm: this process ")]
    assert len(done.stderr.splitlines()) == len(states) + 1 and len(farm.events("begun")) == 1
    farm.run("work", farm.job)
    farm.run("resume", farm.job, "-o", farm.out)
    assert farm.out.read_bytes() == farm.expected()


@pytest.mark.long
def test_pieces_that_fail_or_kill_are_told_and_the_rest_is_made(farm: Farm) -> None:
    farm.write_scene(12, fails=[2], crashes=[7], ms=5)
    said = farm.render("--workers", 2, code=1)
    assert "2 of 12 pieces cannot be made" in said and "the device was lost at 2" in said
    assert "ended while it made the piece" in said
    status = farm.status()
    assert status["done"] == 10 and len(status["failed"]) == 2
    tries = {name: (value["failures"], value["deaths"]) for name, value in status["tries"].items()}
    pieces = farm.create().pieces
    # If a worker is killed by the next piece before it can report a failure, only the ledger has the failure, and the
    # piece is tried once more.
    failures = tries[pieces[2].name][0]
    assert 3 <= failures <= 3 + 5
    assert tries == {pieces[2].name: (failures, 0), pieces[7].name: (0, 5)}
    # `promin-farm work` does not try these pieces again; `resume` does.
    farm.run("work", farm.job, code=1)
    assert farm.events("begun").count(7) == 5
    assert "2 of 12 pieces cannot be made" in farm.run("resume", farm.job, "--workers", 1, code=1)
    assert farm.events("begun").count(2) == failures + 3
