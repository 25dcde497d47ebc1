# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""The ledger of a job: the events that each process recorded in a file of its own (docs/jobs.md)."""

from __future__ import annotations

import heapq
import json
import threading
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any


@dataclass(frozen=True)
class Receipt:
    """The record of a piece that was made."""

    number: int
    name: str
    sha256: str
    """SHA-256 of the piece's bytes."""
    bytes: int
    ms: float
    """Time that the piece took, in milliseconds."""
    made_on: str
    """Device and driver that made the piece."""
    fingerprint: str
    """`Runner.fingerprint` of the maker; empty if a program made the piece, because programs compute no fingerprint."""
    version: str
    """Version of promin."""
    host: str
    pid: int

    def to_dict(self) -> dict[str, Any]:
        """Returns a dict for JSON."""
        return asdict(self)


class Ledger:
    """Reads the makers' events. Later reads return only new events. An incomplete line is read after it is complete."""

    def __init__(self, folder: Path, pieces: Sequence[str]) -> None:
        self._folder = folder
        self._pieces = pieces
        self._ends: dict[str, int] = {}
        self._by_maker: dict[str, list[tuple[float, dict[str, Any]]]] = {}
        self._receipts: dict[int, list[dict[str, Any]]] = {}
        self._lock = threading.Lock()

    def events(self, maker: str | None) -> list[dict[str, Any]]:
        """Returns the events of all makers sorted by time, or those of one maker in the order of its file."""
        with self._lock:
            self._read()
            lists = self._by_maker.values() if maker is None else [self._by_maker.get(maker, [])]
            return [event for _, event in heapq.merge(*lists, key=lambda timed: timed[0])]

    def find(self, number: int, sha256: str) -> Receipt | None:
        """Returns the last record of a piece with these bytes."""
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
            events = self._by_maker.setdefault(file.stem, [])
            for event in _parse(whole, self._pieces):
                event["maker"] = file.stem
                # Events of one maker keep their order even if the maker's clock is set back.
                events.append((max(float(event["time_s"]), events[-1][0] if events else 0.0), event))
                if event["event"] == "done":
                    self._receipts.setdefault(event["number"], []).append(event)


_OF_ANY = {"event": str, "number": int, "piece": str, "time_s": (int, float), "made_on": str, "fingerprint": str}
_OF_RECEIPT = {"sha256": str, "size_bytes": int, "ms": (int, float), "version": str, "host": str, "pid": int}


def _parse(text: bytes, pieces: Sequence[str]) -> Iterator[dict[str, Any]]:
    """Returns the events of these pieces. Damaged lines are skipped."""
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
