#!/usr/bin/env python3
# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Reports as a user makes them, quick, and the checks of their figures.

report_test.py TEST BIN TOOLS SCENES: TEST is a function below, BIN the folder of the programs."""

import copy
import csv
import html.parser
import json
import math
import os
import pathlib
import random
import re
import shutil
import statistics
import subprocess
import sys
import tempfile

BIN, TOOLS, SCENES = map(pathlib.Path, sys.argv[2:5])
sys.path.insert(0, str(TOOLS / "reporting"))

import check_report
import compare
import front_text
from figures import beyond_noise_text, number
from report_file import read_report, read_runs, tables, write_report
from stats import (
    figures_of_few,
    figures_of_times,
    find_front,
    fit_doublings,
    fit_power,
    judge,
    median_interval,
    ratio_of_few,
    ratio_of_reports,
)


def expect(condition, what):
    if not condition:
        sys.exit(f"report_test.py: {what}")


def run_program(*words, environment=None):
    return subprocess.run(list(map(str, words)), capture_output=True, text=True, timeout=900, env=environment)


def run(*words, environment=None):
    return run_program(BIN / "promin-report", *words, environment=environment)


def has_lists_of_numbers(value):
    if isinstance(value, list) and any(isinstance(part, (int, float)) for part in value):
        return True
    parts = value.values() if isinstance(value, dict) else value if isinstance(value, list) else ()
    return any(has_lists_of_numbers(part) for part in parts)


def count_lines(file):
    with open(file, encoding="utf-8", newline="") as lines:
        return sum(1 for _ in csv.DictReader(lines))


def check_files(folder, report):
    """A line for each row; and CSV files of these lines, with what every figure stands under."""
    done = run_python("csv_files.py", folder)
    expect(done.returncode == 0, f"csv_files.py: {done.stderr}")
    for name in ("kernels", "boxes", "frames", "robustness", "specialisation", "scaling", "rates", "peers"):
        rows = report[name]["rows"]
        if rows:
            expect(count_lines(folder / f"{name}.csv") == len(rows), f"{name}.csv has other rows than report.json")
    expect(not has_lists_of_numbers(report), "report.json has the single runs")
    lines = (folder / "report.json").read_text(encoding="utf-8").count("\n")
    rows = sum(len(rows) for _, rows in tables(report))
    expect(lines < rows + 50, f"report.json has {lines} lines for {rows} rows")
    runs = read_runs(folder / "runs.json")
    expect(count_lines(folder / "runs.csv") == sum(map(len, runs.values())), "runs.csv has other runs than runs.json")
    faults = list(check_report.find_run_faults(report, runs))
    expect(not faults, "the single runs do not give the figures:\n" + "\n".join(faults[:10]))
    own = runs["frames", report["frames"]["rows"][1]["id"], "ms"]
    own[0], own[1] = 3 * own[0], 3 * own[1]
    expect(list(check_report.find_run_faults(report, runs)), "not noticed: other runs than the medians'")
    with open(folder / "frames.csv", encoding="utf-8", newline="") as lines:
        row = next(csv.DictReader(lines))
    for column in ("device", "driver", "compiler", "commit", "date", "cpu", "scene_hash", "ms.median", "ms.runs"):
        expect(row.get(column), f"frames.csv tells of no {column}")
    expect(not [f for f in folder.iterdir() if f.name.startswith(".")], "temporary files are left")
    for row in report["rates"]["rows"]:
        expect({"hits", "node_steps_per_ray", "primitive_tests_per_ray", "promin_ms"} <= row.keys(), f"lacking: {row}")
    expect({"nodes", "sah_cost", "promin_ms", "bvh_ms"} <= report["rates"]["builds"][0].keys(), "no build is measured")
    expect(report["peers"]["first"], f"the first picture is not measured: {report['peers']}")
    first = report["peers"]["first"][0]
    expect(0 < first["trace_ms"]["median"] < first["process_ms"]["median"], f"the first picture: {first}")
    cpus = {line.split(":", 1)[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")}
    expect(not cpus or any(report["provenance"]["cpu"].startswith(cpu) for cpu in cpus), "the CPU's model is another")


class SectionReader(html.parser.HTMLParser):
    """The page's sections, each as text outside of its tags by the tag; and how many tags of each kind it has."""

    def __init__(self, page):
        super().__init__()
        self.sections, self.tags = [], []
        self.feed(page)

    def handle_starttag(self, tag, attributes):
        if tag == "section":
            self.sections.append({})
        self.tags.append(tag)
        if self.sections:
            self.sections[-1].setdefault(tag, "")

    def handle_endtag(self, tag):
        while self.tags and self.tags.pop() != tag:
            pass

    def handle_data(self, data):
        for tag in self.tags if self.sections else ():
            self.sections[-1][tag] = self.sections[-1].get(tag, "") + data


