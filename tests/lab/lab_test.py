#!/usr/bin/env python3
# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Tests the tools that measure: statistics, tables, peers and a quick report as a user makes it.

lab_test.py TEST BIN TOOLS SCENES: TEST is a function below, BIN the folder of the programs."""

import json
import math
import os
import pathlib
import random
import re
import statistics
import subprocess
import sys
import tempfile

BIN, TOOLS, SCENES = map(pathlib.Path, sys.argv[2:5])
sys.path[:0] = [str(TOOLS / "lab"), str(TOOLS)]
sys.dont_write_bytecode = True

import honesty_plot
import processes
from figures import gap_text, number
from stats import figures_of_times, fit_doublings, median_interval, read_figures


def expect(condition, what):
    if not condition:
        sys.exit(f"lab_test.py: {what}")


def run_program(*words, environment=None):
    return subprocess.run(list(map(str, words)), capture_output=True, text=True, timeout=900, env=environment)


def run_lab(*words):
    done = run_program(BIN / "promin-lab", *words)
    expect(done.returncode == 0, f"promin-lab {words}: {done.stderr[-2000:]}")
    return done.stdout


def run_python(script, *words, environment=None):
    python = os.environ.get("PROMIN_PYTHON", "/usr/bin/python3")
    return run_program(python, "-B", TOOLS / "lab" / script, *words, environment=environment)


def read_json(file):
    return json.loads(file.read_text(encoding="utf-8"))


def draws_claims(folder):
    """Checks the points of the plot of claims, and its data as promin-lab honesty writes them."""
    pixels = [(0.25, error / 1000.0) for error in range(1, 201)] + [(0.01, 0.5)] * 99 + [(0.0, 0.0)] * 200
    points = honesty_plot.quantiles(pixels)
    expect(len(points) == 1 and points[0][1] == 0.19, f"not the error of 95 in 100 pixels: {points}")
    expect(0.25 <= points[0][0] < 0.25 * math.sqrt(2.0), f"not the middle of the range of claims: {points}")
    file = folder / "pixels.csv"
    words = ("--size", "125x125", "--truth", 64, "--most", 2, "--runs", 1, "--pixels", file)
    run_lab("honesty", SCENES / "box.gltf", *words)
    lines = file.read_text().splitlines()
    expect(lines[0] == "scene,target,claim,error" and len(lines) > 10, f"{lines[:2]}")
    expect(all(line.startswith("box,") for line in lines[1:]), "another scene")
    measured = honesty_plot.read_pixels(file)
    expect(len(measured) == len(lines) - 1 and all(claim >= 0.0 for claim, _ in measured), "other pixels")


def computes_figures(folder):
    """Checks statistics, numbers, and what the page derives from rows."""
    values = [3.0, 1.0, 2.0, 4.0, 100.0]
    figures = figures_of_times(values)
    expect(figures["median"] == statistics.median(values) and figures["runs"] == 5, f"{figures}")
    expect(median_interval(values) == (1.0, 100.0, 0.9375), "an interval of fewer than 6 runs")
    lower, upper, confidence = median_interval(range(1, 21))
    expect((lower, upper) == (6, 15) and abs(confidence - 0.9586) < 1e-4, f"{lower}, {upper}, {confidence}")
    # The interval contains the true median of a skewed distribution this often.
    draw = random.Random(5)
    held = 0
    for _ in range(2000):
        low, high, _ = median_interval([draw.expovariate(1.0) for _ in range(20)])
        held += low <= math.log(2) <= high
    expect(0.94 < held / 2000 < 0.98, f"the interval holds the median in {held} of 2000 cases")
    line = fit_doublings([1, 2, 4, 8], [5, 7, 9, 11])
    expect(abs(line["per_doubling"] - 2) < 1e-9 and abs(line["r_squared"] - 1) < 1e-9, f"{line}")
    expect([number(v) for v in (None, 0, 1.2345, 1234, 2e-5)] == ["–", "0", "1.23", "1,234", "2·10^−5"], "numbers")
    gaps = [{"name": "A", "is_installed": False}, {"name": "B", "is_installed": True, "reason": "no file"}]
    said = "Not measured, because not installed: A. Not measured: B, which failed: no file"
    expect(gap_text(gaps) == said, gap_text(gaps))
    import report

    rows = [
        {"renderer": "promin", "samples": n, "ms": [10.0 * n, 11.0 * n, 9.0 * n], "error": 0.08 / n} for n in (1, 4, 16)
    ]
    rows.append({"renderer": "Tachyon", "samples": 4, "ms": [50.0], "error": 0.01})
    sentences = list(report.renderer_sentences({"rows": rows, "versions": {"Tachyon": "Tachyon 1"}, "between": {}}))
    said = "Tachyon 1 takes 50 ms for an error of 1 %; promin takes 80 ms for the same error."
    expect(sentences == [said], sentences)
    expect(report.plot(rows) == report.plot(rows), "a plot of the same figures differs")
    words = [report.duration(ms) for ms in (1.26, 12.4, 1260, 12400)]
    expect(words == ["1.3 ms", "12 ms", "1.3 s", "12 s"], f"{words}")
    words = [report.compared(ratio) for ratio in (1.01, 1.12, 0.9, 3.0)]
    expect(words[1:] == ["12 % more time than", "10 % less time than", "3 times the time of"], f"{words}")


def names_gaps(folder):
    """A peer that fails does not stop the others; the table names the last line of the failed program."""
    peers = folder / "peers.json"

    def measure():
        options = ("--programs", BIN, "--side", 16, "--level", 1, "--runs", 1)
        done = run_python("peers.py", peers, *options, environment={**os.environ, "PATH": path})
        expect(done.returncode == 0, f"peers.py: {done.stderr}")
        return read_json(peers)["peers"]

    def install(name, script):
        (folder / name).write_text(f"#!/bin/sh\n{script}\n", encoding="utf-8")
        (folder / name).chmod(0o755)

    for name in ("sh", "head", "cat"):
        (folder / name).symlink_to(f"/bin/{name}")
    path = str(folder)
    found = measure()
    expect(not found["rows"], f"without peers: {found}")
    expect([gap["reason"] for gap in found["gaps"]] == ["not installed"] * 2, f"without peers: {found['gaps']}")
    install("tachyon", "echo working; echo 'Tachyon: no such file' >&2; exit 1")
    install("povray", "echo hi")
    found = measure()
    reasons = {gap["name"]: gap["reason"] for gap in found["gaps"] if gap["is_installed"]}
    expect(reasons["Tachyon"] == "Tachyon: no such file", f"Tachyon: {reasons}")
    expect("no time" in reasons["POV-Ray"], f"POV-Ray: {reasons}")
    # One program is measured and makes a black picture; the other is too fast for its own clock.
    picture = "printf 'P6\\n16 16\\n65535\\n' >tachyon.ppm; head -c 1536 /dev/zero >>tachyon.ppm"
    install("tachyon", f"{picture}; echo 'Version 0.5 Ray Tracing Time: 2.5'")
    install("povray", "echo 'Version 3.7'; echo '  Trace Time:  0 hours  0 minutes  0 seconds (0.000 seconds)'")
    found = measure()
    expect(found["rows"], f"a peer that works was not measured: {found}")
    row = found["rows"][0]
    expect(row["peer"] == "Tachyon 0.5" and row["peer_ms"] == [2500.0], f"a peer that is measured: {row}")
    expect("less time" in found["gaps"][0]["reason"], f"a renderer whose time is 0: {found['gaps']}")
    expect(row["mean_difference"] > 0.01 and row["time_ratio"] == [row["promin_ms"][0] / 2500.0], f"{row}")


def names_the_gap_of_mitsuba(folder):
    """Mitsuba may be missing or fail; the reason is its last line."""
    gap = folder / "gap.json"
    for problem, reason in (
        ("ModuleNotFoundError(\"No module named 'mitsuba'\")", "not installed"),
        ("RuntimeError('no LLVM')", "RuntimeError: no LLVM (it may need another LLVM, which DRJIT_LIBLLVM_PATH names)"),
    ):
        (folder / "mitsuba.py").write_text(f"raise {problem}\n", encoding="utf-8")
        environment = {**os.environ, "PYTHONPATH": str(folder)}
        done = run_python("mitsuba_rates.py", folder / "none.json", folder, gap, environment=environment)
        expect(done.returncode == 0, f"mitsuba_rates.py: {done.stderr}")
        found = read_json(gap)["mitsuba"]
        expect(not found["rows"] and [gap["reason"] for gap in found["gaps"]] == [reason], f"{problem}: {found}")


def measures_processes(folder):
    """A process with empty caches compiles its kernels; the next one takes them from the caches. A process that fails
    is an error."""
    rows = processes.measure(BIN / "promin", [(SCENES / "sphere.gltf", 16)], 2)
    expect([row["scene"] for row in rows] == ["sphere.gltf"], f"rows: {rows}")
    times = [rows[0][f"{caches}_{clock}"] for caches in ("cached", "empty") for clock in ("cpu_s", "s")]
    expect(all(len(runs) == 2 and min(runs) > 0.0 for runs in times), f"times: {rows}")
    expect(max(rows[0]["cached_cpu_s"]) < min(rows[0]["empty_cpu_s"]), f"kernels are not compiled, or twice: {rows}")
    row = processes.measure_uses(BIN / "promin-lab", SCENES / "sphere.gltf", 1)
    expect(row["uses"] == "light, AOVs, normals, target error", f"uses: {row}")
    expect(0.0 < row["cached_compile_ms"][0] < row["empty_compile_ms"][0], f"kernels are compiled twice: {row}")
    expect(row["empty_compile_ms"][0] < 1e3 * row["empty_cpu_s"][0] * os.cpu_count(), f"more than all time: {row}")
    try:
        processes.measure(BIN / "promin", [(folder / "none.gltf", 16)], 1)
    except RuntimeError as problem:
        expect("none.gltf" in str(problem), f"another error: {problem}")
    else:
        expect(False, "a process that failed was measured")


def _cells(text):
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines()]


def check_bench_tables(folder):
    system = folder / "system"
    system.mkdir()
    run_lab("rates", "wavy:500", "--runs", 1, "--side", 32, "-o", system / "rates.json")
    run_lab("growth", "--quick", "--runs", 1, "--side", 32, "-o", folder / "growth.json")
    process = {"scene": "a.gltf", "width": 16, "cached_cpu_s": [2.0], "cached_s": [3.0]}
    process |= {"empty_cpu_s": [5.0], "empty_s": [4.0]}
    uses = {"scene": "b.gltf", "uses": "light, AOVs", "cached_cpu_s": [2.0], "cached_compile_ms": [3.0]}
    uses |= {"empty_cpu_s": [5.0], "empty_compile_ms": [4.0]}
    content = {"processes": {"rows": [process], "uses": [uses]}}
    (system / "processes.json").write_text(json.dumps(content), encoding="utf-8")
    rays = {"scene": "c", "rays": "camera", "count": 1000, "peer": "Mitsuba 9", "peer_ms": [4.0], "peer_cpu_ms": [7.0]}
    rays |= {"promin_ms": [6.0], "differing_hits": 0}
    gap = {"name": "Mitsuba", "is_installed": True, "reason": "no LLVM"}
    (system / "mitsuba.json").write_text(json.dumps({"mitsuba": {"rows": [rays], "gaps": [gap]}}), encoding="utf-8")
    done = run_python("bench_tables.py", "-o", folder / "bench.json", "--growth", folder / "growth.json", system)
    expect(done.returncode == 0, f"bench_tables.py: {done.stderr}")
    lines = _cells(done.stdout)
    files = (system / f"{name}.json" for name in ("rates", "processes", "mitsuba"))
    report = {key: value for file in files for key, value in read_figures(file).items()}
    cells = next(line for line in lines if line[1:2] == ["b.gltf"])
    expect([cell.split(" ")[0] for cell in cells[2:]] == ["light,", "3", "2", "4", "5"], f"other uses: {cells}")
    cells = next(line for line in lines if line[1:2] == ["c"])
    expect(cells[6].startswith("4 ") and cells[7:] == ["1.5", "7,000", "0"], f"other times of Mitsuba: {cells}")
    expect("Not measured: Mitsuba, which failed: no LLVM" in done.stdout, done.stdout)
    cells = next(line for line in lines if line[1:2] == ["a.gltf"])
    expect([cell[0] for cell in cells[3:]] == ["2", "3", "5", "4"], f"other processes: {cells}")
    for row in report["rates"]["rows"]:
        cells = next(line for line in lines if line[1:3] == [row["scene"], row["rays"]])
        expect(cells[4] == number(row["promin_mrays_per_s"]), f"another rate than {row}: {cells}")
        expect(cells[-4] == number(row["node_steps_per_ray"]), f"other steps than {row}: {cells}")
    rows = [row for row in read_json(folder / "growth.json")["growth"]["rows"] if row["curve"] == "camera"]
    fit = fit_doublings([row["value"] for row in rows], [row["node_steps_per_ray"] for row in rows])
    cells = next(line for line in lines if line[0].startswith("steps a doubling"))
    expect(cells[1] == f"{fit['per_doubling']:.2f} ({fit['r_squared']:.3f})", f"another growth than {fit}: {cells}")
    expect(read_json(folder / "bench.json")["drivers"]["system"] == report, "bench.json has other figures")


def check_accuracy_document(folder):
    (folder / "system.log").touch()
    run_lab("robustness", "wavy:500", "--runs", 1, "--side", 32, "-o", folder / "system" / "robustness.json")
    report = read_figures(folder / "system" / "robustness.json")
    hard = {"driver": report["provenance"]["driver"], "failed": [], "primitives": {}, "rows": []}
    (folder / "system.json").write_text(json.dumps(hard), encoding="utf-8")
    done = run_python("accuracy_document.py", folder)
    expect(done.returncode == 0, f"accuracy_document.py: {done.stderr}")
    lines = _cells(done.stdout)
    for row in report["robustness"]["rows"]:
        cells = next(line for line in lines if line[0] == row["scene"] and line[2] == row["rays"])
        expect(cells[6:] == [str(row["only_promin_hits"]), str(row["only_textbook_hits"])], f"{row}: {cells}")
    edges = next(row for row in report["robustness"]["rows"] if row["rays"] == "edges")
    expect(edges["promin_hits"] == edges["count"], f"promin loses rays inside of a closed mesh: {edges}")


def check_picture_rays(folder):
    """promin-lab rates compares a picture with its rays, and writes the rays as files that cast reads."""
    rays = folder / "rays"
    scene = SCENES / "showcase.gltf"
    options = ("--runs", 1, "--side", 64, "--max-depth", 2, "--rays", rays, "-o", folder / "runs.json")
    done = run_program(BIN / "promin-lab", "rates", scene, *options)
    is_refused = done.returncode == 1 and "the folder does not exist" in done.stderr and not done.stdout
    expect(is_refused, f"a folder is missing: {done}")
    rays.mkdir()
    expect("of what its own" in run_lab("rates", scene, *options), "no picture is compared with its rays")
    rates = read_json(folder / "runs.json")["rates"]
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
    # The rays follow the picture's rules. The scenes have highlights without diffuse light, colours, cones and parallel
    # cameras.
    names = "showcase metallic_roughness vertex_colors light_spot light_physical orthographic mirrors"
    scenes = [SCENES / f"{name}.gltf" for name in names.split()]
    run_lab("rates", *scenes, "--runs", 1, "--side", 64, "-o", folder / "runs.json")
    for part in read_json(folder / "runs.json")["rates"]["pictures"]:
        apart = abs(part["count"] - part["traced_rays"])
        expect(apart <= max(3, 1e-3 * part["traced_rays"]), f"other rays than the picture's: {part}")
    done = run_program(BIN / "promin-lab", "rates", scene, "--runs", 0, "--rays", rays)
    expect(done.returncode == 2 and "--runs 0" in done.stderr, f"rays without a picture: {done}")


def check_instances_tables(folder):
    """Embree is measured if it is installed."""
    run_lab("instances", "--quick", "--runs", 1, "--side", 32, "-o", folder / "instances.json")
    rows = read_json(folder / "instances.json")["instances"]["rows"]
    expect([row["count"] for row in rows] == [10, 1000], f"other scenes: {rows}")
    expect(rows[0]["copies_bytes"] > 5 * rows[0]["instances_bytes"], f"instances do not share: {rows[0]}")
    growth = rows[1]["instances_bytes"] - rows[0]["instances_bytes"]
    expect(0 < growth < 990 * 200, f"990 instances take {growth} bytes")
    done = run_python("instances_tables.py", folder / "instances.json")
    expect(done.returncode == 0, f"instances_tables.py: {done.stderr}")
    lines = _cells(done.stdout)
    few, many = (next(line for line in lines if line[0] == f"wavy:2000 × {count}") for count in ("10", "1,000"))
    expect("–" in many and few[1] != "–", f"other rates: {few}, {many}")


def makes_tables(folder):
    """Checks the tables of tools/bench and tools/accuracy, and a table for the terminal."""
    check_bench_tables(folder)
    check_instances_tables(folder)
    check_accuracy_document(folder)
    printed = run_lab("rates", "needles:500", "--runs", 0, "--side", 16, "-o", folder / "runs.json")
    expect("needles:500, 500 primitives" in printed, printed)
    rows = read_json(folder / "runs.json")["rates"]["rows"]
    expect([row["rays"] for row in rows] == ["camera", "shadow", "random"], f"promin-lab rates: {rows}")
    expect(rows[0]["count"] == 256 and "promin_ms" not in rows[0], f"it should only count steps: {rows}")
    check_picture_rays(folder)


def writes_a_report(folder):
    """Checks a quick page on a scene of the user's: it has pictures, one plot, a row for each knob and a footer."""
    scene = SCENES / "mirrors.gltf"
    done = run_python("report.py", scene, "--quick", "--programs", BIN, "--commit", "abc", "-o", folder / "out")
    expect(done.returncode == 0, f"report.py: {done.stderr[-2000:]}")
    page = (folder / "out" / "report.html").read_text(encoding="utf-8")
    figures = read_json(folder / "out" / "figures.json")
    expect(not re.search(r"(src|href)=['\"]?(http|//|file)", page), "the page needs other files")
    expect("A quick report" in page, "the page does not say that it is quick")
    expect(page.count("<svg") == 1 and page.count('<img src="data:image/png;base64,') == 7, "other pictures")
    knobs = re.findall(r"<h3>([^<]*)</h3>", page)
    expect(knobs == ["Samples", "Target error", "Depth", "Builder", "Robust methods"], f"other knobs: {knobs}")
    footer = page[page.index("<footer>") :]
    expect("commit abc" in footer and figures["methods"]["provenance"]["driver"] in footer, f"the footer: {footer}")
    expect(scene.name in page and str(folder) not in page, "the page names the folder, or not the scene")
    names = {row["renderer"] for row in figures["renderers"]["rows"]}
    missing = {gap["name"] for gap in figures["renderers"]["gaps"]}
    expect(names | missing == {"promin", "Tachyon", "POV-Ray"} and not names & missing, f"{names}, {missing}")
    for name in missing:
        expect(name in page, f"the page does not name {name}, which is missing")
    # These results hold on any machine: more samples are more exact, a tree does not change a picture, and promin loses
    # no ray.
    own = [row["error"] for row in figures["renderers"]["rows"] if row["renderer"] == "promin"]
    expect(own == sorted(own, reverse=True) and own[-1] > 0, f"errors of more and more samples: {own}")
    builders = [row["error"] for row in figures["knobs"] if row["knob"] == "builder"]
    expect(len(builders) == 3 and len(set(builders)) == 1, f"errors of builders: {builders}")
    expect(figures["methods"]["lost_by_promin"] == 0, f"{figures['methods']}")
    done = run_python("report.py", folder / "none.gltf", "--programs", BIN, "-o", folder / "none")
    expect(done.returncode == 1 and "no such scene" in done.stderr, f"a scene that is not there: {done}")


TESTS = (
    computes_figures,
    draws_claims,
    measures_processes,
    names_gaps,
    names_the_gap_of_mitsuba,
    makes_tables,
    writes_a_report,
)
TESTS = {test.__name__: test for test in TESTS}

with tempfile.TemporaryDirectory() as name:
    TESTS[sys.argv[1]](pathlib.Path(name))
