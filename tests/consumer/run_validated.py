#!/usr/bin/env python3
# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""run_validated.py CONSUMER ARGUMENT...: runs the consumer under the Khronos validation layer, which writes to the
standard output. Anything there besides the consumer's one line is a failure.

Exits with 77, which ctest counts as skipped, if the layer is not installed.
"""

import os
import pathlib
import subprocess
import sys

FOLDERS = ("/usr/share/vulkan", "/usr/local/share/vulkan", "/etc/vulkan", "/usr/local/etc/vulkan")


def is_layer_installed():
    files = [file for folder in FOLDERS for file in pathlib.Path(folder).glob("explicit_layer.d/*.json")]
    return any("VK_LAYER_KHRONOS_validation" in file.read_text() for file in files)


def main():
    if not is_layer_installed():
        print("the validation layer is not installed")
        sys.exit(77)
    environment = {**os.environ, "VK_INSTANCE_LAYERS": "VK_LAYER_KHRONOS_validation"}
    # If promin loaded the layer itself, promin would receive the layer's messages.
    environment.pop("PROMIN_VALIDATION", None)
    # The layer reports warnings and errors. The variables are those of this release and of older ones.
    environment["VK_LAYER_REPORT_FLAGS"] = "error,warn,perf"
    environment["VK_KHRONOS_VALIDATION_REPORT_FLAGS"] = "error,warn,perf"
    environment["VK_LOADER_DEBUG"] = "layer"
    done = subprocess.run(sys.argv[1:], capture_output=True, text=True, env=environment)
    print(done.stdout + done.stderr)
    if done.returncode != 0:
        sys.exit(f"it ended with {done.returncode}")
    if "VK_LAYER_KHRONOS_validation" not in done.stderr:
        sys.exit("the loader did not take the layer")
    if done.stdout != "the library works\n":
        sys.exit("the validation layer speaks")


if __name__ == "__main__":
    main()
