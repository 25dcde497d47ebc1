# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Makes a sample of a job's pieces again on this machine and compares it with the existing pieces. Pieces of the same
fingerprint must have equal bits; others must agree within the published bounds."""

from __future__ import annotations

import hashlib
import math
from dataclasses import dataclass, field

from promin import jobs

from promin_farm.survey import take_survey


@dataclass
class Audit:
    """The results of an audit for each piece."""

    fingerprint: str
    """The fingerprint of this process."""
    within: dict[str, jobs.Comparison] = field(default_factory=dict)
    """Results by name for pieces of this fingerprint, which must have equal bits."""
    across: dict[str, jobs.Comparison] = field(default_factory=dict)
    """Results for pieces of other fingerprints, which must agree within the published bounds."""

    @property
    def is_good(self) -> bool:
        """Returns whether all audited pieces are correct."""
        return all(found.is_equal for found in self.within.values()) and all(
            found.is_within for found in self.across.values()
        )

    def describe(self) -> str:
        """Returns a line for each piece whose bits differ, then the counts."""
        lines = []
        for name, found in self.within.items():
            if not found.is_equal:
                lines.append(f"{name}: other bits of the same fingerprint, {_describe(found)}: a machine is broken")
        for name, found in self.across.items():
            if not found.is_equal:
                lines.append(f"{name}: {'within' if found.is_within else 'beyond'} the bounds, {_describe(found)}")
        if self.within or not self.across:
            equal = sum(found.is_equal for found in self.within.values())
            lines.append(f"{equal} of {len(self.within)} pieces of this fingerprint have equal bits")
        if self.across:
            equal = sum(found.is_equal for found in self.across.values())
            good = sum(found.is_within for found in self.across.values())
            lines.append(
                f"of {len(self.across)} pieces of other fingerprints {equal} have equal bits, {good - equal} are "
                f"within the bounds, {len(self.across) - good} beyond"
            )
        return "\n".join(lines)


def _describe(found: jobs.Comparison) -> str:
    share = f"{100.0 * found.mismatches / max(found.count, 1):.3g} % see another surface"
    return f"{share}, the rest differs by at most {found.largest:.3g}" if found.mismatches < found.count else share


def parse_share(words: str) -> float:
    """Returns the share as a number, for "1%" or "0.01". Raises UsageError."""
    try:
        share = float(words[:-1]) / 100.0 if words.endswith("%") else float(words)
    except ValueError:
        share = math.nan
    if not 0.0 < share <= 1.0:
        raise jobs.UsageError(f"--share is {words!r}; give a fraction such as 1% or 0.01")
    return share


def pick_sample(job: jobs.Job, numbers: list[int], share: float, seed: int) -> list[int]:
    """Returns a sample of the pieces: those with the smallest hashes, at least one. The same job and seed give the same
    sample."""

    def key(number: int) -> str:
        return hashlib.sha256(f"{job.id} {seed} {number}".encode()).hexdigest()

    return sorted(sorted(numbers, key=key)[: math.ceil(share * len(numbers))])


def audit(job: jobs.Job, share: str, seed: int, device: str | None) -> Audit:
    """Audits a sample of the pieces. Raises RunError if no piece is done, and promin's errors."""
    part = parse_share(share)
    survey = take_survey(job)
    sample = pick_sample(job, sorted(survey.done), part, seed)
    if not sample:
        raise jobs.RunError(f"the job has no piece to audit, {job.folder}; run promin-farm resume first")
    runner = job.runner(device)
    found = Audit(runner.fingerprint)
    for number in sample:
        receipt = job.receipt(number)
        is_within = receipt is not None and receipt.fingerprint == runner.fingerprint
        kind = found.within if is_within else found.across
        kind[job.pieces[number].name] = runner.compare(number)
    return found
