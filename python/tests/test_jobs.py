# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Tests of promin.jobs: any process may make a piece, and the files are the same as those of a single run."""

from __future__ import annotations

import concurrent.futures
import hashlib
import json
import os
import pickle
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

import promin
from conftest import fails, make_rays
from promin import jobs

RunPromin = Callable[..., None]

PATH = {
    "format": "promin camera path",
    "version": 1,
    "frames": [
        {"time_s": 0.0, "eye": [0, 2, 8], "look": [0, 0, -1], "up": [0, 1, 0], "fov_deg": 45},
        {"time_s": 0.1, "eye": [1, 2, 8], "look": [0, 0, -1], "up": [0, 1, 0], "fov_deg": 60},
    ],
}


@pytest.fixture
def scene(scenes: Path, tmp_path: Path) -> Path:
    """Returns the path of a copy that a test may change."""
    return Path(shutil.copy(scenes / "box.gltf", tmp_path / "box.gltf"))


@pytest.fixture
def rays(tmp_path: Path) -> Path:
    file = tmp_path / "rays.npy"
    np.save(file, make_rays(1000))
    return file


def make_all(job: jobs.Job) -> jobs.Runner:
    runner = job.runner()
    for piece in job.pieces:
        runner.run(piece.number)
    return runner


@pytest.mark.parametrize("count", [1, 3])
def test_pictures_are_those_of_the_single_run(scene: Path, tmp_path: Path, run_promin: RunPromin, count: int) -> None:
    words = [scene, "--size", "40", "30", "--aov", "depth", "--background", "environment"]
    run_promin("render", *words, "-o", tmp_path / "whole.exr")
    job = jobs.create("render", [*map(str, words), "--pieces", str(count)], tmp_path / "job")
    assert [job.state(piece.number) for piece in job.pieces] == ["missing"] * count
    assert sum(piece.weight for piece in job.pieces) == 40 * 30
    make_all(job)
    assert [job.state(piece.number) for piece in job.pieces] == ["done"] * count
    job.merge([tmp_path / "merged.exr"])
    assert (tmp_path / "merged.exr").read_bytes() == (tmp_path / "whole.exr").read_bytes()
    # The program accepts the job as its own.
    run_promin("render", *words, "--pieces", count, "--job", tmp_path / "job", "-o", tmp_path / "again.exr")
    assert (tmp_path / "again.exr").read_bytes() == (tmp_path / "whole.exr").read_bytes()
    assert len([event for event in job.events() if event["event"] == "done"]) == count


def test_frames_of_a_path(scene: Path, tmp_path: Path, run_promin: RunPromin) -> None:
    (tmp_path / "path.json").write_text(json.dumps(PATH))
    words = [str(scene), "--size", "24", "18", "--path", str(tmp_path / "path.json")]
    run_promin("render", *words, "-o", tmp_path / "whole.##.png")
    job = jobs.create("render", [*words, "--tiles", "2", "1"], tmp_path / "job")
    assert len(job.pieces) == 4
    runner = job.runner()
    for number in (1, 2, 3):
        runner.run(number)
    # A frame whose pieces are done can be written before the other frames.
    job.merge([tmp_path / "early.##.png"], frames=[1])
    assert (tmp_path / "early.01.png").read_bytes() == (tmp_path / "whole.01.png").read_bytes()
    with fails(promin.RunError, "job.pieces.missing", "1 of 4", "frame000000_"):
        job.merge([tmp_path / "early.##.png"], frames=[0, 1])
    with fails(promin.UsageError, "job.frame.missing", "2"):
        job.merge([tmp_path / "early.##.png"], frames=[1, 2])
    with pytest.raises(promin.UsageError, match="frames has -1"):
        job.merge([tmp_path / "early.##.png"], frames=[-1])
    assert not (tmp_path / "early.00.png").exists()
    make_all(job)
    with fails(promin.UsageError, "film.fps.missing"):
        job.merge([tmp_path / "one.png"])
    job.merge([tmp_path / "cut.##.png"])
    for number in ("00", "01"):
        assert (tmp_path / f"cut.{number}.png").read_bytes() == (tmp_path / f"whole.{number}.png").read_bytes()


