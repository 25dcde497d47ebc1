# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Exit codes, the same as those of promin's programs."""

from __future__ import annotations

from promin import jobs


def exit_code_of(error: BaseException) -> int:
    """Returns the exit code: 1 for failures while running, 2 for wrong use, 3 for bad input, 4 for a missing device."""
    if isinstance(error, jobs.UsageError):
        return 2
    if isinstance(error, jobs.InputError):
        return 3
    return 4 if isinstance(error, jobs.DeviceError) else 1
