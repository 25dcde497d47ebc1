# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""What pages and tables of figures share: numbers for people, tables, sections and words for several figures."""

import html
import re

from stats import LEAST_CONFIDENCE, judge


def number(value, digits=3):
    """For people; an en dash for what was not measured."""
    if value is None:
        return "–"
    if isinstance(value, str):
        return html.escape(value)
    if value == 0:
        return "0"
    if abs(value) >= 1e5 or abs(value) < 1e-3:
        mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
        mantissa = f"{float(mantissa):g}"
        power = f"10<sup>{int(exponent)}</sup>"
        return (power if float(mantissa) == 1 else f"{mantissa}·{power}").replace("-", "−")
    if abs(value) >= 100:
        return f"{value:,.0f}"
    return f"{value:.{digits}g}"


def plain(value, digits=3):
    """As number, for text without markup."""
    return number(value, digits).replace("<sup>", "^").replace("</sup>", "")


def spread(times, digits=3):
    """Median with quartiles of {"median", "lower_quartile", "upper_quartile"}."""
    if not times:
        return "–"
    low, high = quartiles(times)
    return f'{number(times["median"], digits)} <small>({number(low, digits)}…{number(high, digits)})</small>'


def quartiles(times):
    return times["lower_quartile"], times["upper_quartile"]


def interval(ratio, digits=3):
    """Median and interval, for tables."""
    if not ratio:
        return "–"
    low, high = ratio["interval_lower"], ratio["interval_upper"]
    return f'{number(ratio["median"], digits)} <small>[{number(low, digits)}…{number(high, digits)}]</small>'


def few(times, digits=3):
    """Median with least and most of what is timed a few times; of one run that alone."""
    if times["runs"] == 1:
        return f'{number(times["median"], digits)} <small>once</small>'
    least, most = number(times["least"], digits), number(times["most"], digits)
    return f'{number(times["median"], digits)} <small>({least}–{most})</small>'


_LONGEST_LINE = 24


def _cell(text):
    """Sentences take lines of their own; numbers do not."""
    is_long = len(str(text)) > _LONGEST_LINE and "<" not in str(text)
    return f"<td class='long'>{text}</td>" if is_long else f"<td>{text}</td>"


def table(columns, rows, is_shipped=lambda row: False, caption=""):
    """A column is its head and what makes a cell of a row."""
    lines = ["<div class='table'><table>"]
    if caption:
        lines.append(f"<caption>{caption}</caption>")
    lines.append("<thead><tr>" + "".join(f"<th>{head}</th>" for head, _ in columns) + "</tr></thead><tbody>")
    for row in rows:
        mark = ' class="shipped"' if is_shipped(row) else ""
        lines.append(f"<tr{mark}>" + "".join(_cell(make(row)) for _, make in columns) + "</tr>")
    return "\n".join(lines + ["</tbody></table></div>"])


def _without_markup(cell):
    return re.sub("<[^>]*>", "", str(cell).replace("<sup>", "^")).replace("|", "\\|")


def markdown_table(columns, rows):
    """As table, for documents."""
    lines = [[head for head, _ in columns], *([make(row) for _, make in columns] for row in rows)]
    lines = ["| " + " | ".join(map(_without_markup, cells)) + " |" for cells in lines]
    return "\n".join([lines[0], "|" + "---|" * len(columns), *lines[1:]]) + "\n"


def section(title, text, table="", panels=(), legend=()):
    """Of a page: paragraphs, plots as SVG with the (index, name) pairs of their legend, and a table."""
    return {"title": title, "text": text, "table": table, "panels": panels, "legend": legend}


def bound_of(report, on_cpu):
    """Of an error, which a GPU's divisions, good to 2.5 ulp, may make twice as large (check_report.py)."""
    return on_cpu if report["provenance"]["device_type"] == "CPU" else 2 * on_cpu


def beyond_noise_text(ratios, wanted):
    """How many of them judge finds so, as a sentence."""
    if all(ratio["confidence"] < LEAST_CONFIDENCE for ratio in ratios):
        return f"{ratios[0]['runs']} runs are too few to tell that from noise."
    count = sum(judge(ratio) == wanted for ratio in ratios)
    return f"It is {wanted} beyond noise in {count} of {len(ratios)} cases."


def from_to(values):
    """ "0.42 to 0.57" """
    low, high = f"{min(values):.2f}", f"{max(values):.2f}"
    return low if low == high else f"{low} to {high}"


def emphasis(scene):
    return f"<em>{html.escape(scene)}</em>"


def scene_column():
    return "scene", lambda row: html.escape(row["scene"])


def names_of(rows, key):
    """Each once, in the rows' order."""
    return list(dict.fromkeys(row[key] for row in rows))


def front_of(rows, mark="is_on_front", times="ms"):
    """The rows that the report marks as on the Pareto front, by rising time."""
    return sorted((row for row in rows if row.get(mark)), key=lambda row: row[times]["median"])


def gap_text(gaps):
    """Sentences on what was not measured; of what is installed, why."""
    absent = [gap["name"] for gap in gaps if not gap["is_installed"]]
    parts = [f"Not measured, as not installed: {join(absent)}."] if absent else []
    parts += [
        f"Not measured: {gap['name']} is installed, but: <q>{html.escape(gap['reason'])}</q>."
        for gap in gaps
        if gap["is_installed"]
    ]
    return " ".join(parts)


def noise_percent(times):
    """Half the quartiles' distance over the median, in percent."""
    return 50.0 * (times["upper_quartile"] - times["lower_quartile"]) / times["median"] if times["median"] else 0.0


def join(words):
    """ "a, b and c" """
    words = list(words)
    return words[0] if len(words) == 1 else ", ".join(words[:-1]) + " and " + words[-1] if words else "none"
