# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""The page's sections on whole pictures: error against time, a curve a knob; and the three errors apart."""

import plots
from figures import is_slower, join, noise_percent, number, pareto_front, quartiles, spread, table

_FASTER = 0.98


def knobs_of(rows):
    return [knob for knob in dict.fromkeys(row["knob"] for row in rows) if knob != "default"]


def _scenes(rows):
    return list(dict.fromkeys(row["scene"] for row in rows))


def front_of(rows, error):
    """The rows of the Pareto front by median time and this error."""
    points = [(row["ms"]["median"], row[error]) for row in rows]
    return [rows[i] for i in pareto_front(points)]


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
        plots.front_line(axes, [(r["ms"]["median"], r[error]) for r in front_of(rows, error)])
        plots.ring(axes, default["ms"]["median"], default[error])

    return draw


def _name(row):
    return f"{row['knob']} {row['setting']}"


def dominators(rows, error="rmse"):
    """Rows that are no worse than the default by this error and faster beyond noise: in three of four turns, by 2 %."""
    default = next(row for row in rows if row["is_default"])
    as_exact = [r for r in rows if r is not default and r[error] <= default[error]]
    if "time_ratio" in default:
        return [r for r in as_exact if r["time_ratio"]["upper_quartile"] < _FASTER]
    return [r for r in as_exact if is_slower(default["ms"], r["ms"])]


def _ratio_text(row, default):
    ratio = row["time_ratio"]["median"] if "time_ratio" in row else row["ms"]["median"] / default["ms"]["median"]
    return f"{ratio:.2f}"


def _front_text(rows):
    """Whether the default lies on the front, and why not where it does not."""
    default = next(row for row in rows if row["is_default"])
    better = dominators(rows)
    front = [r for r in front_of(rows, "rmse")]
    text = f"In <em>{default['scene']}</em> the default takes {number(default['ms']['median'])} ms with an RMSE of "
    text += f"{number(default['rmse'])}"
    if not better:
        if default in front:
            return text + " and lies on the front."
        ahead = [r for r in rows if r["rmse"] <= default["rmse"] and r["ms"]["median"] < default["ms"]["median"]]
        names = join(_name(r) for r in ahead)
        return text + f" and lies on the front within the noise: {names} would be ahead by less than that."
    reasons = []
    for r in better:
        gain = f"{_name(r)} is as exact here and takes {_ratio_text(r, default)} of the time"
        if r["knob"] == "builder":
            gain += ", but its trees take longer to build"
        elif r["knob"] == "methods":
            gain += ", but it is held to no bound on rounding (see the errors apart)"
        elif r["knob"] == "offset rule":
            gain += ", but its offset fits only scenes of this size (see the errors apart)"
        elif r["knob"] == "boxes":
            gain += ", but a node takes twice the memory, which larger scenes feel"
        elif r["knob"] == "depth":
            gain += ", as this scene shows no reflection beyond"
        reasons.append(gain)
    return text + " and lies off the front: " + "; ".join(reasons) + "."


def frames(report):
    rows = report["frames"]["rows"]
    knobs = knobs_of(rows)
    errors = [("rmse", "RMSE")]
    if all("flip" in row for row in rows):
        errors.append(("flip", "FLIP"))
    panels = []
    for scene in _scenes(rows):
        of_scene = [row for row in rows if row["scene"] == scene]
        size = next(row for row in of_scene if row["is_default"])
        for error, label in errors:
            title = f"{scene}, {size['width']} × {size['height']}"
            draw = _draw_knobs(of_scene, error, knobs)
            panels.append(plots.panel(f"frames-{scene}-{error}", title, draw, "ms a picture", label))
    text = [
        "What each knob takes and brings, all others at their defaults (1 sample, depth 5, builder <em>sah</em>, "
        "boxes in bytes, promin's offset and methods). The truth is a picture of "
        f"{report['frames']['truth_samples']} samples and {report['frames']['truth_depth']} bounces; smaller pictures "
        "are enlarged by repetition, larger ones averaged. A Whitted tracer has no noise: what is left is bias. Dotted "
        "is the Pareto front, ringed the default."
        + ("" if len(errors) > 1 else " FLIP is not measured: PyPI's flip-evaluator is not installed."),
        " ".join(_front_text([row for row in rows if row["scene"] == scene]) for scene in _scenes(rows)),
        _knob_text(rows),
    ]
    head = ["scene", "knob", "setting", "ms", "over the default's", "RMSE", "FLIP"]
    body = [
        (
            [
                r["scene"],
                r["knob"],
                r["setting"],
                spread(r["ms"]),
                spread(r.get("time_ratio")),
                number(r["rmse"]),
                number(r.get("flip")),
            ],
            r["is_default"],
        )
        for r in rows
    ]
    legend = list(enumerate(knobs))
    return {
        "title": "Pictures: error against time",
        "panels": panels,
        "legend": legend,
        "text": text,
        "table": f"<details><summary>All figures</summary>{table(head, body)}</details>",
    }


