# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""The page's sections on single intersections: the table of methods, error against time, error over range."""

import math

import plots
from figures import bound_of, front_of, interval, join, names_of, number, quartiles, section, spread, table
from stats import judge

# So that what has no error at all has a place on a logarithmic axis.
_LEAST_K = 0.1


def _of(rows, primitive, method):
    return next((r for r in rows if r["primitive"] == primitive and r["method"] == method), None)


def _draw_scatter(rows, methods):
    def draw(axes):
        hitting = [row for row in rows if "max_k" in row]
        place = lambda row: (row["ns_per_test"]["median"], max(row["max_k"], _LEAST_K))  # noqa: E731
        for row in hitting:
            x, y = place(row)
            plots.draw_curve(axes, methods.index(row["method"]), [x], [y], [quartiles(row["ns_per_test"])])
            if row["is_shipped"]:
                plots.ring(axes, x, y)
        plots.front_line(axes, [place(row) for row in front_of(rows, times="ns_per_test")])

    return draw


def _what(row):
    return row["what"] + (" (shipped)" if row["is_shipped"] else "")


def _leaks(row):
    return f'{row["leaks"]:,} of {row["leak_rays"]:,}' if "leaks" in row else "–"


def _time_columns(name):
    return [(name, lambda r: spread(r["ns_per_test"])), ("of promin's time", lambda r: interval(r["time_ratio"]))]


_KERNEL_COLUMNS = [
    ("primitive", lambda r: r["primitive"]),
    ("method", _what),
    *_time_columns("ns a test"),
    ("K, max", lambda r: number(r.get("max_k"))),
    ("K, rms", lambda r: number(r.get("rms_k"))),
    ("misclassified / 10<sup>6</sup>", lambda r: number(r["misclassified_per_million"])),
    ("leaks", _leaks),
]
_BOX_COLUMNS = [
    ("method", _what),
    *_time_columns("ns a box"),
    ("bytes a node", lambda r: r["bytes_per_node"]),
    ("boxes hidden", _leaks),
    ("opened needlessly / 10<sup>6</sup>", lambda r: number(r["opened_needlessly_per_million"])),
]


def _is_shipped(row):
    return row["is_shipped"]


def _kernel_text(rows):
    sentences = []
    for primitive in names_of(rows, "primitive"):
        own, plain_row = _of(rows, primitive, "promin"), _of(rows, primitive, "textbook")
        front = [r["method"] for r in front_of([r for r in rows if r["primitive"] == primitive], times="ns_per_test")]
        where = f"by K alone {join(front)} {'are' if len(front) > 1 else 'is'} the front"
        sentence = (
            f"A {primitive} takes {number(own['ns_per_test']['median'], 2)} ns with K up to "
            f"{number(own['max_k'], 2)}, by the textbook {plain_row['time_ratio']['median']:.2f} of that time "
            f"with K up to {number(plain_row.get('max_k'), 2)}"
        )
        if "leaks" in own:
            sentence += f"; of {own['leak_rays']:,} rays {own['leaks']:,} leak, by the textbook {plain_row['leaks']:,}"
        sentences.append(f"<li>{sentence}; {where}.</li>")
    return "<ul>" + "\n".join(sentences) + "</ul>"


def _bargain(row):
    leaks = f" and {row['leaks']:,} leaks" if row.get("leaks") else ""
    return f"{row['method']} ({row['time_ratio']['median']:.2f} of the time, K {number(row['max_k'], 2)}{leaks})"


def _front_gaps(rows):
    """Why a shipped method that others are better than by K alone is shipped."""
    gaps, ahead = [], []
    for primitive in names_of(rows, "primitive"):
        of_primitive = [r for r in rows if r["primitive"] == primitive]
        own = _of(rows, primitive, "promin")
        better = [
            r
            for r in of_primitive
            if r is not own and judge(r["time_ratio"]) == "faster" and r.get("max_k", math.inf) <= own["max_k"]
        ]
        if not better:
            continue
        leaky = [r for r in better if r.get("leaks", 0) > own.get("leaks", 0)]
        sound = [r for r in better if r not in leaky]
        if leaky:
            gaps.append(f"for the {primitive}, {join(map(_bargain, leaky))} would be as exact, but leak")
            gaps[-1] += "s" if len(leaky) == 1 else ""
        if sound:
            rare = " (not every device has fp64)" if all(r["method"] == "fp64" for r in sound) else ""
            ahead.append(
                f"For the {primitive}, {join(map(_bargain, sound))} is ahead by all that is measured here{rare}."
            )
    text = "K does not say all: " + "; ".join(gaps) + "." if gaps else ""
    return " ".join(part for part in (text, " ".join(ahead)) if part)