def check_page(folder):
    page = (folder / "report.html").read_text(encoding="utf-8")
    expect(not re.search(r"(src|href)=['\"]?(http|//|file)", page), "the page needs other files")
    expect("quick report" in page, "the page does not say that it is quick")
    report = read_report(folder / "report.json")
    p = report["provenance"]
    expect(("a CPU driver" in page) == (p["device_type"] == "CPU"), "the page does not call a CPU driver one")
    expect(p["cpu"] in page, "the page does not name the CPU's model")
    claims = check_report.read_claims(page)
    faults = list(check_report.find_claim_faults(report, claims))
    expect(not faults, "the page is at odds with the figures:\n" + "\n".join(faults))
    for claim in claims["fronts"]:
        expect(front_text.front_sentence(claim) in page, f"claimed, but not said: {claim}")
    for said, otherwise in (
        ('"place":"on', '"place":"off'),
        ('id="claims"', 'id="other"'),
        ('quick":true', 'quick":false'),
    ):
        other = check_report.read_claims(page.replace(said, otherwise))
        expect(list(check_report.find_claim_faults(report, other)), f"not noticed: {otherwise} instead of {said}")
    primitives = list(dict.fromkeys(row["primitive"] for row in report["kernels"]["rows"]))
    expect(primitives == check_report.primitive_names() and "box" in primitives, f"other primitives: {primitives}")
    distances = [row["value"] for row in report["kernels"]["range"] if row["variable"] == "distance"]
    said = f"From a distance of {number(min(distances), 2)} to {number(max(distances), 2)} sizes"
    expect(said in page, f"the page does not say: {said}")
    expect(page.count("<svg") >= 20, "the page has too few plots")
    expect("<metadata" not in page and "<dc:date" not in page, "the plots carry metadata")
    expect(page.count("\n") < 1000, "the page has lines without need")
    expect((folder / "frames.png").stat().st_size > 10_000, "there is no picture of the main plot")
    for section in SectionReader(page).sections:
        said = section.get("p", "") + section.get("li", "")
        # Beside other renderers, where none is installed.
        is_gap = "Not measured" in said and "svg" not in section and "table" not in section
        expect(is_gap or any(map(str.isdigit, said)), f"a section's text has no figure: {section}"[:300])


GAP = {"name": "FLIP", "is_installed": True, "reason": "it failed"}
# What 20 runs have.
SURE = 0.9586


