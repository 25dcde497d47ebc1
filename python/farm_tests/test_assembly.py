# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""The assembly writes the frames of a film while workers make the remaining pieces."""

from __future__ import annotations

import threading
from typing import Any

import pytest
from conftest import Farm, wait_for

from promin import jobs
from promin_farm.assembly import Assembly
from promin_farm.settings import Settings


def write_film(farm: Farm) -> Any:
    """Creates a job with 4 frames of 2 pieces each. No piece is done."""
    farm.write_scene(8, names="frames", per_frame=2)
    farm.out = farm.root / "out.####.exr"
    return farm.create()


def make(job: Any, assembly: Assembly, *numbers: int) -> None:
    runner = job.runner()
    for number in numbers:
        runner.run(number)
        assembly.piece_done(number)


def frames_of(farm: Farm) -> list[str]:
    return sorted(file.name for file in farm.root.glob("out.*.exr"))


def test_a_frame_is_there_when_its_pieces_are(farm: Farm) -> None:
    job = write_film(farm)
    job.runner().run(2)
    job.runner().run(3)
    assembly = Assembly(job, Settings(outputs=[str(farm.out)]))
    with assembly.writing([0, 1, 4, 5, 6, 7], lambda: False):
        # The assembly first writes the frame that an earlier run has made.
        wait_for(lambda: frames_of(farm) == ["out.0001.exr"])
        make(job, assembly, 6, 0)
        make(job, assembly, 7)
        wait_for(lambda: frames_of(farm) == ["out.0001.exr", "out.0003.exr"])
        make(job, assembly, 5, 1, 4)
    assert len(frames_of(farm)) == 4 and farm.written() == farm.expected()


def test_no_frame_is_written_twice_and_one_that_failed_at_the_end(farm: Farm) -> None:
    job = write_film(farm)
    merge = job.merge
    asked: list[list[int]] = []

    def merge_with_a_fault(outputs: list[str], *, allow_mixed: bool, frames: list[int]) -> None:
        asked.append(frames)
        if len(asked) == 2:
            raise jobs.RunError("the disk is full")
        merge(outputs, frames=frames)

    job.merge = merge_with_a_fault
    assembly = Assembly(job, Settings(outputs=[str(farm.out)]))
    with assembly.writing(range(8), lambda: False):
        make(job, assembly, *range(8))
    assert asked == [[0], [1], [2], [3]] and len(frames_of(farm)) == 3
    # The second round makes pieces again, as after pieces were altered.
    with assembly.writing([0, 2], lambda: False):
        make(job, assembly, 0, 2)
    assembly.write_rest()
    assert asked[4:] == [[1]] and farm.written() == farm.expected()


def test_a_run_that_ends_early_leaves_the_frames_that_wait(farm: Farm) -> None:
    job = write_film(farm)
    make(job, Assembly(job, Settings()), *range(8))
    merge = job.merge
    is_begun = threading.Event()

    def merge_slowly(outputs: list[str], **words: Any) -> None:
        if not is_begun.is_set():
            is_begun.set()
            # The queue holds three frames and behind them None, which ends the thread.
            wait_for(lambda: assembly._ready.qsize() == 4)
        merge(outputs, **words)

    job.merge = merge_slowly
    assembly = Assembly(job, Settings(outputs=[str(farm.out)]))
    with pytest.raises(jobs.RunError):
        with assembly.writing([], lambda: False):
            assert is_begun.wait(60)
            raise jobs.RunError("the scheduler has gone")
    assert frames_of(farm) == ["out.0000.exr"]
    is_stopped = threading.Event()
    is_stopped.set()
    with assembly.writing([], is_stopped.is_set):
        pass
    assert frames_of(farm) == ["out.0000.exr"]
    assembly.write_rest()
    assert farm.written() == farm.expected()


def test_whole_frames_of_a_film_that_cannot_be_finished_are_there(farm: Farm) -> None:
    pytest.importorskip("distributed")
    farm.write_scene(8, names="frames", per_frame=2, fails=[5])
    farm.out = farm.root / "out.####.exr"
    assert "frame000002_" in farm.render("--workers", "1", code=1)
    assert frames_of(farm) == ["out.0000.exr", "out.0001.exr", "out.0003.exr"]


def test_a_film_in_one_file_is_written_at_the_end(farm: Farm) -> None:
    job = write_film(farm)
    merged: list[tuple[list[str], list[int] | None]] = []

    def merge(outputs: list[str], *, allow_mixed: bool, frames: list[int] | None = None) -> None:
        merged.append((outputs, frames))

    job.merge = merge
    numbered, film = str(farm.out), str(farm.root / "film.mp4")
    assembly = Assembly(job, Settings(outputs=[numbered, film]))
    with assembly.writing(range(8), lambda: False):
        make(job, assembly, *range(8))
    assembly.write_rest()
    assert merged == [([numbered], [frame]) for frame in range(4)] + [([film], None)]
