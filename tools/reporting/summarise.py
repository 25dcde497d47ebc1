#!/usr/bin/env python3
# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""summarise.py FOLDER: what the runs in FOLDER/runs.json come to, as FOLDER/report.json.

Of each array of runs it tells median, quartiles and interval; and of rows together which lie on a Pareto front, how
they grow, and rates. A row is a line of the file."""

import pathlib
import sys

from report_file import read_report, write_report
from stats import figures_of_few, figures_of_times, find_front, fit_doublings, fit_power, mrays_per_s, rounded


def _summarise(value):
    """Runs become figures, wherever they are."""
    if isinstance(value, list) and value and isinstance(value[0], (int, float)):
        return figures_of_times(value)
    if isinstance(value, list):
        return [_summarise(part) for part in value]
    if isinstance(value, dict):
        return figures_of_few(value["few"]) if "few" in value else {k: _summarise(part) for k, part in value.items()}
    return rounded(value) if isinstance(value, float) else value


def _mark_fronts(rows, group, times, error, mark):
    """Of the rows that have the error, in each group."""
    rows = [row for row in rows if error in row]
    for name in {row[group] for row in rows}:
        of_group = [row for row in rows if row[group] == name]
        for row, is_on_front in zip(of_group, find_front([(row[times]["median"], row[error]) for row in of_group])):
            row[mark] = is_on_front


def _curves(rows):
    """(id, points) of each figure that may grow with a variable."""
    for variable, curve in dict.fromkeys((row["variable"], row["curve"]) for row in rows):
        of_curve = [row for row in rows if (row["variable"], row["curve"]) == (variable, curve) and row["value"] > 0]
        for figure in ("ns_per_ray", "node_steps_per_ray", "build_ms", "device_bytes", "ms"):
            values = [row[figure] for row in of_curve if figure in row]
            if len(values) >= 3:
                values = [value["median"] if isinstance(value, dict) else value for value in values]
                name = f"{variable}/{figure}" if curve == "picture" else f"{variable}/{curve}/{figure}"
                yield name, [row["value"] for row in of_curve], values


def _fit(name, xs, ys):
    steps = fit_doublings(xs, ys) if name.endswith("node_steps_per_ray") else {}
    return {"id": name, **fit_power(xs, ys), **steps}


def summarise(runs):
    """The report of these runs."""
    report = {key: _summarise(value) for key, value in runs.items()}
    rows_of = lambda section: report.get(section, {}).get("rows", [])  # noqa: E731
    _mark_fronts(rows_of("kernels"), "primitive", "ns_per_test", "max_k", "is_on_front")
    _mark_fronts(rows_of("frames"), "scene", "ms", "rmse", "is_on_front")
    _mark_fronts(rows_of("frames"), "scene", "ms", "flip", "is_on_flip_front")
    for row in rows_of("robustness"):
        for kernel in ("robust", "plain"):
            row[f"{kernel}_mrays_per_s"] = mrays_per_s(row["count"], row[f"{kernel}_ms"])
    for row in rows_of("rates"):
        for who in ("promin", "peer", "peer_packets"):
            if f"{who}_ms" in row:
                row[f"{who}_mrays_per_s"] = mrays_per_s(row["count"], row[f"{who}_ms"])
    if "scaling" in report:
        report["scaling"]["fits"] = [_fit(*curve) for curve in _curves(rows_of("scaling"))]
    return report


def main():
    if len(sys.argv) != 2:
        sys.exit("summarise.py FOLDER")
    folder = pathlib.Path(sys.argv[1])
    write_report(summarise(read_report(folder / "runs.json")), folder / "report.json")


if __name__ == "__main__":
    main()