def check_that_faults_are_found(report):
    """Each way to spoil the report must be noticed."""

    def find(section, table, **wanted):
        return next(r for r in spoilt[section][table] if all(r.get(k) == v for k, v in wanted.items()))

    def spoil(change, what):
        nonlocal spoilt
        spoilt = copy.deepcopy(report)
        change()
        expect(check_report.find_faults(spoilt), f"not noticed: {what}")

    def take_below_zero(what):
        times = find("rates", "pictures", what=what)["promin_ms"]
        times.update(interval_lower=-1.0, lower_quartile=-0.5)

    spoilt = copy.deepcopy(report)
    take_below_zero("mirror stage")
    expect(not check_report.find_faults(spoilt), "a difference of times below 0 is taken for a fault")
    spoil(lambda: take_below_zero("picture"), "a time below 0")
    spoil(lambda: spoilt.pop("frames"), "a section is missing")
    spoil(lambda: find("kernels", "rows").update(max_k="much"), "a word instead of a number")
    spoil(lambda: find("kernels", "rows", is_shipped=True).update(max_k=8.5), "K beyond its bound")
    spoil(lambda: find("kernels", "rows", is_shipped=True).update(is_shipped=False), "nothing that is shipped")
    spoil(lambda: find("kernels", "rows", is_shipped=False).update(primitive="torus"), "a primitive that is none")
    spoil(lambda: find("kernels", "rows", is_shipped=True).update(leaks=1), "a leak")
    spoil(lambda: find("kernels", "rows", id="sphere/textbook").update(max_k=1.0), "a textbook that is exact")
    spoil(lambda: find("boxes", "rows", is_shipped=True).update(leaks=1), "a hidden box")
    spoil(lambda: find("frames", "rows", is_default=True).update(rmse=-1.0), "an RMSE below 0")
    spoil(lambda: find("frames", "rows", knob="boxes").update(rmse=0.5), "another picture of full boxes")
    spoil(lambda: find("frames", "rows", knob="samples").update(rmse=0.9), "more samples, more error")
    spoil(lambda: find("frames", "rows")["ms"].update(median=1e9), "a median beyond its quartile")
    spoil(lambda: find("frames", "rows")["ms"].update(runs=1), "fewer runs than told")
    spoil(
        lambda: find("frames", "errors", error="precision", method="promin").update(mean_absolute=1e-3),
        "precision beyond its bound",
    )
    spoil(lambda: find("specialisation", "rows").update(is_bit_identical=False), "bits that differ")
    spoil(lambda: find("kernels", "rows", is_shipped=True).pop("max_k"), "a shipped kernel that hits nothing")
    edges = {"rays": "edges"}
    spoil(lambda: find("rates", "pictures").update(traced_rays=1), "rays that are not the picture's")
    spoil(lambda: spoilt["rates"]["picture_rays"].pop(), "a set of rays that is left out")
    spoil(lambda: find("robustness", "rows", **edges).update(textbook_lost=0), "a plain kernel that is not plain")
    spoil(lambda: find("robustness", "rows", **edges).update(promin_lost=1), "a ray lost at an edge")
    spoil(lambda: find("robustness", "rows", **edges).update(truth="oracle"), "edges held against another truth")
    spoil(
        lambda: find("robustness", "rows", truth="oracle").update(promin_worst_margin=2.5), "a ray lost far from edges"
    )
    spoil(lambda: find("robustness", "rows", truth="oracle").pop("promin_worst_margin"), "a margin without end")
    spoil(lambda: find("frames", "rows", is_on_front=True).update(is_on_front=False), "a point of the front unmarked")
    spoil(lambda: find("frames", "rows", is_on_front=False).update(is_on_front=True), "a point off the front marked")
    spoil(lambda: find("frames", "rows", is_on_front=False).update(rmse=0.0), "an error that would be on the front")
    spoil(lambda: find("kernels", "rows", is_on_front=True).update(is_on_front=False), "a kernel of the front unmarked")
    spoil(lambda: find("frames", "rows", is_on_front=False).pop("is_on_front"), "a point without a mark")
    spoil(lambda: find("frames", "rows")["ms"].update(confidence=0.95), "three runs that are sure")
    spoil(lambda: find("frames", "rows")["time_ratio"].update(interval_lower=1e9), "a median out of its interval")
    spoil(lambda: find("specialisation", "rows")["compile_ms"].update(least=1e9), "a least beyond the most")
    spoil(lambda: spoilt["frames"]["gaps"].append(GAP), "FLIP both measured and a gap, or twice a gap")
    spoil(lambda: spoilt["peers"]["gaps"].append({**GAP, "name": "Embree", "reason": "not installed"}), "an odd gap")
    spoil(lambda: find("scaling", "fits").update(exponent=0.9), "an exponent that is not the rows'")
    spoil(lambda: spoilt["boxes"]["rows"].append(spoilt["boxes"]["rows"][0]), "two rows of one id")
    spoil(lambda: spoilt["peers"].update(rows=[], gaps=[]), "a gap that is not named")
    spoil(lambda: find("frames", "rows").update(rmse=math.nan), "a number that is none")
    spoil(lambda: find("frames", "rows").update(scene_hash="short"), "a hash too short")
    spoil(lambda: find("rates", "rows").update(promin_mrays_per_s=1e9), "a rate that is not of its time")
    spoil(lambda: find("rates", "rows").update(hits=10**9), "more hits than rays")
    spoil(lambda: find("robustness", "rows", **edges).update(only_promin_hits=0), "rays that differ by nothing")


def times_in(value):
    if isinstance(value, dict) and "interval_lower" in value:
        yield value
    elif isinstance(value, (dict, list)):
        for part in value.values() if isinstance(value, dict) else value:
            yield from times_in(part)


def check_comparison(report):
    old = copy.deepcopy(report)
    for times in times_in(old):
        times["confidence"] = SURE
    changes, lonely, compared = compare.find_changes(old, copy.deepcopy(old))
    expect(not changes and not lonely, "a report differs from itself")
    expect(compared > 50, f"{compared} times are compared")
    new = copy.deepcopy(old)
    times = new["frames"]["rows"][0]["ms"]
    for key in ("median", "interval_lower", "interval_upper"):
        times[key] *= 10
    # One whose interval meets the other's has not changed, however far its median is.
    within = new["frames"]["rows"][1]["ms"]
    within.update(interval_upper=10 * within["interval_upper"], median=5 * within["median"])
    new["kernels"]["rows"][0]["max_k"] *= 1.5
    del new["boxes"]["rows"][0]
    changes, lonely, _ = compare.find_changes(old, new)
    found = sorted((table, figure) for table, _, figure, _, _ in changes)
    expect(found == [("frames", "ms"), ("kernels", "max_k")], f"changes found: {changes}")
    expect(len(lonely) == 1 and "only in the old" in lonely[0], f"rows of one alone: {lonely}")
    # Three runs tell nothing of times.
    times["confidence"] = 0.75
    changes, _, _ = compare.find_changes(old, new)
    expect([figure for _, _, figure, _, _ in changes] == ["max_k"], f"changes found in few runs: {changes}")


