#!/usr/bin/env python3
# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""promin-report as a user runs it, quick, and the checks of its figures.

report_test.py TEST BIN TOOLS SCENES: TEST is a function below, BIN the folder of the programs."""

import copy
import csv
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

BIN, TOOLS, SCENES = map(pathlib.Path, sys.argv[2:5])
sys.path.insert(0, str(TOOLS / "reporting"))

import check_report
import compare
from figures import pareto_front


def expect(condition, what):
    if not condition:
        sys.exit(f"report_test.py: {what}")


def run(*words, environment=None):
    command = [str(BIN / "promin-report"), *map(str, words)]
    return subprocess.run(command, capture_output=True, text=True, timeout=280, env=environment)


def count_lines(file):
    with open(file, encoding="utf-8", newline="") as lines:
        return sum(1 for _ in csv.DictReader(lines))


def check_files(folder, report):
    """A CSV line for each row, with what every figure stands under; a page that needs nothing else."""
    for name in ("kernels", "boxes", "frames", "robustness", "specialisation", "scaling", "peers"):
        rows = report[name]["rows"]
        if rows:
            expect(count_lines(folder / f"{name}.csv") == len(rows), f"{name}.csv has other rows than report.json")
    with open(folder / "frames.csv", encoding="utf-8", newline="") as lines:
        row = next(csv.DictReader(lines))
    for column in ("device", "driver", "compiler", "commit", "date", "scene_hash", "ms.median", "ms.runs"):
        expect(row.get(column), f"frames.csv tells of no {column}")
    expect(not [f for f in folder.iterdir() if f.name.startswith(".")], "temporary files are left")


def check_page(folder):
    page = (folder / "report.html").read_text(encoding="utf-8")
    expect(not re.search(r"(src|href)=['\"]?(http|//|file)", page), "the page needs other files")
    expect("quick report" in page, "the page does not say that it is quick")
    device_type = json.loads((folder / "report.json").read_text(encoding="utf-8"))["provenance"]["device_type"]
    expect(("a CPU driver" in page) == (device_type == "CPU"), "the page does not call a CPU driver one")
    expect(re.search(r"lies (on|off) the front", page), "the page does not say where the default lies")
    expect(page.count("<svg") >= 20, "the page has too few plots")
    expect("<metadata" not in page and "<dc:date" not in page, "the plots carry metadata")
    expect((folder / "frames.png").stat().st_size > 10_000, "there is no picture of the main plot")
    for section in re.findall(r"<section>.*?</section>", page, flags=re.DOTALL):
        expect(re.search(r"<p>[^<]*\d", section), f"a section's text has no figure: {section[:200]}")


def check_that_faults_are_found(report):
    """Each way to spoil the report must be noticed."""

    def find(section, table, **wanted):
        return next(r for r in spoilt[section][table] if all(r.get(k) == v for k, v in wanted.items()))

    def spoil(change, what):
        nonlocal spoilt
        spoilt = copy.deepcopy(report)
        change()
        expect(check_report.find_faults(spoilt), f"not noticed: {what}")

    spoilt = None
    spoil(lambda: spoilt.pop("frames"), "a section is missing")
    spoil(lambda: find("kernels", "rows").update(max_k="much"), "a word instead of a number")
    spoil(lambda: find("kernels", "rows", is_shipped=True).update(max_k=8.5), "K beyond its bound")
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
    spoil(lambda: find("robustness", "rows", rays="edges").update(lost=0), "a plain kernel that is not plain")
    spoil(lambda: find("robustness", "rows", rays="edges").update(invented=1), "a ray lost at an edge")
    spoil(lambda: find("scaling", "fits").update(exponent=0.9), "an exponent that is not the rows'")
    spoil(lambda: spoilt["boxes"]["rows"].append(spoilt["boxes"]["rows"][0]), "two rows of one id")
    spoil(lambda: spoilt["peers"].update(rows=[], not_measured=[]), "a gap that is not named")


def check_comparison(report):
    changes, lonely = compare.find_changes(report, copy.deepcopy(report))
    expect(not changes and not lonely, "a report differs from itself")
    new = copy.deepcopy(report)
    times = new["frames"]["rows"][0]["ms"]
    for key in ("median", "lower_quartile", "upper_quartile"):
        times[key] *= 3
    # One that moves within the other's quartiles has not changed.
    within = new["frames"]["rows"][1]["ms"]
    within["median"] = within["upper_quartile"]
    new["kernels"]["rows"][0]["max_k"] *= 1.5
    del new["boxes"]["rows"][0]
    changes, lonely = compare.find_changes(report, new)
    found = sorted((table, figure) for table, _, figure, _, _ in changes)
    expect(found == [("frames", "ms"), ("kernels", "max_k")], f"changes found: {changes}")
    expect(len(lonely) == 1 and "only in the old" in lonely[0], f"rows of one alone: {lonely}")


def writes_a_report(folder):
    done = run("--quick", "-o", folder)
    expect(done.returncode == 0, f"exit code {done.returncode}: {done.stderr[-2000:]}")
    report = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    faults = check_report.find_faults(report)
    expect(not faults, "the report is not sound:\n" + "\n".join(faults))
    check_files(folder, report)
    if "matplotlib" in done.stderr:
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


def make_page(folder, *more, environment=None):
    python = os.environ.get("PROMIN_PYTHON", "/usr/bin/python3")
    words = [python, TOOLS / "reporting" / "page.py", folder, *more]
    done = subprocess.run(list(map(str, words)), capture_output=True, text=True, timeout=120, env=environment)
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
        expect(not (folder / "out" / "report.json").exists(), f"{words} leaves a report")


def knows_a_pareto_front(folder):
    points = [(3, 1), (1, 5), (2, 5), (2, 3), (4, 2), (1, 6)]
    expect([points[i] for i in pareto_front(points)] == [(1, 5), (2, 3), (3, 1)], "the front is another")
    expect(pareto_front([]) == [], "the front of nothing is something")


TESTS = {test.__name__: test for test in (writes_a_report, refuses_what_is_wrong, knows_a_pareto_front)}

with tempfile.TemporaryDirectory() as name:
    TESTS[sys.argv[1]](pathlib.Path(name))
