#!/usr/bin/env python3
# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Adds to FOLDER/runs.json what the sphereflake takes promin, Tachyon and POV-Ray, in turns on the same cores, and what
the first picture takes."""

import argparse
import hashlib
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))

from report_file import read_report, write_report
from scene_to_pov import write_pov
from scene_to_tachyon import write_tachyon
from scenegen.sphereflake import sphereflake

_MAX_DEPTH = 6


def _run(*command, folder):
    """The standard output and error of a program, and the milliseconds that it took."""
    start = time.monotonic()
    words = [str(word) for word in command]
    done = subprocess.run(
        words, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace"
    )
    took_ms = 1e3 * (time.monotonic() - start)
    if done.returncode != 0:
        raise RuntimeError(f"{words[0]} failed:\n{done.stdout[-2000:]}")
    return done.stdout, took_ms


class _Peer:
    """Another renderer of the sphereflake. The pattern finds the seconds of its tracing in what it says."""

    def __init__(self, name, command, picture, seconds):
        self.name, self.picture, self.version = name, picture, ""
        self.trace_ms, self.failure, self.difference = [], None, {}
        self._command, self._seconds = command.split(), re.compile(seconds)

    def render(self, folder):
        output, _ = _run(*self._command, folder=folder)
        version = re.search(r"Version ([\d.]*\d)", output)
        seconds = self._seconds.search(output)
        if not version or not seconds:
            raise RuntimeError(f"{self.name} tells of no version or no time: {output[-300:]}")
        self.version = self.name + " " + version.group(1)
        trace_ms = 1e3 * float(seconds.group(1))
        if not trace_ms > 0.0:
            raise RuntimeError(f"{self.name} traces in less time than it can tell")
        self.trace_ms.append(trace_ms)

    def attempt(self, work, *arguments):
        """Its last line is the reason why it is not measured."""
        if self.failure is None:
            try:
                return work(*arguments)
            except RuntimeError as problem:
                self.failure = str(problem).strip().splitlines()[-1]


def _find_peers(folder, scene, side):
    """Those that are installed, with the scene in their languages."""
    threads = os.cpu_count()
    if shutil.which("tachyon"):
        (folder / "flake.dat").write_text(write_tachyon(scene, "0", _MAX_DEPTH, side), encoding="utf-8")
        command = f"tachyon flake.dat -fullshade -shade_phong -format PPM48 -numthreads {threads} -o tachyon.ppm"
        yield _Peer("Tachyon", command, "tachyon.ppm", r"Ray Tracing Time:\s*([\d.]+)")
    if shutil.which("povray"):
        (folder / "flake.pov").write_text(write_pov(scene, "0", _MAX_DEPTH), encoding="utf-8")
        command = f"povray +Iflake.pov +Opovray.exr +FE -A -D +W{side} +H{side} +WT{threads}"
        yield _Peer("POV-Ray", command, "povray.exr", r"Trace Time:.*\(([\d.]+) seconds\)")


class _Promin:
    """`promin render` of the sphereflake and of one sphere."""

    def __init__(self, programs, folder, side, device):
        self._program, self._folder, self._side = programs / "promin", folder, side
        self._device = ("--device", device) if device else ()
        self.trace_ms, self.process_ms, self.one_sphere_process_ms, self.rays = [], [], [], {}

    def _render(self, name, side):
        """Device milliseconds of the tracing, and of the whole process by the clock on the wall; and the rays."""
        command = (self._program, "render", f"{name}.gltf", "-o", f"{name}.exr", "--size", side, side, *self._device)
        settings = ("--spp", 1, "--max-depth", _MAX_DEPTH, "--quiet", "--stats", "stats.json")
        _, took_ms = _run(*command, *settings, folder=self._folder)
        stats = json.loads((self._folder / "stats.json").read_text(encoding="utf-8"))
        return stats["times_ms"]["trace"], took_ms, stats["rays"]

    def render(self):
        trace_ms, process_ms, self.rays = self._render("flake", self._side)
        self.trace_ms.append(trace_ms)
        self.process_ms.append(process_ms)
        self.one_sphere_process_ms.append(self._render("ball", 16)[1])

    def forget_times(self):
        for times in (self.trace_ms, self.process_ms, self.one_sphere_process_ms):
            times.clear()


def _ratios(times, others):
    return [own / other for own, other in zip(times, others)]


def _run_turns(promin, peers, runs, folder):
    """Every contestant once a turn; a peer that fails drops out. Returns why promin failed, or None."""
    try:
        # The round before the first only warms caches.
        for turn in range(runs + 1):
            promin.render()
            for peer in peers:
                peer.attempt(peer.render, folder)
            if turn == 0:
                promin.forget_times()
                for peer in peers:
                    peer.trace_ms.clear()
    except RuntimeError as problem:
        return str(problem).strip().splitlines()[-1]
    return None


def _row_of(peer, promin, difference):
    """Of a whole picture by both."""
    return {
        "promin_ms": promin.trace_ms,
        "peer_ms": peer.trace_ms,
        "time_ratio": _ratios(promin.trace_ms, peer.trace_ms),
        "mean_difference": difference["mean_absolute"],
        "different_pixels_percent": difference["different_percent"],
    }


def _first_row(promin):
    """Of the first picture, which may take its tracing and twice a whole process that does next to nothing."""
    allowed_ms = [trace + 2 * small for trace, small in zip(promin.trace_ms, promin.one_sphere_process_ms)]
    return {
        "trace_ms": promin.trace_ms,
        "process_ms": promin.process_ms,
        "one_sphere_process_ms": promin.one_sphere_process_ms,
        "allowed_ms": allowed_ms,
        "time_ratio": _ratios(promin.process_ms, allowed_ms),
        "rays": sum(promin.rays.values()),
        "shadow_rays": promin.rays["shadow"],
    }


def _compare(programs, folder, peer):
    """How far the peer's picture is from promin's; None where that fails, which the peer then tells."""
    output = peer.attempt(lambda: _run(programs / "promin-peer-difference", "flake.exr", peer.picture, folder=folder)[0])
    return json.loads(output) if output is not None else None


def measure(programs, folder, runs, side, level, device):
    """The section: "rows" of peers, "first" for the first picture, "gaps"."""
    for name, depth in (("flake", level), ("ball", 0)):
        sphereflake(depth, has_endless_ground=True).write(folder / f"{name}.gltf")
    scene = f"sphereflake:{level}"
    scene_hash = hashlib.sha256((folder / "flake.gltf").read_bytes()).hexdigest()[:16]
    of_scene = {"scene": scene, "scene_hash": scene_hash}
    peers = {peer.name: peer for peer in _find_peers(folder, folder / "flake.gltf", side)}
    promin = _Promin(programs, folder, side, device)
    section = {"rows": [], "first": [], "gaps": []}
    failure = _run_turns(promin, peers.values(), runs, folder)
    what = f"a picture of {side} by {side} pixels, {_MAX_DEPTH} bounces"
    for name in ("Tachyon", "POV-Ray"):
        peer = peers.get(name)
        difference = _compare(programs, folder, peer) if peer and not failure else None
        if difference is not None:
            head = {"id": f"{scene}/picture/{name}", **of_scene, "peer": peer.version, "what": what}
            section["rows"].append({**head, **_row_of(peer, promin, difference)})
            continue
        reason = failure or (peer.failure if peer else None)
        section["gaps"].append({"name": name, "is_installed": bool(reason), "reason": reason or "not installed"})
    if not failure:
        section["first"].append({"id": f"{scene}/first", **of_scene, **_first_row(promin)})
    return section


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=pathlib.Path, help="with runs.json; runs and device are those of its provenance")
    parser.add_argument("--programs", type=pathlib.Path, required=True, help="folder of the built programs")
    parser.add_argument("--side", type=int, help="pixels each way [1024; 64 of a quick report]")
    parser.add_argument("--level", type=int, help="of the sphereflake [4, of 7381 spheres; 2 of a quick report]")
    arguments = parser.parse_args()
    file = arguments.folder / "runs.json"
    report = read_report(file)
    p = report["provenance"]
    side = arguments.side or (64 if p["is_quick"] else 1024)
    level = arguments.level or (2 if p["is_quick"] else 4)
    with tempfile.TemporaryDirectory() as folder:
        programs = arguments.programs.resolve()
        report["peers"] = measure(programs, pathlib.Path(folder), p["runs"], side, level, p.get("device_wanted"))
    write_report(report, file)


if __name__ == "__main__":
    main()
