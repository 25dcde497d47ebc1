# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""promin's exceptions: the classes of include/promin/error.h, with the same sentences."""

from __future__ import annotations

from collections.abc import Iterable


class Error(Exception):
    """Base class of promin's exceptions. `str(error)` is the first problem's sentence; the others follow, one on a
    line."""

    problems: tuple[str, ...]
    """The reasons, at least one. Each names the problem, its place and a cure."""

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
    """There is no usable Vulkan device, or the requested one is missing."""


class DifferenceError(Error, AssertionError):
    """Two pictures differ by more than is allowed."""


class Cancelled(Error):
    """A `progress` callback returned False. The object that did the work stays usable."""


class RunError(Error):
    """Something failed while running: input or output, memory, a lost device."""
