# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""The state of a job, from its ledgers and the existing pieces. A survey hashes nothing; `verify`, `resume` and the
assembly hash the pieces."""

from __future__ import annotations

import os
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from promin import jobs

from promin_farm.presence import Roll
from promin_farm.settings import Settings

MOST_FAILURES = 3
MOST_DEATHS = 5
_RATE_OVER_S = 600.0


@dataclass
class Tries:
    """The failed attempts at a piece."""

    failures: int = 0
    deaths: int = 0
    """Number of processes that ended while they made the piece."""
    reason: str = ""
    """The reason of the last failure."""

    @property
    def is_hopeless(self) -> bool:
        """Returns whether the piece has failed so often that it is not tried again."""
        return self.failures >= MOST_FAILURES or self.deaths >= MOST_DEATHS

    def fail(self, reason: str) -> None:
        """Counts a failure."""
        self.failures += 1
        self.reason = reason

    def die(self, worker: str) -> None:
        """Counts the end of a process that made the piece."""
        self.deaths += 1
        self.reason = f"{worker} ended while it made the piece"

    def describe(self) -> str:
        """Returns a description of the failed attempts with the last reason."""
        counts = [f"{self.failures} failures"] * bool(self.failures) + [f"{self.deaths} deaths"] * bool(self.deaths)
        return f"{' and '.join(counts) or 'no try'}, the last: {self.reason}"


@dataclass(frozen=True)
class Stretch:
    """The time during which a process made a piece."""

    number: int
    worker: str
    begun: float
    """Start of the time, in seconds since 1970."""
    ended: float | None
    """End of the time, in seconds since 1970; None if the process is still making the piece."""
    outcome: str
    """The result: "done", "failed", "died" or "running"."""


@dataclass
class Survey:
    """The state of a job at a point in time."""

    total: int
    roll: Roll
    done: set[int] = field(default_factory=set)
    running: list[Stretch] = field(default_factory=list)
    tries: dict[int, Tries] = field(default_factory=dict)
    """Failed attempts since `retries_from`, by number of the piece."""
    receipts: dict[int, dict[str, Any]] = field(default_factory=dict)
    """The last receipt of each finished piece, by number of the piece."""
    stretches: list[Stretch] = field(default_factory=list)
    weight_done: float = 0.0
    weight_left: float = 0.0
    rate: float | None = None
    """Amount of work per second over the last ten minutes of work; None if nothing was made."""

    @property
    def failed(self) -> dict[int, Tries]:
        """Returns the failed attempts of the pieces that are not tried again."""
        return {number: tries for number, tries in self.tries.items() if tries.is_hopeless and number not in self.done}

    @property
    def time_left_s(self) -> float | None:
        """Returns the remaining time in seconds; None if no process works or the rate is unknown."""
        if not self.running or not self.rate:
            return None
        return self.weight_left / self.rate

    @property
    def fingerprints(self) -> dict[int, str]:
        """Returns the known fingerprints of finished pieces, by number of the piece."""
        return {n: str(receipt["fingerprint"]) for n, receipt in self.receipts.items() if receipt.get("fingerprint")}


def take_survey(job: jobs.Job) -> Survey:
    """Reads the ledgers and lists the pieces. Raises InputError if the farm's settings are damaged."""
    folder = Path(job.folder)
    survey = Survey(total=len(job.pieces), roll=Roll(folder))
    try:
        names = {entry.name for entry in os.scandir(folder / "pieces")}
    except OSError:
        names = set()
    survey.done = {piece.number for piece in job.pieces if Path(piece.file).name in names}
    survey.weight_done = sum(piece.weight for piece in job.pieces if piece.number in survey.done)
    survey.weight_left = sum(piece.weight for piece in job.pieces) - survey.weight_done
    since = Settings.read(folder).retries_from
    at_hand: dict[str, dict[str, Any]] = {}
    for event in job.events():
        _take(survey, event, at_hand, since)
    for worker, begun in at_hand.items():
        _take_open(survey, worker, begun, since)
    survey.stretches.sort(key=lambda stretch: stretch.begun)
    weights = [piece.weight for piece in job.pieces]
    survey.rate = _rate_of(survey.stretches, weights)
    return survey


def open_piece(job: jobs.Job, worker: str) -> int | None:
    """Returns the piece that a process has begun and not finished."""
    events = job.events(worker)
    return int(events[-1]["number"]) if events and events[-1]["event"] == "begun" else None


def _take(survey: Survey, event: dict[str, Any], at_hand: dict[str, dict[str, Any]], since: float) -> None:
    """Processes an event. A process makes one piece at a time; it records the start of the piece and then the result.

    at_hand: for each process the piece whose start is its last event."""
    worker, number, at = str(event["maker"]), int(event["number"]), float(event["time_s"])
    begun = at_hand.pop(worker, None)
    start = float(begun["time_s"]) if begun and begun["number"] == number else at
    if event["event"] == "begun":
        if begun:
            _bury(survey, worker, begun, at, since)
        at_hand[worker] = event
    elif event["event"] == "done":
        survey.stretches.append(Stretch(number, worker, start, at, "done"))
        if number in survey.done:
            survey.receipts[number] = event
    elif event["event"] == "failed":
        survey.stretches.append(Stretch(number, worker, start, at, "failed"))
        if at >= since:
            survey.tries.setdefault(number, Tries()).fail(str(event.get("why", "")))


def _take_open(survey: Survey, worker: str, begun: dict[str, Any], since: float) -> None:
    """Processes pieces that were begun and have no later event. A process is making such a piece, or it has ended."""
    at = float(begun["time_s"])
    if not survey.roll.is_alive(worker, at):
        _bury(survey, worker, begun, at, since)
        return
    running = Stretch(int(begun["number"]), worker, at, None, "running")
    survey.running.append(running)
    survey.stretches.append(running)


def _bury(survey: Survey, worker: str, begun: dict[str, Any], at: float, since: float) -> None:
    number, began = int(begun["number"]), float(begun["time_s"])
    survey.stretches.append(Stretch(number, worker, began, at, "died"))
    if number in survey.done:
        # The piece may have been written before its receipt.
        survey.receipts.setdefault(number, begun)
    if began >= since:
        survey.tries.setdefault(number, Tries()).die(worker)


def _rate_of(stretches: list[Stretch], weights: list[float]) -> float | None:
    """Returns the rate over the last minutes in which pieces were made. These minutes may be in the past."""
    made = [s for s in stretches if s.outcome == "done" and s.ended is not None]
    if not made:
        return None
    last = max(s.ended for s in made if s.ended is not None)
    recent = [s for s in made if s.ended is not None and s.ended > last - _RATE_OVER_S]
    until = time.time() if any(s.outcome == "running" for s in stretches) and time.time() - last < 60.0 else last
    span = until - max(min(s.begun for s in recent), last - _RATE_OVER_S)
    return sum(weights[s.number] for s in recent) / max(span, 1e-3)