def kernels(report):
    rows = report["kernels"]["rows"]
    methods = names_of(rows, "method")
    panels = [
        plots.panel(
            f"kernel-{primitive}",
            primitive,
            _draw_scatter([r for r in rows if r["primitive"] == primitive], methods),
            "ns a test",
            "K, max (u S)",
            x_log=False,
        )
        for primitive in names_of(rows, "primitive")
    ]
    text = [
        "Each ray is tested against each primitive, without tree or boxes, so that nothing else takes time. K is the "
        "error in units of u S (u = 2<sup>−24</sup>; S is the distance plus the primitive's size), against an oracle "
        "in long double, over all distances and offsets of the next plot; misclassified rays hit where they should "
        "miss or the other way round; leaks are rays from inside of a closed surface, most of them at edges and rims, "
        "that find no way out. Dotted is the Pareto front, ringed what promin ships.",
        _kernel_text(rows),
        _front_gaps(rows),
    ]
    figures = table(_KERNEL_COLUMNS, rows, _is_shipped)
    return section("Intersections: error against time", text, figures, panels, list(enumerate(methods)))


def boxes(report):
    rows = report["boxes"]["rows"]
    own = next(r for r in rows if r["is_shipped"])
    full = next(r for r in rows if r["method"] == "full")
    bare = next(r for r in rows if r["method"] == "full unpadded")
    text = (
        "Rays aimed at faces, edges and corners of boxes, half of them flat, up to 10<sup>5</sup> from the origin: a "
        "box that an exact ray meets must be met. "
        f"The shipped test takes {number(own['ns_per_test']['median'], 2)} ns a box and hides {own['leaks']:,} of "
        f"{own['leak_rays']:,}; boxes in fp32 take "
        f"{full['time_ratio']['median']:.2f} of its time and {full['bytes_per_node'] / own['bytes_per_node']:g} times "
        f"its memory, and without padding hide {bare['leaks']:,}. What is opened needlessly costs time and no error."
    )
    return section("Boxes", [text], table(_BOX_COLUMNS, rows, _is_shipped))


def _range_panels(rows, methods, bound, variable, label):
    panels = []
    for primitive in names_of(rows, "primitive"):

        def draw(axes, primitive=primitive):
            for index, method in enumerate(methods):
                points = [
                    (r["value"], max(r["max_k"], _LEAST_K))
                    for r in rows
                    if r["primitive"] == primitive
                    and r["method"] == method
                    and r["variable"] == variable
                    and "max_k" in r
                ]
                if points:
                    plots.draw_curve(axes, index, *zip(*sorted(points)))
            axes.axhline(bound, color=plots.color(7), linewidth=0.8, linestyle="--")
            if variable == "offset":
                axes.set_xscale("symlog", linthresh=10)

        title = f"{primitive}, {variable}"
        panels.append(plots.panel(f"range-{primitive}-{variable}", title, draw, label, "K, max (u S)"))
    return panels


def _missed_text(rows, shipped, distance_of_offsets):
    """Where the shipped methods tell most rays wrong, and what the textbook's do there and at their own worst."""
    rate = lambda row: row["misclassified_per_million"]  # noqa: E731
    worst = max((r for r in rows if r["method"] == shipped), key=rate)
    if not rate(worst):
        return "The shipped methods misclassify no ray."
    plain = max((r for r in rows if r["method"] == "textbook"), key=rate)
    # S in sizes.
    scale = 1 + (worst["value"] if worst["variable"] == "distance" else distance_of_offsets)
    place = lambda row: f"{row['primitive']}, {row['variable']} {number(row['value'], 2)}"  # noqa: E731
    return (
        f"The shipped methods misclassify at most {number(rate(worst) / 1e4, 2)} % of the rays of a place "
        f"({place(worst)}), where u S is {number(100 * 2**-24 * scale, 2)} % of the primitive's size and rays pass as "
        f"near to its silhouette; the textbook's {number(rate(plain) / 1e4, 2)} % ({place(plain)})."
    )


def error_range(report):
    rows = report["kernels"]["range"]
    methods = names_of(rows, "method")
    worst = {m: max(r.get("max_k", 0) for r in rows if r["method"] == m) for m in methods}
    shipped = next(r["method"] for r in rows if r["is_shipped"])
    others = [f"{m} {number(worst[m], 2)}" for m in methods if m != shipped]
    distances = [r["value"] for r in rows if r["variable"] == "distance"]
    offsets = [r["value"] for r in rows if r["variable"] == "offset"]
    away = report["kernels"]["distance_of_offsets"]
    bound = bound_of(report, 8)
    text = (
        f"From a distance of {number(min(distances), 2)} to {number(max(distances), 2)} sizes, and from "
        f"{number(away)} sizes away up to {number(max(offsets), 2)} sizes from the world's origin, the shipped "
        f"methods' K never passes {number(worst[shipped], 2)} (bound {bound}, dashed); the others "
        f"reach {join(others)}. "
        f"{_missed_text(rows, shipped, away)} Where a method has no point, no ray hit both by it and "
        "the oracle."
    )
    panels = _range_panels(rows, methods, bound, "distance", "distance / size")
    panels += _range_panels(rows, methods, bound, "offset", "offset from the origin / size")
    return section("Error over range", [text], panels=panels, legend=list(enumerate(methods)))
