# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Shows the progress of a run on standard error: a bar with the remaining time on a terminal, lines in a pipe."""

from __future__ import annotations

import sys
import time
from collections import deque
from collections.abc import Callable, Iterable
from typing import TextIO

from promin import jobs

_EVERY_S = 0.2
_LINES_EVERY_S = 30.0
_RATE_OVER_S = 120.0


class Progress:
    """The progress display of a run."""

    def __init__(
        self,
        job: jobs.Job,
        missing: Iterable[int],
        *,
        is_quiet: bool = False,
        stream: TextIO | None = None,
        on_tick: Callable[[], None] = lambda: None,
        on_piece: Callable[[int], None] = lambda number: None,
    ) -> None:
        """on_tick: a function that is called often. on_piece: a function that is called with the number of each
        finished piece."""
        self._stream = stream or sys.stderr
        self._is_quiet = is_quiet
        self._on_tick = on_tick
        self._on_piece = on_piece
        numbers = set(missing)
        self._total = len(job.pieces)
        self._done = self._total - len(numbers)
        self._weight_left: float = sum(piece.weight for piece in job.pieces if piece.number in numbers)
        self._begun = time.monotonic()
        self._recent: deque[tuple[float, float]] = deque()
        self._last_shown = 0.0
        self._is_terminal = self._stream.isatty()
        self._is_bar_shown = False

    def say(self, sentence: str) -> None:
        if self._is_quiet:
            return
        self._clear()
        print(f"promin-farm: {sentence}", file=self._stream, flush=True)

    def piece_done(self, piece: jobs.Piece, receipt: dict[str, object]) -> None:
        self._on_piece(piece.number)
        self._done += 1
        self._weight_left -= piece.weight
        now = time.monotonic()
        self._recent.append((now, piece.weight))
        while self._recent[0][0] < now - _RATE_OVER_S:
            self._recent.popleft()

    def tick(self, worker_count: int) -> None:
        self._on_tick()
        now = time.monotonic()
        if self._is_quiet or now - self._last_shown < (_EVERY_S if self._is_terminal else _LINES_EVERY_S):
            return
        if self._last_shown == 0.0 and not self._is_terminal:
            self._last_shown = now  # An earlier first line would contain no information.
            return
        self._last_shown = now
        line = self.describe(worker_count)
        if self._is_terminal:
            print(f"\r\x1b[K{line}", end="", file=self._stream, flush=True)
            self._is_bar_shown = True
        else:
            print(f"promin-farm: {line}", file=self._stream, flush=True)

    def describe(self, worker_count: int) -> str:
        """Returns the line of progress."""
        left = self.time_left_s()
        words = f"{self._done} of {of_pieces(self._total)}, {of_workers(worker_count)}"
        return words + (f", {duration(left)} left" if left is not None else "")

    def time_left_s(self) -> float | None:
        """Returns the remaining time in seconds, estimated from the pieces of the last two minutes; None before the
        first piece."""
        if not self._recent:
            return None
        span = time.monotonic() - max(self._begun, time.monotonic() - _RATE_OVER_S)
        return self._weight_left * span / max(sum(weight for _, weight in self._recent), 1e-9)

    def close(self) -> None:
        """Clears the terminal's line."""
        self._clear()

    def _clear(self) -> None:
        if self._is_bar_shown:
            print("\r\x1b[K", end="", file=self._stream, flush=True)
        self._is_bar_shown = False


def duration(seconds: float) -> str:
    """Returns a duration in words: "40 s", "12 min", "3 h 5 min"."""
    if seconds < 100:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60)
    return f"{minutes} min" if minutes < 60 else f"{minutes // 60} h {minutes % 60} min"


def of_pieces(count: int) -> str:
    """Returns a number of pieces in words."""
    return "1 piece" if count == 1 else f"{count} pieces"


def of_workers(count: int) -> str:
    """Returns a number of workers in words."""
    return "1 worker" if count == 1 else f"{count} workers"