def write_picture(report, file):
    """The plots of RMSE as a PNG."""
    rows, p = report["frames"]["rows"], report["provenance"]
    knobs = knobs_of(rows)
    panels = []
    for scene in _scenes(rows):
        of_scene = [row for row in rows if row["scene"] == scene]
        panels.append((scene, _draw_knobs(of_scene, "rmse", knobs), "ms a picture", "RMSE"))
    device = "a CPU" if p["device_type"] == "CPU" else p["device"]
    plots.write_picture(file, f"Error against time on {device}, {p['driver']}; ringed: the default", panels, knobs)


def _knob_text(rows):
    parts = []
    for scene in _scenes(rows):
        of_scene = [r for r in rows if r["scene"] == scene]
        default = next(r for r in of_scene if r["is_default"])
        most = max((r for r in of_scene if r["knob"] == "samples"), key=lambda r: r["ms"]["median"], default=None)
        if most:
            parts.append(
                f"In <em>{scene}</em> {most['setting']} samples take "
                f"{most['ms']['median'] / default['ms']['median']:.1f} times as long and leave "
                f"{100 * most['rmse'] / default['rmse']:.0f} % of the error."
            )
    noise = sorted(noise_percent(r["ms"]) for r in rows)
    parts.append(f"Half the quartiles' distance is {number(noise[len(noise) // 2], 2)} % of a median, typically.")
    return " ".join(parts)


def errors_apart(report):
    rows = report["frames"]["errors"]
    precision = [r for r in rows if r["error"] == "precision"]
    methods = list(dict.fromkeys(r["method"] for r in precision))
    scenes = list(dict.fromkeys(r["scene"] for r in rows))
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
    head = ["scene", "error", "method", "pixels", "RMSE", "mean", "other ids", "not finite"]
    body = [
        (
            [
                r["scene"],
                r["error"],
                r.get("what", "as shipped"),
                f"{r['width']} × {r['height']}",
                number(r["rmse"]),
                number(r.get("mean_absolute")),
                str(r.get("id_mismatches", "–")),
                str(r.get("non_finite_pixels", "–")),
            ],
            r["method"] == "promin",
        )
        for r in rows
    ]
    return {
        "title": "Precision, sampling and truncation apart",
        "panels": panels,
        "legend": list(enumerate(scenes)),
        "text": [_errors_text(rows, precision, scenes)],
        "table": table(head, body),
    }


def _errors_text(rows, precision, scenes):
    parts = [
        "Precision is what fp32 takes from a picture, against brute force in long double with the same samples "
        "(smaller pictures of larger scenes, as brute force takes its time); sampling what few samples do; truncation what "
        "the depth cuts off."
    ]
    for scene in scenes:
        own = {r["error"]: r["rmse"] for r in rows if r["scene"] == scene and r["method"] == "promin"}
        worst = max((r for r in precision if r["scene"] == scene and r["method"] != "promin"), key=lambda r: r["rmse"])
        share = own["all"] / own["precision"] if own["precision"] else None
        parts.append(
            f"In <em>{scene}</em> precision is {number(own['precision'])}, "
            + (f"{number(share, 2)} times less than all of the error; " if share else "nothing; ")
            + f"the worst of the other methods ({worst['method']}) has {number(worst['rmse'])}."
        )
    return " ".join(parts)
