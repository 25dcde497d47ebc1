# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""promin's exceptions: the classes of include/promin/error.h, with the same sentences."""

from __future__ import annotations

from collections.abc import Iterable
from typing import ClassVar, NamedTuple


class Problem(NamedTuple):
    """One reason of an error. `str(problem)` is its sentence, "WHERE: WHAT; CURE"."""

    code: str
    """The kind of the problem, such as "job.piece.cut". Codes are stable; sentences are not."""
    where: str
    """A file, and after ": " the place in it; or a member of a scene. May be empty."""
    what: str
    """The fault, as a sentence without its end."""
    cure: str
    """The remedy, as a sentence without its end. May be empty."""

    def __str__(self) -> str:
        return (self.where and self.where + ": ") + self.what + (self.cure and "; " + self.cure)


class Error(Exception):
    """Base class of promin's exceptions. `str(error)` is the first problem's sentence; the others follow, one on a
    line."""

    problems: tuple[Problem, ...]
    """The reasons, at least one."""

    _CODE: ClassVar[str] = "work.failed"

    def __init__(self, message: str, problems: Iterable[Iterable[str]] = ()) -> None:
        super().__init__(message)
        what, _, cure = message.partition("; ")
        self.problems = tuple(Problem(*problem) for problem in problems) or (Problem(self._CODE, "", what, cure),)

    def __reduce__(self) -> tuple[type[Error], tuple[str, tuple[Problem, ...]]]:
        return type(self), (str(self), self.problems)


class UsageError(Error, ValueError):
    """An argument is wrong. The code is "argument.wrong" where this package finds it itself."""

    _CODE = "argument.wrong"


class InputError(Error):
    """A scene, ray or BVH file or a picture to read is bad, or a scene in memory."""

    _CODE = "input.wrong"


class DeviceError(Error):
    """There is no usable Vulkan device, or the requested one is missing."""


class DifferenceError(Error, AssertionError):
    """Two pictures differ by more than is allowed."""

    _CODE = "picture.pair.differs"


class Cancelled(Error):
    """A `progress` callback returned False. The object that did the work stays usable."""


class RunError(Error):
    """Something failed while running: input or output, memory, a lost device."""
