# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""The page's sections on whole pictures: error against time, a curve a knob; and the three errors apart."""

import html

import plots
from figures import (
    emphasis,
    front_of,
    gap_text,
    interval,
    names_of,
    noise_percent,
    number,
    quartiles,
    scene_column,
    section,
    spread,
    table,
)
from front_text import front_claim, front_sentence


def knobs_of(rows):
    return [knob for knob in names_of(rows, "knob") if knob != "default"]


def _draw_knobs(rows, error, knobs):
    default = next(row for row in rows if row["is_default"])

    def draw(axes):
        for index, knob in enumerate(knobs):
            # The default is a point of every curve.
            curve = sorted([default] + [r for r in rows if r["knob"] == knob], key=lambda r: r["ms"]["median"])
            plots.draw_curve(
                axes,
                index,
                [r["ms"]["median"] for r in curve],
                [r[error] for r in curve],
                [quartiles(r["ms"]) for r in curve],
            )
        front = front_of(rows, "is_on_front" if error == "rmse" else f"is_on_{error}_front")
        plots.front_line(axes, [(r["ms"]["median"], r[error]) for r in front])
        plots.ring(axes, default["ms"]["median"], default[error])

    return draw


def _same_error_panel(scene, rows):
    """Times of what lies at one height in the other plots, or nearly."""
    other = [r for r in rows if r["knob"] in ("builder", "boxes", "offset rule", "methods")]
    names = [f"{r['knob']}: {r['setting']}" for r in other]
    title = f"{scene}, of the default's time"
    return plots.ratio_panel(f"frames-{scene}-ratios", title, names, [r["time_ratio"] for r in other])


def frames(report):
    rows = report["frames"]["rows"]
    knobs = knobs_of(rows)
    errors = [("rmse", "RMSE")]
    if all("flip" in row for row in rows):
        errors.append(("flip", "FLIP"))
    panels = []
    for scene in names_of(rows, "scene"):
        of_scene = [row for row in rows if row["scene"] == scene]
        size = next(row for row in of_scene if row["is_default"])
        for error, label in errors:
            title = f"{scene}, {size['width']} × {size['height']}"
            draw = _draw_knobs(of_scene, error, knobs)
            panels.append(plots.panel(f"frames-{scene}-{error}", title, draw, "ms a picture", label))
        panels.append(_same_error_panel(scene, of_scene))
    text = [
        "What each knob takes and brings, all others at their defaults (1 sample, depth 5, builder <em>sah</em>, "
        "boxes in bytes, promin's offset and methods); <em>error</em> is <code>--target-error</code>. The truth is a picture of "
        f"{report['frames']['truth_samples']} samples and {report['frames']['truth_depth']} bounces; smaller pictures "
        "are enlarged by repetition, larger ones averaged. A Whitted tracer has no noise: what is left is bias. Dotted "
        "is the Pareto front, ringed the default."
        + (" FLIP is that of PyPI's flip-evaluator. " if report["frames"]["gaps"] else "")
        + gap_text(report["frames"]["gaps"]),
        " ".join(front_sentence(front_claim(report, scene)) for scene in names_of(rows, "scene")),
        _knob_text(rows),
    ]
    columns = [
        scene_column(),
        ("knob", lambda r: r["knob"]),
        ("setting", lambda r: r["setting"]),
        ("ms", lambda r: spread(r["ms"])),
        ("over the default's", lambda r: interval(r["time_ratio"])),
        ("RMSE", lambda r: number(r["rmse"])),
        ("FLIP", lambda r: number(r.get("flip"))),
    ]
    figures = table(columns, rows, lambda r: r["is_default"])
    return section(
        "Pictures: error against time",
        text,
        f"<details><summary>All figures</summary>{figures}</details>",
        panels,
        list(enumerate(knobs)),
    )


def write_picture(report, file):
    """The plots of RMSE as a PNG."""
    rows, p = report["frames"]["rows"], report["provenance"]
    knobs = knobs_of(rows)
    panels = []
    for scene in names_of(rows, "scene"):
        of_scene = [row for row in rows if row["scene"] == scene]
        panels.append((scene, _draw_knobs(of_scene, "rmse", knobs), "ms a picture", "RMSE"))
    device = "a CPU" if p["device_type"] == "CPU" else p["device"]
    plots.write_picture(file, f"Error against time on {device}, {p['driver']}; ringed: the default", panels, knobs)


