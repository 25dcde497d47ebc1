#!/usr/bin/env python3
# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Gathers the figures of tools/bench in one file and prints them as Markdown tables beside what is aimed at."""

import argparse
import datetime
import json
import os
import pathlib
import platform

# What is to be reached on a driver: (rate over Embree's for camera, shadow and random rays, time over Tachyon's).
_TARGETS = {"Mesa 22.3.6": (0.45, 0.42, 0.33, 1.5), "Mesa 25.0.7": (0.75, 0.62, 0.5, 1.0)}
_MOST_BUILD_TIME = 1.5  # over Embree's
_MOST_BYTES = 100  # a triangle


def cpu_name():
    try:
        for line in pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    except OSError:
        pass
    return platform.processor() or platform.machine()


def number(value, digits=2):
    return "–" if value is None else f"{value:.{digits}f}"


def spread(q, digits=2):
    """The median with its quartiles."""
    if q is None:
        return "–"
    return f"{q['median']:.{digits}f} ({q['lower_quartile']:.{digits}f}…{q['upper_quartile']:.{digits}f})"


def judge(value, least=None, most=None):
    """The target and whether the value meets it."""
    if value is None or (least is None and most is None):
        return "–"
    if least is not None:
        return f"≥ {least}: {'yes' if value >= least else 'no'}"
    return f"≤ {most}: {'yes' if value <= most else 'no'}"


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def targets_of(driver):
    return next((targets for key, targets in _TARGETS.items() if key in driver["driver"]), (None,) * 4)


def median(q):
    return None if q is None else q["median"]


def rate_rows(driver):
    least = dict(zip(("camera", "shadow", "random"), targets_of(driver)))
    for scene in driver["scenes"]:
        for rays in scene["sets"]:
            ratio = rays.get("rate_ratio")
            yield [
                driver["driver"],
                scene["scene"],
                rays["rays"],
                number(rays.get("promin_mrays_per_s")),
                number(rays.get("embree_mrays_per_s")),
                number(rays.get("embree_packets_mrays_per_s")),
                spread(ratio),
                judge(median(ratio), least=least[rays["rays"]]),
                str(rays.get("differing_hits", "–")),
                number(rays["node_steps_per_ray"]),
                number(rays["primitive_tests_per_ray"]),
            ]


def build_rows(driver):
    for scene in driver["scenes"]:
        build = scene["build"]
        yield [
            scene["scene"],
            str(scene["primitives"]),
            scene["builder"],
            spread(build["promin_ms"], 1),
            spread(build["promin_bvh_ms"], 1),
            spread(build.get("embree_ms"), 1),
            spread(build.get("time_ratio")),
            spread(build.get("bvh_time_ratio")),
            judge(median(build.get("time_ratio")), most=_MOST_BUILD_TIME),
            number(scene["device_bytes_per_primitive"], 1),
            judge(scene["device_bytes_per_primitive"], most=_MOST_BYTES),
        ]


def frame_rows(driver):
    frame = driver["sphereflake"]
    for name in ("Tachyon", "POV-Ray"):
        peer = frame["peers"].get(name, {})
        difference = peer.get("picture_difference", {})
        ratio = peer.get("time_ratio")
        yield [
            driver["driver"],
            peer.get("version", name + ", not installed"),
            spread(frame["trace_ms"], 0),
            spread(peer.get("trace_ms"), 0),
            spread(ratio),
            judge(median(ratio), most=targets_of(driver)[3] if name == "Tachyon" else None),
            number(difference.get("mean_absolute"), 5),
            number(difference.get("different_percent")),
        ]


def first_image_rows(driver):
    first = driver["sphereflake"]["first_image"]
    yield [
        driver["driver"],
        spread(first["process_ms"], 0),
        spread(driver["sphereflake"]["trace_ms"], 0),
        spread(first["one_sphere_process_ms"], 0),
        spread(first["ratio"]),
        judge(median(first["ratio"]), most=1),
    ]


def growth_rows(growth):
    for i, count in enumerate(growth["triangles"]):
        steps = [number(growth[rays]["node_steps"][i]) for rays in ("camera", "shadow", "random")]
        tests = [number(growth[rays]["primitive_tests"][i]) for rays in ("camera", "shadow", "random")]
        yield [str(count), *steps, *tests]
    fits = [growth[rays]["steps_per_doubling"] for rays in ("camera", "shadow", "random")]
    yield ["steps a doubling (r²)", *(f"{fit['slope']:.2f} ({fit['r_squared']:.3f})" for fit in fits), "", "", ""]


def report(bench):
    drivers = bench["drivers"]
    first = drivers[0]
    yield (
        f"{bench['cpu']}, {bench['threads']} threads; {bench['date']}, commit {bench['commit']}; "
        f"{first['embree'] or 'no Embree'}. Medians with quartiles of "
        + ", ".join(
            f"{driver['runs']} runs in turns on {driver['driver']} ({driver['device_type']})" for driver in drivers
        )
        + ".\n"
    )
    yield "Rays, Mrays/s; the ratio is promin's rate over that of Embree's single rays in the same turn:\n"
    head = [
        "driver",
        "scene",
        "rays",
        "promin",
        "Embree",
        "packets of 8",
        "ratio",
        "target",
        "other hits",
        "steps",
        "tests",
    ]
    yield table(head, [row for driver in drivers for row in rate_rows(driver)])
    yield "From triangles in memory to all that is copied to the device, ms, against rtcCommitScene:\n"
    head = ["scene", "triangles", "builder", "promin", "BVH alone", "Embree", "ratio", "BVH alone", "target"]
    yield table(head + ["bytes a triangle", "target"], build_rows(first))
    framed = [driver for driver in drivers if "sphereflake" in driver]
    if framed:
        rays = framed[0]["sphereflake"]["rays"]
        yield (
            f"Sphereflake of 7381 mirror spheres on a plane, 1024², 6 bounces, {1e-6 * sum(rays.values()):.2f} Mrays, "
            f"{1e-6 * rays['shadow']:.2f} M of them shadow rays; ms of tracing:\n"
        )
        head = ["driver", "peer", "promin", "peer", "ratio", "target", "mean difference", "pixels > 0.02, %"]
        yield table(head, [row for driver in framed for row in frame_rows(driver)])
        yield "First picture: that as a whole process, ms, over its tracing and twice the process of one sphere at 16²:\n"
        head = ["driver", "process", "its tracing", "one sphere at 16²", "ratio", "target"]
        yield table(head, [row for driver in framed for row in first_image_rows(driver)])
    if "growth" in first:
        yield "Node steps and primitive tests a ray over the triangles of a wavy sphere:\n"
        head = ["triangles", "camera", "shadow", "random", "tests: camera", "shadow", "random"]
        yield table(head, growth_rows(first["growth"]))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("figures", nargs="+", type=pathlib.Path, help="what bench_driver.py wrote, the system's first")
    parser.add_argument("--commit", default="unknown")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True, help="the .json file")
    arguments = parser.parse_args()
    bench = {
        "date": datetime.date.today().isoformat(),
        "commit": arguments.commit,
        "cpu": cpu_name(),
        "threads": os.cpu_count(),
        "drivers": [json.loads(file.read_text(encoding="utf-8")) for file in arguments.figures],
    }
    arguments.output.write_text(json.dumps(bench, indent=1) + "\n", encoding="utf-8")
    print("\n".join(report(bench)))


if __name__ == "__main__":
    main()
