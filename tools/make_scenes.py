#!/usr/bin/env python3
# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Writes the scenes in scenes/. Each run writes the same bytes. With --sphereflake it writes one sphereflake of any
size. With --fine it writes scenes that have more detail than pixels."""

import argparse
import pathlib

from scenegen import features, fine
from scenegen.colored_meshes import write_colored_meshes
from scenegen.showcase import showcase
from scenegen.sphereflake import sphereflake
from scenegen.still_life import still_life
from scenegen.wavefront import write_obj_scenes


def write_each(scenes, folder):
    folder.mkdir(parents=True, exist_ok=True)
    for scene in scenes:
        scene().write(folder / f"{scene.__name__}.gltf")


def write_all(folder):
    write_each(features.SCENES, folder)
    sphereflake(2).write(folder / "sphereflake.gltf")
    showcase().write(folder / "showcase.gltf", separate_buffer=True)
    still_life().write(folder / "still_life.gltf", separate_buffer=True)
    write_obj_scenes(folder)
    write_colored_meshes(folder)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--sphereflake", type=int, metavar="LEVEL", help="write 1 + 9 + ... + 9^LEVEL spheres")
    parser.add_argument("--fine", action="store_true", help="write textures.gltf and wires.gltf; needs -o FOLDER")
    parser.add_argument("--endless-ground", action="store_true", help="put a plane under the sphereflake, not a square")
    parser.add_argument(
        "-o",
        "--output",
        type=pathlib.Path,
        help="folder to write, or .gltf file with --sphereflake (default: scenes/ of this repository)",
    )
    arguments = parser.parse_args()
    if arguments.fine:
        if arguments.output is None or arguments.sphereflake is not None:
            parser.error("--fine needs -o FOLDER, and no --sphereflake")
        write_each(fine.SCENES, arguments.output)
    elif arguments.sphereflake is None:
        write_all(arguments.output or pathlib.Path(__file__).resolve().parent.parent / "scenes")
    elif arguments.output is None or not 0 <= arguments.sphereflake <= 7:
        parser.error("--sphereflake takes a level of 0 to 7 and needs -o FILE.gltf")
    else:
        sphereflake(arguments.sphereflake, arguments.endless_ground).write(arguments.output)


if __name__ == "__main__":
    main()
