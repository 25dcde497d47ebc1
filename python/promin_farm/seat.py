# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""A worker process of this machine, which `processes` starts: reads a number a line, makes that piece, or proves itself
for PROOF, and writes the number and the answer as a line of JSON. It ends with its standard input, and leaves the piece
that it is at then."""

from __future__ import annotations

import json
import os
import queue
import sys
import threading

from promin_farm import worker
from promin_farm.foreman import PROOF


def main(folder: str) -> None:
    """Works until there is nobody left to work for."""
    answers = os.fdopen(os.dup(1), "w", buffering=1)
    # What a driver prints is no answer.
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
