# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""The page's section on how time, steps and memory grow."""

import plots
from figures import join, number, quartiles, section, table

_RAYS = ("camera", "shadow", "random")


def _rows(rows, variable, curve):
    return sorted((r for r in rows if r["variable"] == variable and r["curve"] == curve), key=lambda r: r["value"])


def _draw_rays(rows, key):
    def draw(axes):
        for index, rays in enumerate(_RAYS):
            curve = _rows(rows, "triangles", rays)
            values = [r[key]["median"] if isinstance(r[key], dict) else r[key] for r in curve]
            bars = [quartiles(r[key]) for r in curve] if isinstance(curve[0][key], dict) else None
            plots.draw_curve(axes, index, [r["value"] for r in curve], values, y_spread=bars)

    return draw


def _draw_pictures(rows, variable):
    def draw(axes):
        curve = _rows(rows, variable, "picture")
        times = [r["ms"]["median"] for r in curve]
        plots.draw_curve(axes, 3, [r["value"] for r in curve], times, y_spread=[quartiles(r["ms"]) for r in curve])
        if variable == "depth":
            axes.set_xscale("symlog", linthresh=1)
        if variable != "pixels":
            axes.set_xticks([r["value"] for r in curve])

    return draw


def _draw_build(rows, key):
    def draw(axes):
        curve = _rows(rows, "triangles", "build")
        is_timed = isinstance(curve[0][key], dict)
        values = [r[key]["median"] if is_timed else r[key] for r in curve]
        bars = [(r[key]["least"], r[key]["most"]) for r in curve] if is_timed else None
        plots.draw_curve(axes, 4, [r["value"] for r in curve], values, y_spread=bars)

    return draw


def _power(fits, key):
    fit = next((f for f in fits if f["id"] == key), None)
    if not fit:
        return "–"
    return f"n<sup>{fit['exponent']:.2f}</sup> ({fit['lower']:.2f}…{fit['upper']:.2f})".replace("-", "−")


def scaling(report):
    rows, fits = report["scaling"]["rows"], report["scaling"]["fits"]
    panels = [
        plots.panel("scaling-time", "a ray", _draw_rays(rows, "ns_per_ray"), "triangles", "ns a ray"),
        plots.panel(
            "scaling-steps", "steps of a ray", _draw_rays(rows, "node_steps_per_ray"), "triangles", "node steps"
        ),
        plots.panel("scaling-build", "building the tree", _draw_build(rows, "build_ms"), "triangles", "ms"),
        plots.panel("scaling-memory", "memory", _draw_build(rows, "device_bytes"), "triangles", "bytes on the device"),
    ]
    for variable in ("pixels", "sources", "depth"):
        panels.append(
            plots.panel(f"scaling-{variable}", variable, _draw_pictures(rows, variable), variable, "ms a picture")
        )
    builds = _rows(rows, "triangles", "build")
    first, last = builds[0], builds[-1]
    times = {rays: _rows(rows, "triangles", rays) for rays in _RAYS}
    growth = join(f"{rays} rays {times[rays][-1]['time_ratio']['median']:.1f}" for rays in _RAYS)
    runs = last["build_ms"]["runs"]
    depth = _rows(rows, "depth", "picture")
    text = (
        f"From {first['value']:,.0f} to {last['value']:,.0f} triangles a ray takes that many times longer: {growth}; "
        f"brute force would take {last['value'] / first['value']:,.0f}. Steps grow as n to the powers of the "
        "table, with 95 % intervals; a logarithm's power falls with n. A triangle takes "
        f"{last['device_bytes'] / last['value']:.1f} bytes on the device, and the largest "
        f"mesh's tree is built in {number(last['build_ms']['median'])} ms"
        + (" (built once)" if runs == 1 else f" (median of {runs})")
        + ". A picture grows with its pixels "
        f"as {_power(fits, 'pixels/ms')}, with sources as "
        f"{_power(fits, 'sources/ms')}; at a depth of {depth[-1]['value']:.0f} it takes "
        f"{depth[-1]['time_ratio']['median']:.1f} times what it does without mirror rays, and "
        f"{depth[-1]['rays'] / depth[0]['rays']:.1f} times the rays."
    )
    columns = [
        ("grows", lambda f: f["id"].replace("/", ": ").replace("_", " ")),
        ("exponent", lambda f: f"{f['exponent']:.3f}"),
        ("95 % interval", lambda f: f"{f['lower']:.3f}…{f['upper']:.3f}".replace("-", "−")),
        ("points", lambda f: f["points"]),
        ("a doubling adds (r²)", _doubling),
    ]
    return section("Growth", [text], table(columns, fits), panels, list(enumerate(_RAYS)))


def _doubling(fit):
    return f"{fit['per_doubling']:.2f} ({fit['r_squared']:.3f})" if "per_doubling" in fit else "–"