@pytest.mark.parametrize("query", [[], ["--any"], ["--count"], ["--all"]])
def test_answers_to_rays_are_those_of_the_single_run(
    scene: Path, rays: Path, tmp_path: Path, run_promin: RunPromin, query: list[str]
) -> None:
    def outputs(name: str) -> list[Path]:
        return [tmp_path / f"{name}.npy", tmp_path / f"{name}_offsets.npy"][: 2 if query == ["--all"] else 1]

    whole = outputs("whole")
    more = ["--offsets", whole[1]] if query == ["--all"] else []
    run_promin("cast", scene, rays, *query, "-o", whole[0], *more)
    job = jobs.create("cast", [str(scene), str(rays), *query, "--pieces", "3"], tmp_path / "job")
    assert [piece.weight for piece in job.pieces] == [334, 333, 333]
    make_all(job)
    job.merge(outputs("merged"))
    for one, other in zip(whole, outputs("merged")):
        assert one.read_bytes() == other.read_bytes()


class Chunks:
    """Rays that are not in an .npy file."""

    name = "rays.chunks"

    def __init__(self, rays: NDArray[np.float32]) -> None:
        self.rays = rays
        self.count = len(rays)
        self.size_bytes = rays.nbytes
        self.sha256 = hashlib.sha256(rays.tobytes()).hexdigest()

    def read(self, first: int, count: int) -> NDArray[np.float32]:
        return self.rays[first : first + count]


def test_rays_of_python(scene: Path, tmp_path: Path) -> None:
    source = Chunks(make_rays(500))
    words = [str(scene), "rays.chunks", "--pieces", "4"]
    job = jobs.create("cast", words, tmp_path / "job", rays=source)
    make_all(job)
    with fails(promin.UsageError, "job.frames.none"):
        job.merge([tmp_path / "hits.npy"], frames=[0])
    job.merge([tmp_path / "hits.npy"])
    hits = np.load(tmp_path / "hits.npy")
    assert hits.tobytes() == promin.Caster(promin.Scene.load(scene)).cast(source.rays).tobytes()
    # A job that is opened elsewhere needs the rays again, and refuses other rays.
    again = jobs.open(tmp_path / "job")
    assert again.runner(rays=source).recompute(2) == job.sha256(2)
    with fails(promin.UsageError, "job.other", '"rays.chunks"'):
        again.runner(rays=Chunks(make_rays(500, seed=2)))
    Path(job.pieces[1].file).unlink()

    class Short(Chunks):
        def read(self, first: int, count: int) -> NDArray[np.float32]:
            return super().read(first, min(count, 400 - first))

    runner = jobs.open(tmp_path / "job").runner(rays=Short(source.rays))
    assert runner.recompute(0) == job.sha256(0)
    Path(job.pieces[3].file).unlink()
    with fails(promin.InputError, "rays.short", "rays.chunks: ", "400", "500"):
        runner.run(3)
    assert job.state(3) == "missing" and job.events()[-1]["event"] == "failed"
    source.rays = np.zeros((500, 7), np.float32)
    with pytest.raises(Exception):
        job.runner().run(1)
    assert job.state(1) == "missing"


def test_receipts_and_events(scene: Path, tmp_path: Path) -> None:
    job = jobs.create("render", [str(scene), "--size", "16", "12", "--pieces", "3"], tmp_path / "job")
    assert job.receipt(1) is None
    runner = job.runner()
    receipt = runner.run(1)
    assert (receipt.number, receipt.name, receipt.bytes) == (1, "y00004-00008_x00000-00016", 16 * 4 * 12)
    assert receipt.sha256 == hashlib.sha256(job.read(1)[1]).hexdigest() == job.sha256(1) == runner.recompute(1)
    assert receipt.fingerprint == runner.fingerprint == job.runner().fingerprint and len(receipt.fingerprint) == 64
    assert receipt.made_on == runner.made_on and receipt.pid == os.getpid() and receipt.ms > 0
    assert json.loads(json.dumps(receipt.to_dict()))["version"] == promin.__version__
    # A second run does not make the piece again: it returns the same receipt.
    before = Path(job.pieces[1].file).stat().st_mtime_ns
    assert (
        runner.run(1) == receipt == jobs.open(tmp_path / "job").receipt(1) == pickle.loads(pickle.dumps(job)).receipt(1)
    )
    assert Path(job.pieces[1].file).stat().st_mtime_ns == before
    with pytest.raises(promin.Cancelled):
        runner.run(2, stop=lambda: True)
    assert job.state(2) == "missing"
    assert [(event["event"], event["number"]) for event in job.events()] == [("begun", 1), ("done", 1)]
    assert [event["event"] for event in job.events(f"{os.uname().nodename}-{os.getpid()}")] == ["begun", "done"]
    assert job.events("nobody-1") == []
    # Fields that the ledger lacks are empty. Half a line waits for its end, and a line without an event is skipped.
    (ledger,) = (tmp_path / "job/ledger").iterdir()
    ledger.write_bytes(b"\xff{}\n[]\n{}\n" + ledger.read_bytes()[:-1])
    bare = jobs.open(tmp_path / "job").receipt(1)
    assert bare is not None and bare.made_on == "" and bare.sha256 == receipt.sha256 and bare.bytes == receipt.bytes


