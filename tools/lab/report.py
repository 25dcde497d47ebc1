#!/usr/bin/env python3
# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Measures promin's speed against its error and writes one page of it: FOLDER/report.html, with all figures in
FOLDER/figures.json. tools/report builds the programs and calls this."""

import argparse
import base64
import datetime
import html
import io
import json
import math
import os
import pathlib
import random
import statistics
import sys
import tempfile

from figures import gap_text, join
from peers import MAX_DEPTH, PEERS, find_peers, gap_of, run_program
from scenegen.sphereflake import sphereflake

_REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
_COLORS = {"promin": "#c2410c", "Tachyon": "#2563eb", "POV-Ray": "#15803d"}
_TRUTH_DEPTH = 50


class Plan:
    """The sizes of the measurements: of a whole report, or of a quick one that only shows that everything works."""

    def __init__(self, is_quick, runs):
        self.is_quick = is_quick
        self.runs = runs or (1 if is_quick else 5)
        self.flake_level = 2 if is_quick else 4
        self.flake_side = 64 if is_quick else 320
        # POV-Ray accepts only square numbers, up to 81.
        self.samples = {
            "promin": (1, 4, 16) if is_quick else (1, 2, 4, 8, 16, 32, 64),
            "Tachyon": (1, 4) if is_quick else (1, 4, 16, 64),
            "POV-Ray": (1, 4) if is_quick else (1, 4, 9, 16),
        }
        self.truths = {
            "promin": 64 if is_quick else 512,
            "Tachyon": 16 if is_quick else 256,
            "POV-Ray": 16 if is_quick else 81,
        }
        self.size = (96, 54) if is_quick else (480, 270)
        self.knob_samples = (1, 4, 16) if is_quick else (1, 4, 16, 64)
        self.truth_samples = 64 if is_quick else 256
        self.mesh = "wavy:2000" if is_quick else "wavy:131000"
        self.ray_side = 64 if is_quick else 1024


class Lab:
    """Runs the programs. Their pictures go to a folder of their own."""

    def __init__(self, programs, folder, plan):
        self.programs, self.folder, self.plan = programs.resolve(), folder, plan
        self.stats = {}

    def say(self, text):
        print(f"report.py: {text}", file=sys.stderr, flush=True)

    def render(self, scene, name, *options):
        """Writes NAME.exr and NAME.png; returns the statistics."""
        outputs = ("-o", f"{name}.exr", "-o", f"{name}.png", "--stats", "stats.json", "--quiet")
        run_program(self.programs / "promin", "render", scene, *outputs, *options, folder=self.folder)
        self.stats = json.loads((self.folder / "stats.json").read_text(encoding="utf-8"))
        return self.stats

    def lab(self, *words):
        return run_program(self.programs / "promin-lab", *words, folder=self.folder)[0]

    def error(self, picture, truth):
        """Returns the root of the mean squared difference of two pictures in linear light from 0 to 1."""
        return json.loads(self.lab("difference", picture, truth))["rmse"]

    def png(self, name):
        """Returns a picture as a data URI for the page."""
        data = base64.b64encode((self.folder / name).read_bytes()).decode("ascii")
        return f"data:image/png;base64,{data}"


def _run_turns(contestants, runs):
    """Maps {name: function that returns milliseconds} to {name: list}. Each contestant runs once in each turn, in
    another order each time. A contestant that returns None drops out."""
    times = {name: [] for name in contestants}
    order = list(contestants)
    shuffler = random.Random(1)
    for _ in range(runs):
        shuffler.shuffle(order)
        for name in order:
            if times[name] is not None:
                took_ms = contestants[name]()
                times[name] = None if took_ms is None else [*times[name], took_ms]
    return {name: taken for name, taken in times.items() if taken is not None}


# These functions measure. Each returns rows with "ms", a list with one number for each run.


def measure_renderers(lab):
    """Measures error over time on the sphereflake, for promin and for each peer that is installed. The truth of each
    renderer is its own picture of many samples, because no two renderers model light in quite the same way."""
    plan, folder = lab.plan, lab.folder
    flake = folder / "flake.gltf"
    sphereflake(plan.flake_level, has_endless_ground=True).write(flake)
    size = ("--size", plan.flake_side, plan.flake_side, "--max-depth", MAX_DEPTH)
    peers = {peer.name: peer for peer in find_peers(folder, flake, plan.flake_side)}

    def render_promin(samples):
        return lab.render("flake.gltf", f"flake{samples}", *size, "--spp", samples)["times_ms"]["trace"]

    lab.say(f"the truth of the sphereflake, by {join(['promin', *peers])}")
    render_promin(plan.truths["promin"])
    truth = f"flake{plan.truths['promin']}.exr"
    for peer in peers.values():
        peer.attempt(peer.render, folder, plan.truths[peer.name])
        if peer.failure is None:
            (folder / peer.picture).rename(folder / f"truth_{peer.picture}")
    errors, contestants = {}, {}

    def contest(name, samples):
        if name == "promin":
            took_ms = render_promin(samples)
            errors[name, samples] = lambda: lab.error(f"flake{samples}.exr", truth)
            return took_ms
        peer = peers[name]
        took_ms = peer.attempt(peer.render, folder, samples)
        if took_ms is not None and (name, samples) not in errors:
            error = peer.attempt(lab.error, peer.picture, f"truth_{peer.picture}")
            errors[name, samples] = lambda: error
        return took_ms if peer.failure is None else None

    for name in ("promin", *peers):
        for samples in plan.samples[name]:
            contestants[name, samples] = lambda name=name, samples=samples: contest(name, samples)
    lab.say(f"the sphereflake: {len(contestants)} settings, {plan.runs} turns")
    times = _run_turns(contestants, plan.runs)
    alive = {name for name, peer in peers.items() if peer.failure is None} | {"promin"}
    rows = [
        {"renderer": name, "samples": samples, "ms": ms, "error": errors[name, samples]()}
        for (name, samples), ms in times.items()
        if name in alive
    ]
    rows.sort(key=lambda row: (row["renderer"] != "promin", row["renderer"], row["samples"]))
    between = {
        name: peer.attempt(lab.error, f"truth_{peer.picture}", truth) for name, peer in peers.items() if name in alive
    }
    versions = {name: peer.version for name, peer in peers.items() if name in alive}
    gaps = [gap_of(name, peers.get(name)) for name in PEERS if name not in alive]
    spheres = lab.stats["scene"]["spheres"]
    return {"rows": rows, "between": between, "versions": versions, "gaps": gaps, "spheres": spheres}


def measure_knobs(lab, scene):
    """Measures settings of promin on one scene: {"knob", "setting", "ms", "error", "name" of the pictures, ...}."""
    plan = lab.plan
    size = ("--size", *plan.size)
    lab.say(f"the truth of {scene.name}")
    lab.render(scene, "truth", *size, "--spp", plan.truth_samples, "--max-depth", _TRUTH_DEPTH)
    settings = [("samples", f"{samples}", ("--spp", samples)) for samples in plan.knob_samples]
    settings += [("target error", f"1/{part}", ("--target-error", 1 / part)) for part in (16, 64)]
    settings += [("depth", f"{depth}", ("--spp", 4, "--max-depth", depth)) for depth in (0, 1, 2, 5, 10)]
    settings += [("builder", name, ("--spp", 4, "--builder", name)) for name in ("sah", "median", "spatial")]
    figures, contestants = {}, {}

    def contest(index, options):
        figures[index] = lab.render(scene, f"knob{index}", *size, *options)
        return figures[index]["times_ms"]["trace"]

    for index, (_, _, options) in enumerate(settings):
        contestants[index] = lambda index=index, options=options: contest(index, options)
    lab.say(f"{scene.name}: {len(settings)} settings, {plan.runs} turns")
    times = _run_turns(contestants, plan.runs)
    pixels = plan.size[0] * plan.size[1]
    rows = []
    for index, (knob, setting, _) in enumerate(settings):
        stats = figures[index]
        row = {"knob": knob, "setting": setting, "ms": times[index], "name": f"knob{index}"}
        row["error"] = lab.error(f"knob{index}.exr", "truth.exr")
        row["samples_a_pixel"] = stats["rays"]["primary"] / pixels
        row["build_ms"] = stats["times_ms"]["bvh"]
        rows.append(row)
    return rows


def measure_methods(lab, scene):
    """Compares promin's methods with the textbook's: one picture with each method, and rays into a closed mesh, each of
    which must hit."""
    plan = lab.plan
    lab.say("promin's methods beside the textbook's")
    output = lab.lab("methods", scene, "-o", ".", "--side", plan.size[1], "--spp", 4, "--runs", plan.runs)
    difference = json.loads(lab.lab("difference", "textbook.exr", "promin.exr"))
    run_program(
        lab.programs / "promin", "compare", "textbook.exr", "promin.exr", "-o", "methods.png", folder=lab.folder
    )
    rays = ("robustness", plan.mesh, "--runs", plan.runs, "--side", plan.ray_side, "-o", "robustness.json")
    lab.lab(*rays)
    rows = json.loads((lab.folder / "robustness.json").read_text(encoding="utf-8"))
    edges = next(row for row in rows["robustness"]["rows"] if row["rays"] == "edges")
    return {
        **json.loads(output),
        "different_percent": difference["different_percent"],
        "rays": edges["count"],
        "lost_by_promin": edges["count"] - edges["promin_hits"],
        "lost_by_textbook": edges["count"] - edges["textbook_hits"],
        "provenance": rows["provenance"],
    }


# These functions write words.


def percent(error):
    """Returns an error as a percentage of white."""
    return f"{100 * error:.2g} %"


def duration(ms):
    if ms >= 10e3:
        return f"{ms / 1e3:.0f} s"
    return f"{ms / 1e3:.2g} s" if ms >= 1e3 else f"{ms:.0f} ms" if ms >= 10 else f"{ms:.1f} ms"


def factor(ratio):
    return f"{ratio:.0f}" if ratio >= 9.5 else f"{ratio:.2g}"


def median(row):
    return statistics.median(row["ms"])


def ratio_of(times, others):
    """Returns the median of the ratios of each turn."""
    return statistics.median(a / b for a, b in zip(times, others))


def compared(ratio):
    """Returns words like "12 % less time than"."""
    if abs(ratio - 1) < 0.02:
        return "the same time as"
    if ratio >= 2:
        return f"{factor(ratio)} times the time of"
    return f"{abs(100 * (ratio - 1)):.0f} % {'more' if ratio > 1 else 'less'} time than"


def _time_at(rows, error):
    """Returns the time at which these rows reach an error, interpolated along straight lines of logarithms. Returns
    None for an error beyond their ends."""
    rows = sorted(rows, key=median)
    for worse, better in zip(rows, rows[1:]):
        if worse["error"] >= error >= better["error"] > 0 and worse["error"] > better["error"]:
            share = math.log(worse["error"] / error) / math.log(worse["error"] / better["error"])
            return median(worse) * (median(better) / median(worse)) ** share
    return None


def renderer_sentences(figures):
    """Says how long a peer takes for its picture with the most samples, and how long promin takes for the same
    error."""
    for name, version in figures["versions"].items():
        own = [row for row in figures["rows"] if row["renderer"] == name]
        last = own[-1]
        took_ms = _time_at([row for row in figures["rows"] if row["renderer"] == "promin"], last["error"])
        text = f"{version} takes {duration(median(last))} for an error of {percent(last['error'])}"
        own_time = f"; promin takes {duration(took_ms)} for the same error."
        yield text + (own_time if took_ms else "; no picture of promin has this error.")
    if figures["between"]:
        known = {name: error for name, error in figures["between"].items() if error is not None}
        differences = [f"{percent(error)} from {name}'s" for name, error in known.items()]
        yield f"With the most samples, promin's picture differs by {join(differences)}."


def _listed(rows, figure):
    return "; ".join(f"<b>{html.escape(row['setting'])}</b>: {figure(row)}" for row in rows) + "."


def _time_and_error(row):
    return f"{duration(median(row))}, error {percent(row['error'])}"


def knob_rows(lab, knobs, methods):
    """Returns (name, what it is, figures in words, picture, caption) of each knob."""
    by_name = {}
    for row in knobs:
        by_name.setdefault(row["knob"], []).append(row)
    samples = by_name["samples"]
    one, most = samples[0], samples[-1]
    slower, better = ratio_of(most["ms"], one["ms"]), one["error"] / max(most["error"], 1e-9)
    yield (
        "Samples",
        "Each pixel is the mean of several camera rays.",
        _listed(samples, _time_and_error)
        + f" From {one['setting']} to {most['setting']} samples the time grows {factor(slower)} times"
        f" and the error falls {factor(better)} times.",
        lab.png(f"{one['name']}.png"),
        "1 sample",
    )
    targets = by_name["target error"]
    yield (
        "Target error",
        "Instead of a number of samples: each pixel stops when its estimated error is below a limit.",
        _listed(targets, lambda row: f"{_time_and_error(row)}, {row['samples_a_pixel']:.1f} samples a pixel"),
        lab.png(f"{targets[-1]['name']}.png"),
        f"target error {targets[-1]['setting']}",
    )
    depths = by_name["depth"]
    yield (
        "Depth",
        "The number of bounces in mirrors and glass; 4 samples.",
        _listed(depths, _time_and_error) + " Where more bounces change nothing, the samples cause the error.",
        lab.png(f"{depths[0]['name']}.png"),
        "no bounces",
    )
    builders = by_name["builder"]
    is_equal = len({row["error"] for row in builders}) == 1
    yield (
        "Builder",
        "The program that builds the tree over the scene; 4 samples.",
        _listed(builders, lambda row: f"{duration(row['build_ms'])} to build, {duration(median(row))} to trace")
        + (" The error is the same with each." if is_equal else " The errors differ, which they should not."),
        lab.png(f"{builders[0]['name']}.png"),
        "sah, the default",
    )
    ratio = ratio_of(methods["promin_ms"], methods["textbook_ms"])
    yield (
        "Robust methods",
        "promin's intersections decide edges without a gap; a textbook's do not.",
        f"A picture with promin's methods takes {compared(ratio)} one with the textbook's."
        f" {methods['different_percent']:.2g} % of its pixels differ visibly."
        f" From inside of a closed mesh, at its edges, the textbook's methods lose {methods['lost_by_textbook']:,} and"
        f" promin {methods['lost_by_promin']:,} of {methods['rays']:,} rays.",
        lab.png("methods.png"),
        "the difference of the two pictures: black is none",
    )


# These functions write the page.

def plot(rows):
    """Returns a chart of error over time as SVG, with a line for each renderer; both axes are logarithmic."""
    import matplotlib

    matplotlib.use("svg")
    matplotlib.rcParams["svg.hashsalt"] = "promin"
    from matplotlib import pyplot
    from matplotlib.ticker import FuncFormatter, LogLocator

    figure, axes = pyplot.subplots(figsize=(9, 4.6))
    for name in dict.fromkeys(row["renderer"] for row in rows):
        own = [row for row in rows if row["renderer"] == name]
        times, errors = [median(row) / 1e3 for row in own], [100 * row["error"] for row in own]
        axes.plot(times, errors, "o-", color=_COLORS[name], linewidth=2, label=name)
        for row, x, y in zip(own, times, errors):
            axes.annotate(f"{row['samples']}", (x, y), (4, 5), textcoords="offset points", fontsize=8, color="#57534e")
    axes.set_xscale("log")
    axes.set_yscale("log")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axis.set_minor_formatter(FuncFormatter(lambda value, _: ""))
    axes.set_xlabel("seconds of tracing  (← faster)")
    axes.set_ylabel("error, % of white  (↓ more exact)")
    axes.grid(True, which="both", color="#e7e5e4", linewidth=0.6)
    axes.legend(frameon=False)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    figure.tight_layout()
    text = io.StringIO()
    figure.savefig(text, format="svg", metadata={"Date": None, "Creator": None})
    pyplot.close(figure)
    svg = text.getvalue()
    return svg[svg.index("<svg") :]


def _figure(source, caption):
    return f'<figure><img src="{source}" alt=""><figcaption>{caption}</figcaption></figure>'


def page(lab, scene, renderers, knobs, methods, footer):
    """Returns the page as a single, self-contained file."""
    plan = lab.plan
    peers = join(["promin", *renderers["versions"].values()])
    top = [
        "<h1>promin: speed against error</h1>",
        "<p>How long a picture takes, and how far it is from the exact picture.</p>",
    ]
    if plan.is_quick:
        top.append('<p class="quick">A quick report: it shows that everything works, not how fast promin is.</p>')
    flake_caption = f"the sphereflake, {renderers['spheres']:,} mirror spheres, {plan.flake_side}² pixels"
    top += [
        '<div class="pictures">',
        _figure(lab.png(f"flake{plan.truths['promin']}.png"), f"{flake_caption}: the plot"),
        _figure(lab.png("truth.png"), f"{html.escape(scene.name)}, {plan.size[0]} × {plan.size[1]} pixels: the knobs"),
        "</div>",
        "<h2>Error over time</h2>",
        f"<p>Each point is the sphereflake by {html.escape(peers)}; the number is the samples of a pixel."
        " Lower left is better.</p>",
        f'<div class="plot">{plot(renderers["rows"])}</div>',
    ]
    top += [f"<p>{html.escape(sentence)}</p>" for sentence in renderer_sentences(renderers)]
    if renderers["gaps"]:
        top.append(f"<p>{html.escape(gap_text(renderers['gaps']))}</p>")
    top.append(
        "<p><small>The error is the root of the mean squared difference of all channels, in linear light from 0 (black)"
        " to 1 (white). Here the exact picture is each renderer's own of"
        f" {plan.truths['promin']} samples (Tachyon {plan.truths['Tachyon']}, POV-Ray {plan.truths['POV-Ray']})."
        " Times are medians of the tracing alone; loading a scene and compiling kernels, which the driver keeps, come"
        " on top.</small></p>"
    )
    top.append(
        f"<h2>What each knob does</h2><p>On {html.escape(scene.name)}; the exact picture has"
        f" {plan.truth_samples} samples and {_TRUTH_DEPTH} bounces.</p>"
    )
    for name, what, figures, picture, caption in knob_rows(lab, knobs, methods):
        words = f"<div><h3>{name}</h3><p>{what}</p><p>{figures}</p></div>"
        top.append(f'<div class="knob">{_figure(picture, caption)}{words}</div>')
    top.append(f"<footer><p>{html.escape(footer)}</p></footer>")
    style = (pathlib.Path(__file__).parent / "report.css").read_text(encoding="utf-8")
    head = '<!doctype html><html lang="en"><head><meta charset="utf-8"><title>promin: speed against error</title>'
    head += '<meta name="viewport" content="width=device-width">'
    return f"{head}<style>{style}</style></head><body>\n" + "\n".join(top) + "\n</body></html>\n"


def footer_text(provenance, plan, commit, busy):
    date = datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%d")
    runs = "1 run" if plan.runs == 1 else f"medians of {plan.runs} runs in turns"
    kind = " (a CPU driver)" if provenance["device_type"] == "CPU" else ""
    return (
        f"{provenance['cpu']}, {provenance['threads']} threads; {provenance['driver']}{kind}; commit {commit}; {date};"
        f" {runs}. Load of the machine before: {busy:.1f} of {os.cpu_count()} cores."
    )


def read_arguments():
    description = "Makes a page on promin's speed against its error."
    parser = argparse.ArgumentParser(prog="tools/report", description=description)
    scene_help = "scene to compare settings with [scenes/showcase.gltf]"
    parser.add_argument("scene", nargs="?", type=pathlib.Path, help=scene_help)
    parser.add_argument("-o", "--output", type=pathlib.Path, metavar="FOLDER", help="folder to write [build/report]")
    parser.add_argument("--quick", action="store_true", help="render small pictures once, as a check")
    parser.add_argument("--runs", type=int, metavar="N", help="number of timed runs of each setting [5]")
    parser.add_argument("--programs", type=pathlib.Path, required=True, help=argparse.SUPPRESS)
    parser.add_argument("--commit", default="unknown", help=argparse.SUPPRESS)
    return parser.parse_args()


def main():
    arguments = read_arguments()
    scene = (arguments.scene or _REPOSITORY / "scenes" / "showcase.gltf").resolve()
    output = arguments.output or _REPOSITORY / "build" / "report"
    if not scene.is_file():
        sys.exit(f"tools/report: error: no such scene, {scene}; give a file that promin renders")
    output.mkdir(parents=True, exist_ok=True)
    busy = os.getloadavg()[0]
    with tempfile.TemporaryDirectory() as folder:
        lab = Lab(arguments.programs, pathlib.Path(folder), Plan(arguments.quick, arguments.runs))
        try:
            methods = measure_methods(lab, scene)
            knobs = measure_knobs(lab, scene)
            renderers = measure_renderers(lab)
        except RuntimeError as problem:
            sys.exit(f"tools/report: error: {problem}")
        footer = footer_text(methods["provenance"], lab.plan, arguments.commit, busy)
        text = page(lab, scene, renderers, knobs, methods, footer)
    figures = {"renderers": renderers, "knobs": knobs, "methods": methods, "commit": arguments.commit}
    (output / "figures.json").write_text(json.dumps(figures, indent=1) + "\n", encoding="utf-8")
    (output / "report.html").write_text(text, encoding="utf-8")
    lab.say(f"wrote {output / 'report.html'}")


if __name__ == "__main__":
    main()
