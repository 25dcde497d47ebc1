#!/usr/bin/env python3
# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Prints the figures of promin-lab instances as Markdown tables. With --plot it draws how memory and time grow with the
number of instances. tools/bench calls this program."""

import argparse
import json
import pathlib
import statistics

from figures import markdown_table, number

_RAYS = ("camera", "random")


def _rate(row, rays, who):
    """Returns millions of rays per second, or None."""
    times = row[rays].get(f"{who}_ms")
    return times and row[rays]["rays"] / (1e3 * statistics.median(times))


def _ratio(row, rays, who, other):
    """Returns the median of the ratios of the rates of both in each turn, or None."""
    times, others = row[rays].get(f"{who}_ms"), row[rays].get(f"{other}_ms")
    return times and others and statistics.median(b / a for a, b in zip(times, others))


def _megabytes(row, who):
    size = row.get(f"{who}_bytes")
    return None if size is None else size / 1e6


def _name(row):
    return f"{pathlib.Path(row['mesh']).stem} × {row['count']:,}"


def rates_table(rows):
    columns = [("scene", _name)]
    for rays in _RAYS:
        columns += [
            (f"{rays}: promin", lambda r, rays=rays: number(_rate(r, rays, "promin_instances"))),
            ("over its copies", lambda r, rays=rays: number(_ratio(r, rays, "promin_instances", "promin_copies"))),
            ("Embree", lambda r, rays=rays: number(_rate(r, rays, "embree_instances"))),
            ("over its copies", lambda r, rays=rays: number(_ratio(r, rays, "embree_instances", "embree_copies"))),
            (
                "promin over Embree",
                lambda r, rays=rays: number(_ratio(r, rays, "promin_instances", "embree_instances")),
            ),
        ]
    return markdown_table(columns, rows)


def growth_table(rows):
    columns = [("scene", _name), ("triangles", lambda r: f"{r['triangles']:,}")]
    for head, key in (("instances", "instances"), ("copies", "copies")):
        for who, prefix in (("promin", ""), ("Embree", "embree_")):
            columns += [
                (f"{head}, {who}: MB", lambda r, k=prefix + key: number(_megabytes(r, k))),
                ("build, ms", lambda r, k=prefix + key: number(r.get(f"{k}_build_ms"))),
            ]
    return markdown_table(columns, rows)


def plot(rows, file):
    """Draws memory, builds and times of rays over the number of instances, on logarithmic axes."""
    import matplotlib

    matplotlib.use("svg")
    matplotlib.rcParams |= {"svg.hashsalt": "promin", "svg.fonttype": "none"}
    from matplotlib import pyplot
    from matplotlib.ticker import FuncFormatter, LogLocator

    grown = [row for row in rows if not any(key.startswith("copies") for key in row)]
    mesh = max({row["mesh"] for row in grown}, key=lambda name: sum(row["mesh"] == name for row in grown))
    grown = [row for row in rows if row["mesh"] == mesh]
    panels = (
        ("MB", "_bytes", 1e6, ("instances", "copies", "embree_instances", "embree_copies")),
        ("ms to build", "_build_ms", 1.0, ("instances", "copies", "embree_instances", "embree_copies")),
    )
    styles = {
        "instances": ("promin, instances", "#0f766e", "-"),
        "copies": ("promin, copies", "#0f766e", ":"),
        "embree_instances": ("Embree, instances", "#b45309", "-"),
        "embree_copies": ("Embree, copies", "#b45309", ":"),
    }
    figure, all_axes = pyplot.subplots(1, 3, figsize=(11, 3.8))
    for axes, (label, suffix, unit, keys) in zip(all_axes, panels):
        for key in keys:
            own = sorted({row["count"]: row[key + suffix] / unit for row in grown if key + suffix in row}.items())
            name, color, line = styles[key]
            axes.plot(*zip(*own), "o" + line, color=color, label=name)
        axes.set_ylabel(label)
    for rays, line in (("camera", "-"), ("random", "--")):
        for who, key in (("promin", "promin_instances"), ("Embree", "embree_instances")):
            own = sorted({row["count"]: 1e3 / _rate(row, rays, key) for row in grown}.items())
            color = styles["instances" if who == "promin" else "embree_instances"][1]
            all_axes[2].plot(*zip(*own), "o" + line, color=color, label=f"{who}, {rays} rays")
    all_axes[2].set_ylabel("ns a ray")
    for axes in all_axes:
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_xlabel("objects")
        axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,.0f}"))
        axes.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5) if axes is all_axes[2] else (1,)))
        axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,g}"))
        axes.yaxis.set_minor_formatter(FuncFormatter(lambda value, _: ""))
        axes.grid(True, which="major", color="#e7e5e4", linewidth=0.6)
        axes.legend(frameon=False, fontsize=8, loc="lower right" if axes is all_axes[2] else "upper right")
        for side in ("top", "right"):
            axes.spines[side].set_visible(False)
    # The legend lies below the lines.
    all_axes[2].set_ylim(bottom=all_axes[2].get_ylim()[0] / 3)
    figure.tight_layout()
    figure.savefig(file, format="svg", metadata={"Date": None, "Creator": None})
    pyplot.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("file", help="file of promin-lab instances")
    parser.add_argument("--plot", metavar="FILE.svg", help="picture to draw")
    options = parser.parse_args()
    report = json.loads(pathlib.Path(options.file).read_text(encoding="utf-8"))
    rows = report["instances"]["rows"]
    p = report["provenance"]
    print(
        f"{p['cpu']}, {p['threads']} threads, {p['driver']}; {p['date']}, commit {p['commit']}. Mrays/s, medians of "
        f"{p['runs']} runs in turns.\n"
    )
    print(rates_table(rows))
    print(growth_table(rows))
    if options.plot:
        plot(rows, options.plot)


if __name__ == "__main__":
    main()
