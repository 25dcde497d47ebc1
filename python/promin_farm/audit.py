# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""A sample of a job's pieces is made once more, here, and its bits are compared with those that are there."""

from __future__ import annotations

import hashlib
import math
from dataclasses import dataclass, field

from promin import jobs

from promin_farm.survey import take_survey


@dataclass
class Audit:
    """What was found."""

    fingerprint: str
    """Of this process."""
    equal: list[str] = field(default_factory=list)
    """Names of pieces, as of all others."""
    differing: list[str] = field(default_factory=list)
    """Of the same fingerprint with other bits, which must not be."""
    equal_across: list[str] = field(default_factory=list)
    """Of another fingerprint, with the same bits nevertheless."""
    differing_across: list[str] = field(default_factory=list)
    """Of another fingerprint, with other bits."""

    def describe(self) -> str:
        """A sentence or two."""
        within = len(self.equal) + len(self.differing)
        across = len(self.equal_across) + len(self.differing_across)
        lines = []
        if within or not across:
            lines.append(f"{len(self.equal)} of {within} pieces of this fingerprint have equal bits")
        if across:
            lines.append(f"{len(self.equal_across)} of {across} pieces of other fingerprints have equal bits")
        if self.differing:
            lines.append(f"promin-farm: error: other bits of the same fingerprint: {', '.join(self.differing)}")
        return "\n".join(lines)


def parse_share(words: str) -> float:
    """Of "1%" or "0.01". Raises UsageError."""
    try:
        share = float(words[:-1]) / 100.0 if words.endswith("%") else float(words)
    except ValueError:
        share = math.nan
    if not 0.0 < share <= 1.0:
        raise jobs.UsageError(f"--share is {words!r}, on the command line; give a part, as 1% or 0.01")
    return share


def pick_sample(job: jobs.Job, numbers: list[int], share: float, seed: int) -> list[int]:
    """The same for a job and a seed: those of the least hashes, one at least."""

    def key(number: int) -> str:
        return hashlib.sha256(f"{job.id} {seed} {number}".encode()).hexdigest()

    return sorted(sorted(numbers, key=key)[: math.ceil(share * len(numbers))])


def audit(job: jobs.Job, share: str, seed: int, device: str | None) -> Audit:
    """Raises RunError where no piece is there, and promin's errors."""
    part = parse_share(share)
    survey = take_survey(job)
    sample = pick_sample(job, sorted(survey.done), part, seed)
    if not sample:
        raise jobs.RunError(f"no piece is there to be audited, {job.folder}; run promin-farm resume first")
    runner = job.runner(device)
    found = Audit(runner.fingerprint)
    for number in sample:
        is_equal = runner.recompute(number) == job.sha256(number)
        receipt = job.receipt(number)
        is_within = receipt is not None and receipt.fingerprint == runner.fingerprint
        names = {
            (True, True): found.equal,
            (True, False): found.differing,
            (False, True): found.equal_across,
            (False, False): found.differing_across,
        }[is_within, is_equal]
        names.append(job.pieces[number].name)
    return found
