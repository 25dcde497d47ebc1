# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Panels of the report's page: matplotlib's SVG, made fit for a page that may be light or dark.

Colours are the page's CSS variables (--c0...--c7), text is currentColor; the same figures give the same bytes."""

import io
import math
import re

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt  # noqa: E402 - the backend comes first
from matplotlib.ticker import FixedLocator, FuncFormatter, LogLocator, NullFormatter  # noqa: E402

# What stands for the page's variables until the SVG is written; nothing else has these.
_SERIES = [f"#0{i}fe0{i}" for i in range(8)]
_TEXT, _GRID = "#08fe08", "#09fe09"
_MARKERS = "osD^vPX*"
WIDTH_IN, HEIGHT_IN = 4.2, 3.1


def color(index):
    return _SERIES[index % len(_SERIES)]


def marker(index):
    return _MARKERS[index % len(_MARKERS)]


def _style(name):
    return {
        "svg.hashsalt": name,
        "svg.fonttype": "none",
        "font.family": "sans-serif",
        "font.size": 9,
        "axes.titlesize": 10,
        "axes.edgecolor": _TEXT,
        "axes.labelcolor": _TEXT,
        "axes.titlecolor": _TEXT,
        "text.color": _TEXT,
        "xtick.color": _TEXT,
        "ytick.color": _TEXT,
        "grid.color": _GRID,
        "axes.grid": True,
        # A scene's name may have a $.
        "text.parse_math": False,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "lines.linewidth": 1.3,
        "lines.markersize": 5,
    }


def _to_page(svg, title):
    """Short, without prologue and fixed size; with the page's colours, and a name for who cannot see it."""
    svg = svg[svg.index("<svg") :]
    for i, code in enumerate(_SERIES):
        svg = svg.replace(code, f"var(--c{i})")
    svg = svg.replace(_TEXT, "currentColor").replace(_GRID, "var(--grid)")
    svg = re.sub(r"<metadata>.*?</metadata>", "", svg, flags=re.DOTALL)
    svg = re.sub(r"font: ([^;\"]*?)'?(sans-serif|DejaVu Sans)[^;\"]*", r"font: \1sans-serif", svg)
    # Comments repeat texts; only what is used again needs a name.
    svg = re.sub(r' id="(?![mp][0-9a-f]{10}")[^"]*"|<!--.*?-->', "", svg, flags=re.DOTALL)
    svg = re.sub(r">\s+<", "><", re.sub(r"<[^>]*>", lambda tag: _shorten(tag.group(0)), svg)).strip()
    svg = _without_bare_groups(svg)
    # Ticks' lines have their colour where they are defined.
    svg = re.sub(r'(<use [^>]*) style="fill:currentColor;stroke:currentColor[^"]*"', r"\1", svg)
    label = title.replace("&", "&amp;").replace('"', "&quot;").replace("<", "&lt;")
    svg = re.sub(r'<svg ([^>]*?)width="[^"]*"', rf'<svg role="img" aria-label="{label}" \1', svg, count=1)
    return svg.replace(re.search(r' height="[^"]*pt"', svg).group(0), "", 1)


def _without_bare_groups(svg):
    """Groups that say nothing, which are most, are not needed."""
    kept, is_bare = [], []
    for part in re.split("(</?g[^>]*>)", svg):
        if part.startswith("<g"):
            is_bare.append(part == "<g>")
        if not (is_bare and is_bare[-1] and part in ("<g>", "</g>")):
            kept.append(part)
        if part == "</g>":
            is_bare.pop()
    return "".join(kept)


def _shorten(tag):
    """A tag of an SVG: a tenth of a point is finer than any screen shows."""
    tag = re.sub(r"-?\d+\.\d+", lambda match: f"{float(match.group(0)):.1f}".removesuffix(".0"), tag)
    tag = re.sub(r"\s+", " ", tag).replace("; ", ";").replace(": ", ":").replace(" />", "/>").replace(' "', '"')
    return re.sub(r" ?([MLCz]) ?(?=[-\d\"])", r"\1", tag)


def _label(value):
    """A tick's number as people write it: 0.05, 20, 5000, 10⁶."""
    if value == 0 or 1e-4 < abs(value) < 1e5:
        return f"{value:g}"
    exponent = math.floor(math.log10(abs(value)) + 1e-9)
    power = "10" + str(exponent).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
    mantissa = value / 10**exponent
    return power if abs(mantissa - 1) < 1e-9 else f"{mantissa:g}·{power}"


def _set_log_ticks(axis):
    """Decades; 2 and 5 of each beside where there are less than two."""
    low, high = sorted(axis.get_view_interval())
    is_short = low > 0 and high / low < 100
    axis.set_major_formatter(FuncFormatter(lambda value, _: _label(value)))
    # Unless the plot has ticks of its own.
    if is_short and not isinstance(axis.get_major_locator(), FixedLocator):
        axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axis.set_minor_formatter(NullFormatter())


