# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""The page of a job, DIR/index.html: how far it is, its pieces as pictures, and who made what when. It is plain HTML
and needs nothing but the files in DIR/farm/pictures."""

from __future__ import annotations

import html
import re
import struct
import time
import zlib
from collections.abc import Iterable
from pathlib import Path

from promin import jobs

from promin_farm.files import write_whole
from promin_farm.status import amount, rate_of, slowest
from promin_farm.survey import Stretch, Survey, take_survey
from promin_farm.watch import duration

_EVERY_S = 15.0
_MOST_COST = 0.05
"""Of a run's time the page takes about this part at most."""
_MOST_PICTURES = 400
_NEW_PICTURES_S = 2.0
"""So long a page reads pieces for new pictures; the next page has more."""
_MOST_STRETCHES = 3000
_PICTURE_PX = 128
_WIDTH_PX = 1000
_LANE_PX = 18
_WINDOW = re.compile(r"(?:(frame\d+)_)?y(\d+)-(\d+)_x(\d+)-(\d+)$")

_STYLE = """
:root { color-scheme: light dark; --line: #8884; --done: #2a9d6f;
  --failed: #d1495b; --died: #edae49; --running: #3a86d8 }
body { font: 15px/1.45 system-ui, sans-serif; max-width: 1000px; margin: 2em auto; padding: 0 1em }
h1 { font-size: 1.4em } h2 { font-size: 1.1em; margin-top: 2em } code { font-size: .9em; overflow-wrap: anywhere }
.bar { height: 14px; background: var(--line); border-radius: 7px; overflow: hidden }
.bar div { height: 100%; background: var(--done) }
table { border-collapse: collapse }
td, th { text-align: left; padding: .2em 1em .2em 0; border-bottom: 1px solid var(--line) }
.pictures { display: flex; flex-wrap: wrap; gap: 8px } figure { margin: 0 } figcaption { font-size: .75em }
.mosaic { position: relative; width: 100%; background: var(--line) } .mosaic img { position: absolute; display: block }
svg { width: 100%; height: auto; display: block } svg text { font: 11px system-ui, sans-serif; fill: currentColor }
.done { fill: var(--done) } .failed { fill: var(--failed) } .died { fill: var(--died) } .running { fill: var(--running) }
"""


