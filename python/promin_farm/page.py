# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""The page of a job, DIR/index.html: its progress, its pieces as pictures, and a timeline of the processes. It is plain
HTML and needs only the files in DIR/farm/pictures."""

from __future__ import annotations

import re
import time
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from promin import jobs

from promin_farm.files import write_whole
from promin_farm.markup import Markup, element, join, table
from promin_farm.pictures import write_pictures
from promin_farm.status import describe_rate, slowest
from promin_farm.survey import Stretch, Survey, take_survey
from promin_farm.watch import duration

_EVERY_S = 15.0
_MOST_COST = 0.05
"""The largest fraction of a run's time that the page may take, approximately."""
_NEW_PICTURES_S = 2.0
"""Time in seconds that a page may spend on reading pieces for new pictures. The next page adds more pictures."""
_MOST_STRETCHES = 3000
_WIDTH_PX = 1000
_LANE_PX = 18

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
svg { width: 100%; height: auto; display: block }
svg text { font: 11px system-ui, sans-serif; fill: currentColor; opacity: .75 }
.done { fill: var(--done) } .failed { fill: var(--failed) } .died { fill: var(--died) } .running { fill: var(--running) }
"""


class Page:
    """Writes the page from time to time during a run."""

    def __init__(self, job: jobs.Job) -> None:
        self._job = job
        self._next = time.monotonic() + 2.0

    def tick(self) -> None:
        """Writes the page if it is due."""
        if time.monotonic() < self._next:
            return
        begun = time.monotonic()
        self.write()
        now = time.monotonic()
        self._next = now + max(_EVERY_S, (now - begun) / _MOST_COST)

    def write(self, survey: Survey | None = None) -> None:
        """Writes the page. Failures are ignored, because the work does not depend on the page."""
        try:
            survey = survey or take_survey(self._job)
            pictures = write_pictures(self._job, survey.done, _NEW_PICTURES_S)
            write_whole(Path(self._job.folder) / "index.html", make_page(self._job, survey, pictures))
        except (OSError, jobs.Error):
            pass


def make_page(job: jobs.Job, survey: Survey, pictures: Mapping[int, str]) -> str:
    """Returns the page's text. pictures: files of pieces, by number."""
    name = Path(job.folder).name
    share = 100.0 * survey.weight_done / max(survey.weight_done + survey.weight_left, 1e-9)
    head = [
        element("meta", charset="utf-8"),
        element("meta", name="viewport", content="width=device-width"),
        element("title", f"{share:.0f} % of {name}"),
        element("style", Markup(_STYLE)),
    ]
    if survey.running:
        head.append(element("meta", http_equiv="refresh", content="15"))
    body = [
        element("h1", f"{job.kind} ", element("code", name)),
        element("div", element("div", style=f"width:{share:.2f}%"), class_="bar"),
        element("p", _describe_state(job, survey), id="state"),
        _failures(job, survey),
        _pictures(job, pictures),
        _timeline(job, survey),
        _workers(survey),
        _slowest(job, survey),
        element("p", "Job ", element("code", job.id)),
    ]
    page = element("html", element("head", *head), element("body", *body), lang="en")
    return f"<!doctype html>\n{page}\n"


def _describe_state(job: jobs.Job, survey: Survey) -> str:
    words = [
        f"{len(survey.done)} of {survey.total} pieces",
        f"{len(survey.running)} running",
        f"{len(survey.failed)} failed",
    ]
    if rate := describe_rate(job, survey):
        words.append(rate)
    if survey.time_left_s is not None:
        words.append(f"{duration(survey.time_left_s)} left")
    return f"{', '.join(words)}. {time.strftime('%Y-%m-%d %H:%M:%S', time.gmtime())} UTC."


def _section(title: str, *content: str) -> Markup:
    return join([element("h2", title), *content])


def _failures(job: jobs.Job, survey: Survey) -> str:
    rows = [(job.pieces[n].name, tries.describe()) for n, tries in sorted(survey.failed.items())]
    return _section("Given up", table(("piece", "after"), rows)) if rows else ""


@dataclass(frozen=True)
class _Window:
    """The rectangle of a picture that a piece covers, read from the piece's name."""

    frame: str
    top: int
    bottom: int
    left: int
    right: int

    @staticmethod
    def of(piece: jobs.Piece) -> _Window | None:
        found = re.fullmatch(r"(?:(frame\d+)_)?y(\d+)-(\d+)_x(\d+)-(\d+)", piece.name)
        return _Window(found[1] or "", *map(int, found.groups()[1:])) if found else None


def _pictures(job: jobs.Job, pictures: Mapping[int, str]) -> str:
    if not pictures:
        return ""
    windows = [_Window.of(piece) for piece in job.pieces]
    places = [window for window in windows if window]
    if len(places) == len(windows) and not any(window.frame for window in places):
        return _section("Picture", _mosaic(places, pictures))
    figures = [
        element("figure", _image(file, loading="lazy"), element("figcaption", job.pieces[n].name.partition("_")[0]))
        for n, file in pictures.items()
    ]
    return _section("Pictures", element("div", *figures, class_="pictures"))


def _image(file: str, **attributes: object) -> Markup:
    return element("img", src=file, alt="", **attributes)


def _mosaic(places: list[_Window], pictures: Mapping[int, str]) -> Markup:
    """Returns the pictures of pieces, arranged at their places in the whole picture."""
    top, left = min(place.top for place in places), min(place.left for place in places)
    rows = max(place.bottom for place in places) - top
    columns = max(place.right for place in places) - left

    def style_of(place: _Window) -> str:
        shares = {
            "left": (place.left - left) / columns,
            "top": (place.top - top) / rows,
            "width": (place.right - place.left) / columns,
            "height": (place.bottom - place.top) / rows,
        }
        return ";".join(f"{name}:{100.0 * share:.4f}%" for name, share in shares.items())

    images = [_image(file, style=style_of(places[number])) for number, file in pictures.items()]
    return element("div", *images, class_="mosaic", style=f"aspect-ratio:{columns}/{rows}")


def _timeline(job: jobs.Job, survey: Survey) -> str:
    stretches = survey.stretches[-_MOST_STRETCHES:]
    if not stretches:
        return ""
    now = time.time()
    begin = min(stretch.begun for stretch in stretches)
    length_s = max(stretch.ended or now for stretch in stretches) - begin
    scale = _WIDTH_PX / max(length_s, 1e-3)
    # The timeline has one row for each process, in the order in which the processes started.
    lanes = {worker: i for i, worker in enumerate(dict.fromkeys(stretch.worker for stretch in stretches))}

    def bar(stretch: Stretch) -> Markup:
        took_s = (stretch.ended or now) - stretch.begun
        title = f"{job.pieces[stretch.number].name}: {stretch.outcome}, {took_s:.2f} s"
        return element(
            "rect",
            element("title", title),
            class_=stretch.outcome,
            x=f"{(stretch.begun - begin) * scale:.1f}",
            y=lanes[stretch.worker] * _LANE_PX + 2,
            width=f"{max(took_s * scale - 0.5, 1.0):.1f}",
            height=_LANE_PX - 4,
        )

    names = [element("text", worker, x=4, y=(lane + 1) * _LANE_PX - 5) for worker, lane in lanes.items()]
    more = f" The last {_MOST_STRETCHES} are shown." if len(survey.stretches) > len(stretches) else ""
    words = "a lane for each process: made, failed (red), ended meanwhile (yellow), running (blue)."
    return _section(
        "Timeline",
        element("p", f"{duration(length_s)}, {words}{more}"),
        element("svg", *map(bar, stretches), *names, id="timeline", viewBox=f"0 0 {_WIDTH_PX} {len(lanes) * _LANE_PX}"),
    )


def _workers(survey: Survey) -> str:
    made = Counter(stretch.worker for stretch in survey.stretches if stretch.outcome == "done")
    rows = []
    for worker in dict.fromkeys(stretch.worker for stretch in survey.stretches):
        presence = survey.roll.workers.get(worker)
        known = (presence.device, presence.fingerprint[:16]) if presence else ("", "")
        rows.append((worker, str(made[worker]), *known))
    return _section("Workers", table(("process", "pieces", "device", "fingerprint"), rows)) if rows else ""


def _slowest(job: jobs.Job, survey: Survey) -> str:
    rows = [(job.pieces[number].name, f"{ms / 1e3:.2f} s") for number, ms in slowest(survey)]
    return _section("Slowest", table(("piece", "took"), rows)) if rows else ""
