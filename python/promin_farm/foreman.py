# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""The main loop of the farm: it decides which worker makes which piece and which pieces are tried again, until all
pieces are done or the remaining pieces cannot be made.

The foreman does not depend on a scheduler. A `Crew` carries pieces to workers and answers back. The foreman gives each
worker its current piece and a few more. When the answer arrives, it forgets the piece. A scheduler therefore has little
to remember with a million pieces, and little to repeat after the end of a worker."""

from __future__ import annotations

import os
import time
from collections import defaultdict, deque
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path
from statistics import median
from typing import Protocol

from promin import jobs

from promin_farm.settings import Settings, group_of
from promin_farm.survey import Tries, open_piece
from promin_farm.worker import Answer

PROOF = -1
"""A number that is sent in place of a piece's number: the worker must compute its fingerprint."""
_SHORT_MS = 1000.0
_MOST_IN_A_ROW = 10
_MOST_ALIKE = 3
"""Number of different pieces. If at least this many pieces fail in a row, the job and not a piece is at fault."""
_MOST_DEATHS_PROVING = 5
_MOST_LOST_PROOFS = 5
_REFUSED_S = 2.0
_SPACE_AFTER = 4
"""Number of finished pieces that are needed to estimate the duration of other pieces."""


class Crew(Protocol):
    """A set of workers, local or remote."""

    patience_s: float
    """Time in seconds that the foreman waits if no worker can take a piece. A worker may be restarting, or a queue may
    not have started it yet."""

    most_at_once: int
    """Number of pieces that a worker may have at the same time."""

    def members(self) -> set[str]:
        """Returns the current workers. Raises RunError if the crew has lost contact with them."""

    def send(self, member: str, number: int) -> None:
        """Sends a piece, or PROOF, to a worker."""

    def next_answer(self, timeout_s: float) -> tuple[str, int, Answer | None] | None:
        """Waits for an answer and returns the worker, its piece and the answer. The answer is None if it was lost.
        Returns None after the timeout."""

    def withdraw(self, member: str, number: int) -> None:
        """Withdraws a piece that has not been started. The worker then gives no answer for it."""

    def forget(self, member: str) -> None:
        """Drops all answers of a worker that has ended."""


class Watch(Protocol):
    """Receives the progress of the work."""

    def say(self, sentence: str) -> None:
        """Shows a message to the user."""

    def piece_done(self, piece: jobs.Piece, receipt: dict[str, object]) -> None:
        """Counts a finished piece."""

    def tick(self, worker_count: int) -> None:
        """Called often, so that the watch can update its display."""


@dataclass
class Member:
    """The foreman's record of a worker."""

    state: str = "proving"
    """State of the worker: "proving", "ready", "idle" or "refused"."""
    fingerprint: str = ""
    name: str = ""
    """Name of the worker's ledger."""
    ends_at: float = float("inf")
    pieces: list[int] = field(default_factory=list)
    """The pieces that the worker has, in the order of sending."""
    lost_proofs: int = 0


@dataclass
class Tally:
    """The result of a run."""

    done: int = 0
    failed: dict[int, Tries] = field(default_factory=dict)
    reason: str = ""
    """The reason why the run ended early; empty if it did not."""
    exit_code: int = 0
    was_stopped: bool = False
    foreign: dict[int, str] = field(default_factory=dict)
    """Pieces that need a fingerprint that no worker has, each with this fingerprint."""
    repeats: int = 0
    """Number of pieces that were sent again."""


