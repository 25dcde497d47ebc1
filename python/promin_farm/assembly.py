# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Writes a job's files from its pieces. Pictures of frames are written while other frames are made, all other files at
the end."""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from promin import jobs

from promin_farm.settings import Settings, frame_number_of


class Assembly:
    """The outputs of one job. A frame is written once, as soon as its pieces are done. The command waits for pieces at
    that time anyway, so the files of a film cost little time after its last piece."""

    def __init__(self, job: jobs.Job, settings: Settings) -> None:
        self._job = job
        self._outputs = settings.outputs
        self._numbered = [output for output in settings.outputs if "#" in Path(output).name]
        """The outputs that are a file for each frame."""
        self._allow_mixed = settings.allow_mixed
        self._missing: dict[int, set[int]] = {}
        """For each frame that is not written, the pieces that are missing."""
        self._ready: queue.SimpleQueue[int | None]
        """Frames to write; None ends the thread."""
        self._written: set[int] = set()
        self._frames: dict[int, int] = {}
        """The frame of each piece. Either all pieces have a frame or none has."""
        for piece in job.pieces:
            frame = frame_number_of(piece)
            if frame is None:
                break  # A picture or rays; there may be a million pieces.
            self._frames[piece.number] = frame

    @contextmanager
    def writing(self, missing: Iterable[int], stop: Callable[[], bool]) -> Iterator[None]:
        """A context in which frames are written on a separate thread. missing: the pieces to make. stop: a function
        that returns True if frames that have not been started must be left out. Waiting frames are also left out after
        an error."""
        if not self._numbered or not self._frames:
            yield
            return
        self._ready = queue.SimpleQueue()
        self._missing = {frame: set() for frame in self._frames.values() if frame not in self._written}
        for number in missing:
            # If a piece is altered after its frame was written, it is made again with the same bytes.
            if self._frames[number] in self._missing:
                self._missing[self._frames[number]].add(number)
        for frame, numbers in self._missing.items():
            if not numbers:
                self._ready.put(frame)
        has_failed = threading.Event()
        thread = threading.Thread(
            target=self._write_frames, args=[lambda: has_failed.is_set() or stop()], name="promin-farm frames"
        )
        thread.start()
        try:
            yield
        except BaseException:
            has_failed.set()
            raise
        finally:
            self._ready.put(None)
            thread.join()

    def piece_done(self, number: int) -> None:
        """Records that the piece is done; to be called within `writing`."""
        frame = self._frames.get(number)
        if frame not in self._missing:
            return
        self._missing[frame].discard(number)
        if not self._missing[frame]:
            self._ready.put(frame)

    def write_rest(self) -> None:
        """Writes everything that is not written yet. Raises promin's errors."""
        if not self._outputs:
            return
        if not self._frames:
            self._job.merge(self._outputs, allow_mixed=self._allow_mixed)
            return
        rest = sorted(set(self._frames.values()) - self._written)
        if rest and self._numbered:
            self._job.merge(self._numbered, allow_mixed=self._allow_mixed, frames=rest)
        films = [output for output in self._outputs if output not in self._numbered]
        if films:
            self._job.merge(films, allow_mixed=self._allow_mixed)

    def _write_frames(self, stop: Callable[[], bool]) -> None:
        while (frame := self._ready.get()) is not None and not stop():
            try:
                self._job.merge(self._numbered, allow_mixed=self._allow_mixed, frames=[frame])
            except jobs.Error:
                continue  # The frame is tried again at the end; an error is reported then.
            self._written.add(frame)
