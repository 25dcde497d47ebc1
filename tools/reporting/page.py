#!/usr/bin/env python3
# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Makes the page of a report: page.py FOLDER [--compare OLD.json] reads FOLDER/report.json and writes
FOLDER/report.html, one file that needs nothing else, and its main plot as FOLDER/frames.png. Without matplotlib it says
so in one sentence and writes nothing."""

import argparse
import html
import json
import os
import pathlib
import sys

try:
    import matplotlib  # noqa: F401 - whether it is there
except ImportError:
    print("report.html is not made: this python3 has no matplotlib (Debian's python3-matplotlib); report.json is there")
    sys.exit(0)

import compare
import frame_page
import kernel_page
import plots
import price_page
import scaling_page
import summary_page
from figures import names_of
from front_text import front_claim
from report_file import read_report, replace

# What each section takes of the report.
_SECTIONS = (
    ("provenance", summary_page.summary),
    ("frames", frame_page.frames),
    ("frames", frame_page.errors_apart),
    ("kernels", kernel_page.kernels),
    ("kernels", kernel_page.error_range),
    ("boxes", kernel_page.boxes),
    ("robustness", price_page.robustness),
    ("specialisation", price_page.specialisation),
    ("scaling", scaling_page.scaling),
    ("rates", price_page.peers),
)


def _interval_words(runs):
    return "the median's 95 % interval" if runs >= 6 else "least and most, as so few have no 95 % interval"


def _device_sentence(p):
    kind = "a CPU driver: the device is the host's processor" if p["device_type"] == "CPU" else f"a {p['device_type']}"
    quick = (
        " <strong>This is a quick report: its few runs and small sizes tell that it works, not how fast.</strong>"
        if p["is_quick"]
        else ""
    )
    if p.get("is_validated"):
        quick += " <strong>Vulkan's validation layers watched, which takes time.</strong>"
    load = ""
    if p.get("busy_cores_before") is not None and p.get("busy_cores_after") is not None:
        before, after = p["busy_cores_before"], p["busy_cores_after"]
        load = f" Of {p['threads']} cores others kept {before:.1f} busy before and {after:.1f} after."
        if max(before, after) > 0.2 * p["threads"]:
            load += " <strong>The machine was busy with other work as well.</strong>"
    return (
        f"{html.escape(p['device'])}, {html.escape(p['driver'])}, {kind}. {html.escape(p['cpu'])}.{load} "
        f"{p['runs']} timed runs of each after a warm-up, in turns; times are {html.escape(p['times_are'])}, medians "
        f"with quartiles (…); ratios are of the same turn, medians with {_interval_words(p['runs'])} […]. "
        f"Commit {html.escape(p['commit'])}, {html.escape(p['compiler'])}, {html.escape(p['date'])}, "
        f"{p.get('minutes', 0):.0f} minutes.{quick}"
    )


def _section(content):
    parts = [f"<section><h2>{content['title']}</h2>"]
    parts += [text if text.startswith("<ul>") else f"<p>{text}</p>" for text in content["text"] if text]
    if content["legend"]:
        parts.append(plots.legend(content["legend"]))
    if content["panels"]:
        parts.append(
            "<div class='panels'>" + "\n".join(f"<figure>{svg}</figure>" for svg in content["panels"]) + "</div>"
        )
    if content.get("table"):
        parts.append(content["table"])
    return "\n".join(parts + ["</section>"])


def _claims_text(report):
    """What check_report.py reads of the page instead of its sentences."""
    p, rows = report["provenance"], report.get("frames", {}).get("rows", [])
    fronts = [front_claim(report, scene) for scene in names_of(rows, "scene")]
    claims = {"is_quick": p["is_quick"], "is_cpu": p["device_type"] == "CPU", "fronts": fronts}
    return json.dumps(claims, ensure_ascii=False, separators=(",", ":")).replace("<", "\\u003c")


def make_page(report, old=None):
    """The page as text."""
    sections = [compare.compare(old, report)] if old else []
    sections += [make(report) for name, make in _SECTIONS if report.get(name)]
    style = (pathlib.Path(__file__).parent / "page.css").read_text(encoding="utf-8")
    p = report["provenance"]
    title = f"promin: speed against error on {p['device']}"
    return "\n".join(
        [
            '<!DOCTYPE html><html lang="en"><head><meta charset="utf-8">',
            '<meta name="viewport" content="width=device-width, initial-scale=1">',
            f"<title>{html.escape(title)}</title><link rel='icon' href='data:,'>",
            f"<style>{style}</style></head><body><main>",
            f"<h1>Speed against error</h1><p class='device'>{_device_sentence(p)}</p>",
            *[_section(section) for section in sections],
            f'<script type="application/json" id="claims">{_claims_text(report)}</script>',
            "</main></body></html>\n",
        ]
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--compare", type=pathlib.Path, metavar="OLD.json")
    arguments = parser.parse_args()
    report = read_report(arguments.folder / "report.json")
    old = read_report(arguments.compare) if arguments.compare else None
    replace(arguments.folder / "report.html", make_page(report, old))
    if "frames" in report:
        picture = arguments.folder / f".frames.{os.getpid()}.png"
        frame_page.write_picture(report, picture)
        picture.replace(arguments.folder / "frames.png")
    if old:
        print(compare.summary(old, report))


if __name__ == "__main__":
    main()
