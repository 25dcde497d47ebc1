# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Tests of the command line, the status, the audit, the page and the job scripts of queues."""

from __future__ import annotations

import ast
import dataclasses
import json
import shutil
import struct
import subprocess
import sys
import zlib
from collections import Counter
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
from conftest import HERE, Farm, wait_for


def test_wrong_use_is_refused_in_one_line(farm: Farm) -> None:
    farm.write_scene(3)
    base = ("render", farm.scene, "--job", farm.job)
    out = ("-o", farm.out)
    for words, sentence in (
        (base, "give one with -o FILE"),
        (("render", farm.scene, *out), "there is no folder for the job; give one with --job DIR"),
        (("my model.glb",), "use: promin-farm render 'my model.glb' -o 'my model.png' --job 'my model.job'"),
        (("resume", farm.scene), f"{farm.scene} is a file, not a job's folder"),
        ((*base, "-o", "out.jpg"), f"an output is none of .exr, .png, {farm.root}/out.jpg"),
        ((*base, *out, "--nonsense"), "--nonsense is not known"),
        ((*base, *out, "--workers", "0"), "give 1 or more"),
        ((*base, *out, "--scheduler", "sge"), "give tcp://HOST:PORT, slurm, pbs, lsf"),
        ((*base, *out, "--scheduler", "slurm", "--device", "A"), "set PROMIN_DEVICE"),
        ((*base, *out, "--scheduler", "tcp://a:1", "--workers", "2"), "the cluster has its own workers"),
        ((*base, *out, "--scheduler", "slurm", "--queue-config", "nothing.toml"), "the settings cannot be read"),
        ((*base, *out, "--queue-config", "queue.toml"), "--queue-config needs a queue"),
        ((*base, *out, "--scheduler", "tcp://a:1", "--queue-config", "queue.toml"), "give --scheduler slurm, pbs, lsf"),
        (("resume", farm.job, "--nonsense"), "--nonsense is not known"),
        (("audit", farm.job, "--share", "200%"), "give a fraction such as 1% or 0.01"),
    ):
        said = farm.run(*words, code=2)
        assert sentence in said and said.startswith("promin-farm: ") and said.count("\n") == 1, said


def test_a_scene_or_a_job_in_a_wrong_place_is_answered_with_the_command(farm: Farm) -> None:
    farm.write_scene(3)
    job = farm.create()
    assert f"is a job's folder, not a command; use: promin-farm status {job.folder}" in farm.run(farm.job, code=2)
    (farm.root / "a.OBJ").touch()
    said = farm.run("resume", "a.OBJ", code=2)
    assert "a.OBJ is a file, not a job's folder; to make a job of it, use: promin-farm render a.OBJ -o a.png" in said
    assert "a.OBJ is a scene, not a command" in farm.run("a.OBJ", "-o", "b.png", code=2)


def test_frames_need_files_of_their_own_and_outputs_a_folder(farm: Farm) -> None:
    farm.write_scene(4, names="frames")
    assert "write #### in its name for the number of a frame" in farm.render(code=2)
    words = ("render", farm.scene, "-o", "nowhere/out.####.exr", "--job", farm.job)
    assert "cannot write to the folder" in farm.run(*words, code=1)
    assert not farm.events("begun")


def test_rates_are_of_rays_or_of_pixels(farm: Farm) -> None:
    from promin_farm.status import describe_rate
    from promin_farm.survey import take_survey

    farm.write_scene(4, ms=5)
    job = farm.create()
    assert describe_rate(job, take_survey(job)) == ""
    farm.run("work", farm.job)
    survey = take_survey(job)
    survey.rate = 1234567.0
    assert describe_rate(job, survey) == "1.23 M pixels a second"
    job.kind = "cast"
    assert describe_rate(job, survey) == "1.23 M rays a second"


def test_a_scene_that_is_not_there(farm: Farm) -> None:
    assert "cannot open" in farm.render(code=3)


def test_promin_reads_the_options_in_their_order(farm: Farm) -> None:
    farm.write_scene(2)
    words = ("--size", "10", "-20", "--tiles", "2", "1")
    farm.run("render", "--workers", "1", farm.scene, *words, "-o", farm.out, "--quiet", "--job", farm.job)
    spec = {"scene": str(farm.scene), "size": ["10", "-20"], "tiles": ["2", "1"]}
    assert json.loads((farm.job / "job.json").read_text())["spec"] == spec


