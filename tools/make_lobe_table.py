#!/usr/bin/env python3
# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Computes the table of lobes (engine/device_scene/lobe_table.h) and prints it, for engine/device_scene/lobe_table.def.

An entry is of a roughness r (rows, from 0 to 1) and of the square root of the cosine v to the eye (columns): the
integrals over the hemisphere of V D l (lower 16 bits of the word) and of V D (1 - V.H)^5 l (upper 16 bits), where D is
GGX's density and V Smith's height-correlated visibility (glTF 2.0, B.3). At r = 0 they are 1 and (1 - v)^5. Half
vectors are drawn by D on a lattice, so what is left is the mean of 4 V l (V.H) / (N.H). tests/oracle/lobe_test.cpp
holds the table against a quadrature of another kind.
"""

import argparse
import itertools
import math
import sys

SIDE = 32
SAMPLES = 128  # along each of the two axes of the lattice


def shares(v, roughness):
    """E1 and B of a cosine and a roughness."""
    if roughness == 0.0:
        return 1.0, (1.0 - v) ** 5
    a2 = roughness**4
    sine_v = math.sqrt(1.0 - v * v)
    # The lobe lies about the plane of the eye, so half of all azimuths do.
    cosines = [math.cos(math.pi * (i + 0.5) / SAMPLES) for i in range(SAMPLES)]
    e1 = b = 0.0
    for i in range(SAMPLES):
        # The share of D that lies beyond the half vector. Places crowd where the integrand has roots: at the normal,
        # and more so at the horizon, which much of a lobe seen from the side comes from.
        x = (i + 0.5) / SAMPLES
        beyond = (1.0 - x * x) ** 4
        density = 8.0 * x * (1.0 - x * x) ** 3
        n_h = math.sqrt(beyond / (beyond + a2 * (1.0 - beyond)))
        across = sine_v * math.sqrt(max(0.0, 1.0 - n_h * n_h))
        for cosine in cosines:
            v_h = across * cosine + v * n_h
            n_l = 2.0 * v_h * n_h - v
            if n_l <= 0.0 or v_h <= 0.0:
                continue
            visibility = 0.5 / (n_l * math.sqrt(a2 + (1.0 - a2) * v * v) + v * math.sqrt(a2 + (1.0 - a2) * n_l * n_l))
            weight = 4.0 * density * visibility * n_l * v_h / n_h
            e1 += weight
            b += weight * max(0.0, 1.0 - v_h) ** 5
    return e1 / SAMPLES**2, b / SAMPLES**2


def word(v, roughness):
    """The entry of a cosine and a roughness."""
    e1, b = (round(65535.0 * min(max(share, 0.0), 1.0)) for share in shares(v, roughness))
    return e1 | b << 16


def lines():
    """The lines of the table's file."""
    yield "// SPDX-FileCopyrightText: The promin developers"
    yield "// SPDX-License-Identifier: Apache-2.0"
    yield "// Made by tools/make_lobe_table.py. Not edited by hand."
    for row in range(SIDE):
        words = [word((column / (SIDE - 1)) ** 2, row / (SIDE - 1)) for column in range(SIDE)]
        for first in range(0, SIDE, 8):
            yield " ".join(f"0x{w:08x}," for w in words[first : first + 8])


def main():
    """Prints the table, or holds a file against it."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", metavar="FILE", help="say where this file is another, with exit code 1")
    arguments = parser.parse_args()
    if arguments.check is None:
        print("\n".join(lines()))
        return 0
    with open(arguments.check, encoding="utf-8") as file:
        found = file.read().splitlines()
    for number, (wanted, got) in enumerate(itertools.zip_longest(lines(), found), start=1):
        if wanted != got:
            print(f"{arguments.check}:{number}: not what the tool makes: {wanted}", file=sys.stderr)
            return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
