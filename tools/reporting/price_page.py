# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""The page's sections on what robustness and specialisation cost and bring."""

import plots
from figures import join, number, quartiles, spread, table, time_ratio


def _draw_ratios(names, ratios):
    """Ratios as points over their names, with their quartiles."""

    def draw(axes):
        values = [ratio["median"] for ratio in ratios]
        bars = [quartiles(ratio) for ratio in ratios]
        places = list(range(len(names)))[::-1]
        plots.draw_curve(axes, 0, values, places, x_spread=bars, line="none")
        axes.set_yticks(places, names)
        axes.set_ylim(-0.6, len(names) - 0.4)
        axes.axvline(1, color=plots.color(7), linewidth=0.8, linestyle="--")

    return draw


def _pictures_text(report):
    """What it comes to in whole pictures, shading and all."""
    rows = report["frames"]["rows"]
    parts = []
    for plain in (row for row in rows if row["knob"] == "methods"):
        own = next(row for row in rows if row["scene"] == plain["scene"] and row["is_default"])
        parts.append(f"{own['ms']['median'] / plain['ms']['median']:.2f} (<em>{own['scene']}</em>)")
    return f"Whole pictures take {join(parts)} times as long as with all of the textbook's methods." if parts else ""


def robustness(report):
    rows = report["robustness"]["rows"]
    names = [f"{r['scene']}, {r['rays']}" for r in rows]
    by_row = [time_ratio(r, "robust_ms", "plain_ms") for r in rows]
    draw = _draw_ratios(names, by_row)
    panel = plots.panel("robustness", "time over the textbook's", draw, "ratio of times", "", x_log=False, y_log=False)
    ratios = sorted(ratio["median"] for ratio in by_row)
    lost = [r for r in rows if r["lost"] or r["invented"]]
    text = (
        "The same rays through the same tree: promin's intersections, boxes and rays against the textbook's "
        "(quadratics, Möller and Trumbore, boxes without padding). "
        f"Robustness takes {ratios[0]:.2f} to {ratios[-1]:.2f} times the textbook's time, "
        f"{ratios[len(ratios) // 2]:.2f} in the middle. "
        + (
            "For that "
            + join(
                f"{r['lost']:,} of {r['count']:,} rays ({r['scene']}, {r['rays']}) no longer slip through"
                for r in lost
                if r["lost"]
            )
            + "."
            if any(r["lost"] for r in lost)
            else "None of these rays slips through either."
        )
        + (
            f" {sum(r['invented'] for r in lost):,} hits that the textbook invents are gone."
            if any(r["invented"] for r in lost)
            else ""
        )
    )
    head = [
        "scene",
        "rays",
        "number",
        "promin, ms",
        "textbook, ms",
        "ratio",
        "Mrays/s",
        "lost by the textbook",
        "invented",
    ]
    body = [
        (
            [
                r["scene"],
                r["rays"],
                f"{r['count']:,}",
                spread(r["robust_ms"]),
                spread(r["plain_ms"]),
                spread(ratio),
                number(r["robust_mrays_per_s"]),
                f"{r['lost']:,}",
                f"{r['invented']:,}",
            ],
            False,
        )
        for r, ratio in zip(rows, by_row)
    ]
    return {
        "title": "The price of robustness",
        "panels": [panel],
        "legend": [],
        "text": [text, _pictures_text(report)],
        "table": table(head, body),
    }