def test_the_farm_works_with_a_specification(farm: Farm, monkeypatch: pytest.MonkeyPatch) -> None:
    from promin import jobs

    from promin_farm.command import main

    monkeypatch.chdir(farm.root)
    read = {"scene": "scene.json", "rays": "rays.npy", "output": "hits.npy", "offsets": "offsets.npy", "odd": [1, {}]}
    created = []

    def create(kind: str, spec: object, folder: str) -> None:
        created.append((kind, spec, folder))
        raise jobs.UsageError("enough")

    monkeypatch.setattr(jobs, "parse_arguments", lambda kind, arguments: {**read, "read": [kind, *arguments]})
    monkeypatch.setattr(jobs, "create", create)
    assert main(["cast", "--odd", "1", "2", "--job", "job", "x.json"]) == 2
    spec = {"scene": "scene.json", "rays": "rays.npy", "odd": [1, {}], "read": ["cast", "--odd", "1", "2", "x.json"]}
    assert created == [("cast", spec, str(farm.job))]


def test_status_in_words_and_as_json(farm: Farm) -> None:
    farm.write_scene(6, ms=20, fails=[4])
    farm.create()
    farm.run("work", farm.job, code=1)
    status = farm.status()
    assert status["pieces"] == 6 and status["done"] == 5 and status["running"] == []
    assert status["failed"][0]["reason"].startswith("the device was lost") and status["pixels_per_s"] > 0
    assert status["weight_done"] + status["weight_left"] == 12 and status["time_left_s"] is None
    assert len(status["slowest"]) == 5 and all(20 <= item["ms"] < 2000 for item in status["slowest"])
    words = farm.run("status", farm.job)
    assert "render of 6 pieces: 5 done (83 %), 0 running, 1 failed" in words and "after" not in words.splitlines()[0]
    assert "3 failures, the last: the device was lost at 4" in words


def test_of_a_piece_that_is_gone_nothing_is_told(farm: Farm) -> None:
    farm.write_scene(3)
    job = farm.create()
    farm.run("work", farm.job)
    Path(job.pieces[1].file).unlink()
    status = farm.status()
    assert [item["piece"] for item in status["slowest"] if item["piece"] == job.pieces[1].name] == []
    assert list(status["fingerprints"].values()) == [2] and status["done"] == 2


def test_status_of_what_runs_tells_the_time_left(farm: Farm) -> None:
    farm.write_scene(30, ms=150)
    farm.create()
    process = farm.start("work", farm.job)
    wait_for(lambda: len(farm.events("done")) >= 2)
    status = farm.status()
    process.terminate()
    process.communicate()
    assert len(status["running"]) == 1 and 1.0 < status["time_left_s"] < 30.0


def test_audit_finds_a_machine_that_gives_other_bits(farm: Farm) -> None:
    farm.write_scene(20)
    job = farm.create()
    farm.run("work", farm.job)
    assert "20 of 20 pieces of this fingerprint have equal bits" in farm.run("audit", farm.job, "--share", "100%")
    assert "2 of 2" in farm.run("audit", farm.job, "--share", "10%")
    for piece in job.pieces[:3]:
        Path(piece.file).unlink()
    farm.run("work", farm.job, FAKE_SALT="a broken machine")
    said = farm.run("audit", farm.job, "--share", "100%", code=1)
    for piece in job.pieces[:3]:
        broken = f"{piece.name}: other bits of the same fingerprint, 100 % see another surface: a machine is broken\n"
        assert broken in said
    assert "an audit has found wrong pieces" in said and "17 of 20 pieces of this fingerprint have equal bits" in said
    # The audit fails for every difference, however small.
    farm.run("audit", farm.job, "--share", "100%", code=1, FAKE_DIFFERENCE="0.001")


def test_audit_holds_other_fingerprints_to_the_bounds(farm: Farm) -> None:
    farm.write_scene(20)
    job = farm.create()
    farm.run("work", farm.job, FAKE_SALT="other bits", FAKE_FINGERPRINT="two")
    for piece in job.pieces[:16]:
        Path(piece.file).unlink()
    for piece in job.pieces[:16]:
        assert job.runner().run(piece.number)
    audit = ("audit", farm.job, "--share", "100%")
    said = farm.run(*audit, FAKE_DIFFERENCE="0.0012")
    within = "within the bounds, 0.2 % see another surface, the rest differs by at most 0.0012\n"
    assert f"{job.pieces[16].name}: {within}" in said
    assert "16 of 16 pieces of this fingerprint have equal bits" in said
    assert "of 4 pieces of other fingerprints 0 have equal bits, 4 are within the bounds, 0 beyond" in said
    assert said.count("\n") == 6
    said = farm.run(*audit, FAKE_FINGERPRINT="three", FAKE_DIFFERENCE="0.01", code=1)
    assert f"{job.pieces[16].name}: beyond the bounds, 100 % see another surface\n" in said
    assert "of 20 pieces of other fingerprints 16 have equal bits, 0 are within the bounds, 4 beyond" in said


