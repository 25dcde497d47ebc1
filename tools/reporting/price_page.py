# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""The page's sections on what robustness and specialisation cost and bring, and on other renderers."""

import html
import math

import peer_tables
import plots
from figures import (
    beyond_noise_text,
    bound_of,
    emphasis,
    few,
    from_to,
    gap_text,
    interval,
    join,
    number,
    scene_column,
    section,
    spread,
    table,
)


def _pictures_text(report):
    """What it comes to in whole pictures, shading and all."""
    parts = [
        f"{row['time_ratio']['median']:.2f} ({emphasis(row['scene'])})"
        for row in report.get("frames", {}).get("rows", [])
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
    panel = plots.ratio_panel("robustness", "time over the textbook's", names, by_row)
    ratios = sorted(ratio["median"] for ratio in by_row)
    text = (
        "The same rays through the same tree: promin's intersections, boxes and rays against the textbook's "
        "(quadratics, Möller and Trumbore, boxes without padding; its triangle in one step where promin's takes two). "
        f"Robustness takes {from_to(ratios)} times the textbook's time, "
        f"{ratios[len(ratios) // 2]:.2f} in the middle. " + beyond_noise_text(by_row, "slower")
    )
    wrong = lambda r, kernel: f"{r[f'{kernel}_lost']:,}, {r[f'{kernel}_invented']:,}"  # noqa: E731
    columns = [
        scene_column(),
        ("rays", lambda r: r["rays"]),
        ("number", lambda r: f"{r['count']:,}"),
        ("promin, ms", lambda r: spread(r["robust_ms"])),
        ("textbook, ms", lambda r: spread(r["plain_ms"])),
        ("ratio", lambda r: interval(r["time_ratio"])),
        ("Mrays/s", lambda r: number(r["robust_mrays_per_s"])),
        ("judged", lambda r: f"{r['judged']:,}" + (", each hits" if r["truth"] == "each hits" else "")),
        ("lost, invented by promin", lambda r: wrong(r, "promin")),
        ("by the textbook", lambda r: wrong(r, "textbook")),
    ]
    texts = [text, _truth_text(rows, bound_of(report, 2)), _pictures_text(report)]
    return section("The price of robustness", texts, table(columns, rows), [panel])


def _times(runs):
    return "once" if runs == 1 else f"{runs} times, told as median with least and most"


def specialisation(report):
    rows = report["specialisation"]["rows"]
    names = [r["scene"] for r in rows]
    tracing = [r["time_ratio"] for r in rows]
    compiling = [r["compile_time_ratio"] for r in rows]
    panels = [
        plots.ratio_panel("specialisation-ms", "tracing, of all features' time", names, tracing),
        plots.ratio_panel("specialisation-compile", "compiling, likewise", names, compiling),
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
    columns = [
        scene_column(),
        ("features", lambda r: f"{r['features']} of {r['all_features']}"),
        ("ms", lambda r: spread(r["ms"])),
        ("with all, ms", lambda r: spread(r["ms_with_all"])),
        ("ratio", lambda r: interval(r["time_ratio"])),
        ("compiling, ms", lambda r: few(r["compile_ms"])),
        ("with all, ms", lambda r: few(r["compile_ms_with_all"])),
        ("ratio", lambda r: few(r["compile_time_ratio"])),
        ("bits", lambda r: "the same" if r["is_bit_identical"] else "<strong>differ</strong>"),
    ]
    return section("Only what a scene needs", [text], table(columns, rows), panels)


def _name_of_peer(row):
    return row["peer"].split(",")[0]


def _ray_sentence(row):
    return (
        f"{row['rays'][0].upper() + row['rays'][1:]} rays ({html.escape(row['scene'])}) take promin "
        f"{row['time_ratio']['median']:.2f} times as long as {_name_of_peer(row)}; {row['differing_hits']:,} of "
        f"{row['count']:,} hit in one and miss in the other."
    )


def _own_sentence(row):
    """What is told of promin where there is no peer."""
    return (
        f"promin traces {number(row['promin_mrays_per_s'])} million {row['rays']} rays a second "
        f"({html.escape(row['scene'])})."
    )


def _build_sentence(row):
    return (
        f"To have {html.escape(row['scene'])} on the device takes promin {row['time_ratio']['median']:.2f} times as "
        f"long as {_name_of_peer(row)}'s build, the tree alone {row['bvh_time_ratio']['median']:.2f}."
    )


def _over_rays_sentence(row):
    what = {"picture": "A picture", "mirror stage": "What mirrors add to it"}[row["what"]]
    return (
        f"{what} ({html.escape(row['scene'])}) takes {row['rays_time_ratio']['median']:.2f} times as long, shading "
        "and all, as promin takes to cast the picture's own rays, set by set, ordering them included."
    )


def _picture_sentence(row):
    return (
        f"{row['what'][0].upper() + row['what'][1:]} ({html.escape(row['scene'])}) takes promin "
        f"{row['time_ratio']['median']:.2f} times as long as {_name_of_peer(row)}, whose picture is "
        f"{number(row['mean_difference'], 2)} away on average, {number(row['different_pixels_percent'], 2)} % of its "
        "pixels by more than 0.02."
    )


def peers(report):
    rates = report.get("rates", {"rows": [], "builds": [], "gaps": []})
    pictures = report.get("peers", {"rows": [], "first": [], "gaps": []})
    beside = lambda rows: [row for row in rows if "peer" in row]  # noqa: E731
    rays, builds = beside(rates["rows"]), beside(rates["builds"])
    compared = [(f"{_name_of_peer(r)}, {r['rays']} rays", r) for r in rays]
    compared += [(f"{_name_of_peer(r)}, build", r) for r in builds]
    compared += [
        (f"{_name_of_peer(r)}, {r['what'].split(' by ')[0].removeprefix('a picture of ')} px²", r)
        for r in pictures["rows"]
    ]
    sentences = [_ray_sentence(r) for r in rays] + [_build_sentence(r) for r in builds]
    sentences += [_picture_sentence(r) for r in pictures["rows"]]
    panels = []
    if compared:
        names, rows = zip(*compared)
        ratios = [row["time_ratio"] for row in rows]
        panels = [plots.ratio_panel("peers", "promin's time over the peer's", names, ratios, x_log=True)]
    gaps, runs = gap_text(rates["gaps"] + pictures["gaps"]), report["provenance"]["runs"]
    text = [f"The same scene in the same run, in {runs} turns, on the same cores. {gaps}" if sentences else gaps]
    if not sentences and rates["rows"]:
        text.append(" ".join(_own_sentence(r) for r in rates["rows"]))
    if sentences:
        text.append("<ul>" + "\n".join(f"<li>{sentence}</li>" for sentence in sentences) + "</ul>")
    if rates.get("pictures"):
        text.append(" ".join(_over_rays_sentence(r) for r in rates["pictures"]))
    kinds = (
        ("Rays", peer_tables.RAYS, rates["rows"]),
        ("From triangles in memory to all that is copied to the device", peer_tables.BUILDS, rates["builds"]),
        ("Pictures over their own rays", peer_tables.OVER_RAYS, rates.get("pictures", [])),
        ("Pictures", peer_tables.PICTURES, pictures["rows"]),
        ("The first picture", peer_tables.FIRST, pictures["first"]),
    )
    tables = "\n".join(table(columns, rows, caption=caption) for caption, columns, rows in kinds if rows)
    return section("Beside other renderers", text, tables, panels)