def check_front_text(report):
    """What the page says of the default follows from the figures."""
    other = copy.deepcopy(report)
    rows = other["frames"]["rows"]
    scene = rows[0]["scene"]
    default = next(row for row in rows if row["is_default"])
    for times in times_in(rows):
        times.update(interval_lower=0.9 * times["median"], interval_upper=1.1 * times["median"], confidence=SURE)
    for row in rows:
        row["rmse"] = 2 * default["rmse"] if not row["is_default"] else row["rmse"]
    page = {"is_quick": True, "is_cpu": other["provenance"]["device_type"] == "CPU"}

    def faults_of(claim):
        return list(check_report.find_claim_faults(other, {**page, "fronts": [claim]}))

    alone = front_text.front_claim(other, scene)
    expect(not faults_of(alone), f"at odds: {alone}")
    ahead = next(row for row in rows if row["knob"] == "methods")
    ahead["rmse"] = default["rmse"]
    ahead["time_ratio"].update(median=0.65, interval_lower=0.6, interval_upper=0.7)
    expect(faults_of(alone), "not noticed: a dominator that the page leaves out")
    claim = front_text.front_claim(other, scene)
    expect(not faults_of(claim), f"at odds: {claim}")
    text = front_text.front_sentence(claim)
    expect("methods textbook takes 0.65 of its time" in text.replace("Methods", "methods"), f"no figures: {text}")
    expect("rounding alone takes" in text and "rays leak by its test of the " in text, f"no reasons: {text}")
    claim["ahead"][0]["gives_up"][0]["figure"] = 0
    expect(faults_of(claim), "not noticed: a reason without a figure")
    other["frames"]["errors"] = [row for row in other["frames"]["errors"] if row["method"] == "promin"]
    other["kernels"]["rows"] = []
    ahead.update(device_bytes=default["device_bytes"], build_ms=default["build_ms"])
    ahead.pop("flip", None)
    text = front_text.front_sentence(front_text.front_claim(other, scene))
    expect("gives up nothing that is measured here" in text, f"reasons without figures: {text}")
    # Beyond noise alone counts.
    ahead["time_ratio"]["interval_upper"] = 1.05
    claim = front_text.front_claim(other, scene)
    expect(claim["place"] != "off", "noise takes the default off the front")
    expect("off the front" not in front_text.front_sentence(claim), "noise takes the default off the front")


def writes_a_report(folder):
    done = run_program(TOOLS / "reporting" / "run", BIN, "--quick", "-o", folder)
    expect(done.returncode == 0, f"exit code {done.returncode}: {done.stderr[-2000:]}")
    expect(done.stderr.strip().endswith("sound"), f"the report is not checked: {done.stderr[-2000:]}")
    report = read_report(folder / "report.json")
    faults = check_report.find_faults(report)
    expect(not faults, "the report is not sound:\n" + "\n".join(faults))
    check_files(folder, report)
    if "matplotlib" in done.stdout:
        expect(not (folder / "report.html").exists(), "a page without matplotlib")
        print("no page: this machine has no matplotlib")
    else:
        check_page(folder)
        again = json.dumps((folder / "report.html").read_text(encoding="utf-8"))
        make_page(folder)
        same = json.dumps((folder / "report.html").read_text(encoding="utf-8")) == again
        expect(same, "the same report gives another page")
        expect("nothing changed" in make_page(folder, "--compare", folder / "report.json"), "it differs from itself")
        check_without_matplotlib(folder)
    check_that_faults_are_found(report)
    check_comparison(report)
    check_front_text(report)


def make_page(folder, *more, environment=None):
    done = run_python("page.py", folder, *more, environment=environment)
    expect(done.returncode == 0, f"page.py: {done.stderr}")
    return done.stdout


def check_without_matplotlib(folder):
    """One sentence, and no page."""
    hidden = folder / "hidden"
    (hidden / "matplotlib").mkdir(parents=True)
    (hidden / "matplotlib" / "__init__.py").write_text("raise ImportError\n", encoding="utf-8")
    (folder / "report.html").unlink()
    said = make_page(folder, environment={**os.environ, "PYTHONPATH": str(hidden)})
    expect(said.count("\n") == 1 and "matplotlib" in said, f"without matplotlib it says: {said}")
    expect(not (folder / "report.html").exists(), "a page without matplotlib")


