#!/usr/bin/env python3
# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Holds a report against report.schema.json and rules that any report of a sound promin keeps; needs nothing beyond
Python's own library. check_report.py REPORT.json prints what is wrong, a line each; exit code 1 if anything is."""

import json
import math
import pathlib
import statistics
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

from figures import pareto_front

# Bounds of docs/accuracy.md and of tests/oracle (compare_picture.h).
_BOUND_K = 8
_BOUND_COLOR_MEAN = 1e-4
_BOUND_IDS = 0.0005

_TYPES = {
    "object": dict,
    "array": list,
    "string": str,
    "boolean": bool,
    "integer": int,
    "number": (int, float),
}


def find_schema_faults(value, schema, root, place="report"):
    """What a value lacks by the words of JSON Schema that report.schema.json uses."""
    if "$ref" in schema:
        schema = root["definitions"][schema["$ref"].rsplit("/", 1)[1]]
    faults = []
    wanted = schema.get("type")
    # A boolean is a number to Python.
    if wanted and (not isinstance(value, _TYPES[wanted]) or (isinstance(value, bool) and wanted != "boolean")):
        return [f"{place} is no {wanted}: {value!r}"[:200]]
    if "enum" in schema and value not in schema["enum"]:
        faults.append(f"{place} is {value!r}, none of {schema['enum']}")
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        if (
            not math.isfinite(value)
            or value < schema.get("minimum", -math.inf)
            or value > schema.get("maximum", math.inf)
        ):
            faults.append(f"{place} is out of range: {value}")
    if isinstance(value, str) and len(value) < schema.get("minLength", 0):
        faults.append(f"{place} is too short: {value!r}")
    if isinstance(value, dict):
        faults += [f"{place} has no {key}" for key in schema.get("required", ()) if key not in value]
        for key, part in schema.get("properties", {}).items():
            if key in value:
                faults += find_schema_faults(value[key], part, root, f"{place}.{key}")
    if isinstance(value, list) and "items" in schema:
        for index, item in enumerate(value):
            faults += find_schema_faults(item, schema["items"], root, f"{place}[{index}]")
    return faults


def _times_in(value, place=""):
    if isinstance(value, dict) and "median" in value:
        yield place, value
    elif isinstance(value, dict):
        for key, part in value.items():
            yield from _times_in(part, f"{place}.{key}")
    elif isinstance(value, list):
        for part in value:
            yield from _times_in(part, f"{place}[{part.get('id', '?')}]" if isinstance(part, dict) else place)


def _find_time_faults(report):
    for place, times in _times_in(report):
        if not 0 < times["lower_quartile"] <= times["median"] <= times["upper_quartile"]:
            yield f"{place}: quartiles out of order: {times}"
        if times["runs"] != report["provenance"]["runs"] and "compile" not in place:
            yield f"{place}: of {times['runs']} runs"
    if report["provenance"]["runs"] < 20 and not report["provenance"]["is_quick"]:
        yield f"{report['provenance']['runs']} runs are fewer than the 20 of a full report"


def _find_kernel_faults(report):
    # K may double where division and square root are not rounded correctly.
    bound = _BOUND_K if report["provenance"]["device_type"] == "CPU" else 2 * _BOUND_K
    rows = report["kernels"]["rows"]
    shipped = [row for row in rows if row["is_shipped"]]
    if sorted(row["primitive"] for row in shipped) != ["cone", "cylinder", "plane", "sphere", "triangle"]:
        yield "kernels: not each primitive has one shipped method"
    for row in shipped + [row for row in report["kernels"]["range"] if row.get("is_shipped")]:
        # A row without K is of a method that hits nothing.
        if not row.get("max_k", math.inf) <= bound:
            yield f"{row['id']}: K of {row.get('max_k', 'no hit')} is beyond {bound}"
        if row.get("leaks"):
            yield f"{row['id']}: {row['leaks']} leaks"
    for row in report["boxes"]["rows"]:
        if row["is_shipped"] and row["leaks"]:
            yield f"{row['id']}: {row['leaks']} boxes hidden"
    # What is compared with must be what it is called.
    if not all(row.get("max_k", 0) > bound for row in rows if row["id"] in ("sphere/textbook", "cylinder/textbook")):
        yield "the textbook's quadratics are as exact as the shipped ones: they are not what was measured"
    if not any(row["leaks"] for row in rows if row["id"] == "triangle/textbook"):
        yield "Möller and Trumbore's triangles do not leak: they are not what was measured"
    if not any(row["leaks"] for row in report["boxes"]["rows"] if row["method"] == "full unpadded"):
        yield "unpadded boxes hide nothing: they are not what was measured"