@pytest.mark.parametrize("is_told", [True, False])
def test_an_audit_counts_pieces_without_a_fingerprint_among_the_others(farm: Farm, is_told: bool) -> None:
    """Pieces without a fingerprint are those of promin's programs and those whose maker was killed before it wrote a
    receipt."""
    from promin_farm.audit import audit

    farm.write_scene(3)
    job = farm.create()
    farm.run("work", farm.job)
    receipt = dataclasses.replace(job.receipt(0), fingerprint="")
    job.receipt = lambda number: receipt if is_told else None
    found = audit(job, "100%", 0, None)
    assert len(found.across) == 3 and not found.within and found.is_good


def test_an_audit_of_nothing_is_refused(farm: Farm) -> None:
    farm.write_scene(3)
    farm.create()
    assert "the job has no piece to audit" in farm.run("audit", farm.job, code=1)


def test_samples_are_spread_and_the_same_for_a_seed(farm: Farm) -> None:
    from promin_farm.audit import pick_sample

    farm.write_scene(1000)
    job = farm.create()
    first = pick_sample(job, list(range(1000)), 0.01, 0)
    assert len(first) == 10 == len(set(first)) and first == pick_sample(job, list(range(1000)), 0.01, 0)
    assert first != pick_sample(job, list(range(1000)), 0.01, 1) and first != list(range(10))
    # The sample has at least one piece, and at least the requested share.
    assert [len(pick_sample(job, list(range(1000)), share, 0)) for share in (0.0001, 0.0015)] == [1, 2]


def make_page(farm: Farm, **values: object) -> str:
    farm.write_scene(6, **values)
    farm.create()
    farm.run("work", farm.job, code=1 if values.get("fails") else 0)
    farm.run("status", farm.job, "--page")
    return (farm.job / "index.html").read_text()