def specialisation(report):
    rows = report["specialisation"]["rows"]
    names = [r["scene"] for r in rows]
    tracing = [time_ratio(r, "ms", "ms_with_all") for r in rows]
    compiling = [time_ratio(r, "compile_ms", "compile_ms_with_all", "compile_time_ratio") for r in rows]
    panels = [
        plots.panel(
            "specialisation-ms",
            "tracing, of all features' time",
            _draw_ratios(names, tracing),
            "ratio of times",
            x_log=False,
            y_log=False,
        ),
        plots.panel(
            "specialisation-compile",
            "compiling, likewise",
            _draw_ratios(names, compiling),
            "ratio of times",
            x_log=False,
            y_log=False,
        ),
    ]
    gains = [ratio["median"] for ratio in tracing]
    compiles = [ratio["median"] for ratio in compiling]
    same = sum(r["is_bit_identical"] for r in rows)
    text = (
        "A pipeline is specialised to what its scene uses. Beside one with all features compiled in, tracing takes "
        f"{min(gains):.2f} to {max(gains):.2f} of the time and compiling {min(compiles):.2f} to {max(compiles):.2f}; "
        f"{same} of {len(rows)} pictures have the same bits either way. Compiling is timed on a device that has "
        f"compiled nothing, {rows[0]['compile_ms']['runs']} runs, without the driver's cache on disk."
    )
    head = ["scene", "features", "ms", "with all, ms", "ratio", "compiling, ms", "with all, ms", "ratio", "bits"]
    body = [
        (
            [
                r["scene"],
                f"{r['features']} of {r['all_features']}",
                spread(r["ms"]),
                spread(r["ms_with_all"]),
                spread(time_ratio(r, "ms", "ms_with_all")),
                spread(r["compile_ms"]),
                spread(r["compile_ms_with_all"]),
                spread(time_ratio(r, "compile_ms", "compile_ms_with_all", "compile_time_ratio")),
                "the same" if r["is_bit_identical"] else "<strong>differ</strong>",
            ],
            False,
        )
        for r in rows
    ]
    return {
        "title": "Only what a scene needs",
        "panels": panels,
        "legend": [],
        "text": [text],
        "table": table(head, body),
    }


def peers(report):
    content = report["peers"]
    rows = content["rows"]
    absent = content["not_measured"]
    gap = f" Not measured, as not installed: {join(absent)}." if absent else ""
    if not rows:
        return {"title": "Beside other renderers", "panels": [], "legend": [], "text": [gap.strip()]}
    names = [f"{r['peer'].split(',')[0]}, {r['what'].split(' by ')[0]}" for r in rows]
    names = [
        name.replace("a picture of ", "") + (" px²" if "picture" in r["what"] else "") for name, r in zip(names, rows)
    ]
    ratios = [time_ratio(r, "promin_ms", "peer_ms") for r in rows]
    draw = _draw_ratios(names, ratios)
    panel = plots.panel("peers", "promin's time over the peer's", draw, "ratio of times", "", y_log=False)
    sentences = [
        f"{r['what'][0].upper() + r['what'][1:]} ({r['scene']}) take{'s' if 'picture' in r['what'] else ''} promin "
        f"{ratio['median']:.2f} times as long as {r['peer'].split(',')[0]}"
        + (
            f", whose picture is {number(r['mean_difference'], 2)} away on average, "
            f"{number(r['different_pixels_percent'], 2)} % of its pixels by more than 0.02."
            if "mean_difference" in r
            else f"; {r['differing_hits']:,} of {r['count']:,} hit in one and miss in the other."
        )
        for r, ratio in zip(rows, ratios)
    ]
    head = ["scene", "what", "peer", "promin, ms", "peer, ms", "ratio", "in packets of 8, ms", "difference"]
    body = [
        (
            [
                r["scene"],
                r["what"],
                r["peer"],
                spread(r["promin_ms"]),
                spread(r["peer_ms"]),
                spread(ratio),
                spread(r.get("peer_packets_ms")),
                (
                    f"mean {number(r['mean_difference'], 2)}, {number(r['different_pixels_percent'], 2)} % of pixels"
                    if "mean_difference" in r
                    else f"{r['differing_hits']:,} hits"
                ),
            ],
            False,
        )
        for r, ratio in zip(rows, ratios)
    ]
    text = "The same scene in the same run, in turns, on the same cores. " + " ".join(sentences) + gap
    return {
        "title": "Beside other renderers",
        "panels": [panel],
        "legend": [],
        "text": [text],
        "table": table(head, body),
    }
