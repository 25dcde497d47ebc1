#!/usr/bin/env python3
# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Draws the true errors of pixels over their claimed errors, from the files of promin-lab honesty --pixels. For each
scene and each range of claims, a point is the error that 95 of 100 pixels do not exceed. Claims are true if the points
lie below the diagonal."""

import argparse
import csv
import math
import pathlib

_BINS_PER_OCTAVE = 2
_FEWEST_PIXELS = 100
_SHARE = 0.95


def read_pixels(file):
    """Returns pairs of claim and error."""
    with open(file, newline="") as lines:
        return [(float(row["claim"]), float(row["error"])) for row in csv.DictReader(lines)]


def quantiles(pixels):
    """Returns a point for each range of claims that has enough pixels: the middle of the range, and the error that 95
    of 100 of its pixels do not exceed."""
    bins = {}
    for claim, error in pixels:
        if claim > 0.0:
            bins.setdefault(math.floor(_BINS_PER_OCTAVE * math.log2(claim)), []).append(error)
    points = []
    for number, errors in sorted(bins.items()):
        if len(errors) >= _FEWEST_PIXELS:
            middle = 2.0 ** ((number + 0.5) / _BINS_PER_OCTAVE)
            points.append((middle, sorted(errors)[math.ceil(_SHARE * len(errors)) - 1]))
    return points


def plot(scenes, file):
    """Draws the points of scenes, given as pairs of a name and pixels."""
    import matplotlib

    matplotlib.use("svg")
    matplotlib.rcParams |= {"svg.hashsalt": "promin", "svg.fonttype": "none"}
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(6.5, 4.2))
    ends = []
    for name, pixels in scenes:
        points = quantiles(pixels)
        honest = sum(error <= claim for claim, error in pixels) / len(pixels)
        axes.plot(*zip(*points), "o-", markersize=3, linewidth=1, label=f"{name}: {100 * honest:.1f} % within")
        ends += [claim for claim, _ in points]
    axes.plot([min(ends), max(ends)], [min(ends), max(ends)], "k--", linewidth=1, label="error = claim")
    axes.set_xscale("log", base=2)
    axes.set_yscale("log", base=2)
    axes.set_xlabel("claimed error of a pixel")
    axes.set_ylabel("error of 95 in 100 pixels")
    axes.legend(fontsize=8)
    axes.grid(alpha=0.3)
    figure.tight_layout()
    figure.savefig(file, format="svg", metadata={"Date": None, "Creator": None})


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scenes", nargs="+", metavar="NAME=FILE.csv", help="name of a scene, and its pixels")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True, metavar="FILE.svg")
    options = parser.parse_args()
    files = [scene.split("=", 1) for scene in options.scenes]
    plot([(name, read_pixels(file)) for name, file in files], options.output)


if __name__ == "__main__":
    main()