class Tags(HTMLParser):
    """Counts the elements of HTML and keeps the text. Raises an error if elements are not closed in reverse order."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.count: Counter[str] = Counter()
        self.sources: list[str] = []
        self.text = ""

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.count[f"{tag}.{dict(attrs).get('class')}" if tag == "rect" else tag] += 1
        self.sources += [value for name, value in attrs if name == "src" and value]
        if tag not in ("meta", "img"):
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.text += data


def test_the_page_has_pictures_timeline_and_failures(farm: Farm) -> None:
    tags = Tags()
    tags.feed(make_page(farm, fails=[4], ms=10))
    assert not tags.open and tags.count["img"] == 5
    assert tags.count["rect.done"] == 5 and tags.count["rect.failed"] == 3
    assert "5 of 6 pieces, 0 running, 1 failed" in tags.text and "the device was lost at 4" in tags.text
    assert all((farm.job / source).read_bytes().startswith(b"\x89PNG") for source in tags.sources)


def test_pictures_are_pngs(tmp_path: Path) -> None:
    from promin_farm.pictures import encode_png

    pixels = np.arange(5 * 7 * 3, dtype=np.uint8)
    png = encode_png(7, 5, pixels.tobytes())
    assert png[:8] == b"\x89PNG\r\n\x1a\n" and png[-8:-4] == b"IEND"
    assert struct.unpack(">II", png[16:24]) == (7, 5)
    at = png.index(b"IDAT")
    lines = zlib.decompress(png[at + 4 : at + 4 + struct.unpack(">I", png[at - 4 : at])[0]])
    assert b"".join(lines[y * 22 + 1 : (y + 1) * 22] for y in range(5)) == pixels.tobytes()


CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)


@pytest.mark.skipif(CHROMIUM is None, reason="there is no chromium")
def test_the_page_in_chromium(farm: Farm) -> None:
    make_page(farm, fails=[4], ms=10)
    done = subprocess.run(
        [str(CHROMIUM), "--headless", "--no-sandbox", "--disable-gpu", "--virtual-time-budget=2000", "--dump-dom",
         f"file://{farm.job}/index.html"],
        capture_output=True, text=True, timeout=120,
    )  # fmt: skip
    assert "5 of 6 pieces" in done.stdout and done.stdout.count("<rect") == 8 and done.stdout.count("<img") == 5


def test_job_scripts_of_queues(tmp_path: Path) -> None:
    pytest.importorskip("dask_jobqueue")
    from promin_farm.queues import QUEUES, make_cluster, read_config

    config = tmp_path / "queue.toml"
    config.write_text('queue = "short"\ncores = 4\nwalltime = "02:00:00"\njob_script_prologue = ["module load mesa"]\n')
    for queue in QUEUES:
        extra = {"interface": "lo", **({"use_stdin": True} if queue == "lsf" else {})}
        with make_cluster(queue, {**read_config(str(config)), **extra}) as cluster:
            script = cluster.job_script()
        assert (
            "module load mesa\nexport LP_NUM_THREADS=4\nexport PROMIN_FARM_ENDS_AT=$(( $(date +%s) + 7140 ))" in script
        )
        assert "--nthreads 1" in script and "--lifetime 7140s --lifetime-stagger 30s" in script and "short" in script


def test_wrong_settings_of_a_queue_are_refused(farm: Farm) -> None:
    pytest.importorskip("dask_jobqueue")
    farm.write_scene(3)
    config = farm.root / "queue.toml"
    for text, sentence in (('walltime = "soon"', "give HH:MM:SS"), ("nonsense = 1", "not settings of dask-jobqueue")):
        config.write_text(text + "\n")
        said = farm.render("--scheduler", "slurm", "--queue-config", config, code=2)
        assert sentence in said and "promin-farm: " in said, said


def test_rays_of_zarr_are_those_of_numpy(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    zarr = pytest.importorskip("zarr")
    from promin import jobs

    from promin_farm import rays as module

    monkeypatch.setattr(module, "_ROWS", 600)  # Several parts of whole chunks each.
    rays = np.random.default_rng(1).normal(size=(1000, 8)).astype(np.float32)
    source = tmp_path / "rays.zarr"
    array = zarr.open_array(str(source), mode="w", shape=rays.shape, chunks=(300, 8), dtype="float32")
    array[:] = rays
    copy, expected = tmp_path / "job.rays.npy", tmp_path / "expected.npy"
    spec = {"scene": "scene.gltf", "rays": str(source), "count": True}
    for _ in range(2):
        assert module.prepare_rays(spec, tmp_path / "job") == {**spec, "rays": str(copy)}
        np.save(expected, rays)
        assert copy.read_bytes() == expected.read_bytes()
    array[5, 5] = 7
    with pytest.raises(jobs.InputError, match="the rays have changed since the start of the job"):
        module.prepare_rays(spec, tmp_path / "job")
    zarr.open_array(str(tmp_path / "flat.zarr"), mode="w", shape=(8,), chunks=(8,), dtype="float32")
    with pytest.raises(jobs.InputError, match="an array of N x 8 float32 numbers"):
        module.prepare_rays({"rays": str(tmp_path / "flat.zarr")}, tmp_path / "other")
    with pytest.raises(jobs.InputError, match="the zarr array cannot be opened"):
        module.prepare_rays({"rays": str(tmp_path / "nothing.zarr")}, tmp_path / "other")
    assert module.prepare_rays({"rays": "rays.npy"}, tmp_path / "other") == {"rays": "rays.npy"}


def test_of_promin_only_its_jobs_are_imported() -> None:
    seen = set()
    for file in (HERE.parent / "promin_farm").glob("*.py"):
        for node in ast.walk(ast.parse(file.read_text())):
            if isinstance(node, ast.Import):
                seen |= {alias.name for alias in node.names}
            elif isinstance(node, ast.ImportFrom):
                assert node.level == 0
                seen |= (
                    {f"{node.module}.{alias.name}" for alias in node.names}
                    if node.module == "promin"
                    else {node.module}
                )
    assert {name for name in seen if str(name).partition(".")[0] == "promin"} == {"promin.jobs"}


def test_mypy_strict(tmp_path: Path) -> None:
    pytest.importorskip("mypy")
    done = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", "-p", "promin_farm", "--cache-dir", str(tmp_path)],
        cwd=tmp_path, env={"MYPYPATH": f"{HERE / 'fake'}:{HERE.parent}", "PATH": "/usr/bin:/bin"},
        capture_output=True, text=True, timeout=300,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout
