# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Whether the default lies on the Pareto front of a scene's pictures, and if not what the settings ahead of it bring
and give up, all by the report's figures."""

import html

from figures import join, judge, number, ratio_of_few

# Of figures that are the same in every run, and of memory.
_LEAST_WORSE = 1.02
_MOST_REASONS = 3


def _name(row):
    return f"{row['knob']} {row['setting']}"


def _em(scene):
    return f"<em>{html.escape(scene)}</em>"


def _default_of(rows, scene):
    return next(row for row in rows if row["is_default"] and row["scene"] == scene)


def find_dominators(rows):
    """Of a scene's rows those that are as exact as the default and faster beyond noise, the fastest first."""
    default = next(row for row in rows if row["is_default"])
    ahead = [
        r for r in rows if r is not default and r["rmse"] <= default["rmse"] and judge(r["time_ratio"]) == "faster"
    ]
    return sorted(ahead, key=lambda r: r["time_ratio"]["median"])


def _ratio(own, other):
    return own / other if other else float("inf") if own else 1.0


def _in_other_scenes(row, rows):
    """What the same setting does elsewhere: error, time."""
    others = [r for r in rows if _name(r) == _name(row) and r["scene"] != row["scene"]]
    if not others:
        return
    error = lambda r: _ratio(r["rmse"], _default_of(rows, r["scene"])["rmse"])  # noqa: E731
    worst = max(others, key=error)
    if error(worst) > _LEAST_WORSE:
        yield f"in {_em(worst['scene'])} it leaves {number(error(worst))} times the error"
    slow = max(others, key=lambda r: r["time_ratio"]["median"])
    if judge(slow["time_ratio"]) == "slower":
        yield f"in {_em(slow['scene'])} it takes {slow['time_ratio']['median']:.2f} of the time"


def _of_its_tree(row, rows):
    """Memory and building, where they are most worse."""
    pairs = [(r, _default_of(rows, r["scene"])) for r in rows if _name(r) == _name(row)]
    memory = max(pairs, key=lambda pair: _ratio(pair[0]["device_bytes"], pair[1]["device_bytes"]))
    factor = _ratio(memory[0]["device_bytes"], memory[1]["device_bytes"])
    if factor > _LEAST_WORSE:
        yield f"it takes {number(factor)} times the memory ({_em(memory[0]['scene'])})"
    builds = [(ratio_of_few(r["build_ms"], default["build_ms"]), r["scene"]) for r, default in pairs]
    build = max(builds, key=lambda pair: pair[0]["median"])
    if judge(build[0]) == "slower":
        yield f"its tree takes {number(build[0]['median'])} times as long to build ({_em(build[1])})"


def _of_its_rounding(row, report):
    """Against the oracle; and of its kernels, where they are measured by the same name."""
    precision = [r for r in report["frames"]["errors"] if r["error"] == "precision"]
    own = {r["scene"]: r for r in precision if r["method"] == "promin"}
    others = [r for r in precision if r["method"] == row["method"] != "promin"]
    if others:
        worst = max(others, key=lambda r: _ratio(r["rmse"], own[r["scene"]]["rmse"]))
        factor = _ratio(worst["rmse"], own[worst["scene"]]["rmse"])
        ids = sum(r["id_mismatches"] for r in others)
        if factor > _LEAST_WORSE:
            reason = f"rounding alone takes {number(worst['rmse'])} from {_em(worst['scene'])}, where promin's takes "
            reason += number(own[worst["scene"]]["rmse"])
            yield reason + (f", and {ids:,} pixels show another primitive" if ids else "")
    leaks = [r for r in report["kernels"]["rows"] if r["method"] == row["method"] != "promin" and r.get("leaks")]
    if leaks:
        worst = max(leaks, key=lambda r: r["leaks"])
        yield f"{worst['leaks']:,} of {worst['leak_rays']:,} rays leak between its {worst['primitive']}s"


def find_losses(row, report):
    """What a setting that is ahead of the default here gives up, in words."""
    rows = report["frames"]["rows"]
    losses = []
    # By another measure of error, in the same pictures.
    default = _default_of(rows, row["scene"])
    if "flip" in row and "flip" in default and row["flip"] > _LEAST_WORSE * default["flip"]:
        losses.append(f"by FLIP it leaves {number(row['flip'] / default['flip'])} times the error")
    losses += _of_its_rounding(row, report)
    losses += _in_other_scenes(row, rows)
    losses += _of_its_tree(row, rows)
    return losses[:_MOST_REASONS]


def front_sentence(report, scene):
    """For one scene. check_report.py reads it: it says "on the front" or "off the front" and names all ahead."""
    rows = [row for row in report["frames"]["rows"] if row["scene"] == scene]
    default = _default_of(rows, scene)
    text = f"In {_em(scene)} the default takes {number(default['ms']['median'])} ms with an RMSE of "
    text += f"{number(default['rmse'])} and "
    ahead = find_dominators(rows)
    if ahead:
        reasons = []
        for row in ahead:
            exact = "the same error" if row["rmse"] == default["rmse"] else f"an RMSE of {number(row['rmse'])}"
            losses = find_losses(row, report)
            gives_up = f"it gives up this: {join(losses)}" if losses else "it gives up nothing that is measured here"
            reasons.append(f"{_name(row)} takes {row['time_ratio']['median']:.2f} of its time with {exact}; {gives_up}")
        text += "lies off the front. " + ". ".join(reason[0].upper() + reason[1:] for reason in reasons) + "."
    elif default["is_on_front"]:
        text += "lies on the front."
    else:
        by_median = [r for r in rows if r["rmse"] <= default["rmse"] and r["ms"]["median"] < default["ms"]["median"]]
        text += f"lies on the front within the noise: by the medians alone {join(map(_name, by_median))} "
        text += "would be ahead, and not beyond it." if len(by_median) == 1 else "would be ahead, none beyond it."
    return f'<span class="front" data-scene="{html.escape(scene)}">{text}</span>'
