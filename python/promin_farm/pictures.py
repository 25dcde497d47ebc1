# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Previews of pieces of pictures as small files, DIR/farm/pictures/PIECE.png."""

from __future__ import annotations

import struct
import time
import zlib
from pathlib import Path

from promin import jobs

from promin_farm.files import write_whole

_MOST = 400
_PX = 128


def write_pictures(job: jobs.Job, done: set[int], most_s: float) -> dict[int, str]:
    """Returns preview files of finished pieces that are spread over the job. The keys are numbers of pieces; the files
    are relative to the job's folder. Missing previews are made for at most the given time. Raises OSError and promin's
    errors."""
    files = {}
    until = time.monotonic() + most_s
    for number in range(0, len(job.pieces), max(1, -(-len(job.pieces) // _MOST))):
        if number not in done:
            continue
        name = f"farm/pictures/{job.pieces[number].name}.png"
        file = Path(job.folder) / name
        if not file.exists():
            if time.monotonic() > until:
                continue
            pixels = job.preview(number, _PX)
            if pixels is None:
                return {}
            rows, columns = pixels.shape[:2]
            write_whole(file, encode_png(columns, rows, pixels.tobytes()))
        files[number] = name
    return files


def encode_png(columns: int, rows: int, rgb: bytes) -> bytes:
    """Returns the bytes of a PNG file with three channels of 8 bits, whose rows start at the top."""

    def chunk(name: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    lines = b"".join(b"\0" + rgb[3 * columns * y : 3 * columns * (y + 1)] for y in range(rows))
    head = struct.pack(">IIBBBBB", columns, rows, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(lines, 6)) + chunk(b"IEND", b"")
