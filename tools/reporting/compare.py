# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""What changed between two reports beyond noise.

Rows are the same by section, table and id. A time or ratio of times has changed where stats.judge says so; any other
number where it differs by more than a hundred-thousandth: errors and counts are the same in every run on one device."""

import html

from figures import number, plain, section, table
from report_file import tables
from stats import judge, ratio_of_few, ratio_of_reports

_SAME = 1e-5


def _ratio(new, old):
    """Of two times; none of anything else."""
    if not isinstance(new, dict) or not isinstance(old, dict):
        return None
    if "interval_lower" in new and "interval_lower" in old:
        return ratio_of_reports(new, old)
    return ratio_of_few(new, old) if "least" in new and "least" in old else None


def _rows_by_id(report):
    return {name.replace("_", " "): {row["id"]: row for row in rows} for name, rows in tables(report)}


def _changed_number(key, old, new):
    # What is made of times says nothing by itself.
    if key.endswith("_per_s") or key.startswith("is_on_") or key in ("exponent", "lower", "upper"):
        return False
    if isinstance(old, bool) or isinstance(new, bool):
        return old != new
    return abs(new - old) > _SAME * max(abs(old), abs(new))


def find_changes(old, new):
    """(table, id, figure, old, new) of what changed; then ids that only one of them has, and how many times both
    have."""
    changes, lonely, compared = [], [], 0
    old_tables = _rows_by_id(old)
    for name, rows in _rows_by_id(new).items():
        others = old_tables.pop(name, {})
        lonely += [f"{name} {key} (only in the new)" for key in rows.keys() - others.keys()]
        lonely += [f"{name} {key} (only in the old)" for key in others.keys() - rows.keys()]
        for key, row in rows.items():
            for figure, value in row.items():
                before = others.get(key, {}).get(figure)
                if before is None:
                    continue
                ratio = _ratio(value, before)
                if ratio:
                    compared += 1
                    if judge(ratio):
                        changes.append((name, key, figure, before["median"], value["median"]))
                elif isinstance(value, (int, float)) and isinstance(before, (int, float)):
                    if _changed_number(figure, before, value):
                        changes.append((name, key, figure, before, value))
    lonely += [f"{name} (only in the old)" for name in old_tables]
    return changes, sorted(lonely), compared


def _circumstances(old, new):
    """Sentences on what else is different."""
    a, b = old["provenance"], new["provenance"]
    keys = ("device", "driver", "compiler", "cpu", "threads", "runs", "is_quick")
    other = [
        f"{key} ({html.escape(str(a.get(key)))} then, {html.escape(str(b.get(key)))} now)"
        for key in keys
        if a.get(key) != b.get(key)
    ]
    text = f"Against {html.escape(a['commit'])} of {html.escape(a['date'])}."
    return text + (
        " Not alike: " + "; ".join(other) + "." if other else " Device, driver, compiler and runs are alike."
    )


def compare(old, new):
    """The page's section."""
    changes, lonely, compared = find_changes(old, new)
    times = [c for c in changes if _is_time_name(c[2])]
    text = [_circumstances(old, new)]
    if changes:
        faster = sum(after < before for *_, before, after in times)
        text.append(
            f"Beyond noise {len(changes)} figures changed: of {compared} times and ratios {faster} are shorter and "
            f"{len(times) - faster} longer (the 95 % intervals of their medians do not meet, and the medians are 2 % "
            f"apart or more); {len(changes) - len(times)} are errors, counts and sizes."
        )
    else:
        text.append(f"Nothing changed beyond noise; {compared} times and ratios were compared.")
    if lonely:
        text.append(
            f"In one of the two alone: {html.escape('; '.join(lonely[:20]))}"
            + (", and more." if len(lonely) > 20 else ".")
        )
    columns = [
        ("section", lambda change: change[0]),
        ("row", lambda change: html.escape(change[1])),
        ("figure", lambda change: change[2]),
        ("then", lambda change: number(change[3])),
        ("now", lambda change: number(change[4])),
        ("ratio", lambda change: f"{change[4] / change[3]:.2f}" if change[3] else "–"),
    ]
    return section("What changed", text, table(columns, changes) if changes else "")


def _is_time_name(figure):
    return figure.endswith("ms") or "_ms" in figure or "time" in figure or figure.startswith("ns_")


def summary(old, new):
    """One line for the terminal, and one for each change, the largest first."""
    changes, _, _ = find_changes(old, new)
    if not changes:
        return "nothing changed beyond noise"
    size = lambda change: abs(change[4] - change[3]) / max(abs(change[3]), 1e-300)  # noqa: E731
    lines = [f"{len(changes)} figures changed beyond noise; the largest:"]
    for name, key, figure, before, after in sorted(changes, key=size, reverse=True)[:10]:
        lines.append(f"  {name} {key}, {figure}: {plain(before)} then, {plain(after)} now")
    return "\n".join(lines)
