# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""A lidar scan of a scene as a point cloud.

    python lidar.py SCENE -o cloud.ply [--picture cloud.png]

The scanner stands beside the scene, at half its height. It sends a ray for each of 64 beams and 2048 azimuths. Each hit
becomes a point with its distance and the cosine of the angle of incidence, which is the fraction of the light that
returns."""

from __future__ import annotations

import argparse

import numpy as np

import promin


def make_beams(beams: int, azimuths: int) -> np.ndarray:
    """Returns unit directions (beams, azimuths, 3) around +Y, from 25 degrees above the horizon to 35 degrees below
    it."""
    elevation = np.deg2rad(np.linspace(25, -35, beams))[:, None]
    azimuth = np.linspace(0, 2 * np.pi, azimuths, endpoint=False)[None, :]
    level = np.cos(elevation)
    return np.stack(np.broadcast_arrays(level * np.sin(azimuth), np.sin(elevation), level * np.cos(azimuth)), axis=-1)


def write_ply(path: str, points: np.ndarray, intensity: np.ndarray) -> None:
    rows = np.empty(len(points), [("xyz", "<f4", 3), ("intensity", "<f4")])
    rows["xyz"], rows["intensity"] = points, intensity
    names = "".join(f"property float {name}\n" for name in ("x", "y", "z", "intensity"))
    with open(path, "wb") as file:
        file.write(f"ply\nformat binary_little_endian 1.0\nelement vertex {len(rows)}\n{names}end_header\n".encode())
        file.write(rows.tobytes())


def draw(points: np.ndarray, intensity: np.ndarray, size: tuple[int, int]) -> np.ndarray:
    """Returns a picture of the cloud, seen from above and in front, as linear light (rows, columns, 3). Nearer points
    cover farther ones."""
    middle, extent = points.mean(axis=0), np.ptp(points, axis=0).max()
    camera = promin.Camera.look_at(middle + np.array([0.15, 0.45, 0.5]) * extent, middle)
    look, up = np.array(camera.look), np.array(camera.up)
    seen = points - np.array(camera.eye)
    depth = seen @ look
    scale = size[1] / depth
    column = (size[0] / 2 + seen @ np.cross(look, up) * scale).astype(int)
    row = (size[1] / 2 - seen @ up * scale).astype(int)
    inside = (depth > 0) & (column >= 0) & (column < size[0] - 1) & (row >= 0) & (row < size[1] - 1)
    height = (points[:, 1] - points[:, 1].min()) / max(np.ptp(points[:, 1]), 1e-9)
    colors = (0.15 + 0.85 * intensity[:, None]) * np.stack([height, 0.45 + 0.3 * height, 1.1 - height], axis=1)
    picture = np.full((size[1], size[0], 3), 0.01, np.float32)
    order = np.argsort(-depth[inside])
    for dx, dy in ((0, 0), (1, 0), (0, 1), (1, 1)):
        picture[row[inside][order] + dy, column[inside][order] + dx] = colors[inside][order]
    return picture


def main() -> None:
    parser = argparse.ArgumentParser(description="A lidar scan of a scene as a point cloud")
    parser.add_argument("scene")
    parser.add_argument("-o", "--output", default="cloud.ply")
    parser.add_argument("--picture")
    parser.add_argument("--eye", type=float, nargs=3)
    options = parser.parse_args()

    scene = promin.Scene.load(options.scene)
    low, high = scene.bounds
    eye = options.eye or (low + high) / 2 + (high - low) * (0.3, 0.0, 0.45)
    directions = make_beams(64, 2048)
    rays = (eye, directions, 0, np.linalg.norm(high - low))
    hits = promin.Caster(scene).cast(rays)
    is_hit = hits["object"] >= 0
    points = promin.positions(rays, hits)[is_hit]
    intensity = np.abs((hits["normal"] * directions).sum(axis=-1))[is_hit]
    write_ply(options.output, points, intensity)
    if options.picture:
        promin.write_image(options.picture, draw(points, intensity, (640, 360)))
    print(f"{len(points)} points of {is_hit.size} rays: {options.output}")


if __name__ == "__main__":
    main()
