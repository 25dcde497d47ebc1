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
    if abs(value) >= 1e6 or abs(value) < 1e-3:
        mantissa, exponent = f"{value:.{max(0, digits - 2)}e}".split("e")
        return f"{mantissa}·10<sup>{int(exponent)}</sup>".replace("-", "−")
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


def table(head, rows, caption=""):
    lines = ["<div class='table'><table>"]
    if caption:
        lines.append(f"<caption>{caption}</caption>")
    lines.append("<thead><tr>" + "".join(f"<th>{cell}</th>" for cell in head) + "</tr></thead><tbody>")
    for cells, is_shipped in rows:
        mark = ' class="shipped"' if is_shipped else ""
        lines.append(f"<tr{mark}>" + "".join(f"<td>{cell}</td>" for cell in cells) + "</tr>")
    lines.append("</tbody></table></div>")
    return "\n".join(lines)


# Of the medians; quartiles of so few runs may part by chance.
_LEAST_DIFFERENCE = 1.02


def is_slower(a, b):
    """Whether times `a` are beyond the noise above `b`: their quartiles do not meet, and the medians are 2 % apart."""
    return a["lower_quartile"] > b["upper_quartile"] and a["median"] > _LEAST_DIFFERENCE * b["median"]


def time_ratio(row, own, other, key="time_ratio"):
    """Of each turn the one time over the other, as quartiles; without such, the least that the times' quartiles say."""
    if key in row:
        return row[key]
    a, b = row[own], row[other]
    return {
        "median": a["median"] / b["median"],
        "lower_quartile": a["lower_quartile"] / b["upper_quartile"],
        "upper_quartile": a["upper_quartile"] / b["lower_quartile"],
    }


def pareto_front(points):
    """Indices of the (cost, error) pairs that no other is at least as good as in both, by rising cost."""
    front = []
    least = math.inf
    for index in sorted(range(len(points)), key=lambda i: points[i]):
        if points[index][1] < least:
            front.append(index)
            least = points[index][1]
    return front


def noise_percent(times):
    """Half the quartiles' distance over the median, in percent."""
    return 50.0 * (times["upper_quartile"] - times["lower_quartile"]) / times["median"] if times["median"] else 0.0


def join(words):
    """ "a, b and c" """
    words = list(words)
    return words[0] if len(words) == 1 else ", ".join(words[:-1]) + " and " + words[-1] if words else "none"
