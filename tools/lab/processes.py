#!/usr/bin/env python3
# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Measures whole processes of `promin render` with one sample per pixel: the CPU time and the elapsed time of the first
picture, with kernels in the caches and with empty caches. Also measures a process that uses a scene in several ways one
after the other, and how long its kernels take to compile. tools/bench calls this program."""

import argparse
import json
import os
import pathlib
import subprocess
import tempfile
import time

_SCENES = pathlib.Path(__file__).resolve().parents[2] / "scenes"
_PICTURES = [(_SCENES / f"{name}.gltf", size) for name, size in (("sphere", 64), ("showcase", 640), ("glass", 640))]
_MODEL_WIDTH = 640


def measure_process(command, caches, output=subprocess.DEVNULL):
    """Runs the command with the caches of this folder. Returns its CPU time and its elapsed time in seconds."""
    environment = {**os.environ, "MESA_SHADER_CACHE_DIR": f"{caches}/driver", "XDG_CACHE_HOME": f"{caches}/promin"}
    start = time.monotonic()
    process = subprocess.Popen(command, env=environment, stdout=output, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    took_s = time.monotonic() - start
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        raise RuntimeError(f"{' '.join(map(str, command))} failed")
    return usage.ru_utime + usage.ru_stime, took_s


def measure_uses(program, scene, runs):
    """Returns a row with the times of a process that uses the scene for a picture, for AOVs, for a debug view and for a
    target error, and with the times in which its kernels compile. Turns are those of measure()."""
    row = {"scene": scene.name, "uses": ""}
    for _ in range(runs):
        with tempfile.TemporaryDirectory() as folder:
            for caches in ("empty", "cached"):
                with tempfile.TemporaryFile("w+", encoding="utf-8") as output:
                    cpu_s, _ = measure_process([program, "kernels", scene], folder, output)
                    output.seek(0)
                    uses = json.load(output)
                row["uses"] = ", ".join(use["use"] for use in uses)
                row.setdefault(f"{caches}_cpu_s", []).append(cpu_s)
                row.setdefault(f"{caches}_compile_ms", []).append(sum(use["compile_ms"] for use in uses))
    return row


def measure(program, pictures, runs):
    """Returns a row for each picture. A turn measures each picture with empty caches, and then with the caches that
    this has filled."""
    rows = [
        {"scene": scene.name, "width": width, "cached_cpu_s": [], "cached_s": [], "empty_cpu_s": [], "empty_s": []}
        for scene, width in pictures
    ]
    for _ in range(runs):
        for row, (scene, width) in zip(rows, pictures):
            with tempfile.TemporaryDirectory() as folder:
                command = [program, "render", scene, "-o", f"{folder}/picture.png", "--size", str(width), "--spp", "1"]
                for caches in ("empty", "cached"):
                    cpu_s, took_s = measure_process(command, folder)
                    row[f"{caches}_cpu_s"].append(cpu_s)
                    row[f"{caches}_s"].append(took_s)
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("output", type=pathlib.Path, help=".json file to write")
    parser.add_argument("models", nargs="*", type=pathlib.Path, help="scenes to measure too, 640 pixels wide")
    parser.add_argument("--programs", type=pathlib.Path, required=True, help="folder of the built programs")
    parser.add_argument("--runs", type=int, default=5)
    arguments = parser.parse_args()
    pictures = _PICTURES + [(model, _MODEL_WIDTH) for model in arguments.models]
    rows = measure(arguments.programs / "promin", pictures, arguments.runs)
    uses = [measure_uses(arguments.programs / "promin-lab", _SCENES / "showcase.gltf", arguments.runs)]
    arguments.output.write_text(json.dumps({"processes": {"rows": rows, "uses": uses}}) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