class Page:
    """Writes the page now and then while a run goes on."""

    def __init__(self, job: jobs.Job) -> None:
        self._job = job
        self._folder = Path(job.folder)
        self._next = time.monotonic() + 2.0

    def tick(self) -> None:
        """Writes it where it is time to."""
        if time.monotonic() < self._next:
            return
        begun = time.monotonic()
        self.write()
        now = time.monotonic()
        self._next = now + max(_EVERY_S, (now - begun) / _MOST_COST)

    def write(self, survey: Survey | None = None) -> None:
        """A page that cannot be written is left out: the work goes on without it."""
        try:
            survey = survey or take_survey(self._job)
            pictures = self._write_pictures(survey)
            write_whole(self._folder / "index.html", make_page(self._job, survey, pictures))
        except (OSError, jobs.Error):
            pass

    def _write_pictures(self, survey: Survey) -> dict[int, str]:
        """Of pieces that are there, spread over the job: their files, relative to the page."""
        step = max(1, -(-survey.total // _MOST_PICTURES))
        pictures = {}
        until = time.monotonic() + _NEW_PICTURES_S
        for number in range(0, survey.total, step):
            if number not in survey.done:
                continue
            name = f"farm/pictures/{self._job.pieces[number].name}.png"
            if not (self._folder / name).exists():
                if time.monotonic() > until:
                    continue
                pixels = self._job.preview(number, _PICTURE_PX)
                if pixels is None:
                    return {}
                rows, columns = pixels.shape[:2]
                write_whole(self._folder / name, encode_png(columns, rows, pixels.tobytes()))
            pictures[number] = name
        return pictures


def make_page(job: jobs.Job, survey: Survey, pictures: dict[int, str]) -> str:
    """The page's text. pictures: files of pieces by number."""
    share = 100.0 * survey.weight_done / max(survey.weight_done + survey.weight_left, 1e-9)
    refresh = '<meta http-equiv="refresh" content="15">' if survey.running else ""
    words = [
        f"{len(survey.done)} of {survey.total} pieces",
        f"{len(survey.running)} running",
        f"{len(survey.failed)} failed",
    ]
    if rate := rate_of(job, survey):
        words.append(f"{amount(rate[0])} {rate[1]} a second")
    if survey.time_left_s is not None:
        words.append(f"{duration(survey.time_left_s)} left")
    sections = [
        f"<h1>{html.escape(job.kind)} <code>{html.escape(Path(job.folder).name)}</code></h1>",
        f'<div class="bar"><div style="width:{share:.2f}%"></div></div><p id="state">{", ".join(words)}. '
        f"{time.strftime('%Y-%m-%d %H:%M:%S', time.gmtime())} UTC.</p>",
        _failures(job, survey),
        _pictures(job, pictures),
        _timeline(job, survey),
        _workers(survey),
        _slowest(job, survey),
        f"<p>Job <code>{job.id}</code></p>",
    ]
    return (
        f'<!doctype html>\n<html lang="en"><head><meta charset="utf-8">{refresh}'
        f'<meta name="viewport" content="width=device-width"><title>{share:.0f} % of {html.escape(Path(job.folder).name)}'
        f"</title><style>{_STYLE}</style></head><body>\n" + "\n".join(filter(None, sections)) + "\n</body></html>\n"
    )


def encode_png(columns: int, rows: int, rgb: bytes) -> bytes:
    """8 bits a channel, three channels, row by row from above."""

    def chunk(name: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    lines = b"".join(b"\0" + rgb[3 * columns * y : 3 * columns * (y + 1)] for y in range(rows))
    head = struct.pack(">IIBBBBB", columns, rows, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(lines, 6)) + chunk(b"IEND", b"")


def _table(head: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    def row(kind: str, cells: Iterable[str]) -> str:
        return "<tr>" + "".join(f"<{kind}>{html.escape(cell)}</{kind}>" for cell in cells) + "</tr>"

    return "<table>" + row("th", head) + "".join(row("td", cells) for cells in rows) + "</table>"


def _failures(job: jobs.Job, survey: Survey) -> str:
    if not survey.failed:
        return ""
    rows = [(job.pieces[n].name, tries.describe()) for n, tries in sorted(survey.failed.items())]
    return "<h2>Given up</h2>" + _table(("piece", "after"), rows)


def _pictures(job: jobs.Job, pictures: dict[int, str]) -> str:
    if not pictures:
        return ""
    windows = {number: _WINDOW.match(job.pieces[number].name) for number in pictures}
    whole = [_WINDOW.match(piece.name) for piece in job.pieces]
    if all(whole) and not any(window and window[1] for window in whole):
        return "<h2>Picture</h2>" + _mosaic(windows, whole, pictures)
    figures = [
        f'<figure><img src="{html.escape(file)}" alt="" loading="lazy"><figcaption>'
        f"{html.escape(job.pieces[number].name.partition('_')[0])}</figcaption></figure>"
        for number, file in pictures.items()
    ]
    return f'<h2>Pictures</h2><div class="pictures">{"".join(figures)}</div>'


def _mosaic(
    windows: dict[int, re.Match[str] | None], whole: list[re.Match[str] | None], pictures: dict[int, str]
) -> str:
    """Pieces of one picture where they belong."""
    places = [tuple(map(int, window.groups()[1:])) for window in whole if window]
    top, bottom = min(place[0] for place in places), max(place[1] for place in places)
    left, right = min(place[2] for place in places), max(place[3] for place in places)
    images = []
    for number, window in windows.items():
        assert window
        y0, y1, x0, x1 = map(int, window.groups()[1:])
        images.append(
            f'<img src="{html.escape(pictures[number])}" alt="" style="left:{100 * (x0 - left) / (right - left):.4f}%;'
            f"top:{100 * (y0 - top) / (bottom - top):.4f}%;width:{100 * (x1 - x0) / (right - left):.4f}%;"
            f'height:{100 * (y1 - y0) / (bottom - top):.4f}%">'
        )
    return f'<div class="mosaic" style="aspect-ratio:{right - left}/{bottom - top}">{"".join(images)}</div>'


def _timeline(job: jobs.Job, survey: Survey) -> str:
    stretches = survey.stretches[-_MOST_STRETCHES:]
    if not stretches:
        return ""
    now = time.time()
    begin = min(stretch.begun for stretch in stretches)
    end = max(stretch.ended or now for stretch in stretches)
    lanes = sorted(
        {stretch.worker for stretch in stretches}, key=lambda w: min(s.begun for s in stretches if s.worker == w)
    )
    scale = _WIDTH_PX / max(end - begin, 1e-3)

    def bar(stretch: Stretch) -> str:
        x = (stretch.begun - begin) * scale
        width = max(((stretch.ended or now) - stretch.begun) * scale - 0.5, 1.0)
        words = f"{job.pieces[stretch.number].name}: {stretch.outcome}, {(stretch.ended or now) - stretch.begun:.2f} s"
        return (
            f'<rect class="{stretch.outcome}" x="{x:.1f}" y="{lanes.index(stretch.worker) * _LANE_PX + 2}" '
            f'width="{width:.1f}" height="{_LANE_PX - 4}"><title>{html.escape(words)}</title></rect>'
        )

    names = [
        f'<text x="4" y="{(i + 1) * _LANE_PX - 5}" opacity=".75">{html.escape(lane)}</text>'
        for i, lane in enumerate(lanes)
    ]
    more = f" The last {_MOST_STRETCHES} are shown." if len(survey.stretches) > len(stretches) else ""
    return (
        f"<h2>Timeline</h2><p>{duration(end - begin)}, a lane for each process: made, "
        f"failed (red), ended meanwhile (yellow), running (blue).{more}</p>"
        f'<svg id="timeline" viewBox="0 0 {_WIDTH_PX} {len(lanes) * _LANE_PX}">{"".join(map(bar, stretches))}'
        f'{"".join(names)}</svg>'
    )


def _workers(survey: Survey) -> str:
    counts: dict[str, int] = {}
    for stretch in survey.stretches:
        counts[stretch.worker] = counts.get(stretch.worker, 0) + (stretch.outcome == "done")
    if not counts:
        return ""
    rows = []
    for worker, count in counts.items():
        presence = survey.roll.workers.get(worker)
        rows.append(
            (worker, str(count), presence.device if presence else "", presence.fingerprint[:16] if presence else "")
        )
    return "<h2>Workers</h2>" + _table(("process", "pieces", "device", "fingerprint"), rows)


def _slowest(job: jobs.Job, survey: Survey) -> str:
    rows = [(job.pieces[number].name, f"{ms / 1e3:.2f} s") for number, ms in slowest(survey)]
    return "<h2>Slowest</h2>" + _table(("piece", "took"), rows) if rows else ""