def test_a_receipt_is_of_the_bytes_that_are_there(tmp_path: Path) -> None:
    job = jobs.create_with("bytes", tmp_path / "job", options={}, pieces=["a"])
    job.write(0, "", b"first", fingerprint="one")
    content = Path(job.pieces[0].file).read_bytes()
    job.write(0, "", b"other", fingerprint="two")
    Path(job.pieces[0].file).write_bytes(content)
    receipt = job.receipt(0)
    assert receipt is not None and (receipt.fingerprint, receipt.sha256) == ("one", job.sha256(0))


def test_a_function_that_makes_pieces_may_be_stopped(tmp_path: Path) -> None:
    job = jobs.create_with("bytes", tmp_path / "job", options={}, pieces=["a"])
    answers = iter([False, True])
    made = []

    def make(number: int) -> tuple[str, bytes]:
        made.append(number)
        return "", b"made"

    runner = job.runner(make=make)
    with pytest.raises(jobs.Cancelled):
        runner.run(0, stop=lambda: True)
    assert not made
    with pytest.raises(jobs.Cancelled):
        runner.run(0, stop=lambda: next(answers))
    assert made == [0] and job.state(0) == "missing"
    assert [event["event"] for event in job.events()] == ["begun", "stopped"] * 2
    for ask in (runner.recompute, runner.compare):
        with pytest.raises(jobs.Cancelled):
            ask(0, stop=lambda: True)


def test_parts_that_say_what_there_is_not_are_refused(scene: Path, tmp_path: Path) -> None:
    job = jobs.create("render", [str(scene), "--size", "8", "6", "--pieces", "2"], tmp_path / "job")
    make_all(job)
    whole, data = job.read(0)
    for name, value in (("tone_mapping", 77), ("tone_mapping", -1), ("exr", [False, 99, False])):
        job.write(0, json.dumps({**json.loads(whole), name: value}), data)
        with fails(jobs.InputError, "job.piece.kind"):
            job.merge([tmp_path / "out.exr"])
    said = json.loads(whole)
    said["metadata"] = said["metadata"][:-1]
    job.write(0, json.dumps(said), data)
    with fails(jobs.InputError, "job.piece.other"):
        job.merge([tmp_path / "out.exr"])
    assert not (tmp_path / "out.exr").exists()


def test_no_frame_is_written_over_what_the_job_is_made_of(scene: Path, tmp_path: Path) -> None:
    panorama = tmp_path / "sky.0001.exr"
    promin.write_image(panorama, np.ones((4, 8, 3)))
    kept = panorama.read_bytes()
    look = {"eye": [0, 0, 5], "look": [0, 0, -1], "up": [0, 1, 0], "fov_deg": 40}
    frames = [{"time_s": float(i), **look} for i in range(2)]
    path = tmp_path / "path.json"
    path.write_text(json.dumps({"format": "promin camera path", "version": 1, "frames": frames}))
    words = [str(scene), "--size", "8", "6", "--path", str(path), "--environment", str(panorama)]
    job = jobs.create("render", words, tmp_path / "job")
    make_all(job)
    with fails(jobs.UsageError, "output.input", "sky.0001.exr: "):
        job.merge([tmp_path / "sky.####.exr"])
    assert panorama.read_bytes() == kept


def test_folders_that_are_not_named_in_utf8(scene: Path, tmp_path: Path) -> None:
    odd = tmp_path / os.fsdecode(b"caf\xe9")
    odd.mkdir()
    job = jobs.create("render", [str(scene), "--size", "8", "6", "--pieces", "1"], odd / "job")
    make_all(job)
    assert Path(job.pieces[0].file).exists()
    jobs.open(odd / "job").merge([odd / "out.exr"])
    assert (odd / "out.exr").exists()
    moved = Path(shutil.copy(scene, odd))
    with pytest.raises(jobs.UsageError, match=r"caf.udce9.* is not UTF-8"):
        jobs.create("render", [str(moved)], tmp_path / "other")
    with pytest.raises(jobs.InputError, match="is not UTF-8"):
        jobs.create_with("bytes", tmp_path / "other", options={}, files=[moved], pieces=["a"])


