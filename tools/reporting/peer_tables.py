# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Columns of the tables that set promin beside other renderers, for the page and for tools/bench."""

from figures import interval, number, scene_column, spread

_TIMES = [
    ("promin, ms", lambda r: spread(r.get("promin_ms"))),
    ("peer", lambda r: r.get("peer", "–").split(",")[0]),
    ("peer, ms", lambda r: spread(r.get("peer_ms"))),
    ("ratio", lambda r: interval(r.get("time_ratio"))),
]
RAYS = [
    scene_column(),
    ("rays", lambda r: r["rays"]),
    ("number", lambda r: f"{r['count']:,}"),
    ("promin, Mrays/s", lambda r: number(r.get("promin_mrays_per_s"))),
    ("peer", lambda r: number(r.get("peer_mrays_per_s"))),
    ("packets of 8", lambda r: number(r.get("peer_packets_mrays_per_s"))),
    *_TIMES,
    ("packets, ms", lambda r: spread(r.get("peer_packets_ms"))),
    ("ratio", lambda r: interval(r.get("packets_time_ratio"))),
    ("other hits", lambda r: number(r.get("differing_hits"))),
    ("steps", lambda r: number(r.get("node_steps_per_ray"))),
    ("tests", lambda r: number(r.get("primitive_tests_per_ray"))),
]
BUILDS = [
    scene_column(),
    ("primitives", lambda r: f"{r['primitives']:,}"),
    ("builder", lambda r: r["builder"]),
    *_TIMES,
    ("tree alone, ms", lambda r: spread(r["bvh_ms"])),
    ("ratio", lambda r: interval(r.get("bvh_time_ratio"))),
    ("nodes", lambda r: f"{r['nodes']:,}"),
    ("depth", lambda r: r["depth"]),
    ("SAH cost", lambda r: number(r["sah_cost"])),
    ("bytes a primitive", lambda r: number(r["device_bytes_per_primitive"])),
]
PICTURES = [
    scene_column(),
    ("what", lambda r: r["what"]),
    *_TIMES,
    ("mean difference", lambda r: number(r["mean_difference"], 2)),
    ("pixels > 0.02, %", lambda r: number(r["different_pixels_percent"], 2)),
]
OVER_RAYS = [
    scene_column(),
    ("what", lambda r: r["what"]),
    ("pixels", lambda r: f"{r['width']} × {r['height']}"),
    ("bounces", lambda r: r["depth"]),
    ("its rays", lambda r: f"{r['count']:,}"),
    ("promin, ms", lambda r: spread(r["promin_ms"])),
    ("its rays by cast, ms", lambda r: spread(r["rays_ms"])),
    ("over these", lambda r: interval(r["rays_time_ratio"])),
    ("peer", lambda r: r.get("peer", "–").split(",")[0]),
    ("the same rays, ms", lambda r: spread(r.get("peer_ms"))),
    ("over these", lambda r: interval(r.get("time_ratio"))),
]
FIRST = [
    scene_column(),
    ("whole process, ms", lambda r: spread(r["process_ms"])),
    ("its tracing", lambda r: spread(r["trace_ms"])),
    ("process of one sphere at 16²", lambda r: spread(r["one_sphere_process_ms"])),
    ("over its tracing and twice one sphere's", lambda r: interval(r["time_ratio"])),
    ("rays", lambda r: f"{r['rays']:,}"),
    ("shadow rays", lambda r: f"{r['shadow_rays']:,}"),
]
