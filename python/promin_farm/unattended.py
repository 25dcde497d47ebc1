# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""What a worker of this machine loads first: Ctrl-C in a terminal reaches all processes there, and it is the command that
decides what becomes of pieces at hand."""

from __future__ import annotations

import signal


def dask_setup(worker: object) -> None:
    """Dask calls it in the worker's main thread."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