def refuses_what_is_wrong(folder):
    scene = SCENES / "sphere.gltf"
    (folder / "file").write_text("", encoding="utf-8")
    (folder / "bad.gltf").write_text("{", encoding="utf-8")
    (folder / "old.json").write_text("[", encoding="utf-8")
    no_driver = {**os.environ, "VK_DRIVER_FILES": "/none.json", "VK_ICD_FILENAMES": "/none.json"}
    out = ("-o", folder / "out")
    cases = [
        (2, ("--quick",), None),
        (2, ("--quick", *out, "--runs", "0"), None),
        (2, ("--quick", *out, "--nonsense"), None),
        (2, ("--quick", *out, "--only", "kernels,nonsense"), None),
        (2, ("--quick", *out, "--builder", "nonsense"), None),
        (2, ("--quick", *out, "wavy:3"), None),
        (3, ("--quick", *out, folder / "missing.gltf"), None),
        (3, ("--quick", *out, folder / "bad.gltf"), None),
        (3, ("--quick", *out, scene, folder / "missing.gltf"), None),
        (3, ("--quick", *out, scene, "--compare", folder / "missing.json"), None),
        (3, ("--quick", *out, scene, "--compare", folder / "old.json"), None),
        (1, ("--quick", "-o", folder / "file" / "out"), None),
        (4, ("--quick", *out, "--device", "no such device"), None),
        (4, ("--quick", *out), no_driver),
    ]
    for code, words, environment in cases:
        done = run(*words, environment=environment)
        lines = [line for line in done.stderr.splitlines() if "promin-report: error: " in line]
        expect(done.returncode == code, f"{words} gives {done.returncode}, not {code}: {done.stderr}")
        expect(len(lines) == 1, f"{words} does not say what is wrong in one line: {done.stderr}")
        expect(not (folder / "out" / "runs.json").exists(), f"{words} leaves a report")
    (folder / "old.json").write_text('{"format": 2, "provenance": {}}', encoding="utf-8")
    done = run("--quick", *out, scene, "--compare", folder / "old.json")
    expect(done.returncode == 3, f"a report of another format is compared with: {done.stderr}")
    done = run_program(TOOLS / "reporting" / "run", BIN, "--quick", *out, "--compare", folder / "old.json")
    expect(done.returncode == 3, f"tools/report goes on: {done.returncode}, {done.stderr}")
    done = run_python("page.py", folder)
    expect(done.returncode != 0 and "runs.json" not in done.stderr, f"a page of nothing: {done.stderr}")


def computes_figures(folder):
    lower, upper, confidence = median_interval(list(range(20, 0, -1)))
    # Tables of the sign test: 6th and 15th of 20, 95.86 %.
    expect((lower, upper) == (6, 15) and abs(confidence - 0.9586) < 5e-5, f"of 20: {lower}, {upper}, {confidence}")
    times = figures_of_times(list(range(20, 0, -1)))
    expect((times["median"], times["lower_quartile"], times["upper_quartile"]) == (10.5, 5.75, 15.25), f"{times}")
    expect((times["interval_lower"], times["interval_upper"], times["runs"]) == (6, 15, 20), f"{times}")
    # How little few values tell.
    expect(figures_of_times([3.0])["median"] == 3.0 and median_interval([3.0])[2] == 0, "one value tells too much")
    expect(median_interval([3.0, 1.0, 2.0]) == (1.0, 3.0, 0.75), "three values")
    expect(median_interval([1, 2, 3, 4, 5])[2] < 0.95 < median_interval([1, 2, 3, 4, 5, 6])[2], "five and six values")
    expect(figures_of_few([3, 1, 2]) == {"median": 2, "least": 1, "most": 3, "runs": 3}, "three times")
    # It holds the median as often as it says, and narrows.
    generator, last_width, trials = random.Random(7), math.inf, 4000
    for count in (20, 80, 320):
        # Skewed, as times are; its median is ln 2.
        found = [median_interval([generator.expovariate(1) for _ in range(count)]) for _ in range(trials)]
        held = sum(lower <= math.log(2) <= upper for lower, upper, _ in found) / trials
        width = statistics.fmean(upper - lower for lower, upper, _ in found)
        expect(abs(held - found[0][2]) < 0.012, f"{count} values: it holds the median in {held}, not {found[0][2]}")
        expect(width < 0.6 * last_width, f"{count} values: {width} wide after {last_width}")
        last_width = width
    expect(
        find_front([(3, 1), (1, 5), (2, 5), (2, 3), (4, 2), (1, 6)]) == [True, True, False, True, False, False],
        "the front has what nothing is ahead of",
    )
    expect(find_front([(1, 1), (1, 1)]) == [True, True] and find_front([]) == [], "of two alike neither is ahead")
    # y = 3 x^0.5, then with one point off the line: the interval by hand, 12.706 times the slope's standard error.
    fit = fit_power([1, 4, 16], [3, 6, 12])
    expect(max(abs(fit[key] - 0.5) for key in ("exponent", "lower", "upper")) < 1e-9, f"{fit}")
    fit = fit_power([1, math.e, math.e**2], [1, math.e**2, math.e**2])
    error = math.sqrt(2 / 3 / 2)
    expect(abs(fit["exponent"] - 1) < 1e-9 and abs(fit["upper"] - 1 - 12.706 * error) < 1e-9, f"{fit}")
    line = fit_doublings([1, 2, 4, 8], [5, 7, 9, 11])
    expect(abs(line["per_doubling"] - 2) < 1e-9 and abs(line["r_squared"] - 1) < 1e-9, f"{line}")


