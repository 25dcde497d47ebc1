# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Work that is divided into pieces and saved in a folder, as `promin render --job` and `promin cast --job` do it.

    from promin import jobs

    job = jobs.create("render", {"scene": "scene.gltf", "spp": 64, "pieces": 16}, "job")
    runner = job.runner()
    for piece in job.pieces:
        runner.run(piece.number)
    job.merge(["picture.exr"])

The job and the number of a piece determine the piece bit for bit. Any process or machine that can access the folder,
including the programs, may therefore make any piece at any time. docs/jobs.md describes the files of the folder."""

from __future__ import annotations

import json
import math
import os
import re
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from operator import index
from pathlib import Path
from typing import Any, Literal, Protocol, Union

import numpy as np
from numpy.typing import NDArray

from promin import _promin
from promin._device import Device, DeviceInfo, DeviceLike, find_device
from promin._errors import Cancelled, DeviceError, Error, InputError, RunError, UsageError
from promin._ledger import Ledger, Receipt

PathLike = Union[str, "os.PathLike[str]"]
Stop = Callable[[], bool]
Make = Callable[[int], "tuple[str, bytes]"]

__all__ = [
    "Cancelled",
    "Comparison",
    "DeviceError",
    "Error",
    "InputError",
    "Job",
    "Piece",
    "RaySource",
    "Receipt",
    "Runner",
    "RunError",
    "UsageError",
    "create",
    "create_with",
    "list_gpus",
    "open",
    "parse_arguments",
]


@dataclass(frozen=True)
class Piece:
    """A piece of a job, whether done or not."""

    number: int
    """Number of the piece, counted from 0."""
    name: str
    """Name of the piece in the manifest. It contains the part of the whole that the piece covers."""
    file: str
    """The file of the piece, which exists when the piece is done."""
    weight: float
    """Amount of work relative to other pieces of the job: pixels or rays."""


@dataclass(frozen=True)
class Comparison:
    """The result of comparing an existing piece with the same piece made again, perhaps on another device."""

    is_equal: bool
    """True if both pieces have the same bits."""
    is_within: bool
    """True if both pieces are equal or differ only within the bounds between devices: at most 0.5 % of pixels or rays
    are mismatches."""
    largest: float
    """The largest difference of pixels or rays that are not mismatches. For a pixel's numbers it is at most 0.004
    (relative for numbers above 1); for rays it is at most 16, in units of K of t (docs/glossary.md)."""
    mismatches: int
    """Number of mismatches: pixels or rays that differ by more than the bounds, or that show another surface, for
    example because of rounding at an edge."""
    count: int
    """Number of all pixels or rays of the piece. It is set only if the pieces are not equal."""


class RaySource(Protocol):
    """A source of rays other than a .npy file. The runners of a job use it on their threads."""

    @property
    def count(self) -> int:
        """Number of rays."""

    @property
    def name(self) -> str:
        """Name of the container of the rays, without its folder."""

    @property
    def size_bytes(self) -> int:
        """Size of the container in bytes."""

    @property
    def sha256(self) -> str:
        """A hash over all rays, which identifies the rays."""

    def read(self, first: int, count: int) -> NDArray[np.float32]:
        """Returns the rays `first` to `first` + `count` - 1 as (count, 8) float32 in C order: origin, tmin, direction,
        tmax."""


def parse_arguments(kind: str, arguments: Sequence[str]) -> dict[str, Any]:
    """Returns the specification that the arguments of a command describe, as the command's --print-spec prints it: a
    dict with absolute paths of files.

    kind: "render" or "cast". arguments: the arguments of this command of promin, without the options that each process
    chooses, such as --job and --device. Raises UsageError for arguments that the command refuses, InputError for a file
    of --spec."""
    spec: dict[str, Any] = json.loads(_promin.spec_of_words(str(kind), _words_of(arguments), True))
    return spec


def create(
    kind: str, spec: Mapping[str, Any] | Sequence[str], folder: PathLike, *, rays: RaySource | None = None
) -> Job:
    """Creates the job of a specification in a folder, or continues the one that exists.

    kind: "render" or "cast". spec: a dict of the members that --print-spec of this command of promin prints, such as
    {"scene": "a.gltf", "spp": 64}; "pieces" or "tiles" divides the work. Or a list of the command's arguments, without
    --output, --offsets and the options that each process chooses, such as --job and --device. The scene and all other
    inputs of pieces are read and hashed. The folder records the specification with absolute paths, so `open` needs only
    the folder. rays: for "cast", replaces the file of rays, which the specification must still name; after opening the
    job elsewhere, pass it again to `Job.runner`. Raises UsageError for a specification that the command refuses, and if
    the folder belongs to another job, with the difference; InputError, RunError."""
    if isinstance(spec, Mapping):
        text = json.dumps({f"promin_{kind}_spec": 1, **spec}, default=os.fsdecode)
    else:
        text = _promin.spec_of_words(str(kind), _words_of(spec), False)
    name = os.fsdecode(folder)
    plan = _promin.PlannedJob.plan(str(kind), text, name, rays)
    return Job(plan.create(name), name, plan, rays=rays)


def create_with(
    kind: str,
    folder: PathLike,
    *,
    options: Mapping[str, str],
    pieces: Sequence[str],
    files: Sequence[PathLike] = (),
    make: Make | None = None,
) -> Job:
    """Creates or continues a job, as `create` does, but a function makes its pieces.

    kind: a word for the kind of the pieces. options: everything that determines the pieces' bytes, except files, which
    are hashed. pieces: the names of the pieces, all different, of letters, digits, "_" and "-". make: takes a piece's
    number and returns a text about the piece and its bytes, which must always be the same; after opening the job
    elsewhere, pass it again to `Job.runner`. A job of the kind "cast" can be merged if its texts and bytes have the
    format that docs/jobs.md gives for rays.

    Raises UsageError if the folder belongs to another job, InputError, RunError."""
    names = [str(name) for name in pieces]
    wrong = next((name for name in names if not re.fullmatch(r"[A-Za-z0-9_-]+", name)), None)
    if not names or wrong is not None or len(set(names)) < len(names):
        what = f"{wrong!r} is not a name of a piece" if wrong is not None else "pieces are none or have equal names"
        raise UsageError(f"{what}; give different names of letters, digits, _ and -")
    pairs = [(str(name), str(value)) for name, value in options.items()]
    name = os.fsdecode(folder)
    native = _promin.Job.create_with(name, str(kind), pairs, [os.fsdecode(file) for file in files], names)
    return Job(native, name, make=make)


def open(folder: PathLike) -> Job:
    """Opens the job of a folder. The function reads only the folder and needs neither scenes nor devices. Raises
    InputError if there is no job."""
    name = os.fsdecode(folder)
    return Job(_promin.Job.open(name), name)


def list_gpus() -> list[str]:
    """Returns an argument for `Job.runner`, "uuid:…", for each device of this machine that is not a CPU. The list is
    empty if there is no such device or no Vulkan."""
    try:
        infos = Device.list()
    except DeviceError:
        return []
    return [f"uuid:{info.uuid}" for info in infos if info.type != "CPU" and info.uuid and not info.obstacles]


class Job:
    """A job in its folder, as `create` and `open` return it. Any thread may use it. Each request for the state of a
    piece reads the disk."""

    def __init__(
        self,
        native: _promin.Job,
        folder: str,
        plan: _promin.PlannedJob | None = None,
        make: Make | None = None,
        rays: RaySource | None = None,
    ) -> None:
        """Use `create`, `create_with` or `open`."""
        self._native = native
        self._folder = folder
        self._plan = plan
        self._make = make
        self._rays = rays
        record = native.describe()
        self._id: str = record["id"]
        self._kind: str = record["kind"]
        self._options: dict[str, str] = dict(record["options"])
        self._files: list[tuple[str, int, str]] = record["files"]
        names: list[str] = record["pieces"]
        self._pieces = tuple(Piece(i, name, native.file_of(i), _weigh(name)) for i, name in enumerate(names))
        self._ledger = Ledger(Path(folder) / "ledger", names)

    @property
    def id(self) -> str:
        """SHA-256 of all inputs of the pieces."""
        return self._id

    @property
    def kind(self) -> str:
        """ "render", "cast", or the kind given to `create_with`."""
        return self._kind

    @property
    def folder(self) -> str:
        """The folder as the caller gave it."""
        return self._folder

    @property
    def pieces(self) -> tuple[Piece, ...]:
        """All pieces, indexed by their numbers."""
        return self._pieces

    @property
    def options(self) -> dict[str, str]:
        """The inputs that determine the pieces' bytes, except files: the version of results, and options by their
        names."""
        return dict(self._options)

    @property
    def files(self) -> list[tuple[str, int, str]]:
        """Name, size in bytes and SHA-256 of each file on which the pieces depend."""
        return list(self._files)

    @property
    def spec(self) -> dict[str, Any] | None:
        """The specification from which `runner` makes pieces: a dict of the members that --print-spec prints, with
        absolute paths; None for a job of `create_with`."""
        text = self._native.spec()
        spec: dict[str, Any] | None = None if text is None else json.loads(text)
        return spec

    def state(self, number: int) -> Literal["done", "missing", "bad"]:
        """Reads and hashes a piece on the disk and returns its state: "done", "missing", or "bad" if it is incomplete,
        damaged or belongs to another job."""
        state: Any = self._native.state_of(number)[0]
        return state  # type: ignore[no-any-return]

    def why(self, number: int) -> str:
        """Returns the fault of a bad piece, e.g. "the piece is incomplete"; empty if there is none."""
        return self._native.state_of(number)[1]

    def sha256(self, number: int) -> str:
        """Returns the SHA-256 of the bytes of a piece that is done. Raises InputError if the piece is not done."""
        return self._native.sha256(number)

    def read(self, number: int) -> tuple[str, bytes]:
        """Returns the text and the bytes of a piece that is done. Raises InputError if the piece is not done."""
        return self._native.read(number)

    def preview(self, number: int, most_px: int = 128) -> NDArray[np.uint8] | None:
        """Returns a preview of a piece of a picture, sRGB (rows, columns, 3) without tone mapping, with at most the
        given number of rows and columns; None for other pieces. Raises InputError if the piece is not done."""
        if self._kind != "render":
            return None
        description, data = self.read(number)
        header = json.loads(description)
        left, top, right, bottom = header["part"]
        rows, columns = bottom - top, right - left
        linear = np.frombuffer(data, "<f4", 3 * rows * columns).reshape(rows, columns, 3)
        step = max(1, -(-max(rows, columns) // most_px))
        first_row, first_column = min(step // 2, rows - 1), min(step // 2, columns - 1)
        picked = np.nan_to_num(linear[first_row::step, first_column::step])
        light = np.clip(picked * 2.0 ** header["exposure_ev"], 0, 1)
        codes = np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
        return np.ascontiguousarray(np.round(255.0 * codes), np.uint8)

    def receipt(self, number: int) -> Receipt | None:
        """Returns the record of a piece that is done; None for other pieces. Fields that the ledger lacks, for example
        because a process was killed before it could write them, are empty or 0."""
        stored = self._native.stored(number)
        if stored is None:
            return None
        sha256, size = stored
        recorded = self._ledger.find(number, sha256)
        if recorded is not None:
            return recorded
        name = self._pieces[number].name
        return Receipt(number, name, sha256, size, 0.0, "", "", self._options.get("version", ""), "", 0)

    def events(self, maker: str | None = None) -> list[dict[str, Any]]:
        """Returns the events of all ledgers sorted by time, or the events of one maker in the order of its ledger. Each
        event is a dict with "event" ("begun", "done", "failed" or "stopped"), "number", "piece", "time_s" (since 1970),
        "made_on", "fingerprint" and "maker" (HOST-PID); "done" adds the fields of a Receipt, "failed" the sentence
        "why". A maker without an event after "begun" is still making the piece, or has died."""
        return self._ledger.events(maker)

    def write(
        self,
        number: int,
        description: str,
        data: bytes,
        ms: float = 0.0,
        made_on: str = "",
        fingerprint: str = "",
    ) -> Receipt:
        """Writes a piece, completely or not at all, and its receipt. Programs that make pieces themselves use this
        function. The text and the bytes must be the same as any other maker would write. Raises RunError."""
        return Receipt(**self._native.write(number, description, data, ms, made_on, fingerprint))

    def runner(
        self,
        device: DeviceLike = None,
        make: Make | None = None,
        *,
        rays: RaySource | None = None,
        on_step: Callable[[str], object] = lambda words: None,
    ) -> Runner:
        """Returns a Runner, which makes pieces on this machine. The Runner reads the scene and opens the device once.

        device: a Device, a part of a device's name, an index, or None for the default device. make, rays: the
        arguments of `create_with` and `create`. on_step: receives the name of each long step, such as "loads the
        scene" or "compiles". Processes share the tree of a large scene in DIR/trees; the first process that needs the
        tree writes it. Raises UsageError if a file or the version of results has changed since the job was created,
        and names the change; InputError if the folder does not say how pieces are made, or a file is missing;
        DeviceError, RunError."""
        make = make or self._make
        if make is None and (self._plan is None or (rays is not None and rays is not self._rays)):
            if self._kind not in ("render", "cast"):
                raise UsageError(f"pieces of the kind {self._kind!r} are made by a function; give it as make")
            on_step("loads the scene")
            self._plan = _promin.PlannedJob.plan_again(self._native, rays or self._rays)
        on_step("compiles")
        return Runner(self, device, make)

    def check_outputs(self, outputs: Sequence[PathLike]) -> None:
        """Checks before the work whether `merge` would refuse these files: their extensions and number, several frames
        in one file, and files that are inputs of the job. Raises UsageError, InputError."""
        self._native.check_outputs([os.fsdecode(output) for output in outputs])

    def merge(
        self, outputs: Sequence[PathLike], *, allow_mixed: bool = False, frames: Sequence[int] | None = None
    ) -> None:
        """Combines all pieces and writes the files. The files have the same bytes as those of a single run. Each file
        is written completely or not at all.

        outputs: for "render", pictures (.exr, .png); for a camera path the names have #### in place of the number of a
        frame. For "cast", one .npy file of hits or counts; with --all also the file of offsets. allow_mixed: whether
        results of rays may come from several drivers. frames: only these frames of a camera path, so only their pieces
        must be done; None: all. Raises RunError if pieces are missing or bad, and names some; InputError if they do not
        belong together; UsageError."""
        chosen = None if frames is None else [index(frame) for frame in frames]
        if chosen and min(chosen) < 0:
            raise UsageError(f"frames has {min(chosen)}, of {self.folder}; frames are counted from 0")
        self._native.merge([os.fsdecode(output) for output in outputs], allow_mixed, chosen, None)

    def clear_leftovers(self) -> None:
        """Removes temporary files that processes on this machine left when they ended while writing."""
        self._native.clear_leftovers()

    def __repr__(self) -> str:
        return f"<promin.jobs.Job {self._kind} in {self._folder}, {len(self._pieces)} pieces>"

    def __reduce__(self) -> tuple[Any, ...]:
        return open, (self._folder,)


class Runner:
    """Makes pieces of a job on one device. Only one thread at a time may use it. It releases Python's lock, so other
    threads run meanwhile. Ctrl-C stops a piece before its next dispatch, and nothing of this piece is written."""

    def __init__(self, job: Job, device: DeviceLike, make: Make | None) -> None:
        """Use `Job.runner`."""
        self._job = job
        self._make = make
        self._device: Device | None = None
        self._native: _promin.Runner | None = None
        if make is None:
            assert job._plan is not None
            self._device = find_device(device)
            self._native = _promin.Runner(self._device._native, job._plan, job._native)

    @property
    def job(self) -> Job:
        """The job whose pieces the Runner makes."""
        return self._job

    @property
    def made_on(self) -> str:
        """Device and driver of the Runner; "Python" if a function makes the pieces."""
        return "Python" if self._native is None else self._native.made_on()

    @property
    def fingerprint(self) -> str:
        """SHA-256 over device, driver and the device's results for fixed rays and a fixed picture. Devices with the
        same fingerprint are assumed to give the same bits. Empty if a function makes the pieces. Each process computes
        it once per device, which takes about a second."""
        if self._device is None:
            return ""
        info = self._device.info
        with _asking:
            if info not in _fingerprints:
                _fingerprints[info] = _promin.fingerprint_of(self._device._native)
            return _fingerprints[info]

    def run(self, number: int, stop: Stop | None = None) -> Receipt:
        """Makes and writes a piece unless the piece is done. Returns the receipt of the new or the existing piece.

        If another build of promin has made the job's pieces, the first call makes one of them again to compare the
        bits.

        stop: a function that is called about twenty times a second; if a function makes the pieces, `stop` is called
        before and after it. If it returns True, `run` raises Cancelled and nothing is written. Every event is recorded
        in the ledger. Raises InputError if an input has changed, UsageError if another build of promin has made the
        job's pieces with other bits, RunError."""
        done = self._job.receipt(number)
        if done is not None:
            return done
        if self._native is not None:
            return Receipt(**self._native.run(number, self.fingerprint, _progress_of(stop)))
        native = self._job._native
        native.tell_begun(number, self.made_on, "")
        begun = time.monotonic()
        try:
            description, data = self._call_make(number, stop)
            return self._job.write(number, description, data, 1e3 * (time.monotonic() - begun), self.made_on)
        except Cancelled:
            native.tell_stopped(number, self.made_on, "")
            raise
        except Exception as error:
            native.tell_failed(number, self.made_on, "", str(error) or type(error).__name__)
            raise

    def recompute(self, number: int, stop: Stop | None = None) -> str:
        """Makes a piece again and returns the SHA-256 of its bytes, to compare with `Job.sha256` of the piece on the
        disk. Writes nothing."""
        if self._native is not None:
            return self._native.recompute(number, _progress_of(stop))
        import hashlib

        return hashlib.sha256(self._call_make(number, stop)[1]).hexdigest()

    def compare(self, number: int, stop: Stop | None = None) -> Comparison:
        """Makes a piece again and compares it with the piece on the disk. Writes nothing. Devices with the same
        fingerprint give the same bits; pieces of other devices agree within the bounds. For pieces that a function
        makes, only equal bits count as agreement. Raises InputError if the piece is not done."""
        if self._native is not None:
            return Comparison(**self._native.compare(number, _progress_of(stop)))
        is_equal = self.recompute(number, stop) == self._job.sha256(number)
        return Comparison(is_equal, is_equal, 0.0, 0, 0)

    def _call_make(self, number: int, stop: Stop | None) -> tuple[str, bytes]:
        assert self._make is not None
        _heed(stop)
        description, data = self._make(number)
        _heed(stop)
        if not isinstance(description, str) or not isinstance(data, bytes):
            raise UsageError(f"make({number}) gives {type(description)} and {type(data)}; return a text and bytes")
        return description, data