def _knob_text(rows):
    parts = []
    for scene in names_of(rows, "scene"):
        of_scene = [r for r in rows if r["scene"] == scene]
        default = next(r for r in of_scene if r["is_default"])
        most = max((r for r in of_scene if r["knob"] == "samples"), key=lambda r: r["ms"]["median"], default=None)
        if most and default["rmse"]:
            parts.append(
                f"In {emphasis(scene)} {most['setting']} samples take "
                f"{most['time_ratio']['median']:.1f} times as long and leave "
                f"{100 * most['rmse'] / default['rmse']:.0f} % of the error."
            )
    noise = sorted(noise_percent(r["ms"]) for r in rows)
    parts.append(f"Half the quartiles' distance is {number(noise[len(noise) // 2], 2)} % of a median, typically.")
    return " ".join(parts)


def errors_apart(report):
    rows = report["frames"]["errors"]
    precision = [r for r in rows if r["error"] == "precision"]
    methods = names_of(precision, "method")
    scenes = names_of(rows, "scene")
    kinds = ["precision", "sampling", "truncation", "all"]
    floor = 1e-9

    def draw_kinds(axes):
        for index, scene in enumerate(scenes):
            own = {r["error"]: r["rmse"] for r in rows if r["scene"] == scene and r["method"] == "promin"}
            plots.draw_curve(axes, index, list(range(len(kinds))), [max(own[k], floor) for k in kinds], line="none")
        axes.set_xticks(range(len(kinds)), kinds)
        axes.set_xlim(-0.5, len(kinds) - 0.5)

    def draw_methods(axes):
        for index, scene in enumerate(scenes):
            by = {r["method"]: r["rmse"] for r in precision if r["scene"] == scene}
            plots.draw_curve(axes, index, list(range(len(methods))), [max(by[m], floor) for m in methods], line="none")
        axes.set_xticks(range(len(methods)), [m.replace(" ", "\n") for m in methods])
        axes.set_xlim(-0.5, len(methods) - 0.5)

    panels = [
        plots.panel("errors-kinds", "promin's errors", draw_kinds, "", "RMSE", x_log=False),
        plots.panel("errors-methods", "precision by method", draw_methods, "", "RMSE", x_log=False),
    ]
    columns = [
        scene_column(),
        ("error", lambda r: r["error"]),
        ("method", lambda r: r.get("what", "as shipped")),
        ("pixels", lambda r: f"{r['width']} × {r['height']}"),
        ("RMSE", lambda r: number(r["rmse"])),
        ("mean", lambda r: number(r.get("mean_absolute"))),
        ("other ids", lambda r: r.get("id_mismatches", "–")),
        ("not finite", lambda r: r.get("non_finite_pixels", "–")),
    ]
    return section(
        "Precision, sampling and truncation apart",
        [_errors_text(rows, precision, scenes)],
        table(columns, rows, lambda r: r["method"] == "promin"),
        panels,
        list(enumerate(map(html.escape, scenes))),
    )


def _errors_text(rows, precision, scenes):
    parts = [
        "Precision is what fp32 takes from a picture, against brute force in long double with the same samples "
        "(smaller pictures of larger scenes, as brute force takes its time); sampling what few samples do; truncation "
        "what the depth cuts off."
    ]
    for scene in scenes:
        own = {r["error"]: r["rmse"] for r in rows if r["scene"] == scene and r["method"] == "promin"}
        worst = max((r for r in precision if r["scene"] == scene and r["method"] != "promin"), key=lambda r: r["rmse"])
        share = own["all"] / own["precision"] if own["precision"] else None
        parts.append(
            f"In {emphasis(scene)} precision is {number(own['precision'])}, "
            + (f"1 in {share:,.0f} of all of the error; " if share else "nothing; ")
            + f"the worst of the other methods ({worst['method']}) has {number(worst['rmse'])}."
        )
    return " ".join(parts)
