#!/usr/bin/env python3
# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Writes docs/accuracy.md to the standard output from figures of the hard cases and of promin-lab robustness.

accuracy_document.py FOLDER: FOLDER holds <driver>.log for each driver tried, and <driver>.json and
<driver>/robustness.json for each driver measured."""

import json
import math
import pathlib
import sys

from figures import join, markdown_table
from stats import read_figures

# The kernels use these methods from these sources; shaders/trace/primitives/*.glsl give the reasons.
METHODS = {
    "sphere": (
        "around the closest approach, corrected once; discriminant (r - |p|)(r + |p|) in units of r",
        "Haines et al., Ray Tracing Gems, ch. 7",
    ),
    "plane": (
        "t = n.(q - o) / (n.d), q the plane's point",
        "Haines, in Glassner (ed.), An Introduction to Ray Tracing, 1989, 2.3",
    ),
    "cylinder": (
        "as the frustum of slope 0",
        "as the frustum",
    ),
    "cone": ("as the frustum with one radius 0", "as the frustum"),
    "frustum": (
        "cap slab cut with the lateral interval, solved from the point in the slab nearest to axis and apex",
        "Haines et al., ch. 7, for the re-centring; Press et al., Numerical Recipes, 5.6, for the quadratic",
    ),
    "box": (
        "three slabs in the box's frame, from the closest approach to its centre",
        "Kay and Kajiya, Ray Tracing Complex Scenes, SIGGRAPH 1986",
    ),
    "capsule": (
        "two spheres and the frustum between the circles where it touches them; first entry, last exit",
        "as the sphere and the frustum",
    ),
    "triangle": (
        "shear to the ray's axis, edge functions by compared products, edges belong to the triangle",
        "Woop, Benthin, Wald, Watertight Ray/Triangle Intersection, JCGT 2013",
    ),
}

HEAD = """# How wrong it can be

`tools/accuracy` generates this page from the measurements of the hard cases (`tests/hard`) on each driver. Do not edit
it.

The oracle computes by brute force in long double (`oracle`) from the same fp32 numbers as the device. It shares no
formula with the shaders. [The glossary](glossary.md) defines u, S, K of t and of P, margin, misclassified and leak. The
bounds are 8 on K of t (B1), 8 on K of P (BK) and 2 on the margin (B2).