def test_comparisons_of_pictures(scene: Path, tmp_path: Path) -> None:
    words = [str(scene), "--size", "40", "30", "--aov", "depth,object", "--pieces", "1"]
    job = jobs.create("render", words, tmp_path / "job")
    runner = make_all(job)
    assert runner.compare(0) == jobs.Comparison(True, True, 0.0, 0, 0)
    description, data = job.read(0)

    def compare_with(change: Callable[[NDArray[np.float32]], None]) -> jobs.Comparison:
        values = np.frombuffer(data, np.float32).copy()
        change(values)
        job.write(0, description, values.tobytes(), fingerprint="another")
        return runner.compare(0)

    def shift(values: NDArray[np.float32]) -> None:
        values[: 3 * 1200] += 0.001

    def break_pixels(values: NDArray[np.float32]) -> None:
        values[: 3 * 6] += 0.1

    def break_more(values: NDArray[np.float32]) -> None:
        values[: 3 * 7] += 0.1

    shifted = compare_with(shift)
    assert shifted == jobs.Comparison(False, True, pytest.approx(0.001, rel=0.01), 0, 1200)
    assert compare_with(break_pixels) == jobs.Comparison(False, True, 0.0, 6, 1200)
    assert compare_with(break_more) == jobs.Comparison(False, False, 0.0, 7, 1200)
    job.write(0, description, data[:-4])
    with fails(promin.InputError, "job.piece.kind"):
        runner.compare(0)


