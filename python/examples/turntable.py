# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Pictures of a scene from all around.

    python turntable.py SCENE -o turntable.png [--views 8]

One Renderer renders all pictures; only the camera moves. The pictures are put side by side in two rows."""

from __future__ import annotations

import argparse

import numpy as np

import promin


def take_views(scene: promin.Scene, count: int, size: tuple[int, int]) -> list[promin.Frame]:
    renderer = promin.Renderer(scene, light="studio")
    low, high = scene.bounds
    middle, radius = (low + high) / 2, np.linalg.norm(high - low) / 2
    frames = []
    for angle in np.linspace(0, 2 * np.pi, count, endpoint=False):
        eye = middle + 2.6 * radius * np.array([np.sin(angle), 0.35, np.cos(angle)])
        camera = promin.Camera.look_at(eye, middle, yfov=0.8)
        frames.append(renderer.render(camera=camera, size=size, target_error=0.05))
    return frames


def main() -> None:
    parser = argparse.ArgumentParser(description="A scene from all around")
    parser.add_argument("scene")
    parser.add_argument("-o", "--output", default="turntable.png")
    parser.add_argument("--views", type=int, default=8)
    options = parser.parse_args()

    frames = take_views(promin.Scene.load(options.scene), options.views, (200, 200))
    half = (len(frames) + 1) // 2
    blank = np.zeros_like(frames[0].rgb)
    pictures = [frame.rgb for frame in frames] + [blank] * (2 * half - len(frames))
    sheet = np.concatenate([np.concatenate(pictures[:half], axis=1), np.concatenate(pictures[half:], axis=1)])
    promin.write_image(options.output, sheet, frames[0].display)
    print(f"{len(frames)} views: {options.output}")


if __name__ == "__main__":
    main()
