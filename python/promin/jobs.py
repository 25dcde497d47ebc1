# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Work in pieces that a folder keeps: what `promin render --job` and `promin cast --job` do, from Python.

    from promin import jobs

    job = jobs.create("render", ["scene.gltf", "--spp", "64", "--pieces", "16"], "job")
    runner = job.runner()
    for piece in job.pieces:
        runner.run(piece.number)
    job.merge(["picture.exr"])

A piece is a function of the job and its number, to the bit, so that whoever sees the folder may make any of them at any
time: processes, machines, the programs. docs/jobs.md has the formats of the folder."""

from __future__ import annotations

import heapq
import json
import math
import os
import re
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from operator import index
from pathlib import Path
from typing import Any, Literal, Protocol, Union

import numpy as np
from numpy.typing import NDArray

from promin import _promin
from promin._device import Device, DeviceInfo, DeviceLike, find_device
from promin._errors import Cancelled, DeviceError, Error, InputError, RunError, UsageError

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
]


@dataclass(frozen=True)
class Piece:
    """A piece of a job, done or not."""

    number: int
    """From 0 on."""
    name: str
    """As the manifest has it: what of the whole it is."""
    file: str
    """Where it lies when it is done."""
    weight: float
    """How much there is to do, beside other pieces of the job: pixels, or rays."""


@dataclass(frozen=True)
class Receipt:
    """What is told of a piece that was made."""

    number: int
    name: str
    sha256: str
    """Of the piece's bytes."""
    bytes: int
    ms: float
    """What making it took."""
    made_on: str
    """Device and driver."""
    fingerprint: str
    """`Runner.fingerprint`; empty where a program made it, which does not ask."""
    version: str
    """Of promin."""
    host: str
    pid: int

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return asdict(self)


@dataclass(frozen=True)
class Comparison:
    """How a piece that is there is beside the same one made anew, perhaps by another device."""

    is_equal: bool
    """To the bit."""
    is_within: bool
    """Equal, or within the bounds between devices: at most 0.5 % of pixels or rays are others."""
    largest: float
    """Of those that are no others the largest difference: of a number of a pixel, at most 0.004 (of numbers beyond 1
    relative to them); or of K of t (docs/glossary.md), at most 16."""
    others: int
    """Pixels or rays that differ by more, or show another surface, as where an edge decides by a rounding."""
    count: int
    """Of all pixels or rays of the piece, where it is not equal."""


class RaySource(Protocol):
    """Rays that are not those of a .npy file. The runners of a job use it on their threads."""

    @property
    def count(self) -> int:
        """Of rays."""

    @property
    def name(self) -> str:
        """Of what they are kept in, without its folder."""

    @property
    def size_bytes(self) -> int:
        """Of what they are kept in."""

    @property
    def sha256(self) -> str:
        """A hash over all rays, which tells them from any others."""

    def read(self, first: int, count: int) -> NDArray[np.float32]:
        """The rays first...first + count, as (count, 8) float32 in C order: origin, tmin, direction, tmax."""


def create(kind: str, arguments: Sequence[str], folder: PathLike, *, rays: RaySource | None = None) -> Job:
    """Makes the job of a command in a folder, or goes on with the one that is there.

    kind: "render" or "cast". arguments: the words that this command of promin takes, without --output, --offsets,
    --job, --piece and --device; --pieces (or --tiles) cuts it. The scene and all that a piece hangs on are read and
    hashed. Files are kept by their absolute paths, in the folder, so that `open` knows the rest. rays: of "cast", takes
    the place of the file that the words name all the same; whoever opens the job elsewhere passes it again, to
    `Job.runner`. Raises UsageError for what the command refuses, and where the folder has another job, which says what
    differs; InputError, RunError."""
    if isinstance(arguments, str):
        raise UsageError(f"arguments are {arguments!r}; give a list of words")
    words = [os.fsdecode(word) if isinstance(word, (str, bytes, os.PathLike)) else str(word) for word in arguments]
    for word in words:
        if not _is_utf8(word):
            raise UsageError(
                f"the argument {word!r} is not UTF-8, in which a job tells what it is made of; rename the file"
            )
    name = os.fsdecode(folder)
    plan = _promin.PlannedJob.plan(str(kind), words, name, rays)
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
    """The same for a job whose pieces a function makes.

    kind: a word for what the pieces are. options: all that decides about their bytes, beside files, which are hashed.
    pieces: their names, all different, of letters, digits, "_" and "-". make: takes a piece's number and returns a text
    about it and its bytes, always the same; whoever opens the job elsewhere passes it again, to `Job.runner`. A job of
    the kind "cast" whose texts and bytes are those that docs/jobs.md has of answers to rays can be merged.

    Raises UsageError where the folder has another job, InputError, RunError."""
    names = [str(name) for name in pieces]
    wrong = next((name for name in names if not re.fullmatch(r"[A-Za-z0-9_-]+", name)), None)
    if not names or wrong is not None or len(set(names)) < len(names):
        what = f"{wrong!r} is no name of a piece" if wrong is not None else "pieces are none, or have the same name"
        raise UsageError(f"{what}; give different names of letters, digits, _ and -")
    pairs = [(str(name), str(value)) for name, value in options.items()]
    name = os.fsdecode(folder)
    native = _promin.Job.create_with(name, str(kind), pairs, [os.fsdecode(file) for file in files], names)
    return Job(native, name, make=make)


