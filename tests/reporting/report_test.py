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
import front_text
from figures import beyond_noise_text, judge, number, ratio_of_few, ratio_of_reports


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
    expect('"values"' not in (folder / "report.json").read_text(encoding="utf-8"), "report.json has the single runs")
    runs = check_report.read_runs(folder / "runs.csv")
    faults = list(check_report.find_run_faults(report, runs))
    expect(not faults, "the single runs do not give the figures:\n" + "\n".join(faults[:10]))
    own = runs["frames", report["frames"]["rows"][1]["id"], "ms"]
    own[0], own[1] = 3 * own[0], 3 * own[1]
    expect(list(check_report.find_run_faults(report, runs)), "not noticed: other runs than the medians'")
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
    report = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    faults = list(check_report.find_page_faults(report, page))
    expect(not faults, "the page is at odds with the figures:\n" + "\n".join(faults))
    for said, otherwise in (("on the front", "off the front"), ('class="front"', 'class="back"')):
        other = page.replace(said, otherwise)
        expect(list(check_report.find_page_faults(report, other)), f"not noticed: {otherwise} instead of {said}")
    distances = [row["value"] for row in report["kernels"]["range"] if row["variable"] == "distance"]
    said = f"From a distance of {number(min(distances), 2)} to {number(max(distances), 2)} sizes"
    expect(said in page, f"the page does not say: {said}")
    expect(page.count("<svg") >= 20, "the page has too few plots")
    expect("<metadata" not in page and "<dc:date" not in page, "the plots carry metadata")
    expect((folder / "frames.png").stat().st_size > 10_000, "there is no picture of the main plot")
    for section in re.findall(r"<section>.*?</section>", page, flags=re.DOTALL):
        # Beside other renderers, where none is installed.
        is_gap = "<p>Not measured" in section and "<svg" not in section and "<table" not in section
        expect(is_gap or re.search(r"<(p|li)>[^<]*\d", section), f"a section's text has no figure: {section[:200]}")


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
    edges = {"rays": "edges"}
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
    alone = front_text.front_sentence(other, scene)
    expect(not list(check_report.find_page_faults(other, alone)), f"at odds: {alone}")
    ahead = next(row for row in rows if row["knob"] == "methods")
    ahead["rmse"] = default["rmse"]
    ahead["time_ratio"].update(median=0.65, interval_lower=0.6, interval_upper=0.7)
    expect(list(check_report.find_page_faults(other, alone)), "not noticed: a dominator that the page leaves out")
    text = front_text.front_sentence(other, scene)
    expect(not list(check_report.find_page_faults(other, text)), f"at odds: {text}")
    expect("methods textbook takes 0.65 of its time" in text.replace("Methods", "methods"), f"no figures: {text}")
    expect("rounding alone takes" in text and "leak between its triangles" in text, f"no reasons: {text}")
    other["frames"]["errors"] = [row for row in other["frames"]["errors"] if row["method"] == "promin"]
    other["kernels"]["rows"] = []
    ahead.update(device_bytes=default["device_bytes"], build_ms=default["build_ms"])
    ahead.pop("flip", None)
    text = front_text.front_sentence(other, scene)
    expect("gives up nothing that is measured here" in text, f"reasons without figures: {text}")
    # Beyond noise alone counts.
    ahead["time_ratio"]["interval_upper"] = 1.05
    expect("off the front" not in front_text.front_sentence(other, scene), "noise takes the default off the front")


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
    words = [python, TOOLS / "reporting" / script, *words]
    return subprocess.run(list(map(str, words)), capture_output=True, text=True, timeout=120, env=environment)


def tells_gaps(folder):
    """What is not installed from what is and fails; one that fails does not take the others with it."""
    module = folder / "flip_evaluator"
    module.mkdir()
    modules = {**os.environ, "PYTHONPATH": str(folder)}
    (module / "__init__.py").write_text("raise OSError('its library is gone')\n", encoding="utf-8")
    done = run_python("flip.py", "a.exr", "b.exr", environment=modules)
    expect(done.returncode != 0, "flip.py hides that FLIP failed")
    expect(done.stderr.strip().endswith("OSError: its library is gone"), f"the last line is another: {done.stderr}")
    (module / "__init__.py").write_text("evaluate = lambda *a, **k: (None, 0.25, None)\n", encoding="utf-8")
    done = run_python("flip.py", "a.exr", "b.exr", environment=modules)
    expect(json.loads(done.stdout) == {"errors": [0.25]}, f"flip.py: {done}")
    (module / "__init__.py").unlink()
    module.rmdir()
    (folder / "sitecustomize.py").write_text(
        "import importlib.util as u\nfind = u.find_spec\n"
        "u.find_spec = lambda name, *a: None if name == 'flip_evaluator' else find(name, *a)\n",
        encoding="utf-8",
    )
    done = run_python("flip.py", "a.exr", "b.exr", environment=modules)
    expect(done.returncode == 0 and done.stdout == "{}\n", f"without FLIP: {done}")
    # Renderers: one that fails, one that says nothing of its time.
    for name, script in (("tachyon", "echo working; echo 'Tachyon: no such file' >&2; exit 1"), ("povray", "echo hi")):
        (folder / name).write_text(f"#!/bin/sh\n{script}\n", encoding="utf-8")
        (folder / name).chmod(0o755)
    fake = {**os.environ, "PATH": f"{folder}:{os.environ['PATH']}"}
    done = run_python("peers.py", "--programs", BIN, "--runs", "1", "--side", "16", "--level", "1", environment=fake)
    expect(done.returncode == 0, f"peers.py: {done.stderr}")
    found = json.loads(done.stdout)
    expect(not found["peers"] and len(found["trace_ms"]) == 1, f"peers.py: {found}")
    expect(found["failures"]["Tachyon"] == "Tachyon: no such file", f"Tachyon: {found['failures']}")
    expect("no time" in found["failures"]["POV-Ray"], f"POV-Ray: {found['failures']}")


def tells_scenes_apart(folder):
    """Two scenes of one name, and one given twice."""
    for name in ("a", "b"):
        (folder / name).mkdir()
        (folder / name / "x.gltf").write_bytes((SCENES / "sphere.gltf").read_bytes())
    files = (folder / "a" / "x.gltf", folder / "b" / "x.gltf")
    done = run("--quick", "-o", folder / "twice", files[0], folder / "b" / ".." / "a" / "x.gltf")
    expect(done.returncode == 2 and "given twice" in done.stderr, f"a scene given twice: {done.stderr}")
    done = run("--quick", "--runs", 1, "-o", folder / "out", *files)
    expect(done.returncode == 0, f"exit code {done.returncode}: {done.stderr[-2000:]}")
    report = json.loads((folder / "out" / "report.json").read_text(encoding="utf-8"))
    for section in ("frames", "robustness", "specialisation"):
        scenes = {row["scene"]: row["scene_hash"] for row in report[section]["rows"]}
        expect(sorted(scenes) == ["a/x.gltf", "b/x.gltf"], f"{section}: {scenes}")
        expect(len(set(scenes.values())) == 1, f"{section}: the same content has two hashes: {scenes}")
    expect(not list(check_report._find_twins(report)), "ids are not one row's alone")


TESTS = {
    test.__name__: test
    for test in (writes_a_report, refuses_what_is_wrong, judges_times, tells_gaps, tells_scenes_apart)
}

with tempfile.TemporaryDirectory() as name:
    TESTS[sys.argv[1]](pathlib.Path(name))
