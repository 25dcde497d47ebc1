#!/usr/bin/env python3
# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""flip.py FOLDER PICTURES: adds to FOLDER/runs.json the mean FLIP error of each picture of frames, of those that
`promin-report --pictures PICTURES` wrote; or a gap that says why not: PyPI's flip-evaluator is not installed, or it
fails. Andersson et al., "Visualizing Errors in Rendered High Dynamic Range Images", 2021."""

import importlib.util
import pathlib
import sys

from report_file import read_report, write_report


def _measure(rows, pictures):
    import flip_evaluator  # only where it is there

    errors, truth = [], None
    for index in range(len(rows)):
        own_truth = pictures / f"{index}.truth.exr"
        # The first row of a scene has one.
        truth = own_truth if own_truth.exists() else truth
        picture = pictures / f"{index}.exr"
        errors.append(float(flip_evaluator.evaluate(str(truth), str(picture), "HDR", applyMagma=False)[1]))
    return errors


def main():
    if len(sys.argv) != 3:
        sys.exit("flip.py FOLDER PICTURES")
    file, pictures = pathlib.Path(sys.argv[1]) / "runs.json", pathlib.Path(sys.argv[2])
    report = read_report(file)
    frames = report["frames"]
    is_installed = importlib.util.find_spec("flip_evaluator") is not None
    # What stays where its library takes this program with it.
    reason = "it ended without a word" if is_installed else "not installed"
    frames["gaps"] = [{"name": "FLIP", "is_installed": is_installed, "reason": reason}]
    write_report(report, file)
    if not is_installed:
        return
    try:
        errors = _measure(frames["rows"], pictures)
        frames["gaps"] = []
        for row, error in zip(frames["rows"], errors):
            row["flip"] = error
    except Exception as problem:  # whatever a library of others throws
        frames["gaps"][0]["reason"] = f"{type(problem).__name__}: {problem}"
    write_report(report, file)


if __name__ == "__main__":
    main()
