#!/usr/bin/env python3
# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Prints the figures of promin-lab and of peers.py as Markdown tables with the targets, and writes them to one file.
tools/bench calls this program."""

import argparse
import json
import pathlib

from figures import gap_text, interval, markdown_table, number, spread
from stats import fit_doublings, read_figures

# Targets of each driver: (rate over Embree's for camera, shadow and random rays, time over Tachyon's).
_TARGETS = {"Mesa 22.3.6": (0.45, 0.42, 0.33, 1.5), "Mesa 25.0.7": (0.75, 0.62, 0.5, 1.0)}
_MOST_BUILD_TIME = 1.5  # a multiple of Embree's time
_MOST_BYTES = 100  # bytes of each triangle
_RAYS = ("camera", "shadow", "random")

_TIMES = [
    ("promin, ms", lambda r: spread(r.get("promin_ms"))),
    ("peer", lambda r: r.get("peer", "–").split(",")[0]),
    ("peer, ms", lambda r: spread(r.get("peer_ms"))),
    ("ratio", lambda r: interval(r.get("time_ratio"))),
]
_RAYS_COLUMNS = [
    ("scene", lambda r: r["scene"]),
    ("rays", lambda r: r["rays"]),
    ("number", lambda r: f"{r['count']:,}"),
    ("promin, Mrays/s", lambda r: number(r.get("promin_mrays_per_s"))),
    ("peer", lambda r: number(r.get("peer_mrays_per_s"))),
    ("packets of 8", lambda r: number(r.get("peer_packets_mrays_per_s"))),
    *_TIMES,
    ("packets, ms", lambda r: spread(r.get("peer_packets_ms"))),
    ("ratio", lambda r: interval(r.get("packets_time_ratio"))),
    ("other hits", lambda r: number(r.get("differing_hits"))),
    ("steps", lambda r: number(r.get("node_steps_per_ray"))),
    ("tests", lambda r: number(r.get("primitive_tests_per_ray"))),
]
_BUILDS_COLUMNS = [
    ("scene", lambda r: r["scene"]),
    ("primitives", lambda r: f"{r['primitives']:,}"),
    ("builder", lambda r: r["builder"]),
    *_TIMES,
    ("tree alone, ms", lambda r: spread(r["bvh_ms"])),
    ("ratio", lambda r: interval(r.get("bvh_time_ratio"))),
    ("nodes", lambda r: f"{r['nodes']:,}"),
    ("depth", lambda r: r["depth"]),
    ("SAH cost", lambda r: number(r["sah_cost"])),
    ("bytes a primitive", lambda r: number(r["device_bytes_per_primitive"])),
]
_PICTURES_COLUMNS = [
    ("scene", lambda r: r["scene"]),
    ("what", lambda r: r["what"]),
    *_TIMES,
    ("mean difference", lambda r: number(r["mean_difference"], 2)),
    ("pixels > 0.02, %", lambda r: number(r["different_pixels_percent"], 2)),
]
_OVER_RAYS_COLUMNS = [
    ("scene", lambda r: r["scene"]),
    ("what", lambda r: r["what"]),
    ("pixels", lambda r: f"{r['width']} × {r['height']}"),
    ("bounces", lambda r: r["depth"]),
    ("its rays", lambda r: f"{r['count']:,}"),
    ("promin, ms", lambda r: spread(r["promin_ms"])),
    ("its rays by cast, ms", lambda r: spread(r["rays_ms"])),
    ("over these", lambda r: interval(r["rays_time_ratio"])),
    ("peer", lambda r: r.get("peer", "–").split(",")[0]),
    ("the same rays, ms", lambda r: spread(r.get("peer_ms"))),
    ("over these", lambda r: interval(r.get("time_ratio"))),
]
_MITSUBA_COLUMNS = [
    ("scene", lambda r: r["scene"]),
    ("rays", lambda r: r["rays"]),
    ("number", lambda r: f"{r['count']:,}"),
    ("promin, ms", lambda r: spread(r.get("promin_ms"))),
    ("peer", lambda r: r["peer"]),
    ("peer, ms", lambda r: spread(r["peer_ms"])),
    ("ratio", lambda r: number(_ratio_of_medians(r, "promin_ms", "peer_ms"))),
    ("peer, CPU ns a ray", lambda r: number(1e6 * r["peer_cpu_ms"]["median"] / r["count"])),
    ("other hits", lambda r: number(r["differing_hits"])),
]
_USES_COLUMNS = [
    ("scene", lambda r: r["scene"]),
    ("uses", lambda r: r["uses"]),
    ("compiling, ms, cached kernels", lambda r: spread(r["cached_compile_ms"])),
    ("CPU s", lambda r: spread(r["cached_cpu_s"])),
    ("compiling, ms, empty caches", lambda r: spread(r["empty_compile_ms"])),
    ("CPU s", lambda r: spread(r["empty_cpu_s"])),
]
_PROCESSES_COLUMNS = [
    ("scene", lambda r: r["scene"]),
    ("width", lambda r: r["width"]),
    ("CPU s, cached kernels", lambda r: spread(r["cached_cpu_s"])),
    ("elapsed", lambda r: spread(r["cached_s"])),
    ("CPU s, empty caches", lambda r: spread(r["empty_cpu_s"])),
    ("elapsed", lambda r: spread(r["empty_s"])),
]


def _target(value, least=None, most=None):
    """Returns the target, and whether the value reaches it."""
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


def _ratio_of_medians(row, first, second):
    return row[first]["median"] / row[second]["median"] if row.get(first) and row.get(second) else None


def _rate_target(report, row):
    """Returns the ratio of rates, which is the inverse of the ratio of times."""
    ratio = _ratio_of(row)
    return _target(ratio and 1 / ratio, least=dict(zip(_RAYS, _targets_of(report)))[row["rays"]])


def _picture_target(report, row):
    return _target(_ratio_of(row), most=_targets_of(report)[3] if row["peer"].startswith("Tachyon") else None)


def _table(reports, section, key, columns, further=()):
    """Returns the rows of all reports. The driver is the first column; the columns of the report and of the row are
    last."""
    columns = [("driver", lambda of: of[0]["provenance"]["driver"])] + [
        (head, lambda of, make=make: make(of[1])) for head, make in columns
    ]
    columns += [(head, lambda of, make=make: make(*of)) for head, make in further]
    return markdown_table(columns, [(r, row) for r in reports for row in r.get(section, {}).get(key, [])])


def _growth_table(growth):
    rows = {(r["curve"], r["value"]): r for r in growth["rows"]}
    sizes = sorted({value for _, value in rows})
    columns = [("triangles", lambda size: f"{size:.0f}")]
    for figure, name in (("node_steps_per_ray", ""), ("primitive_tests_per_ray", "tests: ")):
        columns += [(name + rays, lambda s, r=rays, f=figure: number(rows[r, s][f])) for rays in _RAYS]
    fits = [fit_doublings(sizes, [rows[rays, size]["node_steps_per_ray"] for size in sizes]) for rays in _RAYS]
    last = [f"{fit['per_doubling']:.2f} ({fit['r_squared']:.3f})" for fit in fits]
    return markdown_table(columns, sizes) + f"| steps a doubling (r²) | {' | '.join(last)} |  |  |  |\n"


def tables(reports, growth):
    """Returns the text, in parts."""
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
    yield _table(reports, "rates", "rows", _RAYS_COLUMNS, rates)
    yield "The same rays by Mitsuba's LLVM mode, whose turns are its own; ratios are promin's time over Mitsuba's:\n"
    yield _table(reports, "mitsuba", "rows", _MITSUBA_COLUMNS)
    for report in reports:
        yield gap_text(report.get("mitsuba", {}).get("gaps", []))
    yield "From triangles in memory to all that is copied to the device, against rtcCommitScene:\n"
    builds = [
        ("target", lambda _, r: _target(_ratio_of(r), most=_MOST_BUILD_TIME)),
        ("target", lambda _, r: _target(r["device_bytes_per_primitive"], most=_MOST_BYTES)),
    ]
    yield _table(reports, "rates", "builds", _BUILDS_COLUMNS, builds)
    yield "Pictures beside what cast takes for their own rays, set by set:\n"
    yield _table(reports, "rates", "pictures", _OVER_RAYS_COLUMNS)
    yield "Sphereflake of 7381 mirror spheres on a plane, 1024², 6 bounces, tracing:\n"
    yield _table(reports, "peers", "rows", _PICTURES_COLUMNS, [("target", _picture_target)])
    for report in reports:
        yield gap_text(report.get("peers", {}).get("gaps", []))
    yield "Whole processes that render a first picture, 1 sample per pixel:\n"
    yield _table(reports, "processes", "rows", _PROCESSES_COLUMNS)
    yield "One process that uses a scene in several ways, one after the other, 16 by 16 pixels:\n"
    yield _table(reports, "processes", "uses", _USES_COLUMNS)
    yield "Node steps and primitive tests a ray over the triangles of a wavy sphere:\n"
    yield _growth_table(growth["growth"])


def _read_driver(folder):
    """Returns the tables of a driver's rates, with the pictures of the peers, Mitsuba's times and the processes if they
    were measured."""
    report = read_figures(folder / "rates.json")
    for file in (folder / f"{name}.json" for name in ("peers", "mitsuba", "processes")):
        report |= read_figures(file) if file.exists() else {}
    return report


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("drivers", nargs="+", type=pathlib.Path, help="folders of drivers; the system's comes first")
    parser.add_argument("--growth", type=pathlib.Path, required=True, help="file that promin-lab growth has written")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True, help=".json file to write")
    arguments = parser.parse_args()
    reports = {folder.name: _read_driver(folder) for folder in arguments.drivers}
    growth = read_figures(arguments.growth)
    text = json.dumps({"drivers": reports, "growth": growth}, ensure_ascii=False, indent=1)
    arguments.output.write_text(text + "\n", encoding="utf-8")
    print("\n".join(part for part in tables(list(reports.values()), growth) if part))


if __name__ == "__main__":
    main()
