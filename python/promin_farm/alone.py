# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""`promin-farm work`: a process that makes its share of a job without Dask, for queues of any kind."""

from __future__ import annotations

import os
import signal
from collections import deque
from collections.abc import Callable
from pathlib import Path
from types import FrameType

from promin import jobs

from promin_farm import worker
from promin_farm.foreman import PROOF, Foreman, Tally, Watch
from promin_farm.settings import Settings, claim_what_is_there
from promin_farm.survey import Survey, take_survey

_SELF = "this process"


class Signals:
    """Handles SIGINT and SIGTERM: the first ends the work after the current piece, the second abandons the current
    piece."""

    def __init__(self) -> None:
        self.count = 0
        self._old = {number: signal.signal(number, self._count) for number in (signal.SIGINT, signal.SIGTERM)}

    def __enter__(self) -> Signals:
        return self

    def __exit__(self, *_: object) -> None:
        for number, handler in self._old.items():
            signal.signal(number, handler)

    def end_soon(self) -> bool:
        """Returns whether there was at least one signal."""
        return self.count > 0

    def end_now(self) -> bool:
        """Returns whether there were at least two signals."""
        return self.count > 1

    def _count(self, number: int, frame: FrameType | None) -> None:
        self.count += 1


class Alone:
    """A crew that consists of this process, which makes a piece while the foreman waits for its answer."""

    patience_s = 0.0
    most_at_once = 1

    def __init__(
        self, folder: str, device: str | None, stop_piece: Callable[[], bool], say: Callable[[str], None]
    ) -> None:
        self._say = say
        self._folder = folder
        self._device = device
        self._stop_piece = stop_piece
        self._sent: deque[int] = deque()

    def members(self) -> set[str]:
        return {_SELF}

    def send(self, member: str, number: int) -> None:
        self._sent.append(number)

    def next_answer(self, timeout_s: float) -> tuple[str, int, worker.Answer | None] | None:
        if not self._sent:
            return None
        number = self._sent.popleft()
        if number == PROOF:
            return _SELF, number, worker.prove(self._folder, self._device, self._say)
        return _SELF, number, worker.make(self._folder, number, self._stop_piece)

    def withdraw(self, member: str, number: int) -> None:
        self._sent.remove(number)

    def forget(self, member: str) -> None:
        self._sent.clear()


def find_share(words: str | None) -> tuple[int, int]:
    """Returns I and N of "I/N", where I counts from 0. Without an argument it returns the numbers of this process in
    its Slurm array, or 0 and 1 without an array. Raises UsageError."""
    if words is None:
        env = os.environ
        if "SLURM_ARRAY_TASK_COUNT" not in env:
            return 0, 1
        step = int(env.get("SLURM_ARRAY_TASK_STEP", "1")) or 1
        first = int(env.get("SLURM_ARRAY_TASK_MIN", "0"))
        tasks = int(env["SLURM_ARRAY_TASK_COUNT"])
        # In a list with gaps, a task's number may exceed the number of tasks. Two tasks then start with the same share,
        # which only costs time.
        return (int(env["SLURM_ARRAY_TASK_ID"]) - first) // step % tasks, tasks
    index, _, count = words.partition("/")
    if index.isdigit() and count.isdigit() and int(index) < int(count):
        return int(index), int(count)
    raise jobs.UsageError(f"--array-task is {words!r}; give I/N with I from 0 to N - 1, such as 0/8")


def work(job: jobs.Job, share: tuple[int, int], device: str | None, watch: Watch, signals: Signals) -> Tally:
    """Makes every N-th piece from I on, then all other missing pieces, starting at the position I/N of the list. Skips
    pieces that other processes are making. Raises promin's errors."""
    index, count = share
    folder = Path(job.folder)
    settings = Settings.read(folder)
    survey = take_survey(job)
    claim_what_is_there(job, settings, survey.fingerprints)
    crew = Alone(job.folder, device, signals.end_now, lambda words: watch.say(f"{_SELF} {words}"))
    whole = Tally()

    def run(numbers: list[int], survey: Survey) -> bool:
        """Makes these pieces and returns whether the process may continue."""
        foreman = Foreman(job, crew, watch, settings=settings, tries=survey.tries, stop=signals.end_soon)
        # Pieces that have killed other processes come last, because they may kill this one.
        tally = foreman.run(sorted(numbers, key=lambda n: survey.tries[n].deaths if n in survey.tries else 0))
        whole.done += tally.done
        whole.failed.update(tally.failed)
        whole.foreign.update(tally.foreign)
        whole.reason, whole.exit_code, whole.was_stopped = tally.reason, tally.exit_code, tally.was_stopped
        return not tally.reason and not tally.was_stopped

    goes_on = run([n for n in range(index, survey.total, count) if job.state(n) != "done"], survey)
    while goes_on:
        survey = take_survey(job)
        taken = (
            survey.done | {stretch.number for stretch in survey.running} | whole.failed.keys() | whole.foreign.keys()
        )
        first = index * survey.total // count
        missing = [n for n in [*range(first, survey.total), *range(first)] if n not in taken]
        # Only a few pieces are made at a time, because other processes take pieces from the same list.
        goes_on = bool(missing) and run(missing[: max(1, len(missing) // (2 * count))], survey)
    worker.close()
    return whole
