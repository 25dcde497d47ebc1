# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""A worker process on this machine, which `processes` starts. It reads a number per line and makes that piece, or
computes its fingerprint for PROOF. It writes the number and the answer as a line of JSON. It ends when its standard
input ends, and then abandons its current piece."""

from __future__ import annotations

import json
import os
import queue
import sys
import threading

from promin_farm import worker
from promin_farm.foreman import PROOF


def main(folder: str) -> None:
    """Works until the standard input ends."""
    answers = os.fdopen(os.dup(1), "w", buffering=1)
    # Keeps the output of drivers out of the answers.
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
