#!/usr/bin/env python3
# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Shows many scene files as a user first sees them: a sheet of small pictures, and a table of what promin says of each.

Renders each FILE with the promin of a build, without options but a size, and puts the pictures side by side, row by row
in the order of the files. Prints a Markdown table: each file's place in the sheet, and the warnings or the refusal. A file
that is refused has no picture. Exit codes: 0, and 1 where promin crashes over a file or takes too long."""

import argparse
import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import zlib

SIGNATURE = b"\x89PNG\r\n\x1a\n"
BACKGROUND = bytes((40, 40, 40))


def read_png(path):
    """Rows of bytes of an RGB picture of 8 bits, as promin writes them (PNG, 3rd edition, section 9)."""
    data = path.read_bytes()
    if data[:8] != SIGNATURE:
        raise ValueError(f"{path} is no PNG")
    at, compressed, header = 8, b"", None
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at : at + 8])
        content = data[at + 8 : at + 8 + length]
        if kind == b"IHDR":
            header = struct.unpack(">IIBBBBB", content)
        elif kind == b"IDAT":
            compressed += content
        at += 12 + length
    width, height, depth, color, _, _, interlace = header
    if (depth, color, interlace) != (8, 2, 0):
        raise ValueError(f"{path} is not RGB of 8 bits")
    return unfilter(zlib.decompress(compressed), 3 * width, height)


def unfilter(raw, stride, height):
    rows, above = [], bytearray(stride)
    for y in range(height):
        kind = raw[y * (stride + 1)]
        row = bytearray(raw[y * (stride + 1) + 1 : (y + 1) * (stride + 1)])
        for i in range(stride):
            left = row[i - 3] if i >= 3 else 0
            corner = above[i - 3] if i >= 3 else 0
            predicted = (0, left, above[i], (left + above[i]) // 2, paeth(left, above[i], corner))[kind]
            row[i] = (row[i] + predicted) & 255
        rows.append(bytes(row))
        above = row
    return rows


def paeth(left, above, corner):
    estimate = left + above - corner
    distances = (abs(estimate - left), abs(estimate - above), abs(estimate - corner))
    return (left, above, corner)[distances.index(min(distances))]


def write_png(path, rows):
    """Each row's bytes are stored as differences from the left, which compresses what is smooth."""
    stride = len(rows[0])
    raw = b"".join(
        b"\x01" + bytes((row[i] - (row[i - 3] if i >= 3 else 0)) & 255 for i in range(stride)) for row in rows
    )
    chunks = (
        (b"IHDR", struct.pack(">IIBBBBB", stride // 3, len(rows), 8, 2, 0, 0, 0)),
        (b"IDAT", zlib.compress(raw, 9)),
        (b"IEND", b""),
    )
    with open(path, "wb") as file:
        file.write(SIGNATURE)
        for kind, content in chunks:
            file.write(struct.pack(">I", len(content)) + kind + content)
            file.write(struct.pack(">I", zlib.crc32(kind + content)))


def render(promin, scene, size, folder):
    """The rows of the scene's picture or None, what promin says of it, and whether it failed as it must not."""
    picture = folder / "picture.png"
    picture.unlink(missing_ok=True)
    command = [promin, "render", scene, "-o", picture, "--size", *map(str, size), "--spp", "4"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)
    except subprocess.TimeoutExpired:
        return None, "takes more than 300 s", True
    said = [line.removeprefix("promin: ") for line in done.stderr.splitlines()]
    said = [line for line in said if line.startswith(("warning: ", "error: "))]
    said = [line.replace(str(scene), pathlib.Path(scene).name) for line in said]
    rows = read_png(picture) if done.returncode == 0 else None
    return rows, "; ".join(said), done.returncode not in (0, 3)


def join(pictures, size, columns):
    width, height = size
    empty = [BACKGROUND * width] * height
    rows = []
    for first in range(0, len(pictures), columns):
        row = pictures[first : first + columns]
        row += [empty] * (columns - len(row))
        rows += [b"".join(picture[y] for picture in row) for y in range(height)]
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", metavar="FILE", nargs="+", help="scene files")
    parser.add_argument("-o", required=True, metavar="SHEET.png", help="the sheet to write")
    parser.add_argument("--promin", default="build/release/bin/promin", metavar="PROGRAM", help="default: %(default)s")
    parser.add_argument("--size", nargs=2, type=int, default=(160, 120), metavar=("W", "H"), help="of a picture")
    parser.add_argument("--columns", type=int, default=8, metavar="N", help="pictures in a row; default: %(default)s")
    options = parser.parse_args()
    if len(options.files) == 1:
        root = os.path.dirname(options.files[0])
    else:
        root = os.path.commonpath([os.path.dirname(file) for file in options.files])

    pictures, has_failed = [], False
    print("| place | file | what promin says |\n|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for file in options.files:
            rows, said, is_failure = render(options.promin, file, options.size, pathlib.Path(folder))
            has_failed = has_failed or is_failure
            place = "refused" if rows is None else "{}, {}".format(*(n + 1 for n in divmod(len(pictures), options.columns)))
            print(f"| {place} | {os.path.relpath(file, root or '.')} | {said} |", flush=True)
            if rows is not None:
                pictures.append(rows)
    if pictures:
        write_png(options.o, join(pictures, options.size, options.columns))
    return 1 if has_failed else 0


if __name__ == "__main__":
    sys.exit(main())