@pytest.mark.parametrize("query", ["", "--any", "--count", "--all"])
def test_comparisons_of_answers(scene: Path, rays: Path, tmp_path: Path, query: str) -> None:
    words = [str(scene), str(rays), "--pieces", "1", *filter(None, [query])]
    job = jobs.create("cast", words, tmp_path / "job")
    runner = make_all(job)
    assert runner.compare(0).is_equal
    description, data = job.read(0)
    counts = np.frombuffer(data, np.int32).copy()
    hits = np.frombuffer(data[: len(data) // 32 * 32 if query != "--all" else len(data) - 8000], np.int32).copy()
    if query == "--count":
        counts[:5] += 1
        job.write(0, description, counts.tobytes())
        assert runner.compare(0) == jobs.Comparison(False, True, 0.0, 5, 1000)
        return
    tail = data[hits.nbytes :]
    hits = hits.reshape(-1, 8)
    met = np.flatnonzero(hits[:, 1] >= 0) if query != "--any" else np.flatnonzero(np.isfinite(hits[:, 0].view("f4")))
    if query != "--any":
        hits[met, 0] += 1  # The next representable number.
        job.write(0, description, hits.tobytes() + tail)
        found = runner.compare(0)
        assert (found.is_equal, found.is_within, found.mismatches, found.count) == (False, True, 0, 1000)
        assert 0.1 < found.largest < 3.0
    for count, is_within in ((1, True), (40, False)):
        hits[met[:count], 0] = np.float32(1e6).view(np.int32)
        job.write(0, description, hits.tobytes() + tail)
        found = runner.compare(0)
        assert found.is_within == is_within and (
            found.mismatches == count if query != "--all" else found.mismatches >= 1
        )


def test_a_tree_is_built_once(tmp_path: Path, run_promin: RunPromin) -> None:
    """Several processes that begin at the same time build the tree of a large mesh once. A damaged tree is built
    again."""
    side = 240
    x, y = np.meshgrid(np.arange(side + 1), np.arange(side + 1))
    vertices = np.stack([x, y, 3 * np.sin(0.1 * x) * np.cos(0.07 * y)], -1).reshape(-1, 3)
    corner = (np.arange(side) * (side + 1))[:, None] + np.arange(side)
    triangles = [
        np.stack([corner + a, corner + b, corner + c], -1) for a, b, c in ((0, 1, side + 1), (1, side + 2, side + 1))
    ]
    lines = [f"v {a} {b} {c:.6f}" for a, b, c in vertices]
    lines += [f"f {a} {b} {c}" for a, b, c in np.concatenate(triangles).reshape(-1, 3) + 1]
    (tmp_path / "sheet.obj").write_text("\n".join(lines))
    words = [str(tmp_path / "sheet.obj"), "--size", "24", "18"]
    run_promin("render", *words, "-o", tmp_path / "whole.exr")
    job = jobs.create("render", [*words, "--pieces", "3"], tmp_path / "job")
    with concurrent.futures.ThreadPoolExecutor(3) as pool:
        runners = list(pool.map(lambda _: jobs.open(tmp_path / "job").runner(), range(3)))
    tree = tmp_path / "job/trees/sah.pbvh"
    stamp, content = tree.stat().st_mtime_ns, tree.read_bytes()
    for piece, runner in zip(job.pieces, runners):
        runner.run(piece.number)
    job.merge([tmp_path / "merged.exr"])
    assert (tmp_path / "merged.exr").read_bytes() == (tmp_path / "whole.exr").read_bytes()
    assert job.runner().recompute(0) == job.sha256(0) and tree.stat().st_mtime_ns == stamp
    tree.write_bytes(content[:-7])
    assert job.runner().recompute(0) == job.sha256(0) and tree.read_bytes() == content
    assert sorted(file.name for file in tree.parent.iterdir()) == ["sah.lock", "sah.pbvh"]


def test_events_are_those_of_the_job_in_the_order_of_their_makers(tmp_path: Path) -> None:
    job = jobs.create_with("bytes", tmp_path / "job", options={}, pieces=["a", "b"])

    def line(event: str, number: int, piece: str, time_s: float) -> str:
        words = {"event": event, "number": number, "piece": piece, "time_s": time_s, "made_on": "", "fingerprint": ""}
        return json.dumps(words) + "\n"

    first = [line("begun", 0, "a", 5.0), line("stopped", 0, "a", 3.0), line("begun", 1, "b", 7.0)]
    (tmp_path / "job/ledger/x-1.jsonl").write_text("".join(first))
    wrong = [line("begun", 2, "c", 4.0), line("begun", 0, "b", 4.0), line("begun", -1, "b", 4.0)]
    (tmp_path / "job/ledger/y-1.jsonl").write_text("".join([*wrong, line("begun", 1, "b", 6.0)]))
    told = [(event["maker"], event["event"], event["number"]) for event in job.events()]
    # The clock of the maker x was set back meanwhile.
    assert told == [("x-1", "begun", 0), ("x-1", "stopped", 0), ("y-1", "begun", 1), ("x-1", "begun", 1)]


def test_a_stop_ends_a_piece(scenes: Path, tmp_path: Path) -> None:
    words = [str(scenes / "showcase.gltf"), "--size", "960", "540", "--spp", "4096", "--pieces", "1"]
    job = jobs.create("render", words, tmp_path / "job")
    runner = job.runner()
    asked: list[int] = []

    def stop() -> bool:
        asked.append(0)
        return len(asked) > 3

    with pytest.raises(promin.Cancelled):
        runner.run(0, stop)
    assert job.state(0) == "missing"
    assert [event["event"] for event in job.events()] == ["begun", "stopped"]


def test_what_is_bad_is_told_and_made_anew(scene: Path, tmp_path: Path) -> None:
    job = jobs.create("render", [str(scene), "--size", "16", "12", "--pieces", "4"], tmp_path / "job")
    runner = make_all(job)
    job.merge([tmp_path / "whole.png"])
    files = [Path(piece.file) for piece in job.pieces]
    whole = [file.read_bytes() for file in files]
    files[0].write_bytes(whole[0][:-1])
    files[1].write_bytes(b"")
    files[2].write_bytes(whole[2][:-3] + bytes([whole[2][-3] ^ 1]) + whole[2][-2:])
    files[3].write_bytes(whole[1])
    assert [job.state(number) for number in range(4)] == ["bad"] * 4
    assert [job.why(number) for number in range(4)] == [
        "the piece is incomplete",
        "the file is empty",
        "the piece is damaged",
        "the file contains another piece",
    ]
    with fails(promin.RunError, "job.pieces.missing", "4 of 4"):
        job.merge([tmp_path / "none.png"])
    assert not (tmp_path / "none.png").exists()
    for number in range(4):
        runner.run(number)
    assert [file.read_bytes() for file in files] == whole
    other = jobs.create("render", [str(scene), "--size", "16", "12", "--spp", "2", "--pieces", "4"], tmp_path / "other")
    shutil.copy(files[0], other.pieces[0].file)
    assert (other.state(0), other.why(0)) == ("bad", "the piece belongs to another job")


def test_a_change_is_refused(scene: Path, rays: Path, tmp_path: Path) -> None:
    words = [str(scene), str(rays), "--pieces", "2"]
    job = jobs.create("cast", words, tmp_path / "job")
    runner = job.runner()
    assert job.spec == {
        "promin_cast_spec": 1,
        "scene": str(scene),
        "rays": str(rays),
        "pieces": 2,
    }
    for other, what in (
        ([*words, "--any"], "its --any is not given"),
        ([*words[:2]], "it has 2 pieces, but the number is now 1"),
    ):
        with fails(promin.UsageError, "job.other", what):
            jobs.create("cast", other, tmp_path / "job")
    changed = make_rays(1000)
    changed[3, 3] = 0.5
    np.save(rays, changed)
    with fails(promin.InputError, "file.changed", "rays.npy: "):
        runner.run(0)
    with fails(promin.UsageError, "job.other", '"rays.npy"'):
        jobs.open(tmp_path / "job").runner()
    np.save(rays, make_rays(1000))
    scene.write_text(scene.read_text() + "\n")
    with fails(promin.UsageError, "job.other", '"box.gltf"'):
        jobs.open(tmp_path / "job").runner()
    scene.unlink()
    with fails(promin.InputError, "file.missing", "box.gltf: "):
        jobs.open(tmp_path / "job").runner()
    (tmp_path / "job/spec.json").write_text("{}")
    with fails(promin.InputError, "spec.format", "spec.json: "):
        jobs.open(tmp_path / "job").runner()
    (tmp_path / "job/spec.json").unlink()
    with fails(promin.InputError, "job.spec.missing", "spec.json: "):
        jobs.open(tmp_path / "job").runner()


def test_a_specification_is_the_job_of_its_words(scene: Path, tmp_path: Path) -> None:
    words = [str(scene), "--size", "16", "12", "--spp", "2", "--pieces", "2", "--aov", "normal,depth"]
    spec = {"scene": scene, "size": [16, 12], "spp": 2, "pieces": 2, "aov": ["depth", "normal"]}
    first = jobs.create("render", words, tmp_path / "job")
    assert jobs.parse_arguments("render", words) == {"promin_render_spec": 1, **spec, "scene": str(scene)} == first.spec
    assert jobs.create("render", spec, tmp_path / "job").id == first.id
    assert jobs.create("render", first.spec, tmp_path / "other").id == first.id
    with pytest.raises(promin.InputError, match='a specification has no member "sp".*did you mean spp'):
        jobs.create("render", {**spec, "sp": 2}, tmp_path / "none")
    with pytest.raises(promin.InputError, match="spp takes a whole number from 1 to 65535, not 0"):
        jobs.create("render", {**spec, "spp": 0}, tmp_path / "none")
    with pytest.raises(promin.UsageError, match="--quality and --spp contradict each other"):
        jobs.create("render", {**spec, "quality": "high"}, tmp_path / "none")
    assert not (tmp_path / "none").exists()


@pytest.mark.parametrize(
    "kind, words",
    [
        ("render", ["--width", "8", "--fov", "33.3", "--eye", "0.1,2,8", "--background", "red", "--exposure", "-0.7"]),
        ("render", ["--size", "8x6", "--quality", "draft", "--tiles", "2", "2", "--no-shadows", "--lights-off", "0"]),
        ("cast", ["--count", "--builder", "median"]),
    ],
)
def test_the_program_and_python_make_one_job(
    scene: Path, rays: Path, tmp_path: Path, run_promin: RunPromin, kind: str, words: list[str]
) -> None:
    words = [str(scene), *([str(rays)] if kind == "cast" else []), *words]
    run_promin(kind, *words, "--job", tmp_path / "job", "--piece", "0/1")
    ids = [hashlib.sha256((tmp_path / "job/job.json").read_bytes()).hexdigest()]
    ids += [jobs.create(kind, work, tmp_path / "job").id for work in (words, jobs.parse_arguments(kind, words))]
    assert len(set(ids)) == 1


def test_arguments_name_outputs(scene: Path, rays: Path, tmp_path: Path) -> None:
    outputs = [str(tmp_path / name) for name in ("a.npy", "b.npy")]
    words = [str(scene), str(rays), "--all", "-o", outputs[0], "--offsets", outputs[1]]
    spec = jobs.parse_arguments("cast", words)
    assert [spec["output"], spec["offsets"]] == outputs
    assert jobs.create("cast", spec, tmp_path / "job").spec == {
        "promin_cast_spec": 1,
        "scene": str(scene),
        "rays": str(rays),
        "all": True,
    }


@pytest.mark.parametrize(
    "kind, words, error, problem",
    [
        ("render", [], promin.UsageError, "usage.words.wrong SCENE"),
        ("render", ["box.gltf", "--sp", "2"], promin.UsageError, "usage.option.unknown --sp --spp"),
        ("render", ["box.gltf", "--spp", "x"], promin.UsageError, "usage.option.value --spp"),
        ("render", ["box.gltf", "--help"], promin.UsageError, "job.argument.wrong --help"),
        ("render", ["box.gltf", "-o", "a.exr"], promin.UsageError, "job.argument.wrong --output"),
        ("render", ["box.gltf", "--piece", "0/2"], promin.UsageError, "job.argument.wrong --piece"),
        ("cast", ["box.gltf", "box.gltf", "--device", "0"], promin.UsageError, "job.argument.wrong --device"),
        ("render", ["box.gltf", "--threads", "2"], promin.UsageError, "job.argument.wrong --threads"),
        ("render", ["box.gltf", "--stats", "a.json"], promin.UsageError, "job.argument.wrong --stats"),
        ("render", ["box.gltf", "--time-limit", "1"], promin.UsageError, "usage.options.contradict --job --time-limit"),
        ("render", ["none.gltf"], promin.InputError, "file.missing none.gltf:"),
        ("cast", ["box.gltf"], promin.UsageError, "usage.words.wrong RAYS.npy"),
        ("cast", ["box.gltf", "none.npy"], promin.InputError, "file.missing none.npy:"),
        ("paint", ["box.gltf"], promin.UsageError, 'job.command.unknown "paint"'),
    ],
)
def test_wrong_arguments(
    scenes: Path, tmp_path: Path, kind: str, words: list[str], error: type[promin.Error], problem: str
) -> None:
    with fails(error, *problem.split()):
        jobs.create(kind, [str(scenes / word) if word == "box.gltf" else word for word in words], tmp_path / "job")
    assert not (tmp_path / "job").exists()


def test_folders_without_a_job(tmp_path: Path) -> None:
    with fails(promin.InputError, "job.folder.missing"):
        jobs.open(tmp_path / "none")
    with fails(promin.InputError, "job.missing"):
        jobs.open(tmp_path)


def test_pieces_of_a_function(tmp_path: Path) -> None:
    (tmp_path / "input.txt").write_text("7")
    made: list[int] = []

    def make(number: int) -> tuple[str, bytes]:
        made.append(number)
        if number == 2:
            raise OSError("the node is gone")
        return f"number {number}", bytes([number]) * 7

    def create(factor: str) -> jobs.Job:
        return jobs.create_with(
            "bytes",
            tmp_path / "job",
            options={"version": "3", "factor": factor},
            pieces=["a", "b", "c"],
            files=[tmp_path / "input.txt"],
            make=make,
        )

    job = create("7")
    assert (job.kind, job.options, [piece.weight for piece in job.pieces]) == (
        "bytes",
        {"version": "3", "factor": "7"},
        [1, 1, 1],
    )
    runner = job.runner()
    receipt = runner.run(1)
    assert runner.run(1) == receipt and receipt.version == "3" and made == [1]
    assert job.read(1) == ("number 1", bytes([1]) * 7) and runner.recompute(1) == receipt.sha256
    with pytest.raises(OSError, match="the node is gone"):
        runner.run(2)
    assert [(event["event"], event.get("why")) for event in job.events()] == [
        ("begun", None),
        ("done", None),
        ("begun", None),
        ("failed", "the node is gone"),
    ]
    assert job.write(2, "", b"", made_on="elsewhere").made_on == "elsewhere" and job.state(2) == "done"
    with pytest.raises(promin.UsageError, match="its factor is"):
        create("8")
    with pytest.raises(promin.UsageError, match="made by a function"):
        jobs.open(tmp_path / "job").runner()
    with fails(promin.InputError, "job.kind.unknown", '"bytes"'):
        job.merge([tmp_path / "a.npy"])
    with fails(promin.UsageError, "job.piece.unknown", "3 of 3"):
        job.state(3)
    with pytest.raises(promin.UsageError, match="return a text and bytes"):
        job.runner(make=lambda number: ("", 1)).run(0)  # type: ignore[arg-type, return-value]
    for pieces in ([], ["a", "a"], ["a/b"]):
        with pytest.raises(promin.UsageError, match="different names"):
            jobs.create_with("bytes", tmp_path / "other", options={}, pieces=pieces)


def test_threads_and_processes_share_a_job(scene: Path, tmp_path: Path) -> None:
    job = jobs.create("render", [str(scene), "--size", "32", "24", "--pieces", "8"], tmp_path / "job")
    code = "import sys\nfrom promin import jobs\njob = jobs.open(sys.argv[1])\nrunner = job.runner()\n"
    code += "for piece in reversed(job.pieces): runner.run(piece.number)"
    other = subprocess.Popen([sys.executable, "-c", code, str(tmp_path / "job")])
    with concurrent.futures.ThreadPoolExecutor(3) as pool:
        for done in [pool.submit(make_all, job) for _ in range(3)]:
            done.result()
    assert other.wait(120) == 0
    assert [job.state(piece.number) for piece in job.pieces] == ["done"] * 8
    assert len(list((tmp_path / "job/pieces").iterdir())) == 8
    job.merge([tmp_path / "cut.exr"])
    promin.Renderer(promin.Scene.load(scene)).render(size=(32, 24)).save(tmp_path / "whole.exr")
    assert np.array_equal(promin.read_image(tmp_path / "cut.exr"), promin.read_image(tmp_path / "whole.exr"))


def test_leftovers_are_cleared(tmp_path: Path) -> None:
    job = jobs.create_with("bytes", tmp_path / "job", options={}, pieces=["a"])
    left = tmp_path / "job/pieces" / f"a.tmp99999999-{os.uname().nodename}.piece"
    left.write_bytes(b"half")
    job.clear_leftovers()
    assert not left.exists()


ENDLESS = """
import sys, threading, os, signal, time
from promin import jobs
job = jobs.open(sys.argv[1])
runner = job.runner()
runner.fingerprint
threading.Timer(1.0, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
try:
    runner.run(0)
except KeyboardInterrupt:
    print([event["event"] for event in job.events()], job.state(0))
"""


def test_ctrl_c_ends_a_piece(scenes: Path, tmp_path: Path) -> None:
    words = [str(scenes / "showcase.gltf"), "--size", "960", "540", "--spp", "4096", "--pieces", "1"]
    jobs.create("render", words, tmp_path / "job")
    done = subprocess.run(
        [sys.executable, "-c", ENDLESS, str(tmp_path / "job")], capture_output=True, text=True, timeout=120
    )
    assert done.stdout == "['begun', 'stopped'] missing\n", done.stderr


def test_files_are_checked_before_the_work(scene: Path, rays: Path, tmp_path: Path) -> None:
    casts = jobs.create("cast", [str(scene), str(rays)], tmp_path / "cast")
    lists = jobs.create("cast", [str(scene), str(rays), "--all"], tmp_path / "all")
    pictures = jobs.create("render", [str(scene), "--size", "8", "8"], tmp_path / "render")
    casts.check_outputs([tmp_path / "hits.npy"])
    for job, files, problem in (
        (casts, [rays], "output.input"),
        (casts, ["a.npy", "b.npy"], "job.outputs.count"),
        (casts, ["a.exr"], "output.extension"),
        (lists, ["a.npy"], "job.outputs.count"),
        (pictures, ["a.bmp"], "output.extension"),
    ):
        with fails(promin.UsageError, problem):
            job.check_outputs(files)
    content = rays.read_bytes()
    make_all(casts)
    with fails(promin.UsageError, "output.input"):
        casts.merge([rays])
    assert rays.read_bytes() == content
    # A manifest from another user cannot refer to files outside its folder.
    manifest = tmp_path / "cast" / "job.json"
    manifest.write_text(manifest.read_text().replace(casts.pieces[0].name, "../../out"))
    with fails(promin.InputError, "job.manifest.damaged"):
        jobs.open(tmp_path / "cast")


def test_wrong_types(tmp_path: Path) -> None:
    with pytest.raises(promin.UsageError, match="give a list of words"):
        jobs.create("render", "scene.gltf", tmp_path / "job")


def test_previews_are_the_picture_made_small(scene: Path, rays: Path, tmp_path: Path) -> None:
    words = [str(scene), "--size", "40", "30", "--tiles", "2", "3", "--tone-mapping", "none", "--exposure", "1"]
    job = jobs.create("render", words, tmp_path / "job")
    make_all(job)
    job.merge([tmp_path / "whole.png"])
    whole = np.round(255.0 * promin.read_image(tmp_path / "whole.png")).astype(int)
    preview = job.preview(3)
    assert preview is not None and preview.shape == (10, 20, 3) and preview.dtype == np.uint8
    assert np.abs(preview.astype(int) - whole[10:20, 20:40]).max() <= 1 and np.ptp(preview) > 50
    small = job.preview(3, 5)
    assert small is not None and small.shape == (2, 5, 3) and (small == preview[2::4, 2::4]).all()
    answers = jobs.create("cast", [str(scene), str(rays)], tmp_path / "rays_job")
    make_all(answers)
    assert answers.preview(0) is None


def test_processors_are_no_gpus() -> None:
    gpus = [info for info in promin.Device.list() if info.type != "CPU" and not info.obstacles]
    assert jobs.list_gpus() == [f"uuid:{info.uuid}" for info in gpus]
