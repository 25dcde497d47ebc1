# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""What the farm keeps in the folder of a job beside the job itself: `farm/farm.json`, and who gives the job its bits."""

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
    """What `resume` and workers find in the folder."""

    outputs: list[str] = field(default_factory=list)
    """Files that the whole is written to, absolute."""
    allow_mixed: bool = False
    """Whether pieces of different fingerprints may go together, frame by frame."""
    retries_from: float = 0.0
    """Time (seconds since 1970) since which failures count: that of the last `render`, `cast` or `resume`."""

    @staticmethod
    def read(folder: Path) -> Settings:
        """Of a job that the farm has begun; those of any other job are the defaults. Raises InputError."""
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
        """These with other outputs, where there are any."""
        return replace(self, outputs=[str(Path(output).absolute()) for output in outputs]) if outputs else self


def group_of(job: jobs.Job, piece: jobs.Piece, settings: Settings) -> str:
    """What has bits of one fingerprint: the whole job, or with `allow_mixed` a frame, and of a cast each piece."""
    if not settings.allow_mixed:
        return "job"
    return piece.name if job.kind == "cast" else frame_of(piece) or "job"


def frame_of(piece: jobs.Piece) -> str:
    """ "frame000012" of a path's pieces; empty of others."""
    frame = _FRAME.match(piece.name)
    return str(frame.group()) if frame else ""


def frame_number_of(piece: jobs.Piece) -> int | None:
    """12 of "frame000012"."""
    frame = frame_of(piece)
    return int(frame.removeprefix("frame")) if frame else None


def owner_file(folder: Path, group: str) -> Path:
    """Holds the fingerprint of a group."""
    return folder / "farm" / "fingerprints" / group


def claim_group(folder: Path, group: str, fingerprint: str) -> str:
    """The fingerprint that the group has, which is this one if it had none. Raises RunError."""
    file = owner_file(folder, group)
    try:
        return claim(file, fingerprint + "\n").strip()
    except OSError as error:
        raise jobs.RunError(f"cannot write ({error.strerror}), {file}; check the disk and permissions") from error


def claim_what_is_there(job: jobs.Job, settings: Settings, fingerprints: dict[int, str]) -> None:
    """Gives groups the fingerprints that their pieces have, by number: those of a job that other settings or promin
    itself have begun. Raises RunError."""
    groups = {
        (group_of(job, job.pieces[number], settings), fingerprint) for number, fingerprint in fingerprints.items()
    }
    for group, fingerprint in sorted(groups):
        claim_group(Path(job.folder), group, fingerprint)
