# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""The page's sections on what robustness and specialisation cost and bring."""

import html
import math

import plots
from figures import bound_of, from_to, few, gap_text, interval, join, beyond_noise_text, number, spread, table


def _pictures_text(report):
    """What it comes to in whole pictures, shading and all."""
    parts = [
        f"{row['time_ratio']['median']:.2f} (<em>{html.escape(row['scene'])}</em>)"
        for row in report["frames"]["rows"]
        if row["knob"] == "methods"
    ]
    return f"Whole pictures take by all of the textbook's methods {join(parts)} of promin's time." if parts else ""


def _truth_text(rows, bound):
    """What both kernels tell wrong of."""
    inside = [r for r in rows if r["truth"] == "each hits"]
    others = [r for r in rows if r["truth"] == "oracle"]
    parts = []
    if inside:
        rays = sum(r["judged"] for r in inside)
        parts.append(
            f"Of {rays:,} rays from inside of a closed mesh (<em>wavy:N</em>, of about N triangles) at its edges, each "
            f"of which must hit, promin loses {number(sum(r['promin_lost'] for r in inside))} and the textbook "
            f"{sum(r['textbook_lost'] for r in inside):,}."
        )
    if others:
        wrong = {
            kernel: [sum(r[f"{kernel}_{kind}"] for r in others) for kind in ("lost", "invented")]
            for kernel in ("promin", "textbook")
        }
        own, plain = wrong["promin"], wrong["textbook"]
        differing = sum(r["differing"] for r in others)
        all_or_some = "all" if all(r["differing"] <= r["judged"] for r in others) else "some of the"
        judged, count = sum(r["judged"] for r in others), sum(r["count"] for r in others)
        parts.append(
            f"Of the other {count:,} rays {judged:,} were held against the oracle, brute force in long double: "
            f"{all_or_some} {differing:,} on which the two differ, and of the rest as many as time allows. Promin "
            f"loses {own[0]:,} and invents {own[1]:,}, the textbook {plain[0]:,} and {plain[1]:,}."
        )
        margin = max(
            (r.get("promin_worst_margin", math.inf) for r in others if r["promin_lost"] + r["promin_invented"]),
            default=0,
        )
        if margin == math.inf:
            parts.append("Of some of promin's no surface near the ray makes them right.")
        elif margin:
            parts.append(
                f"Where promin is wrong, surfaces {number(margin, 2)} u S away would make it right: "
                f"rays that graze a silhouette as near are within its bound of {bound} u S."
                if margin <= bound
                else f"Promin is off by up to {number(margin, 2)} u S there, beyond its bound of {bound}."
            )
    return " ".join(parts)


def robustness(report):
    rows = report["robustness"]["rows"]
    names = [f"{r['scene']}, {r['rays']}" for r in rows]
    by_row = [r["time_ratio"] for r in rows]
    draw = plots.draw_ratios(names, by_row)
    panel = plots.panel("robustness", "time over the textbook's", draw, "ratio of times", "", x_log=False, y_log=False)
    ratios = sorted(ratio["median"] for ratio in by_row)
    text = (
        "The same rays through the same tree: promin's intersections, boxes and rays against the textbook's "
        "(quadratics, Möller and Trumbore, boxes without padding; its triangle in one step where promin's takes two). "
        f"Robustness takes {from_to(ratios)} times the textbook's time, "
        f"{ratios[len(ratios) // 2]:.2f} in the middle. " + beyond_noise_text(by_row, "slower")
    )
    head = [
        "scene",
        "rays",
        "number",
        "promin, ms",
        "textbook, ms",
        "ratio",
        "Mrays/s",
        "judged",
        "lost, invented by promin",
        "by the textbook",
    ]
    body = [
        (
            [
                html.escape(r["scene"]),
                r["rays"],
                f"{r['count']:,}",
                spread(r["robust_ms"]),
                spread(r["plain_ms"]),
                interval(ratio),
                number(r["robust_mrays_per_s"]),
                f"{r['judged']:,}" + (", each hits" if r["truth"] == "each hits" else ""),
                *(f"{r[f'{kernel}_lost']:,}, {r[f'{kernel}_invented']:,}" for kernel in ("promin", "textbook")),
            ],
            False,
        )
        for r, ratio in zip(rows, by_row)
    ]
    return {
        "title": "The price of robustness",
        "panels": [panel],
        "legend": [],
        "text": [text, _truth_text(rows, bound_of(report, 2)), _pictures_text(report)],
        "table": table(head, body),
    }


def _times(runs):
    return "once" if runs == 1 else f"{runs} times, told as median with least and most"


def specialisation(report):
    rows = report["specialisation"]["rows"]
    names = [r["scene"] for r in rows]
    tracing = [r["time_ratio"] for r in rows]
    compiling = [r["compile_time_ratio"] for r in rows]
    panels = [
        plots.panel(
            "specialisation-ms",
            "tracing, of all features' time",
            plots.draw_ratios(names, tracing),
            "ratio of times",
            x_log=False,
            y_log=False,
        ),
        plots.panel(
            "specialisation-compile",
            "compiling, likewise",
            plots.draw_ratios(names, compiling),
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
        f"{from_to(gains)} of the time and compiling {from_to(compiles)}. "
        + beyond_noise_text(tracing, "faster")
        + f" {same} of {len(rows)} pictures have the same bits either way. Compiling is timed on a device that has "
        f"compiled nothing, {_times(rows[0]['compile_ms']['runs'])}, without the driver's cache on disk."
    )
    head = ["scene", "features", "ms", "with all, ms", "ratio", "compiling, ms", "with all, ms", "ratio", "bits"]
    body = [
        (
            [
                html.escape(r["scene"]),
                f"{r['features']} of {r['all_features']}",
                spread(r["ms"]),
                spread(r["ms_with_all"]),
                interval(r["time_ratio"]),
                few(r["compile_ms"]),
                few(r["compile_ms_with_all"]),
                few(r["compile_time_ratio"]),
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
    gap = " " + gap_text(content["gaps"]) if content["gaps"] else ""
    if not rows:
        return {"title": "Beside other renderers", "panels": [], "legend": [], "text": [gap.strip()]}
    names = [f"{r['peer'].split(',')[0]}, {r['what'].split(' by ')[0]}" for r in rows]
    names = [
        name.replace("a picture of ", "") + (" px²" if "picture" in r["what"] else "") for name, r in zip(names, rows)
    ]
    ratios = [r["time_ratio"] for r in rows]
    draw = plots.draw_ratios(names, ratios)
    panel = plots.panel("peers", "promin's time over the peer's", draw, "ratio of times", "", y_log=False)
    sentences = [
        f"{r['what'][0].upper() + r['what'][1:]} ({html.escape(r['scene'])}) "
        f"take{'s' if 'picture' in r['what'] else ''} promin "
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
                html.escape(r["scene"]),
                r["what"],
                r["peer"],
                spread(r["promin_ms"]),
                spread(r["peer_ms"]),
                interval(ratio),
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
    text = [
        f"The same scene in the same run, in {rows[0]['promin_ms']['runs']} turns, on the same cores." + gap,
        "<ul>" + "\n".join(f"<li>{sentence}</li>" for sentence in sentences) + "</ul>",
    ]
    return {
        "title": "Beside other renderers",
        "panels": [panel],
        "legend": [],
        "text": text,
        "table": table(head, body),
    }