def _find_frame_faults(report):
    rows = report["frames"]["rows"]
    for scene in {row["scene"] for row in rows}:
        of_scene = [row for row in rows if row["scene"] == scene]
        defaults = [row for row in of_scene if row["is_default"]]
        if len(defaults) != 1:
            yield f"{scene}: {len(defaults)} defaults"
            continue
        default = defaults[0]
        points = [(row["ms"]["median"], row["rmse"]) for row in of_scene]
        # What the page draws: these hold for any figures, and fail where pareto_front does.
        front = [points[i] for i in pareto_front(points)]
        if any(not (a[0] <= b[0] and a[1] > b[1]) for a, b in zip(front, front[1:])):
            yield f"{scene}: the Pareto front is not monotone: {front}"
        if any(p[0] < f[0] and p[1] <= f[1] for p in points for f in front):
            yield f"{scene}: a point lies beyond the Pareto front"
        for row in of_scene:
            if row["knob"] in ("builder", "boxes") and row["rmse"] != default["rmse"]:
                yield f"{row['id']}: another picture than the default's, where the bits should be the same"
        samples = [row for row in of_scene if row["knob"] == "samples"]
        if not min(row["rmse"] for row in samples) < default["rmse"]:
            yield f"{scene}: more samples do not lessen the error"
    for row in report["frames"]["errors"]:
        if row["error"] != "precision" or row["method"] not in ("promin", "full boxes"):
            continue
        if row["mean_absolute"] > _BOUND_COLOR_MEAN or row["non_finite_pixels"]:
            yield f"{row['id']}: {row['mean_absolute']} is beyond {_BOUND_COLOR_MEAN}, or pixels are not finite"
        if row["id_mismatches"] > max(1, _BOUND_IDS * row["pixels"]):
            yield f"{row['id']}: {row['id_mismatches']} other ids of {row['pixels']}"


def _find_other_faults(report):
    for row in report["specialisation"]["rows"]:
        if not row["is_bit_identical"]:
            yield f"specialisation {row['id']}: another picture than with all features"
    edges = [row for row in report["robustness"]["rows"] if row["rays"] == "edges"]
    for row in edges:
        # From inside of a closed mesh at its edges: each ray hits.
        if row["invented"]:
            yield f"{row['id']}: promin loses {row['invented']} rays at edges of a closed mesh"
    if edges and not any(row["lost"] for row in edges):
        yield "robustness: the textbook's kernel loses no ray at edges: it is not what was measured"
    for fit in report["scaling"]["fits"]:
        if not fit["lower"] <= fit["exponent"] <= fit["upper"]:
            yield f"{fit['id']}: the exponent is not in its interval"
        yield from _find_fit_faults(report, fit)
    peers = " ".join(row["peer"] for row in report["peers"]["rows"])
    for name in ("Embree", "Tachyon", "POV-Ray"):
        if (name in peers) == (name in report["peers"]["not_measured"]):
            yield f"peers: {name} is neither measured nor a gap, or both"


def _find_twins(report):
    """Rows are compared and drawn by their ids: of two scenes of one name they would be mixed up."""
    for section in report.values():
        for rows in section.values() if isinstance(section, dict) else []:
            ids = [row["id"] for row in rows if isinstance(row, dict) and "id" in row] if isinstance(rows, list) else []
            for twin in sorted({i for i in ids if ids.count(i) > 1}):
                yield f"{twin}: there is more than one"


def _find_fit_faults(report, fit):
    """The exponent once more, from the rows."""
    *path, figure = fit["id"].split("/")
    variable, curve = path[0], path[1] if len(path) > 1 else "picture"
    points = []
    for row in report["scaling"]["rows"]:
        if row["variable"] == variable and row["curve"] == curve and row["value"] > 0:
            value = row[figure]
            points.append((math.log(row["value"]), math.log(value["median"] if isinstance(value, dict) else value)))
    slope = statistics.linear_regression(*zip(*points)).slope
    if abs(slope - fit["exponent"]) > 1e-9 or len(points) != fit["points"]:
        yield f"{fit['id']}: the exponent is {slope} by these rows, not {fit['exponent']}"
    if figure == "node_steps_per_ray" and not fit["exponent"] < 0.5:
        yield f"{fit['id']}: steps grow as n^{fit['exponent']}"


def find_faults(report):
    """All that is wrong, a sentence each."""
    schema = json.loads((pathlib.Path(__file__).parent / "report.schema.json").read_text(encoding="utf-8"))
    faults = find_schema_faults(report, schema, schema)
    if faults:
        return faults
    rules = (_find_time_faults, _find_kernel_faults, _find_frame_faults, _find_other_faults, _find_twins)
    return [fault for rule in rules for fault in rule(report)]


def main():
    if len(sys.argv) != 2:
        sys.exit("check_report.py REPORT.json")
    faults = find_faults(json.loads(pathlib.Path(sys.argv[1]).read_text(encoding="utf-8")))
    print("\n".join(faults) or "sound")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
