#!/usr/bin/env python3
# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""flip.py REFERENCE PICTURE...: prints the mean FLIP error of each EXR as a JSON array; an empty one where PyPI's
flip-evaluator is not installed. Andersson et al., "Visualizing Errors in Rendered High Dynamic Range Images", 2021."""

import json
import sys

try:
    import flip_evaluator
except ImportError:
    print("[]")
    sys.exit(0)

reference, *pictures = sys.argv[1:]
print(json.dumps([float(flip_evaluator.evaluate(reference, file, "HDR", applyMagma=False)[1]) for file in pictures]))
