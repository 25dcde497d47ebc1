#!/usr/bin/env python3
# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Measures promin on the Vulkan driver that the environment names, beside its peers; tools/bench calls it.

Writes as JSON: rates and builds by promin-bench; the sphereflake of 7381 mirror spheres beside Tachyon and POV-Ray;
how long the first picture takes; how the steps of a ray grow with the number of triangles.
"""

import argparse
import json
import math
import os
import pathlib
import re
import shutil
import statistics
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

from scene_to_pov import write_pov
from scene_to_tachyon import write_tachyon
from scenegen.sphereflake import sphereflake

_SIDE = "1024"
_MAX_DEPTH = 6
_STEP_MESHES = (10_000, 30_000, 100_000, 300_000, 1_000_000, 3_000_000, 5_000_000)
_MOST_QUICK = 300_000


def run(*command, folder):
    """The standard output and error of a program, and the seconds that it took."""
    start = time.monotonic()
    words = [str(word) for word in command]
    done = subprocess.run(
        words, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace"
    )
    seconds = time.monotonic() - start
    if done.returncode != 0:
        raise RuntimeError(f"{words[0]} failed:\n{done.stdout[-2000:]}")
    return done.stdout, seconds


def quartiles(values):
    if len(values) < 2:
        return {"median": values[0], "lower_quartile": values[0], "upper_quartile": values[0]}
    lower, median, upper = statistics.quantiles(values, n=4, method="inclusive")
    return {"median": median, "lower_quartile": lower, "upper_quartile": upper}


class Peer:
    """Another renderer of the sphereflake. The pattern finds the seconds of its tracing in what it says."""

    def __init__(self, name, command, picture, seconds):
        self.name, self.picture = name, picture
        self._command, self._seconds = command.split(), re.compile(seconds)
        self.trace_ms, self.version = [], ""

    def render(self, folder):
        output, _ = run(*self._command, folder=folder)
        version = re.search(r"Version ([\d.]*\d)", output)
        seconds = self._seconds.search(output)
        if not version or not seconds:
            raise RuntimeError(f"{self.name} tells of no version or no time: {output[-300:]}")
        self.version = self.name + " " + version.group(1)
        return 1e3 * float(seconds.group(1))


def find_peers(folder, scene, side):
    """Those that are installed, with the scene in their languages."""
    peers = []
    threads = os.cpu_count()
    if shutil.which("tachyon"):
        (folder / "flake.dat").write_text(write_tachyon(scene, "0", _MAX_DEPTH, side), encoding="utf-8")
        command = f"tachyon flake.dat -fullshade -shade_phong -format PPM48 -numthreads {threads} -o tachyon.ppm"
        peers.append(Peer("Tachyon", command, "tachyon.ppm", r"Ray Tracing Time:\s*([\d.]+)"))
    if shutil.which("povray"):
        (folder / "flake.pov").write_text(write_pov(scene, "0", _MAX_DEPTH), encoding="utf-8")
        command = f"povray +Iflake.pov +Opovray.exr +FE -A -D +W{side} +H{side} +WT{threads}"
        peers.append(Peer("POV-Ray", command, "povray.exr", r"Trace Time:.*\(([\d.]+) seconds\)"))
    return peers


def render(programs, folder, scene, picture, side, options=()):
    """Device milliseconds of the tracing, and of the whole process by the clock on the wall; and the rays."""
    command = (programs / "promin", "render", scene, "-o", picture, "--size", side, side)
    settings = ("--max-depth", _MAX_DEPTH, "--quiet", "--stats", "stats.json", *options)
    _, seconds = run(*command, *settings, folder=folder)
    stats = json.loads((folder / "stats.json").read_text(encoding="utf-8"))
    return stats["times_ms"]["trace"], 1e3 * seconds, stats["rays"]


def time_frames(programs, folder, runs, side=_SIDE, level=4, options=()):
    """The sphereflake and one sphere, in turns with the peers; the round before the first only warms caches. `options`
    are further ones of `promin render`. Milliseconds of each run; of a peer that fails the last line that it said under
    "failures", and nothing else."""
    for name, depth in (("flake", level), ("ball", 0)):
        sphereflake(depth, has_endless_ground=True).write(folder / f"{name}.gltf")
    peers = find_peers(folder, folder / "flake.gltf", side)
    times = {"trace_ms": [], "process_ms": [], "one_sphere_process_ms": [], "peers": {}, "failures": {}}
    for turn in range(runs + 1):
        trace, process, times["rays"] = render(programs, folder, "flake.gltf", "flake.exr", side, options)
        _, small, _ = render(programs, folder, "ball.gltf", "ball.exr", 16, options)
        for peer in [peer for peer in peers if peer.name not in times["failures"]]:
            try:
                peer.trace_ms.append(peer.render(folder))
            except RuntimeError as problem:
                times["failures"][peer.name] = str(problem).strip().splitlines()[-1]
        if turn == 0:
            for peer in peers:
                peer.trace_ms.clear()
            continue
        for name, time_ms in (("trace_ms", trace), ("process_ms", process), ("one_sphere_process_ms", small)):
            times[name].append(time_ms)
    for peer in [peer for peer in peers if peer.name not in times["failures"]]:
        try:
            output, _ = run(programs / "promin-compare", "flake.exr", peer.picture, folder=folder)
        except RuntimeError as problem:
            times["failures"][peer.name] = str(problem).strip().splitlines()[-1]
            continue
        difference = json.loads(output)
        times["peers"][peer.name] = {
            "version": peer.version,
            "trace_ms": peer.trace_ms,
            "picture_difference": difference,
        }
    return times


def measure_frames(programs, folder, runs):
    """Quartiles of what time_frames tells, and of ratios of the same turn. A peer that fails is an error."""
    times = time_frames(programs, folder, runs)
    for name, line in times["failures"].items():
        raise RuntimeError(f"{name} failed: {line}")
    process_ms, small_ms = times["process_ms"], times["one_sphere_process_ms"]
    # What the first picture may take: its tracing and twice a whole process that does next to nothing.
    allowed_ms = [trace + 2 * small for trace, small in zip(times["trace_ms"], small_ms)]
    return {
        "rays": times["rays"],
        "trace_ms": quartiles(times["trace_ms"]),
        "first_image": {
            "process_ms": quartiles(process_ms),
            "one_sphere_process_ms": quartiles(small_ms),
            "allowed_ms": quartiles(allowed_ms),
            "ratio": quartiles([p / a for p, a in zip(process_ms, allowed_ms)]),
        },
        "peers": {
            name: {
                "version": peer["version"],
                "trace_ms": quartiles(peer["trace_ms"]),
                "time_ratio": quartiles([own / other for own, other in zip(times["trace_ms"], peer["trace_ms"])]),
                "picture_difference": peer["picture_difference"],
            }
            for name, peer in times["peers"].items()
        },
    }


def measure_rates(programs, folder, scenes, runs, side, name):
    file = f"{name}.rates.json"
    output, _ = run(programs / "promin-bench", *scenes, "--runs", runs, "--side", side, "-o", file, folder=folder)
    print(output, file=sys.stderr)
    return json.loads((folder / file).read_text(encoding="utf-8"))


def fit_line(xs, ys):
    """Slope and intercept of least squares, and the share of the variance that they explain."""
    slope, intercept = statistics.linear_regression(xs, ys)
    return {"slope": slope, "intercept": intercept, "r_squared": statistics.correlation(xs, ys) ** 2}


def measure_growth(programs, folder, most):
    """Steps a ray over the number of triangles of the wavy sphere; these counts do not depend on the driver."""
    file = "growth.json"
    meshes = [f"wavy:{count}" for count in _STEP_MESHES if count <= most]
    run(programs / "promin-bench", *meshes, "--runs", 0, "--side", 512, "-o", file, folder=folder)
    scenes = json.loads((folder / file).read_text(encoding="utf-8"))["scenes"]
    growth = {"triangles": [scene["primitives"] for scene in scenes]}
    doublings = [math.log2(count) for count in growth["triangles"]]
    for i, rays in enumerate(entry["rays"] for entry in scenes[0]["sets"]):
        steps = [scene["sets"][i]["node_steps_per_ray"] for scene in scenes]
        tests = [scene["sets"][i]["primitive_tests_per_ray"] for scene in scenes]
        growth[rays] = {"node_steps": steps, "primitive_tests": tests, "steps_per_doubling": fit_line(doublings, steps)}
    return growth


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument(
        "name", help="of the driver: swiftshader is spared whole pictures, which it compiles for minutes"
    )
    parser.add_argument("scenes", nargs="+", help="as promin-bench takes them")
    parser.add_argument("--quick", action="store_true", help="fewer runs and no mesh beyond 300,000 triangles")
    parser.add_argument("--programs", type=pathlib.Path, required=True, help="folder of the built programs")
    parser.add_argument("--work", type=pathlib.Path, required=True, help="folder for pictures and scenes")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True, help="the .json file")
    arguments = parser.parse_args()
    programs, work = arguments.programs.resolve(), arguments.work.resolve()
    is_slow = arguments.name == "swiftshader"
    runs = 3 if arguments.quick or is_slow else 9
    try:
        figures = {"name": arguments.name, "runs": runs}
        scenes, side = (arguments.scenes[:1], 512) if is_slow else (arguments.scenes, _SIDE)
        figures.update(measure_rates(programs, work, scenes, runs, side, arguments.name))
        if not is_slow:
            figures["sphereflake"] = measure_frames(programs, work, runs)
        if arguments.name == "system":
            figures["growth"] = measure_growth(programs, work, _MOST_QUICK if arguments.quick else _STEP_MESHES[-1])
    except RuntimeError as problem:
        sys.exit(f"bench_driver: error: {problem}")
    arguments.output.write_text(json.dumps(figures, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
