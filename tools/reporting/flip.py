#!/usr/bin/env python3
# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""flip.py REFERENCE PICTURE...: prints {"errors": the mean FLIP error of each EXR}, or {} where PyPI's flip-evaluator
is not installed; where it is and fails, so does this. Andersson et al., "Visualizing Errors in Rendered High Dynamic
Range Images", 2021."""

import importlib.util
import json
import sys


def main():
    if importlib.util.find_spec("flip_evaluator") is None:
        print("{}")
        return
    import flip_evaluator  # after the question whether it is there

    reference, *pictures = sys.argv[1:]
    errors = [flip_evaluator.evaluate(reference, file, "HDR", applyMagma=False)[1] for file in pictures]
    print(json.dumps({"errors": [float(error) for error in errors]}))


if __name__ == "__main__":
    main()
