#!/usr/bin/env python3
# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Tests that tools/prose finds the patterns it lists, accepts plain sentences, and fails if a file has more suspects
than the baseline; that docs/tour.md names files and functions that exist.

prose_test.py TEST TOOLS: TEST is a function below."""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

BASELINE = "tools/prose_baseline.txt"


def expect(holds, what):
    if not holds:
        raise SystemExit(f"failed: {what}")


def run(folder, *words):
    done = subprocess.run([folder / "tools/prose", *words], capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


def make_checkout(folder, files):
    """A checkout of git with tools/prose and these files."""
    (folder / "tools").mkdir()
    shutil.copy(pathlib.Path(sys.argv[2]) / "prose", folder / "tools/prose")
    for name, text in files.items():
        (folder / name).write_text(text)
    for words in (("init", "-q"), ("add", ".")):
        subprocess.run(["git", *words], cwd=folder, check=True)


def finds_suspects(folder):
    files = {
        "odd.h": "/// Of lists: what is asked.\n// It hangs on\n// the driver.\nint plain;  // The number of rays.\n",
        "odd.py": '"""Whoever calls.\n\nReturns the hits."""\nerror = "the file tells of other rays"  # Plain words.\n',
        "odd.md": "# Of headings\n\nA page of\nthe farm. The rest is plain: `told`.\n\n```\ntold\n```\n\n| told | plain |\n",
        "plain.glsl": '// Returns the nearest hit.\n/* told */\nchar told = \'"\';\n',
    }
    make_checkout(folder, files)
    # A run of comments is one text, which begins on its first line.
    expected = {"odd.h": [1, 1], "odd.py": [1, 4], "odd.md": [3, 10], "plain.glsl": []}
    for name, lines in expected.items():
        _, text = run(folder, "--all", name)
        found = [int(line.split(":")[1]) for line in text.splitlines()]
        expect(found == lines, f"{name}: suspects in the lines {found}, expected {lines}\n{text}")


def baseline_only_shrinks(folder):
    make_checkout(folder, {"a.h": "// Of one.\n// Of two.\n", "b.h": "// Plain words.\n"})
    (folder / BASELINE).write_text("2 a.h\n")
    expect(run(folder) == (0, ""), "as many suspects as the baseline allows are no failure")
    (folder / "b.h").write_text("// Of three.\n")
    code, text = run(folder)
    expect(code == 1 and "b.h has 1 suspects, of 0 allowed" in text, f"a new suspect fails: {text}")
    run(folder, "--lower")
    expect((folder / BASELINE).read_text() == "2 a.h\n", "lowering raises nothing")
    (folder / "a.h").write_text("// Of one.\n")
    (folder / "b.h").write_text("// Plain words.\n")
    code, text = run(folder)
    expect(code == 0 and "--lower" in text, f"fewer suspects say how to lower the baseline: {text}")
    run(folder, "--lower")
    expect((folder / BASELINE).read_text() == "1 a.h\n", "lowering writes the lower count")


def tour_names_what_exists(_):
    repository = pathlib.Path(sys.argv[2]).parent
    steps = re.findall(r"^ *Code: (.*?)\n\n", (repository / "docs/tour.md").read_text(), re.MULTILINE | re.DOTALL)
    expect(len(steps) == 12, f"{len(steps)} of 12 steps name their code")
    for place in "; ".join(" ".join(step.split()) for step in steps).split("; "):
        file, *functions = re.findall(r"`([^`]+)`", place)
        text = (repository / file).read_text()
        for function in functions:
            expect(re.search(rf"\b{function}\b", text), f"{file} has {function}")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as name:
        globals()[sys.argv[1]](pathlib.Path(name))
