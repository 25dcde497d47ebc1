#!/usr/bin/env python3
# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Prints what reports of the sections rates, peers and scaling tell of speed as Markdown tables, beside what is aimed
at, and gathers them in one file; tools/bench calls it."""

import argparse
import pathlib

from figures import markdown_table
from report_file import read_report, write_report

# What is to be reached on a driver: (rate over Embree's for camera, shadow and random rays, time over Tachyon's).
_TARGETS = {"Mesa 22.3.6": (0.45, 0.42, 0.33, 1.5), "Mesa 25.0.7": (0.75, 0.62, 0.5, 1.0)}
_MOST_BUILD_TIME = 1.5  # over Embree's
_MOST_BYTES = 100  # a triangle
_RAYS = ("camera", "shadow", "random")


def _number(value, digits=2):
    return "–" if value is None else f"{value:.{digits}f}"


def _spread(times, digits=2):
    """The median with its quartiles."""
    if times is None:
        return "–"
    low, high = times["lower_quartile"], times["upper_quartile"]
    return f"{times['median']:.{digits}f} ({low:.{digits}f}…{high:.{digits}f})"


def _rates(times):
    """A ratio of times as one of rates."""
    if times is None:
        return None
    low, high = times["lower_quartile"], times["upper_quartile"]
    return {"median": 1 / times["median"], "lower_quartile": 1 / high, "upper_quartile": 1 / low}


def _target(value, least=None, most=None):
    """What is aimed at, and whether the value or its median meets it."""
    value = value["median"] if isinstance(value, dict) else value
    if value is None or (least is None and most is None):
        return "–"
    if least is not None:
        return f"≥ {least}: {'yes' if value >= least else 'no'}"
    return f"≤ {most}: {'yes' if value <= most else 'no'}"


def _targets_of(report):
    driver = report["provenance"]["driver"]
    return next((targets for key, targets in _TARGETS.items() if key in driver), (None,) * 4)


def _least_rate(report, row):
    return dict(zip(_RAYS, _targets_of(report)))[row["rays"]]


_RATE_COLUMNS = [
    ("driver", lambda of: of[0]["provenance"]["driver"]),
    ("scene", lambda of: of[1]["scene"]),
    ("rays", lambda of: of[1]["rays"]),
    ("promin", lambda of: _number(of[1].get("promin_mrays_per_s"))),
    ("Embree", lambda of: _number(of[1].get("peer_mrays_per_s"))),
    ("packets of 8", lambda of: _number(of[1].get("peer_packets_mrays_per_s"))),
    ("ratio", lambda of: _spread(_rates(of[1].get("time_ratio")))),
    ("target", lambda of: _target(_rates(of[1].get("time_ratio")), least=_least_rate(*of))),
    ("other hits", lambda of: of[1].get("differing_hits", "–")),
    ("steps", lambda of: _number(of[1]["node_steps_per_ray"])),
    ("tests", lambda of: _number(of[1]["primitive_tests_per_ray"])),
]
_BUILD_COLUMNS = [
    ("scene", lambda row: row["scene"]),
    ("triangles", lambda row: row["primitives"]),
    ("builder", lambda row: row["builder"]),
    ("promin", lambda row: _spread(row["promin_ms"], 1)),
    ("BVH alone", lambda row: _spread(row["bvh_ms"], 1)),
    ("Embree", lambda row: _spread(row.get("peer_ms"), 1)),
    ("ratio", lambda row: _spread(row.get("time_ratio"))),
    ("BVH alone", lambda row: _spread(row.get("bvh_time_ratio"))),
    ("target", lambda row: _target(row.get("time_ratio"), most=_MOST_BUILD_TIME)),
    ("bytes a triangle", lambda row: _number(row["device_bytes_per_primitive"], 1)),
    ("target", lambda row: _target(row["device_bytes_per_primitive"], most=_MOST_BYTES)),
]
_PICTURE_COLUMNS = [
    ("driver", lambda of: of[0]["provenance"]["driver"]),
    ("peer", lambda of: of[1]["peer"]),
    ("promin", lambda of: _spread(of[1].get("promin_ms"), 0)),
    ("peer", lambda of: _spread(of[1].get("peer_ms"), 0)),
    ("ratio", lambda of: _spread(of[1].get("time_ratio"))),
    (
        "target",
        lambda of: _target(
            of[1].get("time_ratio"), most=_targets_of(of[0])[3] if of[1]["peer"].startswith("Tachyon") else None
        ),
    ),
    ("mean difference", lambda of: _number(of[1].get("mean_difference"), 5)),
    ("pixels > 0.02, %", lambda of: _number(of[1].get("different_pixels_percent"))),
]
_FIRST_COLUMNS = [
    ("driver", lambda of: of[0]["provenance"]["driver"]),
    ("process", lambda of: _spread(of[1]["process_ms"], 0)),
    ("its tracing", lambda of: _spread(of[1]["trace_ms"], 0)),
    ("one sphere at 16²", lambda of: _spread(of[1]["one_sphere_process_ms"], 0)),
    ("ratio", lambda of: _spread(of[1]["time_ratio"])),
    ("target", lambda of: _target(of[1]["time_ratio"], most=1)),
]


def _pictures_of(report):
    """Those beside peers, and promin's own time where a peer has none."""
    section = report.get("peers", {"rows": [], "first": [], "gaps": []})
    for row in section["rows"]:
        yield report, row
    for gap in section["gaps"]:
        own = {"promin_ms": section["first"][0]["trace_ms"]} if section["first"] else {}
        yield report, {"peer": f"{gap['name']}, {gap['reason']}", **own}


def _growth_table(report):
    rows = {(r["curve"], r["value"]): r for r in report["scaling"]["rows"] if r["variable"] == "triangles"}
    sizes = sorted({value for _, value in rows})
    columns = [("triangles", lambda size: f"{size:.0f}")]
    for figure, name in (("node_steps_per_ray", ""), ("primitive_tests_per_ray", "tests: ")):
        columns += [(name + rays, lambda s, r=rays, f=figure: _number(rows[r, s][f])) for rays in _RAYS]
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
    yield "Rays, Mrays/s; the ratio is promin's rate over that of Embree's single rays in the same turn:\n"
    yield markdown_table(_RATE_COLUMNS, [(report, row) for report in reports for row in report["rates"]["rows"]])
    yield "From triangles in memory to all that is copied to the device, ms, against rtcCommitScene:\n"
    yield markdown_table(_BUILD_COLUMNS, reports[0]["rates"]["builds"])
    firsts = [(report, row) for report in reports for row in report.get("peers", {}).get("first", [])]
    if firsts:
        rays, shadow_rays = (1e-6 * firsts[0][1][key] for key in ("rays", "shadow_rays"))
        yield (
            f"Sphereflake of 7381 mirror spheres on a plane, 1024², 6 bounces, {rays:.2f} Mrays, {shadow_rays:.2f} M "
            "of them shadow rays; ms of tracing:\n"
        )
        yield markdown_table(_PICTURE_COLUMNS, [of for report in reports for of in _pictures_of(report)])
        yield "First picture: its whole process, ms, over its tracing and twice the process of one sphere at 16²:\n"
        yield markdown_table(_FIRST_COLUMNS, firsts)
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
    print("\n".join(tables(reports, growth)))


if __name__ == "__main__":
    main()
