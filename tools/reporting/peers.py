#!/usr/bin/env python3
# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Whole pictures of the sphereflake beside Tachyon and POV-Ray: prints what time_frames of tools/bench_driver.py tells
as JSON, with a hash of the scene's file."""

import argparse
import hashlib
import json
import pathlib
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))

from bench_driver import time_frames


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--programs", type=pathlib.Path, required=True, help="folder of the built programs")
    parser.add_argument("--runs", type=int, required=True)
    parser.add_argument("--side", type=int, required=True, help="pixels each way")
    parser.add_argument("--level", type=int, required=True, help="of the sphereflake: 4 has 7381 spheres")
    parser.add_argument("--device", help="as `promin render` takes it")
    arguments = parser.parse_args()
    options = ("--device", arguments.device) if arguments.device else ()
    with tempfile.TemporaryDirectory() as folder:
        try:
            programs = arguments.programs.resolve()
            times = time_frames(
                programs, pathlib.Path(folder), arguments.runs, arguments.side, arguments.level, options
            )
            scene = (pathlib.Path(folder) / "flake.gltf").read_bytes()
            times["scene_hash"] = hashlib.sha256(scene).hexdigest()[:16]
        except RuntimeError as problem:
            sys.exit(f"peers.py: error: {problem}")
    print(json.dumps(times))


if __name__ == "__main__":
    main()
