#!/usr/bin/env python3
# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""csv_files.py FOLDER: FOLDER/report.json as CSV files, one for each table, and where FOLDER/runs.json is each timed
run as runs.csv.

A line for each row, with what it stands under: device, driver, compiler, commit and date as well. What a row lacks is
empty."""

import csv
import pathlib
import sys

from report_file import read_report, read_runs, tables


def _flatten(row, prefix=""):
    """Of objects in it as "ns_per_test.median"."""
    for key, value in row.items():
        if isinstance(value, dict):
            yield from _flatten(value, f"{prefix}{key}.")
        else:
            yield prefix + key, value


def _write(file, lines, columns=None):
    columns = columns or list(dict.fromkeys(column for line in lines for column in line))
    with open(file, "w", encoding="utf-8", newline="") as text:
        writer = csv.DictWriter(text, columns)
        writer.writeheader()
        writer.writerows(lines)


def main():
    if len(sys.argv) != 2:
        sys.exit("csv_files.py FOLDER")
    folder = pathlib.Path(sys.argv[1])
    report = read_report(folder / "report.json")
    under = {key: report["provenance"][key] for key in ("device", "driver", "compiler", "commit", "date", "cpu")}
    for name, rows in tables(report):
        _write(folder / f"{name}.csv", [{**dict(_flatten(row)), **under} for row in rows])
    if (folder / "runs.json").exists():
        columns = ("table", "id", "figure", "run", "value")
        runs = read_runs(folder / "runs.json").items()
        lines = [(*key, run, value) for key, values in runs for run, value in enumerate(values, 1)]
        _write(folder / "runs.csv", [dict(zip(columns, line)) for line in lines], columns)


if __name__ == "__main__":
    main()
