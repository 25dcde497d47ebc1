#!/usr/bin/env python3
# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Holds a report against report.schema.json and rules that any report of a sound promin keeps; computes nothing by what
made the report. check_report.py REPORT.json prints what is wrong, a line each; exit code 1 if anything is. Where
runs.json and report.html lie beside it, the figures are held against the single runs, and what the page claims of the
default against the figures. Schemas are read by Debian's python3-jsonschema."""

import html.parser
import json
import math
import pathlib
import re
import statistics
import sys

import jsonschema

from report_file import read_report, read_runs, tables

# Bounds of docs/accuracy.md and of tests/oracle (compare_picture.h).
_BOUND_K = 8
_BOUND_COLOR_MEAN = 1e-4
_BOUND_IDS = 0.0005
_BOUND_MARGIN = 2

_CONFIDENCE = 0.95
# A setting is ahead of another where it takes less than this of its time.
_FASTER = 1 / 1.02


def _find_schema_faults(report):
    schema = json.loads((pathlib.Path(__file__).parent / "report.schema.json").read_text(encoding="utf-8"))
    for error in jsonschema.Draft7Validator(schema).iter_errors(report):
        yield f"{error.json_path}: {error.message}"[:300]
    try:
        json.dumps(report, allow_nan=False)
    except ValueError:
        yield "a number is not finite"


def _times_in(value, place=""):
    if isinstance(value, dict) and "median" in value:
        yield place, value
    elif isinstance(value, dict):
        for key, part in value.items():
            yield from _times_in(part, f"{place}.{key}")
    elif isinstance(value, list):
        for part in value:
            yield from _times_in(part, f"{place}[{part.get('id', '?')}]" if isinstance(part, dict) else place)


