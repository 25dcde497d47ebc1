#!/usr/bin/env python3
# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Lists the shared libraries that a library needs, directly or through other libraries. Each library comes after the
libraries that it needs itself.

list_libraries.py LIBRARY OUTPUT: writes their names to OUTPUT, one on each line. image/open_pictures.cpp opens them in
this order. If the tools for reading libraries are missing, or the library is for another machine, the list is empty.
Opening pictures then only takes longer.
"""

import re
import subprocess
import sys


def find_in_output(pattern, *command):
    try:
        done = subprocess.run(command, capture_output=True, text=True)
    except OSError:
        return []
    return re.findall(pattern, done.stdout, re.MULTILINE)


def needed_by(file):
    return find_in_output(r"\(NEEDED\).*\[(.+)\]", "readelf", "--dynamic", "--wide", file)


def main():
    library, output = sys.argv[1:]
    files = dict(find_in_output(r"^\s*(\S+) => (/\S+)", "ldd", library))
    names = []
    visited = set()

    def visit(name):
        if name in visited or name not in files:
            return
        visited.add(name)
        for other in needed_by(files[name]):
            visit(other)
        names.append(name)

    for name in needed_by(library):
        visit(name)
    with open(output, "w") as file:
        file.writelines(name + "\n" for name in names)


if __name__ == "__main__":
    main()
