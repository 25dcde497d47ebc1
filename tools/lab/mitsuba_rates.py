#!/usr/bin/env python3
# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Measures the times that Mitsuba's LLVM mode takes for the rays of promin-lab rates. tools/bench calls this program.
Python finds Mitsuba, which may be in a folder of PYTHONPATH. Mitsuba uses the system's LLVM, or the library that
DRJIT_LIBLLVM_PATH names."""

import argparse
import json
import pathlib
import subprocess
import sys
import time

_VARIANT = "llvm_ad_rgb"
_RAYS = ("camera", "shadow", "random")
_CURE = "it may need another LLVM, which DRJIT_LIBLLVM_PATH names"


def _open_mitsuba():
    import mitsuba

    mitsuba.set_variant(_VARIANT)
    return mitsuba


class _Scene:
    """Triangles as a scene of Mitsuba."""

    def __init__(self, corners):
        self._mi = _open_mitsuba()
        import drjit

        self._dr = drjit
        mesh = self._mi.Mesh("triangles", 3 * len(corners), len(corners))
        parameters = self._mi.traverse(mesh)
        parameters["vertex_positions"] = corners.reshape(-1)
        parameters["faces"] = drjit.arange(self._mi.UInt32, 3 * len(corners))
        parameters.update()
        self._scene = self._mi.load_dict({"type": "scene", "mesh": mesh})

    def time_rays(self, rays, asks_for_any, runs):
        """Casts the rays `runs` times after a first time that compiles. Returns the elapsed times and the CPU times in
        milliseconds, and the number of hits."""
        mi, dr = self._mi, self._dr
        origin, direction = (mi.Point3f(rays[:, k : k + 3].T) for k in (0, 4))
        ray = mi.Ray3f(origin, direction, mi.Float(rays[:, 7]), 0.0, [])
        dr.eval(ray)
        dr.sync_thread()
        elapsed_ms, cpu_ms, hits = [], [], 0
        for turn in range(runs + 1):
            start, cpu_start = time.monotonic(), time.process_time()
            if asks_for_any:
                found = self._scene.ray_test(ray)
            else:
                crossing = self._scene.ray_intersect_preliminary(ray)
                dr.eval(crossing)
                found = crossing.is_valid()
            dr.eval(found)
            dr.sync_thread()
            if turn > 0:
                elapsed_ms.append(1e3 * (time.monotonic() - start))
                cpu_ms.append(1e3 * (time.process_time() - cpu_start))
            hits = int(dr.count(found)[0])
        return elapsed_ms, cpu_ms, hits


def probe():
    """Traces a ray. Exits with a line that names the reason if Mitsuba is unusable."""
    import numpy

    scene = _Scene(numpy.array([[[0, 0, 0], [1, 0, 0], [0, 1, 0]]], numpy.float32))
    ray = numpy.array([[0.2, 0.2, 1, 0, 0, 0, -1, numpy.inf]], numpy.float32)
    if scene.time_rays(ray, False, 1)[2] != 1:
        sys.exit("a ray misses its triangle")


def find_gap():
    """Returns why Mitsuba is not measured; None if it works. Another process tries it, which may crash."""
    done = subprocess.run(
        [sys.executable, __file__, "--probe"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )
    if done.returncode == 0:
        return None
    lines = done.stdout.strip().splitlines()
    if any("No module named 'mitsuba'" in line for line in lines):
        return {"name": "Mitsuba", "is_installed": False, "reason": "not installed"}
    why = lines[-1] if lines else f"it ends with {done.returncode}"
    return {"name": "Mitsuba", "is_installed": True, "reason": f"{why} ({_CURE})"}


def measure(rates, folder, runs):
    """Returns a row for each row of the rates whose rays are in the folder."""
    import mitsuba
    import numpy

    rows, scenes = [], {}
    for row in rates["rates"]["rows"]:
        name, file = row["scene"], folder / f"{row['scene']}_rates_{row['rays']}.npy"
        if row["rays"] not in _RAYS or not file.exists():
            continue
        if name not in scenes:
            scenes[name] = _Scene(numpy.load(folder / f"{name}_triangles.npy")["corners"])
        elapsed_ms, cpu_ms, hits = scenes[name].time_rays(numpy.load(file), row["rays"] == "shadow", runs)
        kept = {key: row[key] for key in ("scene", "rays", "count")}
        others = abs(hits - row["hits"])
        rows.append({**kept, "peer": f"Mitsuba {mitsuba.__version__}", "peer_ms": elapsed_ms, "peer_cpu_ms": cpu_ms})
        rows[-1] |= {"promin_ms": row.get("promin_ms"), "differing_hits": others}
    return rows


def main():
    if sys.argv[1:] == ["--probe"]:
        return probe()
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("rates", type=pathlib.Path, help="file that promin-lab rates has written")
    parser.add_argument("rays", type=pathlib.Path, help="folder of its --rays")
    parser.add_argument("output", type=pathlib.Path, help=".json file to write")
    parser.add_argument("--runs", type=int, default=9)
    arguments = parser.parse_args()
    gap = find_gap()
    section = {"rows": [], "gaps": [gap] if gap else []}
    if not gap:
        rates = json.loads(arguments.rates.read_text(encoding="utf-8"))
        section["rows"] = measure(rates, arguments.rays, arguments.runs)
    arguments.output.write_text(json.dumps({"mitsuba": section}) + "\n", encoding="utf-8")
    return None


if __name__ == "__main__":
    main()
