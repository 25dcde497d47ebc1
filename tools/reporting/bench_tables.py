#!/usr/bin/env python3
# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Prints what reports of the sections rates, peers and scaling tell of speed as Markdown tables, beside what is aimed
at, and gathers them in one file; tools/bench calls it."""

import argparse
import pathlib

import peer_tables
from figures import gap_text, markdown_table, number
from report_file import read_report, write_report

# What is to be reached on a driver: (rate over Embree's for camera, shadow and random rays, time over Tachyon's).
_TARGETS = {"Mesa 22.3.6": (0.45, 0.42, 0.33, 1.5), "Mesa 25.0.7": (0.75, 0.62, 0.5, 1.0)}
_MOST_BUILD_TIME = 1.5  # over Embree's
_MOST_BYTES = 100  # a triangle
_RAYS = ("camera", "shadow", "random")


def _target(value, least=None, most=None):
    """What is aimed at, and whether the value meets it."""
    if value is None or (least is None and most is None):
        return "–"
    if least is not None:
        return f"≥ {least}: {'yes' if value >= least else 'no'}"
    return f"≤ {most}: {'yes' if value <= most else 'no'}"


def _targets_of(report):
    driver = report["provenance"]["driver"]
    return next((targets for key, targets in _TARGETS.items() if key in driver), (None,) * 4)


def _ratio_of(row, key="time_ratio"):
    return row[key]["median"] if key in row else None


def _rate_target(report, row):
    """Of rates, hence the other way round than of times."""
    ratio = _ratio_of(row)
    return _target(ratio and 1 / ratio, least=dict(zip(_RAYS, _targets_of(report)))[row["rays"]])


def _picture_target(report, row):
    return _target(_ratio_of(row), most=_targets_of(report)[3] if row["peer"].startswith("Tachyon") else None)


def _table(reports, section, key, columns, further=()):
    """The rows of all reports, with the driver before and what is of report and row behind."""
    columns = [("driver", lambda of: of[0]["provenance"]["driver"])] + [
        (head, lambda of, make=make: make(of[1])) for head, make in columns
    ]
    columns += [(head, lambda of, make=make: make(*of)) for head, make in further]
    return markdown_table(columns, [(r, row) for r in reports for row in r.get(section, {}).get(key, [])])


def _growth_table(report):
    rows = {(r["curve"], r["value"]): r for r in report["scaling"]["rows"] if r["variable"] == "triangles"}
    sizes = sorted({value for _, value in rows})
    columns = [("triangles", lambda size: f"{size:.0f}")]
    for figure, name in (("node_steps_per_ray", ""), ("primitive_tests_per_ray", "tests: ")):
        columns += [(name + rays, lambda s, r=rays, f=figure: number(rows[r, s][f])) for rays in _RAYS]
    fits = {fit["id"]: fit for fit in report["scaling"]["fits"]}
    steps = [fits[f"triangles/{rays}/node_steps_per_ray"] for rays in _RAYS]
    last = [f"{fit['per_doubling']:.2f} ({fit['r_squared']:.3f})" for fit in steps]
    return markdown_table(columns, sizes) + f"| steps a doubling (r²) | {' | '.join(last)} |  |  |  |\n"


def tables(reports, growth):
    """The text, in parts."""
    p = reports[0]["provenance"]
    peers = [row["peer"] for row in reports[0]["rates"]["rows"] if "peer" in row]
    runs = ", ".join(
        f"{q['runs']} runs in turns on {q['driver']} ({q['device_type']})" for q in (r["provenance"] for r in reports)
    )
    yield (
        f"{p['cpu']}, {p['threads']} threads; {p['date']}, commit {p['commit']}; {peers[0] if peers else 'no Embree'}. "
        f"Medians with quartiles of {runs}.\n"
    )
    yield (
        "Rays; ratios are promin's time over that of Embree in the same turn, targets of promin's rate over Embree's:\n"
    )
    rates = [
        ("rate over Embree's", lambda _, r: number(1 / _ratio_of(r)) if _ratio_of(r) else "–"),
        ("target", _rate_target),
    ]
    yield _table(reports, "rates", "rows", peer_tables.RAYS, rates)
    yield "From triangles in memory to all that is copied to the device, against rtcCommitScene:\n"
    builds = [
        ("target", lambda _, r: _target(_ratio_of(r), most=_MOST_BUILD_TIME)),
        ("target", lambda _, r: _target(r["device_bytes_per_primitive"], most=_MOST_BYTES)),
    ]
    yield _table(reports, "rates", "builds", peer_tables.BUILDS, builds)
    yield "Pictures beside what cast takes for their own rays, set by set:\n"
    yield _table(reports, "rates", "pictures", peer_tables.OVER_RAYS)
    yield "Sphereflake of 7381 mirror spheres on a plane, 1024², 6 bounces, tracing:\n"
    yield _table(reports, "peers", "rows", peer_tables.PICTURES, [("target", _picture_target)])
    for report in reports:
        yield gap_text(report.get("peers", {}).get("gaps", []))
    yield "First picture: its whole process over its tracing and twice the process of one sphere at 16²:\n"
    first = [("target", lambda _, r: _target(_ratio_of(r), most=1))]
    yield _table(reports, "peers", "first", peer_tables.FIRST, first)
    yield "Node steps and primitive tests a ray over the triangles of a wavy sphere:\n"
    yield _growth_table(growth)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("reports", nargs="+", type=pathlib.Path, help="report.json of each driver, the system's first")
    parser.add_argument("--growth", type=pathlib.Path, required=True, help="report.json with the section scaling")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True, help="the .json file")
    arguments = parser.parse_args()
    reports, growth = [read_report(file) for file in arguments.reports], read_report(arguments.growth)
    write_report(
        {"drivers": {file.parent.name: r for file, r in zip(arguments.reports, reports)}, "growth": growth},
        arguments.output,
    )
    print("\n".join(part for part in tables(reports, growth) if part))


if __name__ == "__main__":
    main()
