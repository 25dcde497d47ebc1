# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""The thickness of a closed workpiece along an axis.

    python thickness.py MESH -o thickness.npy [--picture thickness.png] [--axis z]

Parallel rays, one for each point of a grid, list all their crossings with the workpiece. The lengths between entering
and leaving it add up to its thickness. Edges and corners count once (`Caster.list`), so every pixel is right."""

from __future__ import annotations

import argparse

import numpy as np

import promin
from promin.testing import heat


def measure(scene: promin.Scene, axis: int, columns: int) -> np.ndarray:
    """Returns the lengths of material (rows, columns) in world units; 0 where there is no material."""
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
    # A ray enters the material if it runs against the normal, and leaves the material if it runs along the normal.
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
