# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""What the sections of the page share: numbers for people, tables, and the judgement of times."""

import html
import math


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
    low, high = times["lower_quartile"], times["upper_quartile"]
    return f'{number(times["median"], digits)} <small>({number(low, digits)}…{number(high, digits)})</small>'


def quartiles(times):
    return times["lower_quartile"], times["upper_quartile"]


_LONGEST_LINE = 24


def _cell(text):
    """Sentences take lines of their own; numbers do not."""
    is_long = len(str(text)) > _LONGEST_LINE and "<" not in str(text)
    return f"<td class='long'>{text}</td>" if is_long else f"<td>{text}</td>"


def table(head, rows, caption=""):
    lines = ["<div class='table'><table>"]
    if caption:
        lines.append(f"<caption>{caption}</caption>")
    lines.append("<thead><tr>" + "".join(f"<th>{cell}</th>" for cell in head) + "</tr></thead><tbody>")
    for cells, is_shipped in rows:
        mark = ' class="shipped"' if is_shipped else ""
        lines.append(f"<tr{mark}>" + "".join(map(_cell, cells)) + "</tr>")
    lines.append("</tbody></table></div>")
    return "\n".join(lines)


# Of runs in one turn, or of two reports: less than this may come of where in memory something lies.
_LEAST_DIFFERENCE = 1.02
_LEAST_CONFIDENCE = 0.95


def judge(ratio):
    """What a ratio of times says beyond noise: "faster", "slower", or nothing, "". All times are judged here alone.

    A ratio is of the runs of the same turn, so that what falls on both is not in it; its median's interval, by order
    statistics, holds the true median in 95 % of all cases, whatever the distribution, and narrows with more runs. That
    must be on one side of 1, and the median 2 % from it. Fewer than 6 runs have no such interval and say nothing."""
    if ratio["confidence"] < _LEAST_CONFIDENCE:
        return ""
    if ratio["interval_upper"] < 1 and ratio["median"] * _LEAST_DIFFERENCE < 1:
        return "faster"
    if ratio["interval_lower"] > 1 and ratio["median"] > _LEAST_DIFFERENCE:
        return "slower"
    return ""


def bound_of(report, on_cpu):
    """Of an error, which a GPU's divisions, good to 2.5 ulp, may make twice as large (check_report.py)."""
    return on_cpu if report["provenance"]["device_type"] == "CPU" else 2 * on_cpu


def beyond_noise_text(ratios, wanted):
    """How many of them judge finds so, as a sentence."""
    if all(ratio["confidence"] < _LEAST_CONFIDENCE for ratio in ratios):
        return f"{ratios[0]['runs']} runs are too few to tell that from noise."
    count = sum(judge(ratio) == wanted for ratio in ratios)
    return f"It is {wanted} beyond noise in {count} of {len(ratios)} cases."


def from_to(values):
    """ "0.42 to 0.57" """
    low, high = f"{min(values):.2f}", f"{max(values):.2f}"
    return low if low == high else f"{low} to {high}"


def ratio_of_reports(new, old):
    """The ratio of two times that were not measured in turns: an interval as wide as both of theirs together, so it is
    on one side of 1 where they do not meet."""
    return {
        "median": new["median"] / old["median"],
        "interval_lower": new["interval_lower"] / old["interval_upper"],
        "interval_upper": new["interval_upper"] / old["interval_lower"],
        "confidence": min(new["confidence"], old["confidence"]),
    }


def ratio_of_few(new, old):
    """As ratio_of_reports, of times with their least and most: those of n and m runs part by chance in two of
    C(n + m, n) cases."""
    return {
        "median": new["median"] / old["median"],
        "interval_lower": new["least"] / old["most"],
        "interval_upper": new["most"] / old["least"],
        "confidence": 1 - 2 / math.comb(new["runs"] + old["runs"], new["runs"]),
    }


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


def front_of(rows, mark="is_on_front", times="ms"):
    """The rows that the report marks as on the Pareto front, by rising time."""
    return sorted((row for row in rows if row.get(mark)), key=lambda row: row[times]["median"])


def gap_text(gaps):
    """Sentences on what was not measured; of what is installed and failed, its own last line."""
    absent = [gap["name"] for gap in gaps if not gap["is_installed"]]
    parts = [f"Not measured, as not installed: {join(absent)}."] if absent else []
    parts += [
        f"Not measured: {gap['name']} is installed and failed: <q>{html.escape(gap['reason'])}</q>."
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
