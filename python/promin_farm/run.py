# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""A run of a job: a crew makes the missing pieces, then the run writes the job's files from the pieces."""

from __future__ import annotations

import os
import sys
import time
from contextlib import ExitStack
from dataclasses import dataclass, field
from math import inf
from pathlib import Path

from promin import jobs

from promin_farm.alone import Signals
from promin_farm.assembly import Assembly
from promin_farm.crews import open_remote
from promin_farm.foreman import Crew, Foreman, Tally
from promin_farm.page import Page
from promin_farm.presence import Starts
from promin_farm.processes import LocalCrew, deal_seats
from promin_farm.queues import QUEUES, open_queue
from promin_farm.settings import Settings, claim_what_is_there
from promin_farm.survey import take_survey
from promin_farm.watch import Progress, of_pieces, of_workers

_MOST_ROUNDS = 3
"""Number of times that altered pieces are made again before the run reports an error."""
_MOST_NAMED = 5


@dataclass(frozen=True)
class Options:
    """Options for the workers of a run."""

    workers: int | None = None
    devices: list[str] = field(default_factory=list)
    scheduler: str | None = None
    queue_config: str | None = None
    is_quiet: bool = False


def carry_on(job: jobs.Job, settings: Settings, options: Options) -> int:
    """Makes the missing pieces, writes the outputs and returns the exit code. Raises promin's errors."""
    _check(options)
    job.clear_leftovers()
    assembly = Assembly(job, settings)
    for round_ in range(_MOST_ROUNDS):
        missing = [piece.number for piece in job.pieces if job.state(piece.number) != "done"]
        if missing:
            exit_code = _make(job, settings, options, missing, assembly)
            if exit_code is not None:
                return exit_code
        try:
            assembly.write_rest()
            job.clear_leftovers()  # Removes temporary files of workers that were killed while they wrote.
            break
        except (jobs.InputError, jobs.RunError):
            if round_ + 1 == _MOST_ROUNDS or all(job.state(piece.number) == "done" for piece in job.pieces):
                raise
    if not options.is_quiet:
        pieces = of_pieces(len(job.pieces))
        if settings.outputs:
            print(f"{pieces}: {', '.join(settings.outputs)}")
        else:
            verb = "is" if len(job.pieces) == 1 else "are"
            print(f"{pieces} {verb} in {job.folder}; give the files to write with -o")
    return 0


def check_outputs(job: jobs.Job, outputs: list[str]) -> None:
    """Checks the outputs before the work, because the work may take long. Raises UsageError, InputError and
    RunError."""
    job.check_outputs(outputs)
    for output in outputs:
        if outputs.count(output) > 1:
            raise jobs.UsageError(f"the same output file is named twice, {output}; use different files")
        if not os.access(Path(output).parent, os.W_OK):
            raise jobs.RunError(
                f"cannot write to the folder, {Path(output).parent}; create it, or check its permissions"
            )


def _check(options: Options) -> None:
    if options.workers is not None and options.workers < 1:
        raise jobs.UsageError(f"--workers is {options.workers}; give 1 or more")
    scheduler = options.scheduler
    if scheduler and scheduler not in QUEUES and "://" not in scheduler:
        known = ", ".join(QUEUES)
        raise jobs.UsageError(f"--scheduler is {scheduler!r}; give tcp://HOST:PORT, {known}")
    if scheduler and options.devices:
        raise jobs.UsageError(
            "--device selects devices of this machine, and --scheduler starts workers elsewhere; "
            "set PROMIN_DEVICE where they start"
        )
    if options.queue_config and scheduler not in QUEUES:
        raise jobs.UsageError(
            "--queue-config needs a queue; "
            f"give --scheduler {', '.join(QUEUES)}"
        )
    if scheduler and "://" in scheduler and options.workers:
        raise jobs.UsageError(
            "--workers does not apply to a running cluster, because the cluster has its own workers; remove it"
        )


def _make(job: jobs.Job, settings: Settings, options: Options, missing: list[int], assembly: Assembly) -> int | None:
    """Makes the pieces. Returns None if all pieces are done, otherwise the exit code."""
    survey = take_survey(job)
    claim_what_is_there(job, settings, survey.fingerprints)
    page = Page(job)
    starts = Starts(Path(job.folder))

    def tick() -> None:
        page.tick()
        starts.tell_news(watch.say, time.monotonic())

    watch = Progress(job, missing, is_quiet=options.is_quiet, on_tick=tick, on_piece=assembly.piece_done)
    with Signals() as signals, assembly.writing(missing, signals.end_soon), ExitStack() as stack:
        crew, words, workers = _open_crew(job, options, stack)
        watch.say(f"{len(missing)} of {of_pieces(len(job.pieces))} to make, by {words}")
        if len(job.pieces) < workers:
            watch.say(
                f"{of_pieces(len(job.pieces))} for {of_workers(workers)}: some workers get no work; --pieces divides a "
                "job in another folder into more pieces"
            )
        foreman = Foreman(
            job, crew, watch, settings=settings, tries=survey.tries, stop=signals.end_soon, leave=signals.end_now
        )
        try:
            tally = foreman.run(missing)
        finally:
            starts.tell_news(watch.say, inf)
            watch.close()
            page.write()
    return _conclude(job, tally)


def _open_crew(job: jobs.Job, options: Options, stack: ExitStack) -> tuple[Crew, str, int]:
    """Returns the crew, its description and the number of its workers. The number is 0 if a cluster determines it."""
    if options.scheduler in QUEUES:
        workers = options.workers or 1
        return *open_queue(job, str(options.scheduler), workers, options.queue_config, stack), workers
    if options.scheduler:
        return *open_remote(job, options.scheduler, stack), 0
    # Each GPU has one worker. A CPU has one worker, which uses all cores.
    seats = deal_seats(options.devices or jobs.list_gpus(), options.workers)
    threads = f", LP_NUM_THREADS={seats[0].threads} each" if seats[0].threads else ""
    words = f"{of_workers(len(seats))} on this machine{threads}"
    return stack.enter_context(LocalCrew(job, seats)), words, len(seats)


def _conclude(job: jobs.Job, tally: Tally) -> int | None:
    again = f"promin-farm resume {job.folder}"
    if tally.reason:
        print(f"promin-farm: {tally.reason}; {of_pieces(tally.done)} were made, and {again} continues", file=sys.stderr)
        return tally.exit_code
    if tally.was_stopped:
        print(f"promin-farm: the run stopped after {of_pieces(tally.done)}; {again} continues", file=sys.stderr)
        return 1
    if tally.failed:
        named = [f"{job.pieces[number].name} ({tries.reason})" for number, tries in sorted(tally.failed.items())]
        more = ", …" if len(named) > _MOST_NAMED else ""
        print(
            f"promin-farm: {len(named)} of {of_pieces(len(job.pieces))} cannot be made: "
            f"{', '.join(named[:_MOST_NAMED])}{more}, {job.folder}; correct that, then {again} tries again",
            file=sys.stderr,
        )
        return 1
    if tally.foreign:
        owner = next(iter(tally.foreign.values()))
        print(
            f"promin-farm: {of_pieces(len(tally.foreign))} need a worker with the fingerprint {owner[:16]}, "
            f"which no worker has, {Path(job.folder)}; run {again} where one has it",
            file=sys.stderr,
        )
        return 1
    return None
