# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""A fake of promin.jobs. Its pieces are files whose bytes depend on a scene, which is a JSON file:

    {"pieces": 20, "ms": 5, "bytes": 1000, "names": "y" or "frames", "per_frame": 2, "seed": 1,
     "gate": a file for which makers wait, "crashes": [numbers whose maker is killed], "fails": [numbers that raise]}

A job of "cast" also reads the file of rays. Variables of the environment set the behaviour of a process:
FAKE_FINGERPRINT is its fingerprint, which determines its bits. FAKE_DIFFERENCE is the difference of its pieces from
those of other fingerprints (within the bounds up to 0.004). FAKE_NO_DEVICE removes its device. FAKE_GPUS are the names
of its GPUs. FAKE_SALT changes its bytes as a faulty machine would. FAKE_LOG names a file that gets a line for each
piece that is traced."""

from __future__ import annotations

import hashlib
import json
import os
import signal
import socket
import time
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Optional


class Error(Exception):
    pass


class UsageError(Error, ValueError):
    pass


class InputError(Error):
    pass


class DeviceError(Error):
    pass


class RunError(Error):
    pass


class Cancelled(Error):
    pass


@dataclass(frozen=True)
class Piece:
    number: int
    name: str
    file: str
    weight: float


@dataclass(frozen=True)
class Receipt:
    number: int
    name: str
    sha256: str
    bytes: int
    ms: float
    made_on: str
    fingerprint: str
    version: str
    host: str
    pid: int

    def to_dict(self) -> dict[str, Any]:
        return asdict(self)


@dataclass(frozen=True)
class Comparison:
    is_equal: bool
    is_within: bool
    largest: float
    mismatches: int
    count: int


def parse_arguments(kind: str, arguments: list[str]) -> dict[str, Any]:
    """Reads the scene, for "cast" the rays, and a few options with one or two values."""
    counts = {"--size": 2, "--tiles": 2}
    names = iter(("scene", "rays") if kind == "cast" else ("scene",))
    words = iter("--output" if word == "-o" else word for word in arguments)
    spec: dict[str, Any] = {}
    for word in words:
        if word == "--output":
            spec.setdefault("output", []).append(str(Path(next(words)).absolute()))
        elif word.startswith("--"):
            if word not in counts:
                raise UsageError(f"{word} is not known; see --help")
            spec[word[2:]] = [next(words) for _ in range(counts[word])]
        else:
            spec[next(names)] = str(Path(word).absolute())
    return spec


def create(kind: str, spec: Mapping[str, Any], folder: str | os.PathLike[str]) -> Job:
    scene = Path(spec["scene"])
    if not scene.exists():
        raise InputError(f"cannot open, {scene}; check the name")
    manifest = {
        "fake_job": 1,
        "kind": kind,
        "spec": dict(spec),
        "files": {spec[name]: _hash_file(spec[name]) for name in ("scene", "rays") if name in spec},
        "scene": json.loads(scene.read_text()),
    }
    root = Path(folder).absolute()
    for name in ("pieces", "ledger"):
        (root / name).mkdir(parents=True, exist_ok=True)
    text = json.dumps(manifest, indent=1)
    if (root / "job.json").exists():
        if (root / "job.json").read_text() != text:
            raise UsageError(f"the folder belongs to another job, {root}; take another folder")
    else:
        _write(root / "job.json", text.encode())
    return Job(root)


def open(folder: str | os.PathLike[str]) -> Job:  # noqa: A001 - as promin.jobs has it
    root = Path(folder).absolute()
    if not (root / "job.json").exists():
        raise InputError(f"there is no job in the folder, {root}; name the folder that was given to --job")
    return Job(root)


def list_gpus() -> list[str]:
    return os.environ.get("FAKE_GPUS", "").split()


class Job:
    def __init__(self, root: Path) -> None:
        text = (root / "job.json").read_text()
        self._manifest = json.loads(text)
        if self._manifest.get("fake_job") != 1:
            raise InputError(f"the job was made by another version of promin, {root / 'job.json'}; take another folder")
        self._scene = self._manifest["scene"]
        self._root = root
        self.id = hashlib.sha256(text.encode()).hexdigest()
        self.kind: str = self._manifest["kind"]
        self.folder = str(root)
        self.options: dict[str, str] = {}
        self.pieces = tuple(self._piece(n) for n in range(self._scene["pieces"]))

    def _piece(self, number: int) -> Piece:
        if self._scene.get("names") == "frames":
            frame, row = divmod(number, self._scene.get("per_frame", 2))
            name = f"frame{frame:06}_y{row:05}-{row + 1:05}_x00000-00002"
        else:
            name = f"y{number:05}-{number + 1:05}_x00000-00064"
        return Piece(number, name, str(self._root / "pieces" / f"{name}.piece"), 1.0 + number % 3)

    def _read(self, number: int) -> tuple[str, str, bytes]:
        """Returns the state, the reason and the content of a piece."""
        try:
            data = Path(self.pieces[number].file).read_bytes()
        except FileNotFoundError:
            return "missing", "is missing", b""
        head, _, content = data.partition(b"\n")
        try:
            header = json.loads(head)
            if header["job"] != self.id:
                return "bad", "the piece belongs to another job", b""
            if header["sha256"] != hashlib.sha256(content).hexdigest():
                return "bad", "the piece is damaged", b""
        except (ValueError, KeyError):
            return "bad", "the file is not a piece of a job, or it is incomplete", b""
        return "done", "", content

    def state(self, number: int) -> str:
        return self._read(number)[0]

    def why(self, number: int) -> str:
        return self._read(number)[1]

    def sha256(self, number: int) -> str:
        return hashlib.sha256(self._read(number)[2]).hexdigest()

    def receipt(self, number: int) -> Optional[Receipt]:
        if self.state(number) != "done":
            return None
        return Receipt(**json.loads(Path(self.pieces[number].file).read_bytes().partition(b"\n")[0])["receipt"])

    def events(self, maker: str | None = None) -> list[dict[str, Any]]:
        files = sorted((self._root / "ledger").glob(f"{maker or '*'}.jsonl"))
        events = [{**json.loads(line), "maker": file.stem} for file in files for line in file.read_text().splitlines()]
        return events if maker else sorted(events, key=lambda event: float(event["time_s"]))

    def runner(self, device: str | None = None, *, on_step: Callable[[str], None] = lambda words: None) -> Runner:
        on_step("loads the scene")
        on_step("compiles")
        return Runner(self, device)

    def preview(self, number: int, most_px: int) -> Any:
        import numpy as np

        return np.full((8, 64, 3), number % 256, np.uint8) if self.kind == "render" else None

    def check_outputs(self, outputs: list[str]) -> None:
        endings = (".exr", ".png") if self.kind == "render" else (".npy",)
        frames = {piece.name.split("_")[0] for piece in self.pieces if piece.name.startswith("frame")}
        for output in outputs:
            if not str(output).endswith(endings):
                raise UsageError(f"an output is none of {', '.join(endings)}, {output}; name it so")
            if len(frames) > 1 and "#" not in Path(output).name:
                raise UsageError(
                    f"several frames would be written to one file, {output}; write #### in its name for the number"
                    " of a frame"
                )

    def merge(self, outputs: list[str], *, allow_mixed: bool = False, frames: Optional[list[int]] = None) -> None:
        for frame in frames or ():
            self._write_merged([output.replace("####", f"{frame:04}") for output in outputs], f"frame{frame:06}_")
        if frames is None:
            self._write_merged(outputs, "")

    def _write_merged(self, outputs: list[str], prefix: str) -> None:
        parts = []
        for piece in (piece for piece in self.pieces if piece.name.startswith(prefix)):
            state, why, content = self._read(piece.number)
            if state != "done":
                raise InputError(f"{why}, {piece.file}; run the job again")
            parts.append(content)
        for output in outputs:
            _write(Path(output), b"".join(parts))

    def clear_leftovers(self) -> None:
        for file in self._root.glob("pieces/.*.tmp"):
            file.unlink(missing_ok=True)


class Runner:
    def __init__(self, job: Job, device: str | None) -> None:
        if os.environ.get("FAKE_NO_DEVICE"):
            raise DeviceError("there is no Vulkan device, on this machine; apt install mesa-vulkan-drivers")
        for name, sha256 in job._manifest["files"].items():
            if not Path(name).exists() or _hash_file(name) != sha256:
                raise InputError(f"the file has changed since the job was begun, {name}; take another folder")
        self._job = job
        self.fingerprint = hashlib.sha256(os.environ.get("FAKE_FINGERPRINT", "one").encode()).hexdigest()
        self.made_on = f"fake {device or 'default'}"
        self._ledger = Path(job.folder) / "ledger" / f"{socket.gethostname()}-{os.getpid()}.jsonl"

    def run(self, number: int, stop: Callable[[], bool] | None = None) -> Receipt:
        there = self._job.receipt(number)
        if there:
            return there
        self._tell("begun", number)
        begun = time.monotonic()
        try:
            content = self._trace(number, stop)
        except Cancelled:
            self._tell("stopped", number)
            raise
        except Error as error:
            self._tell("failed", number, why=str(error))
            raise
        piece = self._job.pieces[number]
        receipt = Receipt(
            number=number,
            name=piece.name,
            sha256=hashlib.sha256(content).hexdigest(),
            bytes=len(content),
            ms=1e3 * (time.monotonic() - begun),
            made_on=self.made_on,
            fingerprint=self.fingerprint,
            version="0",
            host=socket.gethostname(),
            pid=os.getpid(),
        )
        header = {"job": self._job.id, "sha256": receipt.sha256, "receipt": receipt.to_dict()}
        try:
            _write(Path(piece.file), json.dumps(header).encode() + b"\n" + content)
        except OSError as error:
            why = f"cannot write ({error.strerror}), {piece.file}; check the disk and permissions"
            self._tell("failed", number, why=why)
            raise RunError(why) from error
        self._tell("done", number, **{k: v for k, v in receipt.to_dict().items() if k != "number"})
        return receipt

    def recompute(self, number: int) -> str:
        return hashlib.sha256(self._trace(number, None)).hexdigest()

    def compare(self, number: int) -> Comparison:
        if self.recompute(number) == self._job.sha256(number):
            return Comparison(True, True, 0.0, 0, 0)
        difference = float(os.environ.get("FAKE_DIFFERENCE", "1"))
        if difference > 0.004:
            return Comparison(False, False, 0.0, 100, 100)
        return Comparison(False, True, difference, 2, 1000)

    def _trace(self, number: int, stop: Callable[[], bool] | None) -> bytes:
        scene = self._job._scene
        if "FAKE_LOG" in os.environ:
            with Path(os.environ["FAKE_LOG"]).open("a") as log:
                log.write(f"{number}\n")
        while "gate" in scene and not Path(scene["gate"]).exists():
            time.sleep(0.02)
        until = time.monotonic() + scene.get("ms", 0) / 1e3
        while time.monotonic() < until:
            if stop and stop():
                raise Cancelled("was cancelled")
            time.sleep(min(0.005, max(0.0, until - time.monotonic())))
        if number in scene.get("crashes", []):
            os.kill(os.getpid(), signal.SIGKILL)
        if number in scene.get("fails", []):
            raise RunError(f"the device was lost at {number}, on this machine; try again")
        salt = os.environ.get("FAKE_SALT", "")
        block = hashlib.sha256(f"{scene.get('seed')} {number} {salt}".encode()).digest()
        size = int(scene["bytes"])
        return (block * (size // 32 + 1))[:size]

    def _tell(self, event: str, number: int, **words: Any) -> None:
        try:
            with self._ledger.open("a") as file:
                file.write(
                    json.dumps(
                        {
                            "event": event,
                            "number": number,
                            "time_s": time.time(),
                            "fingerprint": self.fingerprint,
                            **words,
                        }
                    )
                    + "\n"
                )
        except OSError:
            pass


def _hash_file(file: str | Path) -> str:
    return hashlib.sha256(Path(file).read_bytes()).hexdigest()


def _write(file: Path, data: bytes) -> None:
    temporary = file.with_name(f".{file.name}.{os.getpid()}.tmp")
    try:
        temporary.write_bytes(data)
        os.replace(temporary, file)
    finally:
        temporary.unlink(missing_ok=True)
