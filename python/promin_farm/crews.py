# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Crews on Dask distributed: a cluster that is already running, or workers that a queue starts.

The module uses Dask's Client, of any version since 2022. Dask's scheduler carries numbers and receipts between the
foreman and the workers. The foreman decides which worker makes a piece."""

from __future__ import annotations

import importlib
import logging
import queue
import secrets
import time
from collections.abc import Callable
from typing import Any

from promin import jobs

from promin_farm import worker
from promin_farm.foreman import PROOF
from promin_farm.watch import of_workers

_LOST_S = 45
"""A nanny that has no worker after this time is given up, and another one takes its seat."""
_PATIENCE_S = 600.0
_TOP_UP_S = 15.0
_CONNECT_S = 20
"""Time to wait for a scheduler, in seconds."""


def need(module: str, package: str) -> Any:
    """Imports an optional module. Raises UsageError with the way to install it."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        raise jobs.UsageError(
            f"{package} is not installed ({error}), in this Python; run: pip install 'promin[farm]', or use "
            "promin-farm work, which does not need it"
        ) from error


class DaskCrew:
    """Workers of a Dask cluster."""

    most_at_once = 4

    def __init__(
        self, client: Any, job: jobs.Job, patience_s: float, keep_up: Callable[[], None] | None = None
    ) -> None:
        """keep_up: a function that requests new workers from a queue in place of lost ones. It is called from time to
        time."""
        self.patience_s = patience_s
        self._client = client
        self._folder = job.folder
        self._keep_up = keep_up
        self._kept_up = time.monotonic()
        # Two runs of one job use different task names in Dask, so each foreman gets only its own answers.
        self._keys = f"{job.id[:16]}-{secrets.token_hex(4)}"
        self._count = 0
        self._futures: dict[tuple[str, int], Any] = {}
        self._ended: queue.SimpleQueue[tuple[str, int, Any]] = queue.SimpleQueue()
        self._members: set[str] = set()
        self._looked = 0.0

    def members(self) -> set[str]:
        now = time.monotonic()
        if now - self._looked < 0.5:
            return self._members
        self._looked = now
        if self._keep_up and now - self._kept_up > _TOP_UP_S:
            self._kept_up = now
            self._keep_up()
        try:
            self._members = set(self._client.nthreads())
        except Exception as error:
            raise jobs.RunError(
                f"the connection to the scheduler is lost ({type(error).__name__}: {error}), {self._folder}; "
                "finished pieces are kept, and promin-farm resume continues"
            ) from error
        return self._members

    def send(self, member: str, number: int) -> None:
        self._count += 1
        words: tuple[Any, ...] = (
            (worker.prove, self._folder) if number == PROOF else (worker.make, self._folder, number)
        )
        future = self._client.submit(
            *words,
            key=f"{self._keys}-{number}-{self._count}",
            pure=False,
            workers=[member],
            allow_other_workers=False,
        )
        self._futures[member, number] = future
        future.add_done_callback(lambda ended: self._ended.put((member, number, ended)))

    def next_answer(self, timeout_s: float) -> tuple[str, int, worker.Answer | None] | None:
        try:
            member, number, future = self._ended.get(timeout=timeout_s)
        except queue.Empty:
            return None
        if (member, number) not in self._futures or self._futures[member, number] is not future:
            return None
        del self._futures[member, number]
        answer: worker.Answer | None = None  # The worker has ended; the piece may or may not be written.
        try:
            if future.status == "finished":
                answer = future.result(timeout=10)
            elif future.status == "error":
                answer = _refusal_of(future.exception(timeout=10))
        except Exception:
            pass
        future.release()
        return member, number, answer

    def withdraw(self, member: str, number: int) -> None:
        future = self._futures.pop((member, number), None)
        if future is not None:
            self._client.cancel([future])

    def forget(self, member: str) -> None:
        lost = [key for key in self._futures if key[0] == member]
        futures = [self._futures.pop(key) for key in lost]
        if futures:
            self._client.cancel(futures)


def _refusal_of(error: BaseException) -> worker.Answer | None:
    """The worker's functions raise nothing, so an exception comes from Dask: either the worker has died, which is
    handled elsewhere, or it cannot run them because it lacks this package or has another version of it."""
    if type(error).__name__ == "KilledWorker":
        return None
    words = f"it cannot run this promin-farm ({type(error).__name__}: {error})"
    return {"refused": f"{words}; install the same package there", "exit_code": 1}


def open_remote(job: jobs.Job, address: str, stack: Any) -> tuple[DaskCrew, str]:
    """Joins a cluster. Raises RunError if there is no cluster at the address."""
    quiet()
    distributed = need("distributed", "Dask distributed")
    try:
        client = stack.enter_context(distributed.Client(address, timeout=_CONNECT_S))
    except (OSError, ValueError) as error:
        raise jobs.RunError(
            f"the scheduler does not respond ({error}), {address}; start it with: dask scheduler"
        ) from error
    return DaskCrew(client, job, _PATIENCE_S), f"{of_workers(len(client.nthreads()))} of {address}"


def quiet() -> None:
    """Silences Dask's messages about workers that come and go. The foreman reports the important events."""
    dask = need("dask", "Dask distributed")
    dask.config.set(
        {
            "logging": {"distributed": "critical", "distributed.nanny": "critical", "distributed.worker": "critical"},
            "distributed.deploy.lost-worker-timeout": f"{_LOST_S}s",
            "distributed.scheduler.allowed-failures": 50,
            "distributed.comm.timeouts.connect": f"{_CONNECT_S}s",
        }
    )
    logging.getLogger("distributed").setLevel(logging.CRITICAL)
