# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Files of runs and of reports: one format (report.schema.json), read and written here alone."""

import json
import os
import sys

# As tools/reporting/provenance.h has it.
_FORMAT = 3


def _refuse(constant):
    raise ValueError(f"{constant} is no number of JSON")


def read_report(file):
    """Ends the program with a sentence where that is none."""
    try:
        report = json.loads(file.read_text(encoding="utf-8"), parse_constant=_refuse)
        if report["format"] == _FORMAT:
            return report
        problem = f"is no report of format {_FORMAT}; measure it anew"
    except (OSError, ValueError, KeyError, TypeError) as error:
        problem = f"cannot be read as a report: {error}"
    sys.exit(f"{os.path.basename(sys.argv[0])}: error: {file} {problem}")


def _text(value):
    return json.dumps(value, ensure_ascii=False, separators=(",", ":"), allow_nan=False)


def _section_text(section):
    """An array of rows with a line each."""
    parts = []
    for key, value in section.items():
        is_table = isinstance(value, list) and value
        rows = "[\n" + ",\n".join(map(_text, value)) + "]" if is_table else _text(value)
        parts.append(f"{_text(key)}:{rows}")
    return "{" + ",\n".join(parts) + "}"


def write_report(report, file):
    """Whole or not at all."""
    parts = [
        f"{_text(key)}:{_section_text(value) if isinstance(value, dict) else _text(value)}"
        for key, value in report.items()
    ]
    replace(file, "{" + ",\n".join(parts) + "}\n")


def replace(file, text):
    temporary = file.with_name(f".{file.name}.{os.getpid()}")
    temporary.write_text(text, encoding="utf-8")
    temporary.replace(file)


def tables(report):
    """(name, rows) of each: "frames", "frames_errors"."""
    for section, content in report.items():
        for key, rows in content.items() if isinstance(content, dict) else ():
            if isinstance(rows, list) and rows and "id" in rows[0]:
                yield section if key == "rows" else f"{section}_{key}", rows


def read_runs(file):
    """Of runs.json, {(table, id, figure): the values of each run}."""
    values = {}
    for table, rows in tables(read_report(file)):
        for row in rows:
            for figure, value in row.items():
                value = value["few"] if isinstance(value, dict) else value
                if isinstance(value, list):
                    values[table, row["id"], figure] = value
    return values
