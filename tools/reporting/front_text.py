# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Whether the default lies on the Pareto front of a scene's pictures, and if not what the settings ahead of it bring
and give up, all by the report's figures: first as data, which check_report.py holds against the figures, then in words
that are made of these data alone."""

from figures import emphasis, join, number
from stats import judge, ratio_of_few

# Of figures that are the same in every run, and of memory.
_LEAST_WORSE = 1.02
_MOST_REASONS = 3


def _name(row):
    return f"{row['knob']} {row['setting']}"


def _loss(kind, figure, text):
    return {"kind": kind, "figure": figure, "text": text}


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
        yield _loss(
            "error", error(worst), f"in {emphasis(worst['scene'])} it leaves {number(error(worst))} times the error"
        )
    slow = max(others, key=lambda r: r["time_ratio"]["median"])
    if judge(slow["time_ratio"]) == "slower":
        ratio = slow["time_ratio"]["median"]
        yield _loss("time", ratio, f"in {emphasis(slow['scene'])} it takes {ratio:.2f} of the time")


def _of_its_tree(row, rows):
    """Memory and building, where they are most worse."""
    pairs = [(r, _default_of(rows, r["scene"])) for r in rows if _name(r) == _name(row)]
    memory = max(pairs, key=lambda pair: _ratio(pair[0]["device_bytes"], pair[1]["device_bytes"]))
    factor = _ratio(memory[0]["device_bytes"], memory[1]["device_bytes"])
    if factor > _LEAST_WORSE:
        text = f"it takes {number(factor)} times the memory ({emphasis(memory[0]['scene'])})"
        yield _loss("memory", factor, text)
    builds = [(ratio_of_few(r["build_ms"], default["build_ms"]), r["scene"]) for r, default in pairs]
    build = max(builds, key=lambda pair: pair[0]["median"])
    if judge(build[0]) == "slower":
        text = f"its tree takes {number(build[0]['median'])} times as long to build ({emphasis(build[1])})"
        yield _loss("build", build[0]["median"], text)


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
            reason = (
                f"rounding alone takes {number(worst['rmse'])} from {emphasis(worst['scene'])}, where promin's takes "
            )
            reason += number(own[worst["scene"]]["rmse"])
            reason += f", and {ids:,} pixels show another primitive" if ids else ""
            yield _loss("rounding", worst["rmse"], reason)
    kernels = report.get("kernels", {}).get("rows", [])
    leaks = [r for r in kernels if r["method"] == row["method"] != "promin" and r.get("leaks")]
    if leaks:
        worst = max(leaks, key=lambda r: r["leaks"])
        text = f"{worst['leaks']:,} of {worst['leak_rays']:,} rays leak by its test of the {worst['primitive']}"
        yield _loss("leaks", worst["leaks"], text)


def find_losses(row, report):
    """What a setting that is ahead of the default here gives up: kinds, figures and words."""
    rows = report["frames"]["rows"]
    losses = []
    # By another measure of error, in the same pictures.
    default = _default_of(rows, row["scene"])
    if "flip" in row and "flip" in default and row["flip"] > _LEAST_WORSE * default["flip"]:
        factor = row["flip"] / default["flip"]
        losses.append(_loss("FLIP", factor, f"by FLIP it leaves {number(factor)} times the error"))
    losses += _of_its_rounding(row, report)
    losses += _in_other_scenes(row, rows)
    losses += _of_its_tree(row, rows)
    return losses[:_MOST_REASONS]


def front_claim(report, scene):
    """What the page says of one scene's default: its place, and what is ahead of it, the fastest first."""
    rows = [row for row in report["frames"]["rows"] if row["scene"] == scene]
    default = _default_of(rows, scene)
    dominators = find_dominators(rows)
    by_median = [r for r in rows if r["rmse"] <= default["rmse"] and r["ms"]["median"] < default["ms"]["median"]]
    return {
        "scene": scene,
        "ms": default["ms"]["median"],
        "rmse": default["rmse"],
        "place": "off" if dominators else "on" if default["is_on_front"] else "on within noise",
        "ahead": [
            {
                "id": row["id"],
                "name": _name(row),
                "time_ratio": row["time_ratio"]["median"],
                "rmse": row["rmse"],
                "gives_up": find_losses(row, report),
            }
            for row in dominators
        ],
        "ahead_by_median": [_name(row) for row in by_median],
    }


def _reason(one, claim):
    exact = "the same error" if one["rmse"] == claim["rmse"] else f"an RMSE of {number(one['rmse'])}"
    losses = [loss["text"] for loss in one["gives_up"]]
    gives_up = f"it gives up this: {join(losses)}" if losses else "it gives up nothing that is measured here"
    text = f"{one['name']} takes {one['time_ratio']:.2f} of its time with {exact}; {gives_up}"
    return text[0].upper() + text[1:]


def front_sentence(claim):
    """The claim in words."""
    text = f"In {emphasis(claim['scene'])} the default takes {number(claim['ms'])} ms with an RMSE of "
    text += f"{number(claim['rmse'])} and "
    if claim["place"] == "off":
        return text + "lies off the front. " + ". ".join(_reason(one, claim) for one in claim["ahead"]) + "."
    if claim["place"] == "on":
        return text + "lies on the front."
    by_median = claim["ahead_by_median"]
    text += f"lies on the front within the noise: by the medians alone {join(by_median)} "
    return text + ("would be ahead, and not beyond it." if len(by_median) == 1 else "would be ahead, none beyond it.")
