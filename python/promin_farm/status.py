# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""The progress of a job, in words and as JSON."""

from __future__ import annotations

import time
from typing import Any

from promin import jobs

from promin_farm.survey import Survey
from promin_farm.watch import duration

_SLOWEST = 5


def describe_rate(job: jobs.Job, survey: Survey) -> str:
    """Returns the work per second, such as "1.5 M pixels a second"; empty if nothing was made."""
    return f"{_amount(survey.rate)} {_unit_of(job)} a second" if survey.rate is not None else ""


def slowest(survey: Survey) -> list[tuple[int, float]]:
    """Returns the numbers and the milliseconds of the pieces that took longest."""
    times = [(number, float(receipt["ms"])) for number, receipt in survey.receipts.items() if "ms" in receipt]
    return sorted(times, key=lambda item: -item[1])[:_SLOWEST]


def to_json(job: jobs.Job, survey: Survey) -> dict[str, Any]:
    """Returns the status as a dict for JSON. Times are in seconds, None if unknown."""
    names = [piece.name for piece in job.pieces]
    return {
        "id": job.id,
        "kind": job.kind,
        "folder": job.folder,
        "pieces": survey.total,
        "done": len(survey.done),
        "running": [
            {"piece": names[s.number], "worker": s.worker, "for_s": round(time.time() - s.begun, 3)}
            for s in survey.running
        ],
        "failed": [{"piece": names[n], "reason": tries.reason} for n, tries in sorted(survey.failed.items())],
        "tries": {
            names[n]: {"failures": t.failures, "deaths": t.deaths, "reason": t.reason}
            for n, t in sorted(survey.tries.items())
        },
        "weight_done": survey.weight_done,
        "weight_left": survey.weight_left,
        f"{_unit_of(job)}_per_s": survey.rate,
        "time_left_s": survey.time_left_s,
        "slowest": [{"piece": names[n], "ms": ms} for n, ms in slowest(survey)],
        "fingerprints": _count_fingerprints(survey),
    }


def describe(job: jobs.Job, survey: Survey) -> str:
    """Returns a description of the status in a few lines."""
    share = 100.0 * survey.weight_done / max(survey.weight_done + survey.weight_left, 1e-9)
    lines = [
        f"{job.kind} of {survey.total} pieces: {len(survey.done)} done ({share:.0f} %), {len(survey.running)} running, "
        f"{len(survey.failed)} failed"
    ]
    if rate := describe_rate(job, survey):
        lines.append(rate)
    if survey.time_left_s is not None:
        lines.append(f"{duration(survey.time_left_s)} left")
    for number, tries in sorted(survey.failed.items()):
        lines.append(f"failed: {job.pieces[number].name}, {tries.describe()}")
    for stretch in survey.running:
        lines.append(
            f"running: {job.pieces[stretch.number].name} by {stretch.worker} for {duration(time.time() - stretch.begun)}"
        )
    for number, ms in slowest(survey):
        lines.append(f"slow: {job.pieces[number].name}, {ms / 1e3:.2f} s")
    if len(fingerprints := _count_fingerprints(survey)) > 1:
        lines.append("fingerprints: " + ", ".join(f"{name[:16]} ({count})" for name, count in fingerprints.items()))
    return "\n".join(lines)


def _unit_of(job: jobs.Job) -> str:
    """Returns the unit of a job's work."""
    return "rays" if job.kind == "cast" else "pixels"


def _amount(value: float) -> str:
    """Returns a number with a letter for thousands, millions or billions."""
    for factor, letter in ((1e9, "G"), (1e6, "M"), (1e3, "k")):
        if value >= factor:
            return f"{value / factor:.3g} {letter}"
    return f"{value:.3g}"


def _count_fingerprints(survey: Survey) -> dict[str, int]:
    counts: dict[str, int] = {}
    for fingerprint in survey.fingerprints.values():
        counts[fingerprint] = counts.get(fingerprint, 0) + 1
    return counts