def judges_times(folder):
    ratio = {"median": 0.9, "interval_lower": 0.85, "interval_upper": 0.97, "confidence": SURE}
    slower = {"median": 1.1, "interval_lower": 1.01, "interval_upper": 1.2, "confidence": SURE}
    cases = [
        ("faster", ratio, "wholly below 1"),
        ("", {**ratio, "interval_upper": 1.01}, "with 1 in its interval"),
        ("", {**ratio, "confidence": 0.9375}, "of 5 runs"),
        ("", {**ratio, "median": 0.99, "interval_upper": 0.995}, "less than 2 % away"),
        ("slower", slower, "wholly above 1"),
        ("", {**slower, "interval_lower": 0.99}, "with 1 in its interval"),
    ]
    for wanted, figures, what in cases:
        expect(judge(figures) == wanted, f"a ratio {what} is '{judge(figures)}'")
    old = {"median": 10, "interval_lower": 9, "interval_upper": 11, "confidence": SURE}
    new = {"median": 12, "interval_lower": 11.5, "interval_upper": 13, "confidence": SURE}
    expect(judge(ratio_of_reports(new, old)) == "slower", "intervals that do not meet")
    expect(judge(ratio_of_reports({**new, "interval_lower": 10.5}, old)) == "", "intervals that meet")
    few = {"median": 10, "least": 9, "most": 11, "runs": 5}
    more = {"median": 13, "least": 12, "most": 14, "runs": 5}
    expect(judge(ratio_of_few(more, few)) == "slower", "five runs apart from five")
    expect(judge(ratio_of_few({**more, "runs": 2}, {**few, "runs": 2})) == "", "two runs apart from two")
    expect(beyond_noise_text([ratio, slower], "faster") == "It is faster beyond noise in 1 of 2 cases.", "the count")
    text = beyond_noise_text([{**ratio, "confidence": 0.75, "runs": 3}], "faster")
    expect(text == "3 runs are too few to tell that from noise.", text)


def run_python(script, *words, environment=None):
    python = os.environ.get("PROMIN_PYTHON", "/usr/bin/python3")
    return run_program(python, TOOLS / "reporting" / script, *words, environment=environment)


PROVENANCE = {"runs": 1, "is_quick": True, "device_type": "CPU"}


def tells_gaps(folder):
    """What is not installed from what is and fails; one that fails does not take the others with it."""
    module = folder / "flip_evaluator"
    module.mkdir()
    modules = {**os.environ, "PYTHONPATH": str(folder)}
    file = folder / "runs.json"

    def measure_flip():
        write_report({"format": 3, "frames": {"rows": [{"id": "a"}, {"id": "b"}], "gaps": []}}, file)
        (folder / "0.truth.exr").touch()
        return run_python("flip.py", folder, folder, environment=modules), read_report(file)["frames"]

    (module / "__init__.py").write_text("raise OSError('its library is gone')\n", encoding="utf-8")
    done, frames = measure_flip()
    gap = {"name": "FLIP", "is_installed": True, "reason": "OSError: its library is gone"}
    expect(done.returncode == 0 and frames["gaps"] == [gap], f"flip.py hides that FLIP failed: {done}, {frames}")
    expect("flip" not in frames["rows"][0], f"an error that was not measured: {frames}")
    (module / "__init__.py").write_text("import os\nos.abort()\n", encoding="utf-8")
    done, frames = measure_flip()
    expect(done.returncode != 0 and frames["gaps"][0]["is_installed"], f"a crash is not a gap: {done}, {frames}")
    (module / "__init__.py").write_text(
        "import os\nfound = {'0.exr': 0.25, '1.exr': 0.5}\n"
        "evaluate = lambda a, b, *c, **d: (None, found[os.path.basename(b)], None)\n",
        encoding="utf-8",
    )
    done, frames = measure_flip()
    expect([row.get("flip") for row in frames["rows"]] == [0.25, 0.5] and not frames["gaps"], f"{done}, {frames}")
    shutil.rmtree(module)
    (folder / "sitecustomize.py").write_text(
        "import importlib.util as u\nfind = u.find_spec\n"
        "u.find_spec = lambda name, *a: None if name == 'flip_evaluator' else find(name, *a)\n",
        encoding="utf-8",
    )
    done, frames = measure_flip()
    gap = {"name": "FLIP", "is_installed": False, "reason": "not installed"}
    expect(done.returncode == 0 and frames["gaps"] == [gap], f"without FLIP: {done}, {frames}")
    # Renderers: one that fails, one that says nothing of its time.
    for name, script in (("tachyon", "echo working; echo 'Tachyon: no such file' >&2; exit 1"), ("povray", "echo hi")):
        (folder / name).write_text(f"#!/bin/sh\n{script}\n", encoding="utf-8")
        (folder / name).chmod(0o755)
    fake = {**os.environ, "PATH": f"{folder}:{os.environ['PATH']}"}
    write_report({"format": 3, "provenance": PROVENANCE}, file)
    done = run_python("peers.py", folder, "--programs", BIN, "--side", "16", "--level", "1", environment=fake)
    expect(done.returncode == 0, f"peers.py: {done.stderr}")
    found = read_report(file)["peers"]
    expect(not found["rows"] and found["first"], f"peers.py: {found}")
    expect(len(found["first"][0]["trace_ms"]) == 1, f"peers.py: {found}")
    reasons = {gap["name"]: gap["reason"] for gap in found["gaps"] if gap["is_installed"]}
    expect(reasons["Tachyon"] == "Tachyon: no such file", f"Tachyon: {reasons}")
    expect("no time" in reasons["POV-Ray"], f"POV-Ray: {reasons}")
    # And one that is measured: its picture is black. The other is too fast for its own clock.
    script = "printf 'P6\\n16 16\\n65535\\n' >tachyon.ppm; head -c 1536 /dev/zero >>tachyon.ppm"
    script += "; echo 'Version 0.5 Ray Tracing Time: 2.5'"
    (folder / "tachyon").write_text(f"#!/bin/sh\n{script}\n", encoding="utf-8")
    script = "echo 'Version 3.7'; echo '  Trace Time:  0 hours  0 minutes  0 seconds (0.000 seconds)'"
    (folder / "povray").write_text(f"#!/bin/sh\n{script}\n", encoding="utf-8")
    done = run_python("peers.py", folder, "--programs", BIN, "--side", "16", "--level", "1", environment=fake)
    found = read_report(file)["peers"]
    expect(found["rows"], f"a peer that is there was not measured: {found}, {done.stderr}")
    row = found["rows"][0]
    expect(
        row["peer"] == "Tachyon 0.5" and row["peer_ms"] == [2500.0], f"a peer that is measured: {row}, {done.stderr}"
    )
    reasons = {gap["name"]: gap["reason"] for gap in found["gaps"]}
    expect("less time" in reasons["POV-Ray"], f"a renderer that tells of no time at all: {reasons}")
    expect(row["mean_difference"] > 0.01 and row["time_ratio"] == [row["promin_ms"][0] / 2500.0], f"{row}")


