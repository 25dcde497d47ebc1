# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Formats numbers and tables for people."""


def number(value, digits=3):
    """Returns the figure as text, and an en dash for a figure that was not measured."""
    if value is None:
        return "–"
    if isinstance(value, str):
        return value
    if value == 0:
        return "0"
    if abs(value) >= 1e5 or abs(value) < 1e-3:
        mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
        mantissa = f"{float(mantissa):g}"
        power = f"10^{int(exponent)}"
        return (power if float(mantissa) == 1 else f"{mantissa}·{power}").replace("-", "−")
    if abs(value) >= 100:
        return f"{value:,.0f}"
    return f"{value:.{digits}g}"


def spread(times):
    """Returns the median with the quartiles."""
    if not times:
        return "–"
    low, high = times["lower_quartile"], times["upper_quartile"]
    return f'{number(times["median"])} ({number(low)}…{number(high)})'


def interval(ratio):
    """Returns the median with its interval."""
    if not ratio:
        return "–"
    low, high = ratio["interval_lower"], ratio["interval_upper"]
    return f'{number(ratio["median"])} [{number(low)}…{number(high)}]'


def markdown_table(columns, rows):
    """Returns a Markdown table. A column is its head and a function that makes a cell from a row."""
    lines = [[head for head, _ in columns], *([make(row) for _, make in columns] for row in rows)]
    lines = ["| " + " | ".join(str(cell).replace("|", "\\|") for cell in cells) + " |" for cells in lines]
    return "\n".join([lines[0], "|" + "---|" * len(columns), *lines[1:]]) + "\n"


def gap_text(gaps):
    """Returns sentences that name what was not measured, with the reason if it is installed."""
    absent = [gap["name"] for gap in gaps if not gap["is_installed"]]
    parts = [f"Not measured, because not installed: {join(absent)}."] if absent else []
    parts += [f"Not measured: {gap['name']}, which failed: {gap['reason']}" for gap in gaps if gap["is_installed"]]
    return " ".join(parts)


def join(words):
    """Returns the words as a list like "a, b and c"."""
    words = list(words)
    return words[0] if len(words) == 1 else ", ".join(words[:-1]) + " and " + words[-1] if words else "none"
