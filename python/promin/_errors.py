# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""promin's exceptions: the classes of include/promin/error.h, with the same sentences."""

from __future__ import annotations

from collections.abc import Iterable
from typing import ClassVar, NamedTuple


class Problem(NamedTuple):
    """One reason of an error. `str(problem)` is its sentence, "WHERE: WHAT; CURE"."""

    code: str
    """The kind of the problem, such as "job.piece.cut". Codes do not change between versions; sentences may."""
    where: str
    """The place of the problem: a file, then ": " and a place in the file; or a member of a scene. May be empty."""
    what: str
    """The problem, as a sentence without its full stop."""
    cure: str
    """The way to solve the problem, as a sentence without its full stop. May be empty."""

    def __str__(self) -> str:
        return (self.where and self.where + ": ") + self.what + (self.cure and "; " + self.cure)


class Error(Exception):
    """Base class of promin's exceptions. `str(error)` is the first problem's sentence. The sentences of other problems
    follow, one on each line."""

    problems: tuple[Problem, ...]
    """The problems; there is at least one."""

    _CODE: ClassVar[str] = "work.failed"

    def __init__(self, message: str, problems: Iterable[Iterable[str]] = ()) -> None:
        super().__init__(message)
        what, _, cure = message.partition("; ")
        self.problems = tuple(Problem(*problem) for problem in problems) or (Problem(self._CODE, "", what, cure),)

    def __reduce__(self) -> tuple[type[Error], tuple[str, tuple[Problem, ...]]]:
        return type(self), (str(self), self.problems)


class UsageError(Error, ValueError):
    """An argument is wrong. The code is "argument.wrong" if this package detects the error itself."""

    _CODE = "argument.wrong"


class InputError(Error):
    """A scene file, ray file, BVH file or input picture is invalid, or a scene in memory is."""

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