class Foreman:
    """Directs one run, which makes some pieces of a job."""

    def __init__(
        self,
        job: jobs.Job,
        crew: Crew,
        watch: Watch,
        *,
        settings: Settings,
        tries: dict[int, Tries] | None = None,
        stop: Callable[[], bool] = lambda: False,
        leave: Callable[[], bool] = lambda: False,
    ) -> None:
        """tries: earlier failures of pieces. stop: a function that ends the run after the current pieces by returning
        True. leave: a function that ends the run at once by returning True."""
        self._job = job
        self._crew = crew
        self._watch = watch
        self._settings = settings
        self._tries = defaultdict(Tries, tries or {})
        self._stop = stop
        self._leave = leave
        self._members: dict[str, Member] = {}
        self._waiting: deque[int] = deque()
        self._reserved: dict[str, deque[int]] = defaultdict(deque)
        self._owners: dict[str, str] = {}
        self._answered: set[int] = set()
        self._failed_in_a_row: list[int] = []
        self._recent_ms: deque[float] = deque(maxlen=32)
        self._bytes: deque[int] = deque(maxlen=32)
        self._idle_since: float | None = None
        self._last_refusal = ("", 1)
        self._died_proving = 0
        self._is_over = False
        self._tally = Tally()

    def run(self, numbers: Iterable[int]) -> Tally:
        """Makes these pieces in about this order. Raises RunError if the crew is lost."""
        self._waiting = deque(numbers)
        for number in list(self._waiting):
            if self._tries[number].is_hopeless:
                self._give_up(number)
        self._waiting = deque(n for n in self._waiting if n not in self._tally.failed)
        while not self._is_over:
            if not self._tally.was_stopped and self._stop():
                self._stop_sent()
            if self._leave():
                break
            self._follow_members()
            if not self._tally.was_stopped:
                self._send_pieces()
            if not self._count_sent() and (self._tally.was_stopped or not self._count_waiting()):
                break
            self._watch.tick(sum(member.state == "ready" for member in self._members.values()))
            answer = self._crew.next_answer(0.2)
            if answer:
                self._take(*answer)
            else:
                self._check_patience()
        return self._tally

    def _count_waiting(self) -> int:
        return len(self._waiting) + sum(map(len, self._reserved.values()))

    def _count_sent(self) -> int:
        return sum(len(member.pieces) for member in self._members.values())

    def _stop_sent(self) -> None:
        """Withdraws pieces that were sent but not started."""
        self._tally.was_stopped = True
        for name, member in self._members.items():
            for number in member.pieces[1:]:
                self._crew.withdraw(name, number)
                self._waiting.append(number)
            del member.pieces[1:]

    def _follow_members(self) -> None:
        there = self._crew.members()
        for name in [name for name in self._members if name not in there]:
            self._crew.forget(name)
            member = self._members.pop(name)
            self._mourn(member)
            self._died_proving += member.state == "proving"
            if self._died_proving >= _MOST_DEATHS_PROVING:
                self._end(f"{self._died_proving} workers in a row ended while they opened the job or its device")
        for name in sorted(there - self._members.keys()):
            if self._tally.was_stopped:
                continue
            self._members[name] = Member()
            self._crew.send(name, PROOF)

    def _mourn(self, member: Member) -> None:
        """Counts a death for the piece that the worker was making. Pieces that the worker had not started are not
        counted."""
        at_hand = open_piece(self._job, member.name) if member.name else None
        for number in member.pieces:
            if number == at_hand:
                self._tries[number].die(member.name)
            self._again(number)

    def _again(self, number: int) -> None:
        """Moves a piece to the end of the list, so that a piece that kills its workers does not delay the other
        pieces."""
        self._tally.repeats += 1
        if self._tries[number].is_hopeless:
            self._give_up(number)
        else:
            self._waiting.append(number)

    def _give_up(self, number: int) -> None:
        tries = self._tries[number]
        self._tally.failed[number] = tries
        self._watch.say(f"{self._job.pieces[number].name} failed permanently after {tries.describe()}")

    def _send_pieces(self) -> None:
        typical_ms = median(self._recent_ms) if self._recent_ms else 0.0
        # A worker has one piece waiting while it makes another. It has more if making a piece takes about as long as
        # sending it.
        depth = 4 if self._recent_ms and typical_ms < _SHORT_MS else 2
        for round_ in range(1, min(depth, self._crew.most_at_once) + 1):
            for name, member in self._members.items():
                if member.state != "ready" or len(member.pieces) >= round_:
                    continue
                if time.time() + 2.0 * typical_ms / 1e3 > member.ends_at:
                    continue
                number = self._next_for(member)
                if number is not None:
                    member.pieces.append(number)
                    self._crew.send(name, number)

    def _next_for(self, member: Member) -> int | None:
        if self._reserved[member.fingerprint]:
            return self._reserved[member.fingerprint].popleft()
        while self._waiting:
            number = self._waiting.popleft()
            owner = self._owners.get(self._group_of(number), member.fingerprint)
            if owner == member.fingerprint:
                return number
            self._reserved[owner].append(number)
        return None

    def _group_of(self, number: int) -> str:
        return group_of(self._job, self._job.pieces[number], self._settings)

    def _take(self, name: str, number: int, answer: Answer | None) -> None:
        member = self._members.get(name)
        if member is None:
            return
        self._idle_since = None
        if number == PROOF:
            self._take_proof(name, member, answer)
            return
        if number not in member.pieces:
            return
        member.pieces.remove(number)
        if answer is None or "left" in answer:
            self._again(number)
        elif "done" in answer:
            self._take_receipt(number, answer["done"])
        elif "failed" in answer:
            self._take_failure(number, answer)
        elif "elsewhere" in answer:
            owner = str(answer["elsewhere"])
            self._owners[self._group_of(number)] = owner
            self._reserved[owner].append(number)
        else:
            self._waiting.appendleft(number)
            self._take_proof(name, member, answer)

    def _take_proof(self, name: str, member: Member, answer: Answer | None) -> None:
        if answer is None and member.lost_proofs < _MOST_LOST_PROOFS:
            member.lost_proofs += 1
            self._crew.send(name, PROOF)
            return
        answer = answer or {"refused": f"{_MOST_LOST_PROOFS} of its answers were lost", "exit_code": 1}
        if "proof" in answer:
            member.state, member.fingerprint, member.name = "ready", answer["proof"], answer["name"]
            member.ends_at = answer["ends_at"]
            self._died_proving = 0
        else:
            member.state = "idle" if "idle" in answer else "refused"
            self._last_refusal = (str(answer.get("idle") or answer.get("refused")), int(answer.get("exit_code", 1)))
            self._watch.say(f"{name} makes no pieces: {self._last_refusal[0]}")

    def _take_receipt(self, number: int, receipt: dict[str, object]) -> None:
        self._failed_in_a_row.clear()
        if number not in self._answered:
            self._answered.add(number)
            self._tally.done += 1
            self._watch.piece_done(self._job.pieces[number], receipt)
        self._recent_ms.append(float(str(receipt.get("ms", 0.0))))
        self._bytes.append(int(str(receipt.get("bytes", 0))))
        if self._tally.done == _SPACE_AFTER or self._tally.done % 64 == 0:
            self._check_space()

    def _take_failure(self, number: int, answer: Answer) -> None:
        reason = str(answer["failed"])
        self._tries[number].fail(reason)
        self._failed_in_a_row.append(number)
        self._again(number)
        if answer.get("is_disk_full"):
            self._end(f"the disk is full: {reason}")
        elif len(self._failed_in_a_row) >= _MOST_IN_A_ROW and len(set(self._failed_in_a_row)) >= _MOST_ALIKE:
            self._end(f"{len(self._failed_in_a_row)} pieces in a row have failed, the last: {reason}")

    def _end(self, reason: str, exit_code: int = 1) -> None:
        self._is_over = True
        self._tally.reason, self._tally.exit_code = reason, exit_code

    def _check_space(self) -> None:
        left = self._count_waiting() + self._count_sent()
        needed = left * sum(self._bytes) / len(self._bytes)
        try:
            disk = os.statvfs(self._job.folder)
        except OSError:
            return
        free = disk.f_bavail * disk.f_frsize
        if needed > free:
            self._end(
                f"the disk has {free / 1e6:.0f} MB left, and {left} pieces take about {needed / 1e6:.0f} MB, "
                f"{self._job.folder}"
            )

    def _check_patience(self) -> None:
        """Ends the run after a while if there is work but no worker."""
        if self._count_sent() or any(member.state == "proving" for member in self._members.values()):
            self._idle_since = None
            return
        now = time.monotonic()
        if self._idle_since is None:
            self._idle_since = now
        # A worker that is present and takes no pieces now will not take any later.
        patience_s = min(self._crew.patience_s, _REFUSED_S) if self._members else self._crew.patience_s
        if now - self._idle_since < patience_s:
            return
        ready = {member.fingerprint for member in self._members.values() if member.state == "ready"}
        if not self._members:
            self._end(f"no worker has joined for {patience_s:.0f} s")
        elif not ready:
            self._end(*self._last_refusal)
        else:
            self._tally.foreign = {n: owner for owner, numbers in self._reserved.items() for n in numbers}
            self._end("" if self._tally.foreign else "the workers' time is over")