def _draw_axes(axes, title, draw, x_label, y_label, x_log, y_log):
    if x_log:
        axes.set_xscale("log")
    if y_log:
        axes.set_yscale("log")
    draw(axes)
    for axis, scale in ((axes.xaxis, axes.get_xscale()), (axes.yaxis, axes.get_yscale())):
        if scale == "log":
            _set_log_ticks(axis)
        elif scale == "symlog":
            axis.set_major_formatter(FuncFormatter(lambda value, _: _label(value)))
    axes.set_title(title, loc="left")
    axes.set_xlabel(x_label)
    axes.set_ylabel(y_label)


def panel(name, title, draw, x_label="", y_label="", x_log=True, y_log=True):
    """One plot as an inline SVG; `draw` gets the axes. `name` is unique on the page."""
    with plt.rc_context(_style(name)):
        figure, axes = plt.subplots(figsize=(WIDTH_IN, HEIGHT_IN))
        _draw_axes(axes, title, draw, x_label, y_label, x_log, y_log)
        figure.patch.set_visible(False)
        axes.patch.set_visible(False)
        figure.tight_layout(pad=0.4)
        out = io.StringIO()
        figure.savefig(out, format="svg", metadata={"Date": None, "Creator": None})
        plt.close(figure)
    return _to_page(out.getvalue(), title)


_LIGHT = ("#0b62c4", "#c4420b", "#14805e", "#8a3fc0", "#a8730a", "#c21f6b", "#3b7a9e", "#6b7280")


def write_picture(file, title, panels, names):
    """Plots side by side as a PNG on white, for pages that show no SVG. A panel is (title, draw, x label, y label);
    `names` are the legend's, by colour."""
    global _SERIES, _TEXT
    kept = _SERIES, _TEXT
    _SERIES, _TEXT = _LIGHT, "#1b1f24"
    try:
        with plt.rc_context({**_style("picture"), "grid.color": "#e4e8ec"}):
            figure, all_axes = plt.subplots(1, len(panels), figsize=(max(8.4, 3.6 * len(panels)), 3.8), squeeze=False)
            for axes, (name, draw, x_label, y_label) in zip(all_axes[0], panels):
                _draw_axes(axes, name, draw, x_label, y_label, True, True)
            handles = [
                plt.Line2D([], [], color=color(i), marker=marker(i), linestyle="-", label=name)
                for i, name in enumerate(names)
            ]
            figure.legend(handles=handles, loc="lower center", ncol=len(names), frameon=False)
            figure.suptitle(title, fontsize=11)
            figure.tight_layout(rect=(0, 0.07, 1, 1))
            figure.savefig(file, format="png", dpi=110, facecolor="white", metadata={"Software": None})
            plt.close(figure)
    finally:
        _SERIES, _TEXT = kept


def draw_curve(axes, index, xs, ys, x_spread=None, y_spread=None, line="-", is_marked=True):
    """A series; spreads are (lower, upper) quartiles a point."""

    def bars(values, spread):
        if spread is None:
            return None
        return [
            [max(0.0, value - low) for value, (low, high) in zip(values, spread)],
            [max(0.0, high - value) for value, (low, high) in zip(values, spread)],
        ]

    axes.errorbar(
        xs,
        ys,
        xerr=bars(xs, x_spread),
        yerr=bars(ys, y_spread),
        color=color(index),
        marker=marker(index) if is_marked else None,
        linestyle=line,
        elinewidth=0.8,
    )


def draw_ratios(names, ratios):
    """Ratios as points over their names, with their medians' intervals."""

    def draw(axes):
        values = [ratio["median"] for ratio in ratios]
        bars = [
            (ratio.get("interval_lower", ratio.get("least")), ratio.get("interval_upper", ratio.get("most")))
            for ratio in ratios
        ]
        places = list(range(len(names)))[::-1]
        draw_curve(axes, 0, values, places, x_spread=bars, line="none")
        axes.set_yticks(places, names)
        axes.set_ylim(-0.6, len(names) - 0.4)
        axes.axvline(1, color=color(7), linewidth=0.8, linestyle="--")

    return draw


def ratio_panel(name, title, names, ratios, x_log=False):
    return panel(name, title, draw_ratios(names, ratios), "ratio of times", x_log=x_log, y_log=False)


def ring(axes, x, y):
    """Around what promin ships."""
    axes.plot([x], [y], marker="o", markersize=12, markerfacecolor="none", markeredgecolor=_TEXT, linestyle="none")


def front_line(axes, points):
    """The steps of a Pareto front, points in its order."""
    axes.step(*zip(*points), where="post", color=_TEXT, linewidth=0.8, linestyle=":")


def legend(names):
    """(index, name) pairs as HTML for all panels of a figure."""
    shapes = {"o": "●", "s": "■", "D": "◆", "^": "▲", "v": "▼", "P": "✚", "X": "✖", "*": "★"}
    keys = [f'<span style="color:var(--c{i % 8})">{shapes[marker(i)]}</span> {name}' for i, name in names]
    return '<p class="legend">' + " &ensp; ".join(keys) + "</p>"