def _words_of(arguments: Sequence[str]) -> list[str]:
    """Returns the arguments of a command as texts. Raises UsageError for a single text, and for words that are not
    UTF-8: os.fsdecode represents their bytes by surrogates."""
    if isinstance(arguments, str):
        raise UsageError(f"arguments are {arguments!r}; give a list of words")
    words = [os.fsdecode(word) if isinstance(word, (str, bytes, os.PathLike)) else str(word) for word in arguments]
    for word in words:
        if re.search("[\ud800-\udfff]", word):
            raise UsageError(f"the argument {word!r} is not UTF-8, so a job cannot record it; rename the file")
    return words


def _weigh(name: str) -> float:
    """Returns the number of pixels or rays of a piece. The piece's name contains the ranges of its rows and columns, or
    of its rays."""
    ranges = [int(end) - int(begin) for begin, end in re.findall(r"(\d+)-(\d+)", name)]
    return float(math.prod(ranges)) if ranges else 1.0


def _heed(stop: Stop | None) -> None:
    if stop is not None and stop():
        raise Cancelled("cancelled")


def _progress_of(stop: Stop | None) -> Callable[[float], bool] | None:
    if stop is None:
        return None
    _heed(stop)
    return lambda fraction: not stop()


def _renew_lock() -> None:
    global _asking
    _asking = threading.Lock()


_asking = threading.Lock()
_fingerprints: dict[DeviceInfo, str] = {}
# Another thread may have held the lock at the fork.
os.register_at_fork(after_in_child=_renew_lock)
