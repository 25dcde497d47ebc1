# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""The page's first section: what the others come to, a line each, by their figures."""

import html

from figures import bound_of, emphasis, from_to, names_of, number, section
from front_text import find_dominators


def _ratios(rows, key="time_ratio"):
    return from_to([row[key]["median"] for row in rows])


def _front_line(report):
    rows = report["frames"]["rows"]
    scenes = names_of(rows, "scene")
    off = [s for s in scenes if find_dominators([row for row in rows if row["scene"] == s])]
    if not off:
        return (
            f"The default lies on the Pareto front of pictures in {len(scenes)} of {len(scenes)} scenes, up to noise."
        )
    names = ", ".join(map(emphasis, off))
    return (
        f"The default lies off the Pareto front of pictures in {len(off)} of {len(scenes)} scenes ({names}): see below."
    )


def _kernel_line(report):
    own = [row for row in report["kernels"]["rows"] if row["is_shipped"]]
    plain = [row for row in report["kernels"]["rows"] if row["method"] == "textbook"]
    leaks = [sum(row.get("leaks", 0) for row in rows) for rows in (own, plain)]
    worst = [max(row.get("max_k", 0) for row in rows) for rows in (own, plain)]
    return (
        f"Intersections are off by at most {number(worst[0], 2)} u S (bound {bound_of(report, 8)}), the textbook's by "
        f"{number(worst[1], 2)}; {leaks[0]:,} rays leak, by the textbook's {leaks[1]:,}. "
        f"The textbook's take {_ratios(plain)} of the time."
    )


def _robustness_line(report):
    rows = report["robustness"]["rows"]
    lost = [sum(row[f"{kernel}_lost"] for row in rows) for kernel in ("promin", "textbook")]
    return (
        f"Through a tree robustness takes {_ratios(rows)} times the textbook's time; of "
        f"{sum(row['judged'] for row in rows):,} rays whose truth is known promin loses {lost[0]:,}, the textbook "
        f"{lost[1]:,}."
    )


def _specialisation_line(report):
    rows = report["specialisation"]["rows"]
    same = sum(row["is_bit_identical"] for row in rows)
    return (
        f"Specialised to its scene, tracing takes {_ratios(rows)} of the time and compiling "
        f"{_ratios(rows, 'compile_time_ratio')}, with the same bits in {same} of {len(rows)} scenes."
    )


def _peers_line(report):
    rows = [row for row in report["rates"]["rows"] if "peer" in row] + report["peers"]["rows"]
    parts = []
    for name in dict.fromkeys(row["peer"].split(",")[0] for row in rows):
        of_peer = [row for row in rows if row["peer"].startswith(name)]
        part = f"{_ratios(of_peer)} times as long as {html.escape(name)}"
        if "packets_time_ratio" in of_peer[0]:
            packets = _ratios(of_peer, "packets_time_ratio")
            part += f"'s single rays and {packets} times as long as its packets"
        parts.append(part)
    return f"The same work takes promin {'; '.join(parts)}." if parts else ""


# What each takes.
_LINES = (
    (("frames",), _front_line),
    (("kernels",), _kernel_line),
    (("robustness",), _robustness_line),
    (("specialisation",), _specialisation_line),
    (("rates", "peers"), _peers_line),
)


def summary(report):
    lines = [make(report) for names, make in _LINES if all(name in report for name in names)]
    text = ["<ul>" + "\n".join(f"<li>{line}</li>" for line in lines if line) + "</ul>"] if any(lines) else []
    p = report["provenance"]
    again = f"To make it again: <code>{html.escape(p['command'])}</code> of commit {html.escape(p['commit'])}. "
    if "frames" in report:
        scenes = {row["scene"]: row["scene_hash"] for row in report["frames"]["rows"]}
        names = ", ".join(f"{emphasis(name)} ({code})" for name, code in scenes.items())
        again += f"The pictures' scenes, with hashes of what they hold: {names}. "
    text.append(again + "All figures are in report.json beside this page.")
    return section("In short", text)