def tells_scenes_apart(folder):
    """Two scenes of one name, and one given twice."""
    for name in ("a", "b"):
        (folder / name).mkdir()
        (folder / name / "x.gltf").write_bytes((SCENES / "sphere.gltf").read_bytes())
    files = (folder / "a" / "x.gltf", folder / "b" / "x.gltf")
    done = run("--quick", "-o", folder / "twice", files[0], folder / "b" / ".." / "a" / "x.gltf")
    expect(done.returncode == 2 and "given twice" in done.stderr, f"a scene given twice: {done.stderr}")
    # Not what specialisation brings, whose kernels of all features take long to compile.
    sections = ("frames", "robustness", "rates")
    done = run("--quick", "--runs", 1, "--only", ",".join(sections), "-o", folder / "out", *files)
    expect(done.returncode == 0, f"exit code {done.returncode}: {done.stderr[-2000:]}")
    report = read_report(folder / "out" / "runs.json")
    for section in sections:
        scenes = {row["scene"]: row["scene_hash"] for row in report[section]["rows"]}
        expect(sorted(scenes) == ["a/x.gltf", "b/x.gltf"], f"{section}: {scenes}")
        expect(len(set(scenes.values())) == 1, f"{section}: the same content has two hashes: {scenes}")
    expect(not list(check_report._find_twins(report)), "ids are not one row's alone")


def sets_a_picture_beside_its_rays(folder):
    """promin-bench does, and writes the rays as files that cast takes."""
    rays = folder / "rays"
    scene = SCENES / "showcase.gltf"
    options = ("--runs", 1, "--side", 64, "--max-depth", 2, "--rays", rays, "-o", folder / "runs.json")
    done = run_program(BIN / "promin-bench", scene, *options)
    expect(done.returncode == 1 and "no such folder" in done.stderr and not done.stdout, f"a folder is missing: {done}")
    rays.mkdir()
    done = run_program(BIN / "promin-bench", scene, *options)
    expect(done.returncode == 0 and "of what its own" in done.stdout, f"promin-bench: {done}")
    rates = read_report(folder / "runs.json")["rates"]
    picture, mirrors = rates["pictures"]
    expect((picture["what"], mirrors["what"]) == ("picture", "mirror stage"), f"{picture['what']}, {mirrors['what']}")
    sets = {row["rays"]: row["count"] for row in rates["picture_rays"]}
    expect(list(sets) == ["camera", "shadow 0", "mirror 1", "shadow 1", "mirror 2", "shadow 2"], f"sets: {sets}")
    expect(sets["camera"] == 64 * 64 and sum(sets.values()) == picture["count"], f"not all rays are there: {sets}")
    expect(sum(list(sets.values())[2:]) == mirrors["count"], f"other rays than those behind first hits: {mirrors}")
    for name, count in sets.items():
        file = rays / f"showcase_{name.replace(' ', '_')}.npy"
        done = run_program(BIN / "promin", "cast", scene, file, "-o", folder / "hits.npy")
        expect(done.returncode == 0, f"cast of {file.name}: {done}")
        header = file.read_bytes()[:128].decode("latin1")
        expect(f"'shape': ({count}, 8)" in header, f"{file.name} has other rays: {header}")
    # Rays are found by the picture's rules: highlights without diffuse light, colours, cones, parallel cameras.
    names = ("showcase", "metallic_roughness", "vertex_colors", "light_spot", "light_physical", "orthographic", "mirrors")
    scenes = [SCENES / f"{name}.gltf" for name in names]
    done = run_program(BIN / "promin-bench", *scenes, "--runs", 1, "--side", 64, "-o", folder / "runs.json")
    expect(done.returncode == 0, f"promin-bench: {done}")
    for part in read_report(folder / "runs.json")["rates"]["pictures"]:
        apart = abs(part["count"] - part["traced_rays"])
        expect(apart <= max(3, 1e-3 * part["traced_rays"]), f"other rays than the picture's: {part}")
    done = run_program(BIN / "promin-bench", scene, "--runs", 0, "--rays", rays)
    expect(done.returncode == 2 and "--runs 0" in done.stderr, f"rays without a picture: {done}")


