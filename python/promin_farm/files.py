# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Files that several machines may write at the same time, without locks. Each file appears completely or not at all."""

from __future__ import annotations

import json
import os
import secrets
from pathlib import Path
from typing import Any


def write_whole(file: Path, content: str | bytes) -> None:
    """Replaces the file atomically. Raises OSError."""
    file.parent.mkdir(parents=True, exist_ok=True)
    temporary = _write_beside(file, content)
    try:
        os.replace(temporary, file)
    except OSError:
        temporary.unlink(missing_ok=True)
        raise


def claim(file: Path, content: str) -> str:
    """Writes the file if it does not exist, and returns its content. If several processes write it at the same time,
    all get the content of one of them, because creating a link is atomic, also on NFS. Raises OSError."""
    try:
        return file.read_text()
    except FileNotFoundError:
        pass
    file.parent.mkdir(parents=True, exist_ok=True)
    temporary = _write_beside(file, content)
    try:
        os.link(temporary, file)
    except FileExistsError:
        pass
    finally:
        temporary.unlink(missing_ok=True)
    return file.read_text()


def read_json(file: Path) -> dict[str, Any] | None:
    """Returns the JSON object in the file; None if the file does not exist or contains no JSON object."""
    try:
        value = json.loads(file.read_bytes())
    except (OSError, ValueError):
        return None
    return value if isinstance(value, dict) else None


def _write_beside(file: Path, content: str | bytes) -> Path:
    temporary = file.with_name(f".{file.name}.{os.getpid()}-{secrets.token_hex(4)}.tmp")
    # File names in the content need not be UTF-8. Surrogates of os.fsdecode become the original bytes again.
    data = content.encode(errors="surrogateescape") if isinstance(content, str) else content
    try:
        with open(temporary, "xb") as stream:
            stream.write(data)
            stream.flush()
            os.fsync(stream.fileno())
    except OSError:
        temporary.unlink(missing_ok=True)
        raise
    return temporary
