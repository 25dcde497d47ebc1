#!/usr/bin/env python3
# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Computes a table of engine/device_scene/lobe_table.h and prints it, for engine/device_scene/{lobe,sheen}_table.def.

Each row has a roughness r, from 0 to 1. Each column has a square root of the cosine v to the eye.

lobes: the integrals over the hemisphere of V D l (lower 16 bits of the word) and of V D (1 - V.H)^5 l (upper 16 bits),
where D is GGX's density and V Smith's height-correlated visibility (glTF 2.0, B.3). At r = 0 they are 1 and (1 - v)^5.

sheens: half of the integral of V D l (lower 16 bits). D and V are those of KHR_materials_sheen, but V is at most 1; v
is at least 2^-10 and r at least 0.07. The integral is up to 1.65. It can exceed 1, because V is a fit that reflects
more light than arrives on smooth fibres seen from the side.

The program samples half vectors in proportion to D on a lattice, so the integral is the mean of 4 V l (V.H) / (N.H).
tests/oracle/lobe_test.cpp compares the tables with another method of quadrature.
"""

import argparse
import itertools
import math
import sys

SIDE = 32
SAMPLES = 128  # points along each of the two axes of the lattice


def half_vectors(v, cosine_of):
    """Yields N.L, V.H and 4 (V.H) / (N.H) for each half vector whose light comes from above, with the fraction it
    stands for."""
    sine_v = math.sqrt(1.0 - v * v)
    # The lobe is symmetric about the plane of the eye, so half of all azimuths are enough.
    cosines = [math.cos(math.pi * (i + 0.5) / SAMPLES) for i in range(SAMPLES)]
    for i in range(SAMPLES):
        # `x` is the fraction of D that lies beyond the half vector. The points are denser where the integrand has
        # roots: at the normal, and even more at the horizon, which contributes a large part of a lobe that is seen from
        # the side.
        x = (i + 0.5) / SAMPLES
        beyond = (1.0 - x * x) ** 4
        density = 8.0 * x * (1.0 - x * x) ** 3
        n_h = cosine_of(beyond)
        across = sine_v * math.sqrt(max(0.0, 1.0 - n_h * n_h))
        for cosine in cosines:
            v_h = across * cosine + v * n_h
            n_l = 2.0 * v_h * n_h - v
            if n_l > 0.0 and v_h > 0.0:
                yield n_l, v_h, 4.0 * density * v_h / n_h


def lobe_shares(v, roughness):
    """Returns E1 and B for a cosine and a roughness."""
    if roughness == 0.0:
        return 1.0, (1.0 - v) ** 5
    a2 = roughness**4
    e1 = b = 0.0
    for n_l, v_h, weight in half_vectors(v, lambda beyond: math.sqrt(beyond / (beyond + a2 * (1.0 - beyond)))):
        visibility = 0.5 / (n_l * math.sqrt(a2 + (1.0 - a2) * v * v) + v * math.sqrt(a2 + (1.0 - a2) * n_l * n_l))
        share = weight * visibility * n_l
        e1 += share
        b += share * max(0.0, 1.0 - v_h) ** 5
    return e1 / SAMPLES**2, b / SAMPLES**2


def fitted_lambda(cosine, alpha):
    """Returns Lambda of KHR_materials_sheen."""
    t = (1.0 - alpha) ** 2
    a, b, c, d, e = (
        rough + t * (smooth - rough)
        for rough, smooth in (
            (21.5473, 25.3245),
            (3.82987, 3.32435),
            (0.19823, 0.16801),
            (-1.97760, -1.27393),
            (-4.32054, -4.85967),
        )
    )

    def curve(x):
        return a / (1.0 + b * x**c) + d * x + e

    return math.exp(curve(cosine) if cosine < 0.5 else 2.0 * curve(0.5) - curve(1.0 - cosine))


def sheen_shares(v, roughness):
    """Returns half of the light that a sheen of colour 1 reflects under uniform light, and 0 for the second half of the
    entry."""
    v = max(v, 2.0**-10)
    alpha = max(roughness, 0.07) ** 2
    to_eye = fitted_lambda(v, alpha)
    sent = 0.0
    # The fraction of D up to a sine s is s^(2 + 1 / alpha).
    exponent = 2.0 / (2.0 + 1.0 / alpha)
    for n_l, _, weight in half_vectors(v, lambda beyond: math.sqrt(max(1e-300, 1.0 - (1.0 - beyond) ** exponent))):
        visibility = min(1.0, 1.0 / ((1.0 + to_eye + fitted_lambda(min(n_l, 1.0), alpha)) * 4.0 * v * n_l))
        sent += weight * visibility * n_l
    return 0.5 * sent / SAMPLES**2, 0.0


def word(shares):
    """Returns the table entry that packs two fractions."""
    low, high = (round(65535.0 * min(max(share, 0.0), 1.0)) for share in shares)
    return low | high << 16


def lines(shares):
    """Yields the lines of a table's file."""
    yield "// SPDX-FileCopyrightText: The promin developers"
    yield "// SPDX-License-Identifier: Apache-2.0"
    yield "// tools/make_lobe_table.py made this file. Do not edit it by hand."
    for row in range(SIDE):
        words = [word(shares((column / (SIDE - 1)) ** 2, row / (SIDE - 1))) for column in range(SIDE)]
        for first in range(0, SIDE, 8):
            yield " ".join(f"0x{w:08x}," for w in words[first : first + 8])


def main():
    """Prints the table, or compares a file with it."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("table", choices=("lobes", "sheens"))
    parser.add_argument("--check", metavar="FILE", help="print where this file differs from the table; exit code 1")
    arguments = parser.parse_args()
    made = lines({"lobes": lobe_shares, "sheens": sheen_shares}[arguments.table])
    if arguments.check is None:
        print("\n".join(made))
        return 0
    with open(arguments.check, encoding="utf-8") as file:
        found = file.read().splitlines()
    for number, (wanted, got) in enumerate(itertools.zip_longest(made, found), start=1):
        if wanted != got:
            print(f"{arguments.check}:{number}: not what the tool makes: {wanted}", file=sys.stderr)
            return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