def _interval_rank(count):
    """(k, confidence): the median is between the k-th least and the k-th largest of so many values that often."""
    best = (1, 1 - 2 / 2**count)
    for k in range(1, (count + 1) // 2 + 1):
        confidence = 1 - 2 * sum(math.comb(count, i) for i in range(k)) / 2**count
        if confidence >= _CONFIDENCE:
            best = (k, confidence)
    return best


def _find_time_faults(report):
    runs = report["provenance"]["runs"]
    for place, times in _times_in(report):
        if "least" in times:
            if not 0 < times["least"] <= times["median"] <= times["most"] or times["runs"] > runs:
                yield f"{place}: least, median and most out of order, or too many runs: {times}"
            continue
        # What mirrors add is a difference of times, which noise may take below 0 (report.schema.json, differences).
        bound = -math.inf if "/mirror stage]" in place else 0
        if not bound < times["lower_quartile"] <= times["median"] <= times["upper_quartile"]:
            yield f"{place}: quartiles out of order: {times}"
        if not bound < times["interval_lower"] <= times["median"] <= times["interval_upper"]:
            yield f"{place}: the median is not in its interval: {times}"
        if times["runs"] != runs:
            yield f"{place}: of {times['runs']} runs"
        if abs(times["confidence"] - max(0, _interval_rank(times["runs"])[1])) > 1e-9:
            yield f"{place}: {times['runs']} runs give no interval of {times['confidence']}"
    if runs < 20 and not report["provenance"]["is_quick"]:
        yield f"{runs} runs are fewer than the 20 of a full report"


def _find_front_faults(rows, times, error, mark):
    """Marks of a Pareto front against all that was measured."""
    points = [(row[times]["median"], row[error], row[mark], row["id"]) for row in rows if error in row and mark in row]
    if any((error in row) != (mark in row) for row in rows):
        yield f"{rows[0]['id']}: {mark} is not there where {error} is, or the other way round"
    for time, wrong, is_marked, name in points:
        ahead = [p for p in points if p[0] <= time and p[1] <= wrong and (p[0] < time or p[1] < wrong)]
        if is_marked and ahead:
            yield f"{name}: marked as on the front ({mark}), but {ahead[0][3]} is ahead of it"
        if not is_marked and not ahead:
            yield f"{name}: nothing is ahead of it, and it is not marked as on the front ({mark})"
    front = sorted(set(p[:2] for p in points if p[2]))
    if not front:
        yield f"{rows[0]['id']}: there is no front ({mark})"
    if any(not a[1] > b[1] for a, b in zip(front, front[1:])):
        yield f"{rows[0]['id']}: the front is not monotone ({mark}): {front}"


def primitive_names():
    """Those of promin's own table, in its order."""
    table = pathlib.Path(__file__).resolve().parents[2] / "include" / "promin" / "kinds" / "primitives.def"
    return re.findall(r"^PROMIN_\w+\(\w+, \w+, (\w+), \d", table.read_text(encoding="utf-8"), re.MULTILINE)


def _find_kernel_faults(report):
    # K may double where division and square root are not rounded correctly.
    bound = _BOUND_K if report["provenance"]["device_type"] == "CPU" else 2 * _BOUND_K
    rows = report["kernels"]["rows"]
    shipped = [row for row in rows if row["is_shipped"]]
    # Older reports have fewer of them.
    names = {row["primitive"] for row in rows}
    if not names or not names <= set(primitive_names()):
        yield f"kernels: not primitives of promin: {sorted(names)}"
    if sorted(row["primitive"] for row in shipped) != sorted(names):
        yield "kernels: not each primitive has one shipped method"
    for row in shipped + [row for row in report["kernels"]["range"] if row.get("is_shipped")]:
        # A row without K is of a method that hits nothing.
        if not row.get("max_k", math.inf) <= bound:
            yield f"{row['id']}: K of {row.get('max_k', 'no hit')} is beyond {bound}"
        if row.get("leaks"):
            yield f"{row['id']}: {row['leaks']} leaks"
    for primitive in {row["primitive"] for row in rows}:
        of_primitive = [row for row in rows if row["primitive"] == primitive]
        yield from _find_front_faults(of_primitive, "ns_per_test", "max_k", "is_on_front")
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
        yield from _find_front_faults(of_scene, "ms", "rmse", "is_on_front")
        if "flip" in default:
            yield from _find_front_faults(of_scene, "ms", "flip", "is_on_flip_front")
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


def _find_rate_faults(report):
    for row in report["rates"]["rows"]:
        if not row.get("differing_hits", 0) + row.get("hits", 0) <= 2 * row["count"]:
            yield f"{row['id']}: more hits than rays"
        for who in ("promin", "peer", "peer_packets"):
            times = row.get(f"{who}_ms")
            rate = row.get(f"{who}_mrays_per_s", math.nan)
            if times and not math.isclose(rate * 1e3 * times["median"], row["count"], rel_tol=1e-5):
                yield f"{row['id']}: {rate} Mrays/s are not {row['count']} rays in {times['median']} ms"


def _find_picture_faults(report):
    """Rays of a picture that were found by its rules are, but for grazing ones, those that it traces."""
    for row in report["rates"].get("pictures", []):
        if abs(row["count"] - row["traced_rays"]) > max(3, 2e-3 * row["traced_rays"]):
            yield f"{row['id']}: {row['count']} rays stand for the {row['traced_rays']} of the picture"
        rays = [r["count"] for r in report["rates"]["picture_rays"] if r["scene"] == row["scene"]]
        if row["what"] == "picture" and sum(rays) != row["count"]:
            yield f"{row['id']}: its sets of rays do not add up to {row['count']}"


def _find_other_faults(report):
    for row in report["specialisation"]["rows"]:
        if not row["is_bit_identical"]:
            yield f"specialisation {row['id']}: another picture than with all features"
    rows = report["robustness"]["rows"]
    edges = [row for row in rows if row["rays"] == "edges"]
    # Divisions may be off by more elsewhere, as K.
    bound = _BOUND_MARGIN if report["provenance"]["device_type"] == "CPU" else 2 * _BOUND_MARGIN
    for row in rows:
        if row["judged"] > row["count"] or (row["rays"] == "edges") != (row["truth"] == "each hits"):
            yield f"{row['id']}: {row['judged']} of {row['count']} rays judged, by '{row['truth']}'"
        if "only_promin_hits" in row and row["only_promin_hits"] + row["only_textbook_hits"] != row["differing"]:
            yield f"{row['id']}: {row['differing']} rays differ, but not by what either alone hits"
        # From inside of a closed mesh each ray hits.
        if row["truth"] == "each hits" and (row["promin_lost"] or row["judged"] != row["count"]):
            yield f"{row['id']}: promin loses {row['promin_lost']} of {row['judged']} rays at edges of a closed mesh"
        if row["truth"] == "oracle" and not row.get("promin_worst_margin", math.inf) <= bound:
            yield f"{row['id']}: promin is wrong of a ray further than {bound} u S from any silhouette"
    if edges and not any(row["textbook_lost"] for row in edges):
        yield "robustness: the textbook's kernel loses no ray at edges: it is not what was measured"
    for fit in report["scaling"]["fits"]:
        if not fit["lower"] <= fit["exponent"] <= fit["upper"]:
            yield f"{fit['id']}: the exponent is not in its interval"
        yield from _find_fit_faults(report, fit)
    for section, names in (("rates", ["Embree"]), ("peers", ["Tachyon", "POV-Ray"])):
        peers = " ".join(row.get("peer", "") for row in report[section]["rows"])
        gaps = [gap["name"] for gap in report[section]["gaps"]]
        for name in names:
            if (name in peers) == (name in gaps):
                yield f"{section}: {name} is neither measured nor a gap, or both"
    has_flip = all("flip" in row for row in report["frames"]["rows"])
    if len(report["frames"]["gaps"]) != (0 if has_flip else 1):
        yield "frames: FLIP is neither measured nor one gap, or both"
    for gap in report["rates"]["gaps"] + report["peers"]["gaps"] + report["frames"]["gaps"]:
        if gap["is_installed"] != (gap["reason"] != "not installed"):
            yield f"{gap['name']}: installed or not? {gap}"


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


def find_run_faults(report, runs):
    """Medians, intervals and ratios once more, from the single runs as read_runs gives them."""
    is_near = lambda a, b: math.isclose(a, b, rel_tol=1e-5)  # noqa: E731
    for table, rows in tables(report):
        for row in rows:
            for figure, times in row.items():
                if not isinstance(times, dict) or "median" not in times:
                    continue
                values = sorted(runs.get((table, row["id"], figure), []))
                if len(values) != times["runs"] or not is_near(statistics.median(values), times["median"]):
                    yield f"{table} {row['id']}, {figure}: the runs give another median than {times['median']}"
                elif "interval_lower" in times:
                    k = _interval_rank(len(values))[0]
                    ends = times["interval_lower"], times["interval_upper"]
                    if not (is_near(values[k - 1], ends[0]) and is_near(values[-k], ends[1])):
                        yield f"{table} {row['id']}, {figure}: the runs give another interval than {ends}"
    rows = report["frames"]["rows"]
    for row in rows:
        default = next(r for r in rows if r["is_default"] and r["scene"] == row["scene"])
        own, other = (runs.get(("frames", r["id"], "ms"), []) for r in (row, default))
        ratio = statistics.median(a / b for a, b in zip(own, other)) if own and other else math.nan
        if not is_near(ratio, row["time_ratio"]["median"]):
            yield f"{row['id']}: {ratio} of the default's time in the same turns, not {row['time_ratio']['median']}"


class _ClaimReader(html.parser.HTMLParser):
    """The page's <script id="claims">."""

    def __init__(self, page):
        super().__init__()
        self.text, self._is_inside = "", False
        self.feed(page)

    def handle_starttag(self, tag, attributes):
        self._is_inside = tag == "script" and ("id", "claims") in attributes

    def handle_data(self, data):
        self.text += data if self._is_inside else ""

    def handle_endtag(self, tag):
        self._is_inside = False


def read_claims(page):
    """What the page says in words, as the data that its sentences are made of."""
    return json.loads(_ClaimReader(page).text or "{}")


def find_claim_faults(report, claims):
    """Whether the page says of each scene's default that it lies on the front, or what is ahead and gives up what."""
    if (claims.get("is_quick"), claims.get("is_cpu")) != (
        report["provenance"]["is_quick"],
        report["provenance"]["device_type"] == "CPU",
    ):
        yield "the page says other than the report whether it is quick or of a CPU"
    rows = report["frames"]["rows"]
    for scene in {row["scene"] for row in rows}:
        claim = next((claim for claim in claims.get("fronts", []) if claim["scene"] == scene), None)
        if not claim:
            yield f"{scene}: the page says nothing of its default"
            continue
        default = next(row for row in rows if row["is_default"] and row["scene"] == scene)
        ahead = {}
        for row in rows:
            ratio = row["time_ratio"]
            is_sure = ratio["confidence"] >= _CONFIDENCE and ratio["interval_upper"] < 1
            if row["scene"] == scene and row["rmse"] <= default["rmse"] and is_sure and ratio["median"] < _FASTER:
                ahead[row["id"]] = ratio["median"]
        if {one["id"]: one["time_ratio"] for one in claim["ahead"]} != ahead:
            yield f"{scene}: {ahead or 'nothing'} is ahead of the default beyond noise, and the page says: {claim}"
        if claim["place"] != ("off" if ahead else "on" if default["is_on_front"] else "on within noise"):
            yield f"{scene}: the default's mark and the page are at odds: {claim}"
        for one in claim["ahead"]:
            if not all(loss["kind"] and loss["figure"] > 0 for loss in one["gives_up"]):
                yield f"{scene}: the page gives no reason why {one['id']} is not the default: {claim}"


def find_faults(report):
    """All that is wrong with the figures themselves, a sentence each."""
    faults = list(_find_schema_faults(report))
    if faults:
        return faults
    rules = (
        _find_time_faults,
        _find_kernel_faults,
        _find_frame_faults,
        _find_rate_faults,
        _find_picture_faults,
        _find_other_faults,
        _find_twins,
    )
    return [fault for rule in rules for fault in rule(report)]


def main():
    if len(sys.argv) != 2:
        sys.exit("check_report.py REPORT.json")
    file = pathlib.Path(sys.argv[1])
    runs, page = file.with_name("runs.json"), file.with_name("report.html")
    report = read_report(file)
    faults = find_faults(report)
    if not faults and runs.exists():
        faults += find_run_faults(report, read_runs(runs))
    if not faults and page.exists():
        faults += find_claim_faults(report, read_claims(page.read_text(encoding="utf-8")))
    print("\n".join(faults) or "sound")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
