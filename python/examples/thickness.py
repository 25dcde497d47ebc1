# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""How thick a closed part is, seen along an axis.

    python thickness.py MESH -o thickness.npy [--picture thickness.png] [--axis z]

Parallel rays through a grid list all crossings of the part; where they enter and leave it tells how much material is on
the way. Edges and corners count once (`Caster.list`), so that no pixel is off."""

from __future__ import annotations

import argparse

import numpy as np

import promin
from promin.testing import heat


def measure(scene: promin.Scene, axis: int, columns: int) -> np.ndarray:
    """Lengths of material (rows, columns), 0 where there is none."""
    low, high = scene.bounds
    across, up = [i for i in range(3) if i != axis]
    size = 1.05 * (high - low)
    rows = max(1, round(columns * size[up] / size[across]))
    middle = (low + high) / 2
    origins = np.empty((rows, columns, 3))
    origins[..., axis] = high[axis] + size[axis]
    origins[..., across] = middle[across] + size[across] * ((np.arange(columns) + 0.5) / columns - 0.5)
    origins[..., up] = (middle[up] - size[up] * ((np.arange(rows) + 0.5) / rows - 0.5))[:, None]
    direction = np.zeros(3)
    direction[axis] = -1

    splits, hits = promin.Caster(scene).list((origins, direction))
    # A crossing against the normal enters the material, one along it leaves it.
    signed = hits["t"].astype(np.float64) * np.sign(hits["normal"] @ direction)
    totals = np.concatenate([[0.0], np.cumsum(signed)])
    return (totals[splits[1:]] - totals[splits[:-1]]).reshape(rows, columns)


def main() -> None:
    parser = argparse.ArgumentParser(description="How thick a closed part is, seen along an axis")
    parser.add_argument("mesh")
    parser.add_argument("-o", "--output", default="thickness.npy")
    parser.add_argument("--picture")
    parser.add_argument("--axis", choices="xyz", default="z")
    parser.add_argument("--columns", type=int, default=480)
    options = parser.parse_args()

    scene = promin.Scene.load(options.mesh)
    thickness = measure(scene, "xyz".index(options.axis), options.columns)
    np.save(options.output, thickness)
    if options.picture:
        promin.write_image(options.picture, heat(thickness / thickness.max()))
    print(f"at most {thickness.max():.6g}, on average {thickness[thickness > 0].mean():.6g}: {options.output}")


if __name__ == "__main__":
    main()