def open(folder: PathLike) -> Job:
    """The job of a folder, which is read alone: nothing of scenes and devices. Raises InputError where there is none."""
    name = os.fsdecode(folder)
    return Job(_promin.Job.open(name), name)


def list_gpus() -> list[str]:
    """What `Job.runner` takes for each device of this machine that is no processor, "uuid:…"; empty where there are
    none, or no Vulkan."""
    try:
        infos = Device.list()
    except DeviceError:
        return []
    return [f"uuid:{info.uuid}" for info in infos if info.type != "CPU" and info.uuid and not info.obstacles]


class Job:
    """A job in its folder, as `create` and `open` give it. Any threads may use it. What is done is read from the disk
    whenever it is asked for."""

    def __init__(
        self,
        native: _promin.Job,
        folder: str,
        plan: _promin.PlannedJob | None = None,
        make: Make | None = None,
        rays: RaySource | None = None,
    ) -> None:
        """For `create`, `create_with` and `open`."""
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
        self._ledger = _Ledger(Path(folder) / "ledger", names)

    @property
    def id(self) -> str:
        """SHA-256 of all that pieces hang on."""
        return self._id

    @property
    def kind(self) -> str:
        """ "render", "cast", or what `create_with` was given."""
        return self._kind

    @property
    def folder(self) -> str:
        """As it was given."""
        return self._folder

    @property
    def pieces(self) -> tuple[Piece, ...]:
        """All of them, by their numbers."""
        return self._pieces

    @property
    def options(self) -> dict[str, str]:
        """What decides about the pieces' bytes beside the files: the program's version, options by name."""
        return dict(self._options)

    @property
    def files(self) -> list[tuple[str, int, str]]:
        """Name, bytes and SHA-256 of the files that pieces hang on."""
        return list(self._files)

    @property
    def arguments(self) -> list[str] | None:
        """The command's words, by which `runner` makes pieces; None for a job of `create_with`."""
        return self._native.arguments()

    def state(self, number: int) -> Literal["done", "missing", "bad"]:
        """What the disk tells of a piece, which is read and hashed whenever it is asked: "done", "missing", or "bad"
        where it is cut, damaged or of another job."""
        state: Any = self._native.state_of(number)[0]
        return state  # type: ignore[no-any-return]

    def why(self, number: int) -> str:
        """What is bad about a piece, "is cut"; empty where nothing is."""
        return self._native.state_of(number)[1]

    def sha256(self, number: int) -> str:
        """Of the bytes of a piece that is done. Raises InputError where it is not."""
        return self._native.sha256(number)

    def read(self, number: int) -> tuple[str, bytes]:
        """What its maker says of a piece that is done, and its bytes. Raises InputError where it is not."""
        return self._native.read(number)

    def preview(self, number: int, most_px: int = 128) -> NDArray[np.uint8] | None:
        """A piece of a picture to look at, sRGB (rows, columns, 3) of at most so many rows and columns, without tone
        mapping; None of other pieces. Raises InputError where it is not done."""
        if self._kind != "render":
            return None
        description, data = self.read(number)
        told = json.loads(description)
        left, top, right, bottom = told["part"]
        rows, columns = bottom - top, right - left
        linear = np.frombuffer(data, "<f4", 3 * rows * columns).reshape(rows, columns, 3)
        step = max(1, -(-max(rows, columns) // most_px))
        first_row, first_column = min(step // 2, rows - 1), min(step // 2, columns - 1)
        picked = np.nan_to_num(linear[first_row::step, first_column::step])
        light = np.clip(picked * 2.0 ** told["exposure_ev"], 0, 1)
        codes = np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
        return np.ascontiguousarray(np.round(255.0 * codes), np.uint8)

    def receipt(self, number: int) -> Receipt | None:
        """What is told of a piece that is done; None where it is not. What the ledger does not know of it (it may be of
        a process that was ended before it could tell) is empty or 0."""
        stored = self._native.stored(number)
        if stored is None:
            return None
        sha256, size = stored
        told = self._ledger.find(number, sha256)
        if told is not None:
            return told
        name = self._pieces[number].name
        return Receipt(number, name, sha256, size, 0.0, "", "", self._options.get("version", ""), "", 0)

    def events(self, maker: str | None = None) -> list[dict[str, Any]]:
        """What the ledger tells, by time, or what one maker tells, in its order: dicts with "event" ("begun", "done",
        "failed" or "stopped"), "number", "piece", "time_s" (since 1970), "made_on", "fingerprint" and "maker"
        (HOST-PID); with "done" what a Receipt has, with "failed" the sentence "why". A maker that has begun a piece and
        tells no more of it has died, or is at it."""
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
        """Writes a piece, whole or not at all, and its receipt. It is for makers of pieces of their own; the text and
        the bytes must be those that any other maker would write. Raises RunError."""
        return Receipt(**self._native.write(number, description, data, ms, made_on, fingerprint))

    def runner(
        self,
        device: DeviceLike = None,
        make: Make | None = None,
        *,
        rays: RaySource | None = None,
        tell: Callable[[str], object] = lambda words: None,
    ) -> Runner:
        """What makes pieces here: the scene is read and the device opened once.

        device: a Device, a part of a name, an index, or None for the default one. make, rays: as `create_with` and
        `create` were given them. tell: is told what takes its time, as "loads the scene" or "compiles". The tree of a large scene is that of DIR/trees, where the first who needs it puts it.
        Raises UsageError where the job would be another one today, as a file or the program has changed, and says
        which; InputError where the folder does not say how pieces are made, or a file is gone; DeviceError,
        RunError."""
        make = make or self._make
        if make is None and (self._plan is None or (rays is not None and rays is not self._rays)):
            if self._kind not in ("render", "cast"):
                raise UsageError(f"pieces of the kind {self._kind!r} are made by a function; give it as make")
            tell("loads the scene")
            self._plan = _promin.PlannedJob.plan_again(self._native, rays or self._rays)
        tell("compiles")
        return Runner(self, device, make)

    def check_outputs(self, outputs: Sequence[PathLike]) -> None:
        """Finds before the work what `merge` would refuse these files for: their endings or number, frames that would go to
        one, and a file that the job's pieces hang on. Raises UsageError, InputError."""
        self._native.check_outputs([os.fsdecode(output) for output in outputs])

    def merge(
        self, outputs: Sequence[PathLike], *, allow_mixed: bool = False, frames: Sequence[int] | None = None
    ) -> None:
        """Makes the files of all pieces, byte for byte those of a single run; each whole or not at all.

        outputs: of "render" pictures (.exr, .png), of a camera path with #### for the number; of "cast" one .npy of
        hits or counts, and of --all the offsets after it. allow_mixed: whether answers to rays may be those of several
        drivers. frames: of a camera path only these, whose pieces alone must be there; None: all. Raises RunError where
        pieces are missing or bad, which names some; InputError where they do not belong together, UsageError."""
        chosen = None if frames is None else [index(frame) for frame in frames]
        if chosen and min(chosen) < 0:
            raise UsageError(f"frames has {min(chosen)}, of {self.folder}; frames are counted from 0")
        self._native.merge([os.fsdecode(output) for output in outputs], allow_mixed, chosen, None)

    def clear_leftovers(self) -> None:
        """Removes the temporary files of writers on this machine that have ended before they were done."""
        self._native.clear_leftovers()

    def __repr__(self) -> str:
        return f"<promin.jobs.Job {self._kind} in {self._folder}, {len(self._pieces)} pieces>"

    def __reduce__(self) -> tuple[Any, ...]:
        return open, (self._folder,)


class Runner:
    """Makes pieces of a job on one device, for one thread at a time; without Python's lock, so others run meanwhile.
    Ctrl-C ends a piece before its next dispatch, and nothing of it is written."""

    def __init__(self, job: Job, device: DeviceLike, make: Make | None) -> None:
        """For `Job.runner`."""
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
        """Whose pieces it makes."""
        return self._job

    @property
    def made_on(self) -> str:
        """Device and driver; "Python" where a function makes the pieces."""
        return "Python" if self._native is None else self._native.made_on()

    @property
    def fingerprint(self) -> str:
        """SHA-256 over device, driver and the device's answers to fixed rays and a fixed picture: devices with the same
        one are taken to give the same bits. Empty where a function makes the pieces. A process asks a device once, which
        takes about a second."""
        if self._device is None:
            return ""
        info = self._device.info
        with _asking:
            if info not in _fingerprints:
                _fingerprints[info] = _promin.fingerprint_of(self._device._native)
            return _fingerprints[info]

    def run(self, number: int, stop: Stop | None = None) -> Receipt:
        """Makes a piece unless it is done, writes it, and returns its receipt, or that of the one that is there.

        stop: is asked about twenty times a second, of pieces that a function makes before and after it; where it
        returns True, `run` raises Cancelled and nothing is written. Raises InputError where an input has changed,
        RunError. The ledger is told of all of it."""
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
        """Makes a piece anew and returns the SHA-256 of its bytes, as `Job.sha256` tells that of the one on the disk;
        nothing is written."""
        if self._native is not None:
            return self._native.recompute(number, _progress_of(stop))
        import hashlib

        return hashlib.sha256(self._call_make(number, stop)[1]).hexdigest()

    def compare(self, number: int, stop: Stop | None = None) -> Comparison:
        """Makes a piece anew and compares it with the one on the disk; nothing is written. Devices of one fingerprint
        give the same bits; those of others are within the bounds. Pieces that a function makes are equal or not. Raises
        InputError where the piece is not done."""
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


class _Ledger:
    """Reads what makers tell, and what they have told since the last time; a line that is not whole yet waits."""

    def __init__(self, folder: Path, pieces: Sequence[str]) -> None:
        self._folder = folder
        self._pieces = pieces
        self._ends: dict[str, int] = {}
        self._by_maker: dict[str, list[tuple[float, dict[str, Any]]]] = {}
        self._receipts: dict[int, list[dict[str, Any]]] = {}
        self._lock = threading.Lock()

    def events(self, maker: str | None) -> list[dict[str, Any]]:
        with self._lock:
            self._read()
            lists = self._by_maker.values() if maker is None else [self._by_maker.get(maker, [])]
            return [event for _, event in heapq.merge(*lists, key=lambda timed: timed[0])]

    def find(self, number: int, sha256: str) -> Receipt | None:
        """The last that was told of a piece with these bytes."""
        with self._lock:
            self._read()
            for event in reversed(self._receipts.get(number, [])):
                if event["sha256"] == sha256:
                    return _receipt_of(event)
            return None

    def _read(self) -> None:
        for file in sorted(self._folder.glob("*.jsonl")):
            begin = self._ends.get(file.name, 0)
            with file.open("rb") as stream:
                stream.seek(begin)
                text = stream.read()
            whole = text[: text.rfind(b"\n") + 1]
            self._ends[file.name] = begin + len(whole)
            told = self._by_maker.setdefault(file.stem, [])
            for event in _parse(whole, self._pieces):
                event["maker"] = file.stem
                # A clock that is put back does not change the order in which a maker tells.
                told.append((max(float(event["time_s"]), told[-1][0] if told else 0.0), event))
                if event["event"] == "done":
                    self._receipts.setdefault(event["number"], []).append(event)


_OF_ANY = {"event": str, "number": int, "piece": str, "time_s": (int, float), "made_on": str, "fingerprint": str}
_OF_RECEIPT = {"sha256": str, "size_bytes": int, "ms": (int, float), "version": str, "host": str, "pid": int}


def _parse(text: bytes, pieces: Sequence[str]) -> Iterator[dict[str, Any]]:
    """The lines that are events of these pieces; what a disk has damaged is left out."""
    for line in text.splitlines():
        try:
            event = json.loads(line)
        except ValueError:
            continue
        if not isinstance(event, dict):
            continue
        fields: dict[str, Any] = {**_OF_ANY, **(_OF_RECEIPT if event.get("event") == "done" else {})}
        if not all(isinstance(event.get(name), kind) for name, kind in fields.items()):
            continue
        if 0 <= event["number"] < len(pieces) and event["piece"] == pieces[event["number"]]:
            yield event


def _receipt_of(event: dict[str, Any]) -> Receipt:
    return Receipt(
        number=event["number"],
        name=event["piece"],
        sha256=event["sha256"],
        bytes=event["size_bytes"],
        ms=float(event["ms"]),
        made_on=event["made_on"],
        fingerprint=event["fingerprint"],
        version=event["version"],
        host=event["host"],
        pid=event["pid"],
    )


def _is_utf8(word: str) -> bool:
    """Whether it holds none of os.fsdecode's stand-ins for other bytes."""
    try:
        word.encode()
    except UnicodeEncodeError:
        return False
    return True


def _weigh(name: str) -> float:
    """The ranges in a piece's name are its rows and columns, or its rays."""
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
# Another thread may have held it at the fork.
os.register_at_fork(after_in_child=_renew_lock)