def makes_tables(folder):
    """Of parts of reports, as tools/bench and tools/accuracy do; and a table for the terminal."""
    done = run("--quick", "--runs", 1, "--only", "rates,scaling,robustness", "--side", 32, "-o", folder / "system")
    expect(done.returncode == 0, f"exit code {done.returncode}: {done.stderr[-2000:]}")
    done = run_python("summarise.py", folder / "system")
    expect(done.returncode == 0, f"summarise.py: {done.stderr}")
    file = folder / "system" / "report.json"
    report = read_report(file)
    expect(sorted(report) == ["format", "provenance", "rates", "robustness", "scaling"], f"sections: {list(report)}")
    make_page(folder / "system")
    done = run_python("bench_tables.py", "-o", folder / "bench.json", "--growth", file, file)
    expect(done.returncode == 0, f"bench_tables.py: {done.stderr}")
    lines = [[cell.strip() for cell in line.strip("|").split("|")] for line in done.stdout.splitlines()]
    for row in report["rates"]["rows"]:
        cells = next(line for line in lines if line[1:3] == [row["scene"], row["rays"]])
        expect(cells[4] == number(row["promin_mrays_per_s"]), f"another rate than {row}: {cells}")
        expect(cells[-4] == number(row["node_steps_per_ray"]), f"other steps than {row}: {cells}")
    fit = next(fit for fit in report["scaling"]["fits"] if fit["id"] == "triangles/camera/node_steps_per_ray")
    cells = next(line for line in lines if line[0].startswith("steps a doubling"))
    expect(cells[1] == f"{fit['per_doubling']:.2f} ({fit['r_squared']:.3f})", f"another growth than {fit}: {cells}")
    expect(
        json.loads((folder / "bench.json").read_text())["drivers"]["system"] == report, "bench.json has other figures"
    )
    (folder / "system.log").touch()
    hard = {"driver": report["provenance"]["driver"], "failed": [], "primitives": {}, "rows": []}
    (folder / "system.json").write_text(json.dumps(hard), encoding="utf-8")
    done = run_python("accuracy_document.py", folder)
    expect(done.returncode == 0, f"accuracy_document.py: {done.stderr}")
    lines = [[cell.strip() for cell in line.strip("|").split("|")] for line in done.stdout.splitlines()]
    for row in report["robustness"]["rows"]:
        cells = next(line for line in lines if line[0] == row["scene"] and line[2] == row["rays"])
        expect(cells[6:] == [str(row["only_promin_hits"]), str(row["only_textbook_hits"])], f"{row}: {cells}")
    done = run_program(BIN / "promin-bench", "needles:500", "--runs", 0, "--side", 16, "-o", folder / "runs.json")
    expect(done.returncode == 0 and "needles:500, 500 primitives" in done.stdout, f"promin-bench: {done}")
    rows = read_report(folder / "runs.json")["rates"]["rows"]
    expect([row["rays"] for row in rows] == ["camera", "shadow", "random"], f"promin-bench: {rows}")
    expect(rows[0]["count"] == 256 and "promin_ms" not in rows[0], f"it should only count steps: {rows}")
    sets_a_picture_beside_its_rays(folder)
    done = run_program(BIN / "promin-bench", "needles:5", "--runs", 0)
    expect(done.returncode == 2 and "no number of triangles" in done.stderr, f"promin-bench: {done}")
    expect(not done.stdout, f"promin-bench has begun: {done}")


TESTS = {
    test.__name__: test
    for test in (
        writes_a_report,
        refuses_what_is_wrong,
        computes_figures,
        judges_times,
        tells_gaps,
        tells_scenes_apart,
        makes_tables,
    )
}

with tempfile.TemporaryDirectory() as name:
    TESTS[sys.argv[1]](pathlib.Path(name))
