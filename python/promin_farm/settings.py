# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""The farm's own files in the folder of a job: `farm/farm.json`, and the fingerprints that determine the job's bits."""

from __future__ import annotations

import json
import re
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path

from promin import jobs

from promin_farm.files import claim, read_json, write_whole

FORMAT = 1
_FRAME = re.compile(r"frame\d+(?=_)")


@dataclass(frozen=True)
class Settings:
    """Settings that `resume` and workers read from the folder."""

    outputs: list[str] = field(default_factory=list)
    """Absolute paths of the output files."""
    allow_mixed: bool = False
    """Whether frames may be made by devices of different fingerprints."""
    retries_from: float = 0.0
    """Time (seconds since 1970) from which failures count: that of the last `render`, `cast` or `resume`."""

    @staticmethod
    def read(folder: Path) -> Settings:
        """Reads the settings of a job that the farm has started; other jobs have the defaults. Raises InputError."""
        file = folder / "farm" / "farm.json"
        if not file.exists():
            return Settings()
        damaged = jobs.InputError(
            f"the farm's settings are damaged or of another version, {file}; remove the file, and name the outputs "
            "by -o when you resume"
        )
        there = read_json(file)
        if there is None or there.get("promin_farm") != FORMAT:
            raise damaged
        try:
            return Settings(
                outputs=[str(output) for output in there.get("outputs", [])],
                allow_mixed=bool(there.get("allow_mixed", False)),
                retries_from=float(there.get("retries_from", 0.0)),
            )
        except (TypeError, ValueError):
            raise damaged from None

    def write(self, folder: Path) -> None:
        """Raises RunError."""
        file = folder / "farm" / "farm.json"
        try:
            write_whole(file, json.dumps({"promin_farm": FORMAT, **asdict(self)}, indent=1) + "\n")
        except OSError as error:
            raise jobs.RunError(f"cannot write ({error.strerror}), {file}; check the disk and permissions") from error

    def with_outputs(self, outputs: list[str]) -> Settings:
        """Returns these settings with other outputs, if any are given."""
        return replace(self, outputs=[str(Path(output).absolute()) for output in outputs]) if outputs else self


def group_of(job: jobs.Job, piece: jobs.Piece, settings: Settings) -> str:
    """Returns the group of pieces that must have one fingerprint: the whole job, or with `allow_mixed` a frame, and in
    a cast each piece."""
    if not settings.allow_mixed:
        return "job"
    return piece.name if job.kind == "cast" else frame_of(piece) or "job"


def frame_of(piece: jobs.Piece) -> str:
    """ Returns "frame000012" for pieces of a path; empty for others."""
    frame = _FRAME.match(piece.name)
    return str(frame.group()) if frame else ""


def frame_number_of(piece: jobs.Piece) -> int | None:
    """Returns 12 for "frame000012"."""
    frame = frame_of(piece)
    return int(frame.removeprefix("frame")) if frame else None


def owner_file(folder: Path, group: str) -> Path:
    """Returns the file with the fingerprint of a group."""
    return folder / "farm" / "fingerprints" / group


def claim_group(folder: Path, group: str, fingerprint: str) -> str:
    """Returns the fingerprint of the group, and sets it to this one if it had none. Raises RunError."""
    file = owner_file(folder, group)
    try:
        return claim(file, fingerprint + "\n").strip()
    except OSError as error:
        raise jobs.RunError(f"cannot write ({error.strerror}), {file}; check the disk and permissions") from error


def claim_what_is_there(job: jobs.Job, settings: Settings, fingerprints: dict[int, str]) -> None:
    """Sets the fingerprints of groups from their finished pieces, by number, for a job that was started with other
    settings or by promin itself. Raises RunError."""
    groups = {
        (group_of(job, job.pieces[number], settings), fingerprint) for number, fingerprint in fingerprints.items()
    }
    for group, fingerprint in sorted(groups):
        claim_group(Path(job.folder), group, fingerprint)
