#!/usr/bin/env python3
# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Measures the times of promin, Tachyon and POV-Ray for the sphereflake in turns. tools/bench calls this
program. The page of tools/report uses its classes."""

import argparse
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

from scene_to_pov import write_pov
from scene_to_tachyon import write_tachyon
from scenegen.sphereflake import sphereflake

MAX_DEPTH = 6
PEERS = ("Tachyon", "POV-Ray")


def run_program(*command, folder):
    """Runs a program and returns its output and errors as text, and its time in milliseconds. Throws RuntimeError."""
    start = time.monotonic()
    words = [str(word) for word in command]
    done = subprocess.run(
        words, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace"
    )
    took_ms = 1e3 * (time.monotonic() - start)
    if done.returncode != 0:
        raise RuntimeError(f"{words[0]} failed:\n{done.stdout[-2000:]}")
    return done.stdout, took_ms


def last_line(problem):
    return str(problem).strip().splitlines()[-1]


class Peer:
    """Another renderer of the sphereflake. `sampling` maps a number of samples to arguments; the pattern finds the
    seconds of tracing in the program's output."""

    def __init__(self, name, command, picture, seconds, sampling):
        self.name, self.picture, self.version = name, picture, ""
        self.trace_ms, self.failure = [], None
        self._command, self._seconds, self._sampling = command.split(), re.compile(seconds), sampling

    def render(self, folder, samples=1):
        """Returns the time of tracing in milliseconds."""
        output, _ = run_program(*self._command, *self._sampling(samples).split(), folder=folder)
        version = re.search(r"Version ([\d.]*\d)", output)
        seconds = self._seconds.search(output)
        if not version or not seconds:
            raise RuntimeError(f"{self.name} prints no version or no time: {output[-300:]}")
        self.version = self.name + " " + version.group(1)
        trace_ms = 1e3 * float(seconds.group(1))
        if not trace_ms > 0.0:
            raise RuntimeError(f"{self.name} prints a time of 0: it traces in less time than its clock resolves")
        return trace_ms

    def attempt(self, work, *arguments):
        """Returns work(*arguments). Returns None after a failure, whose last line is the reason why this peer is not
        measured."""
        if self.failure is None:
            try:
                return work(*arguments)
            except RuntimeError as problem:
                self.failure = last_line(problem)
        return None


def _povray_sampling(samples):
    return "-A" if samples == 1 else f"+A0.0 +AM1 -J +R{round(samples**0.5)}"


def find_peers(folder, scene, side):
    """Yields the peers that are installed, and writes the scene in their languages."""
    threads = os.cpu_count()
    if shutil.which("tachyon"):
        (folder / "flake.dat").write_text(write_tachyon(scene, "0", MAX_DEPTH, side), encoding="utf-8")
        command = f"tachyon flake.dat -fullshade -shade_phong -format PPM48 -numthreads {threads} -o tachyon.ppm"
        seconds = r"Ray Tracing Time:\s*([\d.]+)"
        yield Peer("Tachyon", command, "tachyon.ppm", seconds, lambda samples: f"-aasamples {samples - 1}")
    if shutil.which("povray"):
        (folder / "flake.pov").write_text(write_pov(scene, "0", MAX_DEPTH), encoding="utf-8")
        command = f"povray +Iflake.pov +Opovray.exr +FE -D +W{side} +H{side} +WT{threads}"
        yield Peer("POV-Ray", command, "povray.exr", r"Trace Time:.*\(([\d.]+) seconds\)", _povray_sampling)


def gap_of(name, peer, failure=None):
    reason = failure or (peer.failure if peer else None)
    return {"name": name, "is_installed": bool(reason), "reason": reason or "not installed"}


class _Promin:
    """Runs `promin render` on the sphereflake."""

    def __init__(self, programs, folder, side):
        self._program, self._folder, self._side = programs / "promin", folder, side
        self.trace_ms = []

    def render(self):
        command = (self._program, "render", "flake.gltf", "-o", "flake.exr", "--size", self._side, self._side)
        settings = ("--spp", 1, "--max-depth", MAX_DEPTH, "--quiet", "--stats", "stats.json")
        run_program(*command, *settings, folder=self._folder)
        stats = json.loads((self._folder / "stats.json").read_text(encoding="utf-8"))
        self.trace_ms.append(stats["times_ms"]["trace"])


def _run_turns(promin, peers, runs, folder):
    """Runs every contestant once in each turn; a peer that fails drops out. Returns the reason why promin failed, or
    None."""
    try:
        # The first turn only warms the caches.
        for turn in range(runs + 1):
            promin.render()
            for peer in peers:
                trace_ms = peer.attempt(peer.render, folder)
                if turn > 0:
                    peer.trace_ms.append(trace_ms)
            if turn == 0:
                promin.trace_ms.clear()
    except RuntimeError as problem:
        return last_line(problem)
    return None


def _row_of(peer, promin, difference):
    return {
        "promin_ms": promin.trace_ms,
        "peer_ms": peer.trace_ms,
        "time_ratio": [own / other for own, other in zip(promin.trace_ms, peer.trace_ms)],
        "mean_difference": difference["mean_absolute"],
        "different_pixels_percent": difference["different_percent"],
    }


def _compare(programs, folder, peer):
    """Returns the difference of the peer's picture from promin's; None after a failure."""
    words = (programs / "promin-lab", "difference", "flake.exr", peer.picture)
    output = peer.attempt(lambda: run_program(*words, folder=folder)[0])
    return json.loads(output) if output is not None else None


def measure(programs, folder, runs, side, level):
    """Measures. Returns a dict: "rows" of the peers, and "gaps" for missing peers."""
    sphereflake(level, has_endless_ground=True).write(folder / "flake.gltf")
    peers = {peer.name: peer for peer in find_peers(folder, folder / "flake.gltf", side)}
    promin = _Promin(programs, folder, side)
    section = {"rows": [], "gaps": []}
    failure = _run_turns(promin, peers.values(), runs, folder)
    what = f"a picture of {side} by {side} pixels, {MAX_DEPTH} bounces"
    for name in PEERS:
        peer = peers.get(name)
        difference = _compare(programs, folder, peer) if peer and not failure else None
        if difference is not None:
            head = {"scene": f"sphereflake:{level}", "peer": peer.version, "what": what}
            section["rows"].append({**head, **_row_of(peer, promin, difference)})
        else:
            section["gaps"].append(gap_of(name, peer, failure))
    return section


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("output", type=pathlib.Path, help=".json file to write")
    parser.add_argument("--programs", type=pathlib.Path, required=True, help="folder of the built programs")
    parser.add_argument("--runs", type=int, default=9)
    parser.add_argument("--side", type=int, default=1024, help="width and height in pixels [1024]")
    parser.add_argument("--level", type=int, default=4, help="level of the sphereflake [4, with 7381 spheres]")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        programs = arguments.programs.resolve()
        peers = measure(programs, pathlib.Path(folder), arguments.runs, arguments.side, arguments.level)
    arguments.output.write_text(json.dumps({"peers": peers}) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
