# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""The work of a process of the farm: it opens the job once, computes its fingerprint, and makes pieces.

The functions `prove` and `make` take strings and numbers and return JSON values, so that nothing else is transferred.
They return an error as a sentence and raise no exception, because an exception from another machine says less. Each
answer has one of these keys:

    proof     the fingerprint and what the process is
    idle      why this process can do nothing here (no device)
    refused   why it must not (another scene, other bits), and `exit_code`
    done      the receipt of a piece
    failed    why a piece was not made, and `is_disk_full`
    elsewhere the fingerprint that the piece must have
    left      the piece was left because it was asked to"""

from __future__ import annotations

import os
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

from promin import jobs

from promin_farm.errors import exit_code_of
from promin_farm.presence import Heart, Start
from promin_farm.settings import Settings, claim_group, group_of

Answer = dict[str, Any]

_DISK_FULL = ("No space left on device", "Disk quota exceeded", "File too large")


class Bench:
    """A job that is open in this process: its scene, its device and its compiled kernels."""

    def __init__(self, folder: str, device: str | None, say: Callable[[str], None]) -> None:
        """say: a function that receives the name of the current step. Raises promin's errors."""
        self.folder = Path(folder)
        self.stamp = _stamp_of(self.folder)
        self.job = jobs.open(folder)
        self.settings = Settings.read(self.folder)
        start = Start(self.folder, say)
        self.runner = self.job.runner(device, on_step=start.tell)
        start.tell("checks its device")
        fingerprint = self.runner.fingerprint
        start.tell("makes pieces")
        self.heart = Heart(self.folder, fingerprint, str(getattr(self.runner, "made_on", "")))

    def find_obstacle(self, number: int | None) -> Answer | None:
        """Returns an obstacle if the whole job, or a piece, needs bits of another fingerprint than this process has."""
        if number is None and self.settings.allow_mixed:
            return None
        group = "job" if number is None else group_of(self.job, self.job.pieces[number], self.settings)
        owner = claim_group(self.folder, group, self.runner.fingerprint)
        if owner == self.runner.fingerprint:
            return None
        if self.settings.allow_mixed:
            return {"elsewhere": owner}
        return _refuse(
            f"this worker gives other bits, {self.heart.presence.name}: its fingerprint is "
            f"{self.runner.fingerprint[:16]}, that of the job {owner[:16]}; use machines of one kind, or resume with "
            "--allow-mixed",
            1,
        )

    def close(self) -> None:
        self.heart.stop()


_bench: Bench | None = None
_using = threading.RLock()


def prove(folder: str, device: str | None = None, say: Callable[[str], None] = lambda words: None) -> Answer:
    """Opens the job unless it is open, and returns the fingerprint of this process.

    device: an argument of `--device`; None: the environment variable PROMIN_DEVICE, or the default device. say: a
    function that receives the current step, which is also recorded in the folder."""
    with _using:
        try:
            bench = _open(folder, device, say)
            obstacle = bench.find_obstacle(None)
            if obstacle:
                return obstacle
            presence = bench.heart.presence
        except jobs.DeviceError as error:
            return {"idle": str(error), "exit_code": exit_code_of(error)}
        except Exception as error:
            return _refuse(_sentence(error), exit_code_of(error))
        return {
            "proof": presence.fingerprint,
            "name": presence.name,
            "device": presence.device,
            "ends_at": float(os.environ.get("PROMIN_FARM_ENDS_AT", "inf")),
        }


def make(folder: str, number: int, stop: Callable[[], bool] | None = None) -> Answer:
    """Makes a piece unless it is done. stop: a function that is called during the work and abandons the piece by
    returning True."""
    with _using:
        try:
            bench = _open(folder, None)
        except jobs.DeviceError as error:
            return {"idle": str(error), "exit_code": exit_code_of(error)}
        except Exception as error:
            return _refuse(_sentence(error), exit_code_of(error))
        try:
            obstacle = bench.find_obstacle(number)
            if obstacle:
                return obstacle
            receipt = bench.runner.run(number, stop)
        except jobs.Cancelled:
            return {"left": True}
        except Exception as error:
            if isinstance(error, jobs.DeviceError):
                close()  # A lost device is closed here and opened again for the next piece.
            sentence = _sentence(error)
            return {"failed": sentence, "is_disk_full": any(words in sentence for words in _DISK_FULL)}
        return {"done": receipt.to_dict()}


def close() -> None:
    """Closes the open job."""
    global _bench
    with _using:
        if _bench:
            _bench.close()
        _bench = None


def _open(folder: str, device: str | None, say: Callable[[str], None] = lambda words: None) -> Bench:
    global _bench
    if _bench and (str(_bench.folder) != folder or _stamp_of(_bench.folder) != _bench.stamp):
        close()  # The open job is another job, or an older job in the same folder.
    if _bench:
        _bench.settings = Settings.read(_bench.folder)
    else:
        _bench = Bench(folder, device or os.environ.get("PROMIN_DEVICE") or None, say)
    return _bench


def _stamp_of(folder: Path) -> tuple[int, int, int] | None:
    """Returns a value that changes if the job's manifest is written again."""
    try:
        status = (folder / "job.json").stat()
    except OSError:
        return None
    return status.st_ino, status.st_mtime_ns, status.st_size


def _refuse(sentence: str, exit_code: int) -> Answer:
    return {"refused": sentence, "exit_code": exit_code}


def _sentence(error: Exception) -> str:
    """Returns an exception as a sentence. Errors of promin are sentences; for others the type is added."""
    return str(error) if isinstance(error, jobs.Error) else f"{type(error).__name__}: {error}"
