# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""What promin raises: the classes of include/promin/error.h, with the same sentences."""

from __future__ import annotations

from collections.abc import Iterable


class Error(Exception):
    """Base of what promin raises. `str(error)` is the first problem's sentence, and the others on lines after it."""

    problems: tuple[str, ...]
    """The reasons, at least one; each says what, where, and what to do."""

    def __init__(self, message: str, problems: Iterable[str] = ()) -> None:
        super().__init__(message)
        self.problems = tuple(problems) or (message,)

    def __reduce__(self) -> tuple[type[Error], tuple[str, tuple[str, ...]]]:
        return type(self), (str(self), self.problems)


class UsageError(Error, ValueError):
    """An argument is wrong."""


class InputError(Error):
    """A scene, ray or BVH file or a picture to read is bad, or a scene in memory."""


class DeviceError(Error):
    """There is no usable Vulkan device, or none that was asked for."""


class DifferenceError(Error, AssertionError):
    """Two pictures differ by more than was allowed."""


class Cancelled(Error):
    """A `progress` wanted an end by returning False. What was asked to do the work stays usable."""


class RunError(Error):
    """Something failed while running: input or output, memory, a lost device."""
