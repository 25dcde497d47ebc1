# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""A crew of processes on this machine. The command sends numbers of pieces to them through pipes and gets answers back
(promin_farm.seat)."""

from __future__ import annotations

import json
import os
import queue
import socket
import subprocess
import sys
import threading
import time
from collections import deque
from dataclasses import dataclass
from typing import Any

from promin import jobs

from promin_farm.worker import Answer

_PATIENCE_S = 180.0
_GOES_WITHIN_S = 5.0
"""Seconds after which a process that must end is killed, because it is still making a piece or compiling."""
_PROGRAM = "import sys; sys.path[:] = {path!r}; from promin_farm import seat; seat.main({folder!r})"


@dataclass(frozen=True)
class Seat:
    """A seat for a worker: a device and, if the device is a CPU, a number of threads."""

    device: str | None
    """An argument of `--device`; None stands for the default device."""
    threads: int | None = None

    @property
    def environment(self) -> dict[str, str]:
        """Environment variables of the worker's process; lavapipe reads them when the first device is opened."""
        words = {"PROMIN_DEVICE": self.device} if self.device else {}
        return words | ({"LP_NUM_THREADS": str(self.threads)} if self.threads else {})


def count_cores() -> int:
    """Returns the number of cores that this process may use."""
    return len(os.sched_getaffinity(0))


def deal_seats(devices: list[str], count: int | None) -> list[Seat]:
    """Returns a seat for each device, or `count` seats that share the devices. All workers of a machine share its
    cores.

    devices: arguments of `--device`. An empty list stands for the default device, which may be a CPU."""
    count = count or max(1, len(devices))
    threads = max(1, count_cores() // count) if count > 1 else None
    return [Seat(devices[i % len(devices)] if devices else None, threads) for i in range(count)]


class _Process:
    """A worker process. It gets one number at a time, so that the crew can withdraw the other pieces."""

    def __init__(self, folder: str, seat: Seat, ended: queue.SimpleQueue[tuple[str, int, Answer]]) -> None:
        self.seat = seat
        self._ended = ended
        self._waiting: deque[int] = deque()
        self._at: int | None = None
        self._lock = threading.Lock()
        self._popen = subprocess.Popen(
            [sys.executable, "-c", _PROGRAM.format(path=sys.path, folder=folder)],
            env={**os.environ, **seat.environment},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            # Ctrl-C in a terminal must reach only the command, which decides about pieces.
            start_new_session=True,
        )
        self.name = f"{socket.gethostname()}-{self._popen.pid}"
        """The name of the process's ledger."""
        threading.Thread(target=self._read, name="promin-farm answers", daemon=True).start()

    def is_alive(self) -> bool:
        return self._popen.poll() is None

    def send(self, number: int) -> None:
        with self._lock:
            self._waiting.append(number)
            self._pass_on()

    def withdraw(self, number: int) -> None:
        with self._lock:
            if number in self._waiting:
                self._waiting.remove(number)

    def dismiss(self) -> None:
        """Closes the process's input, so that the process ends."""
        assert self._popen.stdin is not None
        try:
            self._popen.stdin.close()
        except OSError:
            pass

    def wait(self, until: float) -> None:
        """Kills the process if it has not ended by this time, measured with time.monotonic()."""
        try:
            self._popen.wait(max(0.0, until - time.monotonic()))
        except subprocess.TimeoutExpired:
            self._popen.kill()
            self._popen.wait()

    def _pass_on(self) -> None:
        if self._at is not None or not self._waiting:
            return
        self._at = self._waiting.popleft()
        assert self._popen.stdin is not None
        try:
            self._popen.stdin.write(f"{self._at}\n")
            self._popen.stdin.flush()
        except (OSError, ValueError):
            pass  # The process has ended, and the crew notices this later.

    def _read(self) -> None:
        assert self._popen.stdout is not None
        for line in self._popen.stdout:
            number, answer = json.loads(line)
            self._ended.put((self.name, number, answer))
            with self._lock:
                self._at = None
                self._pass_on()


class LocalCrew:
    """A crew with one process for each seat. If a process ends, another one takes its seat."""

    patience_s = _PATIENCE_S
    most_at_once = 4

    def __init__(self, job: jobs.Job, seats: list[Seat]) -> None:
        self._folder = job.folder
        self._ended: queue.SimpleQueue[tuple[str, int, Answer]] = queue.SimpleQueue()
        self._processes = [self._start(seat) for seat in seats]

    def _start(self, seat: Seat) -> _Process:
        try:
            return _Process(self._folder, seat, self._ended)
        except OSError as error:
            raise jobs.RunError(f"a worker cannot be started ({error.strerror}), on this machine; try again") from error

    def members(self) -> set[str]:
        for place, process in enumerate(self._processes):
            if not process.is_alive():
                self._processes[place] = self._start(process.seat)
        return {process.name for process in self._processes}

    def send(self, member: str, number: int) -> None:
        for process in self._find(member):
            process.send(number)

    def next_answer(self, timeout_s: float) -> tuple[str, int, Answer | None] | None:
        try:
            return self._ended.get(timeout=timeout_s)
        except queue.Empty:
            return None

    def withdraw(self, member: str, number: int) -> None:
        for process in self._find(member):
            process.withdraw(number)

    def forget(self, member: str) -> None:
        """Answers that a dead process has sent still count."""

    def _find(self, member: str) -> list[_Process]:
        return [process for process in self._processes if process.name == member]

    def __enter__(self) -> LocalCrew:
        return self

    def __exit__(self, *_: Any) -> None:
        until = time.monotonic() + _GOES_WITHIN_S
        for process in self._processes:
            process.dismiss()
        for process in self._processes:
            process.wait(until)
