#!/usr/bin/env python3
# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Tests that tools/joined_names finds the names that clash in joined sources, and accepts all others.

joined_names_test.py TOOL"""

import pathlib
import subprocess
import sys
import tempfile

FIRST = """
#include <span>
#define PARTS(NAME) case NAME: return 1;
namespace promin {
namespace {
using Json = int;
using std::string;

constexpr int kSize = 1 << 20;  // kPlain
const char* const kWords[] = {"namespace { int kQuoted; }", "}"};
struct Row : Base<int> {
  int member() { return kPlain; }
};

template <typename Number, size_t N>
requires std::is_integral_v<Number>
std::array<Number, N> make_row(const std::map<int, int>& values = {}) {
  return {};
}
[[nodiscard]] bool is_good(float value) { return value > 0; }

}  // namespace
static void turn() {}

int count(int value) {
  struct Local {};
  const int kLocal = 1;
  return value;
}
Row::Row() : member_(1) {}
TEST(Names, Differ) {}
}  // namespace promin
"""
# Each text declares a name of FIRST once more. The line is that of the clash in FIRST.
CLASHES = {
    "namespace { using Json = long; }": 6,
    "namespace { int kSize; }": 9,
    "namespace { constexpr std::array kWords = {1}; }": 10,
    "namespace { enum class Row { kOne }; }": 11,
    "namespace promin { namespace { template <typename T> int make_row(T) { return 0; } } }": 15,
    "int is_good(double value) { return 0; }\nint user() { return is_good(1.0); }": 20,
    "static int turn(int x) {\n  return x;\n}": 23,
    "TEST(Names, Differ) {}": 31,
}
FINE = """
namespace {
using Json = int;
using std::string;
int kLocal, kPlain, kQuoted, member;
struct Local {};
void PARTS_of() {}
}  // namespace
TEST(Names, Agree) {}
int other(int value) { return value; }
"""


def run(tool, folder, *texts):
    files = [folder / f"{i}.cpp" for i in range(len(texts))]
    for file, text in zip(files, texts):
        file.write_text(text)
    # All files are in one group. Each is also alone in a group, where it clashes with nothing.
    (folder / "list").write_text("".join(f"a/0 {file}\nb/{file.stem} {file}\n" for file in files))
    done = subprocess.run([sys.executable, tool, folder / "list"], capture_output=True, text=True)
    return done.returncode, done.stdout


def main():
    tool = sys.argv[1]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        found = run(tool, folder, FIRST, FINE)
        assert found == (0, ""), found
        for text, line in CLASHES.items():
            code, said = run(tool, folder, FIRST, text, "int call() { return is_good(2.0) + count(1); }")
            assert code == 1 and said.count("\n") == 1, (text, said)
            assert f"{folder}/0.cpp:{line}" in said and f"{folder}/1.cpp:1" in said, (text, said)


if __name__ == "__main__":
    main()
