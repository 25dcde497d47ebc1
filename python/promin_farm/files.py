# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Files that several machines may write at once: each appears whole or not at all, and there are no locks."""

from __future__ import annotations

import json
import os
import secrets
from pathlib import Path
from typing import Any


def write_whole(file: Path, content: str | bytes) -> None:
    """Replaces the file at once. Raises OSError."""
    file.parent.mkdir(parents=True, exist_ok=True)
    temporary = _write_beside(file, content)
    try:
        os.replace(temporary, file)
    except OSError:
        temporary.unlink(missing_ok=True)
        raise


def claim(file: Path, content: str) -> str:
    """Writes the file if it is not there, and returns what it holds: of several who claim at once all get the words of
    one. A link is made or not at all, on NFS too. Raises OSError."""
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
    """The object that the file holds; None where it is not there or holds none."""
    try:
        value = json.loads(file.read_bytes())
    except (OSError, ValueError):
        return None
    return value if isinstance(value, dict) else None


def _write_beside(file: Path, content: str | bytes) -> Path:
    temporary = file.with_name(f".{file.name}.{os.getpid()}-{secrets.token_hex(4)}.tmp")
    # Names of files in it need not be UTF-8: os.fsdecode's stand-ins become their bytes again.
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
