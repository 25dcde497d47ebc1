# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""The farm's own files in a job's folder: `farm/farm.json`, and the fingerprints that determine the bits of the job."""

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
    """Settings that `resume` and the workers read from the job's folder."""

    outputs: list[str] = field(default_factory=list)
    """Absolute paths of the output files."""
    allow_mixed: bool = False
    """True if frames may be made by devices of different fingerprints."""
    retries_from: float = 0.0
    """Time (seconds since 1970) of the last `render`, `cast` or `resume`. Only failures after this time count."""

    @staticmethod
    def read(folder: Path) -> Settings:
        """Reads the settings of a job. A job that the farm has not started has the defaults. Raises InputError."""
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
        """Writes the settings. Raises RunError."""
        file = folder / "farm" / "farm.json"
        try:
            write_whole(file, json.dumps({"promin_farm": FORMAT, **asdict(self)}, indent=1) + "\n")
        except OSError as error:
            raise jobs.RunError(f"cannot write ({error.strerror}), {file}; check the disk and permissions") from error

    def with_outputs(self, outputs: list[str]) -> Settings:
        """Returns these settings with other outputs if outputs are given."""
        return replace(self, outputs=[str(Path(output).absolute()) for output in outputs]) if outputs else self


def group_of(job: jobs.Job, piece: jobs.Piece, settings: Settings) -> str:
    """Returns the name of the group of pieces that must have one fingerprint. It is the whole job; with `allow_mixed`
    it is a frame, or a single piece of a cast."""
    if not settings.allow_mixed:
        return "job"
    return piece.name if job.kind == "cast" else frame_of(piece) or "job"


def frame_of(piece: jobs.Piece) -> str:
    """Returns "frame000012" for a piece of a camera path; empty for other pieces."""
    frame = _FRAME.match(piece.name)
    return str(frame.group()) if frame else ""


def frame_number_of(piece: jobs.Piece) -> int | None:
    """Returns the number of a piece's frame: 12 for "frame000012"."""
    frame = frame_of(piece)
    return int(frame.removeprefix("frame")) if frame else None


def owner_file(folder: Path, group: str) -> Path:
    """Returns the path of the file with the fingerprint of a group."""
    return folder / "farm" / "fingerprints" / group


def claim_group(folder: Path, group: str, fingerprint: str) -> str:
    """Returns the fingerprint of the group. If the group has no fingerprint, it first gets this one. Raises
    RunError."""
    file = owner_file(folder, group)
    try:
        return claim(file, fingerprint + "\n").strip()
    except OSError as error:
        raise jobs.RunError(f"cannot write ({error.strerror}), {file}; check the disk and permissions") from error


def claim_what_is_there(job: jobs.Job, settings: Settings, fingerprints: dict[int, str]) -> None:
    """Sets the fingerprints of groups from the fingerprints of their finished pieces, which are indexed by number. It
    serves jobs that were started with other settings or by promin itself. Raises RunError."""
    groups = {
        (group_of(job, job.pieces[number], settings), fingerprint) for number, fingerprint in fingerprints.items()
    }
    for group, fingerprint in sorted(groups):
        claim_group(Path(job.folder), group, fingerprint)
