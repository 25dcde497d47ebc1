# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""The workers of a job. Each worker has a file `farm/workers/HOST-PID.json` in the job's folder, which it touches while
it runs."""

from __future__ import annotations

import json
import os
import socket
import threading
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path

from promin_farm.files import read_json, write_whole

BEAT_S = 10.0
_LOOK_S = 0.5
_MOST_TOLD = 8
"""Number of processes whose starting steps are shown."""
STALE_S = 60.0
"""Time in seconds. A worker on another host counts as dead if it has not touched its file for this time."""


@dataclass(frozen=True)
class Presence:
    """A worker."""

    host: str
    pid: int
    started: int
    """Start of the process in the kernel's clock ticks, which distinguishes it from a later process with the same
    number."""
    fingerprint: str
    device: str
    """Device and driver of the worker, in readable form."""
    threads: str
    """LP_NUM_THREADS of the worker; empty if the driver chooses the number of threads."""

    @property
    def name(self) -> str:
        """The name of the worker's ledger."""
        return f"{self.host}-{self.pid}"


class Heart:
    """Writes this process's file and touches it on a separate thread until `stop`."""

    def __init__(self, folder: Path, fingerprint: str, device: str) -> None:
        self.presence = Presence(
            host=socket.gethostname(),
            pid=os.getpid(),
            started=_start_of(os.getpid()) or 0,
            fingerprint=fingerprint,
            device=device,
            threads=os.environ.get("LP_NUM_THREADS", ""),
        )
        self._file = folder / "farm" / "workers" / f"{self.presence.name}.json"
        self._ends = threading.Event()
        self._write()
        threading.Thread(target=self._beat, name="promin-farm heart", daemon=True).start()

    def stop(self) -> None:
        """Records that the worker has ended."""
        self._ends.set()
        try:
            os.utime(self._file, (0, 0))
        except OSError:
            pass

    def _write(self) -> None:
        try:
            write_whole(self._file, json.dumps(asdict(self.presence)) + "\n")
        except OSError:
            pass  # A full disk must not end a worker that only reports its presence.

    def _beat(self) -> None:
        while not self._ends.wait(BEAT_S):
            try:
                os.utime(self._file)
            except FileNotFoundError:
                self._write()
            except OSError:
                pass


class Start:
    """Records the steps of a process that starts to work on a job. It writes a line with a few words for each step to
    `farm/starts/HOST-PID`."""

    def __init__(self, folder: Path, also: Callable[[str], None]) -> None:
        """also: a function that receives the words too."""
        self._file = folder / "farm" / "starts" / f"{socket.gethostname()}-{os.getpid()}"
        self._also = also

    def tell(self, words: str) -> None:
        self._also(words)
        try:
            self._file.parent.mkdir(parents=True, exist_ok=True)
            with self._file.open("a") as stream:
                stream.write(words + "\n")
        except OSError:
            pass  # A full disk must not end a worker that only reports its steps.


class Starts:
    """Reads the steps of processes that start to work on a job. A command uses it while it waits for the first of these
    processes."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder / "farm" / "starts"
        self._ends = {file.name: file.stat().st_size for file in self._folder.glob("*")}
        """The end of the text that has been shown, for each ledger name."""
        self._told: set[str] = set()
        self._read_at = 0.0

    def tell_news(self, say: Callable[[str], None], now: float) -> None:
        """Reports new steps of a few processes. now: the time in seconds. The folder is read at most twice a
        second."""
        if now - self._read_at < _LOOK_S:
            return
        self._read_at = now
        for file in sorted(self._folder.glob("*")):
            if file.name in self._told or len(self._told) < _MOST_TOLD:
                self._tell_of(file, say)

    def _tell_of(self, file: Path, say: Callable[[str], None]) -> None:
        end = self._ends.get(file.name, 0)
        try:
            with file.open("rb") as stream:
                stream.seek(end)
                text = stream.read()
        except OSError:
            return
        whole = text[: text.rfind(b"\n") + 1]
        self._ends[file.name] = end + len(whole)
        for line in whole.decode(errors="replace").splitlines():
            self._told.add(file.name)
            say(f"{file.name} {line}")


class Roll:
    """Determines which processes are alive. Processes are named like their ledgers. The object checks each process once
    and caches the result."""

    def __init__(self, folder: Path) -> None:
        self.workers: dict[str, Presence] = {}
        self._ages: dict[str, float] = {}
        now = _now_of_disk(folder)
        for file in sorted((folder / "farm" / "workers").glob("*.json")):
            value = read_json(file)
            try:
                presence = Presence(**value) if value else None
                age = now - file.stat().st_mtime
            except (TypeError, OSError):
                continue
            if presence:
                self.workers[presence.name] = presence
                self._ages[presence.name] = age

    def is_alive(self, name: str, last_sign: float) -> bool:
        """Returns whether the process HOST-PID that writes a ledger is alive. last_sign: the time of its last line. For
        a process on another host without a file (a process of `promin render --job`), the last line decides: the
        process counts as dead after ten minutes."""
        host, _, pid_word = name.rpartition("-")
        presence = self.workers.get(name)
        if presence and self._ages[name] > 1e8:
            return False  # The worker has recorded its end.
        if host == socket.gethostname() and pid_word.isdigit():
            started = _start_of(int(pid_word))
            if started is None:
                return False
            return presence is None or presence.started == started
        if presence:
            return self._ages[name] < STALE_S
        return time.time() - last_sign < 600.0


def _now_of_disk(folder: Path) -> float:
    """Returns the current time of the file system, which may be on another machine."""
    probe = folder / "farm" / f".clock.{os.getpid()}.tmp"
    try:
        probe.parent.mkdir(exist_ok=True)
        probe.write_bytes(b"")
        now = probe.stat().st_mtime
        probe.unlink()
        return now
    except OSError:
        return time.time()


def _start_of(pid: int) -> int | None:
    """Returns the start of a process in clock ticks; None if there is no such process. A zombie does not count."""
    try:
        words = Path(f"/proc/{pid}/stat").read_bytes().rpartition(b")")[2].split()
    except OSError:
        return None
    return None if words[0] in (b"Z", b"X") else int(words[19])
