# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""A worker process on this machine, which `processes` starts. It reads one number per line and makes the piece with
this number, or computes its fingerprint if the number is PROOF. It writes the number and the answer as a line of JSON.
When its standard input ends, it abandons its current piece and ends."""

from __future__ import annotations

import json
import os
import queue
import sys
import threading

from promin_farm import worker
from promin_farm.foreman import PROOF


def main(folder: str) -> None:
    """Makes pieces until the standard input ends."""
    answers = os.fdopen(os.dup(1), "w", buffering=1)
    # Sends the output of drivers to standard error, so that standard output contains only answers.
    os.dup2(2, 1)
    numbers: queue.SimpleQueue[int | None] = queue.SimpleQueue()
    is_over = threading.Event()

    def read() -> None:
        for line in sys.stdin:
            numbers.put(int(line))
        is_over.set()
        numbers.put(None)

    threading.Thread(target=read, name="promin-farm orders", daemon=True).start()
    while (number := numbers.get()) is not None and not is_over.is_set():
        answer = worker.prove(folder) if number == PROOF else worker.make(folder, number, is_over.is_set)
        try:
            answers.write(json.dumps([number, answer]) + "\n")
        except BrokenPipeError:
            break
    worker.close()