Figures **in bold** exceed their bounds.
"""


def number(value):
    if value is None:
        return ""
    value = float(value)  # also reads "inf" and "nan", for which JSON has no numbers
    if not math.isfinite(value):
        return str(value)
    if value == int(value) and abs(value) < 1e6:
        return str(int(value))
    return f"{value:.3g}"


def cell(figure, bound):
    """Returns the figure, in bold if it is beyond its bound; NaN is beyond any bound."""
    is_beyond = figure is not None and bound is not None and not float(figure) <= bound
    return f"**{number(figure)}**" if is_beyond else number(figure)


def table(header, rows):
    """Returns a table of these rows of cells."""
    return markdown_table([(head, lambda row, i=i: row[i]) for i, head in enumerate(header)], rows).rstrip("\n")


def primitives_section(runs):
    methods = [[name, *METHODS[name]] for name in METHODS]
    rows = []
    for name in METHODS:
        for run in runs:
            figures = run.get("primitives", {}).get(name)
            if figures is None:
                continue
            judged = figures["judged"]
            per_million = 1e6 * figures["misclassified"] / judged if judged else None
            rows.append(
                [
                    name,
                    run["driver"],
                    f"{figures['rays']:,}",
                    f"{judged:,}",
                    number(figures["max_k"]),
                    number(figures["rms_k"]),
                    number(figures["max_surface_k"]),
                    number(per_million),
                    number(figures["max_margin"]),
                    cell(figures["leaks"], 0),
                ]
            )
    header = [
        "primitive",
        "driver",
        "rays",
        "judged",
        "K of t, max",
        "K of t, rms",
        "K of P, max",
        "misclassified per million",
        "margin, max",
        "leaks",
    ]
    return (
        "## Primitives\n\n"
        + table(["primitive", "method", "source"], methods)
        + "\n\nThe figures cover all rays of the hard cases below that have one kind of primitive. These rays aim "
        + "at edges and silhouettes far more often than the rays of a picture. Leaks are counted over all rays. "
        + 'The oracle judges the number of rays in the column "judged", and misclassified rays are counted '
        + "among these. Boxes, capsules, cylinders, cones and frustums must keep the bound BK. Their K of t may "
        + "exceed 8 at a rim or an edge, because the exact hit and the device's hit may be on different parts "
        + "with different angles. A ray is misclassified if it hits where the exact ray misses, or misses where "
        + "it hits. No such ray is farther from an edge than the margin, and none counts as a leak. Most rays "
        + "for triangles only test whether a closed mesh has holes. The judged rays for triangles aim at edges.\n\n"
        + table(header, rows)
    )


def bounds_of(entry):
    """Returns the bound, or all bounds in the order of the drivers if they differ."""
    bounds = [number(bound) for figure, bound in entry.values()]
    return bounds[0] if len(set(bounds)) == 1 else " / ".join(bounds)


def rows_section(runs):
    figures = {}
    for index, run in enumerate(runs):
        for row in run["rows"]:
            figures.setdefault((row["row"], row["what"]), {})[index] = (row["figure"], row.get("bound"))
    body = []
    for row in sorted({row for row, what in figures}):
        entries = {what: entry for (r, what), entry in figures.items() if r == row}
        # Events that must never happen share one line if none of them happened.
        never = [what for what, entry in entries.items() if all(measured == (0, 0) for measured in entry.values())]
        for what, entry in entries.items():
            if what not in never:
                figures_of_runs = [entry.get(i, (None, None)) for i in range(len(runs))]
                body.append([str(row), what, bounds_of(entry)] + [cell(*measured) for measured in figures_of_runs])
        if never:
            what = never[0] if len(never) == 1 else f"{len(never)} counts such as: {never[0]}"
            is_measured = [any(i in entries[each] for each in never) for i in range(len(runs))]
            body.append([str(row), what, "0"] + ["0" if each else "" for each in is_measured])
    header = ["row", "figure", "bound"] + [run["driver"] for run in runs]
    return (
        "## The hard cases\n\n"
        + "A figure without a bound is given only for information. Bounds on K are doubled on drivers whose "
        + "division or square root is not known to be correctly rounded.\n\n"
        + table(header, body)
    )


def robustness_section(reports):
    rows = [(report["provenance"], row) for report in reports for row in report["robustness"]["rows"]]
    cpus = dict.fromkeys(report["provenance"]["cpu"] for report in reports)
    columns = [
        ("scene", lambda of: of[1]["scene"]),
        ("driver", lambda of: of[0]["driver"]),
        ("rays", lambda of: of[1]["rays"]),
        ("robust, Mrays/s", lambda of: number(of[1]["robust_mrays_per_s"])),
        ("plain, Mrays/s", lambda of: number(of[1]["plain_mrays_per_s"])),
        ("ratio", lambda of: f"{of[1]['robust_mrays_per_s'] / of[1]['plain_mrays_per_s']:.2f}"),
        ("lost by plain", lambda of: of[1]["only_promin_hits"]),
        ("invented by plain", lambda of: of[1]["only_textbook_hits"]),
    ]
    return (
        "## What it costs\n\n"
        + "`promin-lab robustness` traces the same rays through the same tree with two kernels in turns. The "
        + "table gives medians. The plain kernel (`tools/plain`) has the triangle test of Möller and Trumbore, "
        + "textbook quadratics, and boxes without padding. There are about 10^6 rays of each kind, measured on "
        + join(cpus)
        + '. "Lost by plain" counts rays that hit with the robust kernel and miss with the plain one. "Invented '
        + 'by plain" counts the opposite.\n\n'
        + markdown_table(columns, rows).rstrip("\n")
    )


def drivers_section(runs, tried, reports):
    lines = []
    for name in tried:
        run = runs.get(name)
        if run is None:
            lines.append(f"- `{name}`: not measured, because the hard cases did not finish")
        elif run["failed"]:
            lines.append(f"- `{name}`, {run['driver']}: **failed** " + ", ".join(run["failed"]))
        else:
            lines.append(f"- `{name}`, {run['driver']}: all rows hold")
    provenances = [report["provenance"] for report in reports]
    commits = join(dict.fromkeys(of["commit"] for of in provenances))
    cpus = join(dict.fromkeys(of["cpu"] for of in provenances))
    return f"Measured at commit {commits} on {cpus}, with these drivers:\n\n" + "\n".join(lines)


def main():
    folder = pathlib.Path(sys.argv[1])
    # The system's driver comes first.
    tried = sorted((f.stem for f in folder.glob("*.log")), key=lambda name: (name != "system", name))
    files = {name: folder / f"{name}.json" for name in tried}
    runs = {name: json.loads(file.read_text()) for name, file in files.items() if file.exists()}
    figures = list(runs.values())
    reports = [read_figures(file) for file in sorted(folder.glob("*/robustness.json"))]
    sections = [HEAD.strip(), drivers_section(runs, tried, reports), primitives_section(figures), rows_section(figures)]
    print("\n\n".join(sections + [robustness_section(reports)]))


main()
