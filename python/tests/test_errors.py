# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Wrong calls raise exceptions with the library's sentences and never crash."""

from __future__ import annotations

import functools
import os
import pickle
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import fails
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

import promin

ERRORS = (promin.Error, TypeError, ValueError)
# Every run has the same cases. A failing case that was found elsewhere becomes an @example or a test of its own.
search = functools.partial(settings, derandomize=True, deadline=None, suppress_health_check=list(HealthCheck))


def test_errors_mirror_the_library() -> None:
    for kind in (promin.UsageError, promin.InputError, promin.DeviceError, promin.RunError, promin.Cancelled):
        assert issubclass(kind, promin.Error)
    assert issubclass(promin.UsageError, ValueError)
    with fails(promin.InputError, "file.missing", "/none/scene.obj: ") as caught:
        promin.Scene.load("/none/scene.obj")
    problem = promin.Problem("file.missing", "/none/scene.obj", "the file does not exist", "check the path")
    assert caught.value.problems == (problem,)
    assert str(problem) == str(caught.value) == "/none/scene.obj: the file does not exist; check the path"
    again = pickle.loads(pickle.dumps(caught.value))
    assert type(again) is promin.InputError and str(again) == str(caught.value)
    assert again.problems == caught.value.problems


def test_all_problems_of_a_scene_are_told() -> None:
    scene = promin.Scene()
    scene.add_triangles([[0, 0, 0], [1, 0, 0], [0, np.nan, 0]], [[0, 1, 2]])
    scene.add_triangles(np.zeros((3, 3)), [[0, 1, 3]], material=7)
    scene.add_sphere(radius=-1)
    for attempt in (scene.validate, lambda: promin.Caster(scene)):
        with pytest.raises(promin.InputError) as caught:
            attempt()
        text = " ".join(str(problem) for problem in caught.value.problems)
        assert len(caught.value.problems) >= 4
        assert all(place in text for place in ("objects[1].material", "positions", "triangles", "radius"))


def run(code: str, **environment: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-c", code], env={**os.environ, **environment}, capture_output=True, text=True, timeout=120
    )


def test_importing_needs_no_driver_and_opening_names_the_variable() -> None:
    code = "import promin\nassert promin.Device.list() == []\ns = promin.Scene()\ns.add_sphere()\npromin.Caster(s)"
    done = run(code, VK_DRIVER_FILES="/nonexistent", VK_ICD_FILENAMES="/nonexistent")
    assert done.returncode == 1
    assert "DeviceError" in done.stderr and "which VK_DRIVER_FILES names" in done.stderr
    # The Vulkan loader and OpenImageIO are loaded only when they are needed.
    code = "import promin\nmaps = open('/proc/self/maps').read()\n"
    code += "assert 'libvulkan' not in maps and 'OpenImageIO' not in maps"
    assert run(code).returncode == 0


def test_devices_are_named() -> None:
    infos = promin.Device.list()
    first = infos[0]
    device = promin.Device(first.index)
    assert device.info == first and first.name in device.fingerprint and device.choice
    assert pickle.loads(pickle.dumps(device)).info == first
    assert promin.Device(f"uuid:{first.uuid}").info.uuid == first.uuid and len(first.uuid) == 32
    with fails(promin.DeviceError, "device.unknown"):
        promin.Device("no such device")
    with pytest.raises(promin.UsageError, match="device is"):
        promin.Caster(promin.Scene(), device=1.5)  # type: ignore[arg-type]


def test_a_device_without_a_cache_keeps_no_kernels(tmp_path: Path) -> None:
    code = "import pickle, promin\nscene = promin.Scene()\nscene.add_sphere()\n"
    code += "device = pickle.loads(pickle.dumps(promin.Device(cache=False)))\npromin.Caster(scene, device)"
    done = run(code, XDG_CACHE_HOME=str(tmp_path))
    assert done.returncode == 0, done.stderr
    assert not (tmp_path / "promin").exists()


ANYTHING: st.SearchStrategy[Any] = st.recursive(
    st.none()
    | st.booleans()
    | st.integers()
    | st.floats()
    | st.text(max_size=5)
    | st.binary(max_size=5)
    | st.just(object()),
    lambda inner: st.lists(inner, max_size=4)
    | st.tuples(inner, inner)
    | st.dictionaries(st.text(max_size=3), inner, max_size=2),
    max_leaves=8,
)
DTYPES = st.sampled_from(["f2", "f4", ">f4", "f8", "i4", "u8", "c8", "?", "O", "U3", "M8[s]", promin.HIT_DTYPE])
ARRAYS = st.builds(
    lambda shape, dtype, step: np.zeros(shape, dtype)[::step],
    st.lists(st.integers(0, 9), min_size=1, max_size=4).map(tuple),
    DTYPES,
    st.sampled_from([1, 2, -1]),
)
VALUES = ANYTHING | ARRAYS
ADDERS = ["add_sphere", "add_plane", "add_box", "add_cylinder", "add_cone", "add_capsule", "add_triangles"]
RECORDS = [promin.Light, promin.Camera, promin.Environment, promin.Display, promin.View]


@search(max_examples=700)
@given(rays=VALUES, query=st.sampled_from(["cast", "occluded", "count", "list"]))
@example(rays=(np.zeros(3), np.zeros((2, 3)), np.zeros(3)), query="cast")
@example(rays=np.full((4, 8), np.nan), query="list")
@example(rays=np.full((4, 8), 1e300), query="count")
def test_random_rays(box_caster: promin.Caster, rays: Any, query: str) -> None:
    try:
        answer = getattr(box_caster, query)(rays)
    except ERRORS as error:
        assert str(error)
    else:
        assert isinstance(answer, (np.ndarray, tuple))


@search(max_examples=200)
@given(data=st.data())
def test_random_scenes(data: st.DataObject) -> None:
    scene = promin.Scene()
    try:
        for _ in range(data.draw(st.integers(1, 3))):
            values = data.draw(st.lists(VALUES, max_size=4))
            getattr(scene, data.draw(st.sampled_from(ADDERS)))(*values)
        scene.add_light(promin.Light(position=data.draw(VALUES), range=data.draw(VALUES), kind=data.draw(VALUES)))
        scene.add_camera(promin.Camera(eye=data.draw(VALUES), yfov=data.draw(VALUES)))
        scene.add_material(promin.Phong(diffuse=data.draw(VALUES), fresnel=data.draw(VALUES)))
        scene.environment = promin.Environment(ambient=data.draw(VALUES), sky=data.draw(VALUES))
        scene.validate()
    except ERRORS as error:
        assert str(error)


@pytest.fixture(scope="module")
def renderer() -> promin.Renderer:
    scene = promin.Scene()
    scene.add_sphere()
    return promin.Renderer(scene)


@search(max_examples=200)
@given(data=st.data())
def test_random_views(renderer: promin.Renderer, data: st.DataObject) -> None:
    names = [
        "camera",
        "crop",
        "spp",
        "max_depth",
        "target_error",
        "error_in",
        "time_limit",
        "filter",
        "filter_width",
        "depth",
        "debug_view",
    ]
    values = {name: data.draw(VALUES) for name in data.draw(st.lists(st.sampled_from(names), min_size=1, max_size=3))}
    if isinstance(values.get("spp"), int) or isinstance(values.get("time_limit"), (int, float)):
        return  # These arguments may be valid, and the calls would take long.
    try:
        renderer.render(promin.View(size=(4, 3), **values))
    except ERRORS as error:
        assert str(error)
    try:
        renderer.update(lights=data.draw(VALUES))
    except ERRORS as error:
        assert str(error)


def test_long_values_are_cut_between_characters(renderer: promin.Renderer) -> None:
    for spaces in range(4):
        with pytest.raises(promin.UsageError, match="crop is .*ü"):
            renderer.render(promin.View(crop=" " * spaces + "ü" * 100))


def test_the_root_widens_what_a_scene_may_name(tmp_path: Path) -> None:
    (tmp_path / "models").mkdir()
    (tmp_path / "a.mtl").write_text("newmtl red\nKd 1 0 0\n")
    scene = tmp_path / "models" / "a.obj"
    scene.write_text("mtllib ../a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n")
    loaded = promin.Scene.load(scene, root=tmp_path)
    for each in (loaded, pickle.loads(pickle.dumps(loaded))):
        assert [material.name for material in each.materials] == ["red"]
    with fails(promin.UsageError, "scene.root.folder"):
        promin.Scene.load(scene, root=tmp_path / "none")


def test_text_that_is_not_utf8(tmp_path: Path) -> None:
    wrong = tmp_path / "wrong.obj"
    wrong.write_bytes(b"v 0 0 0\nf 1 2 \xe9\xe9\n")
    with pytest.raises(promin.InputError, match="\ufffd\ufffd"):
        promin.Scene.load(wrong)
    (tmp_path / "latin.mtl").write_bytes(b"newmtl m\xfcller\nKd 1 0 0\n")
    latin = tmp_path / "latin.obj"
    latin.write_bytes(b"mtllib latin.mtl\no caf\xe9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\xfcller\nf 1 2 3\n")
    scene = promin.Scene.load(latin)
    assert [found.name for found in scene.objects] == ["caf\ufffd"]
    assert [material.name for material in scene.materials] == ["m\ufffdller"]
    with pytest.raises(promin.InputError, match="none\ufffd"):
        promin.Scene.load(tmp_path / os.fsdecode(b"none\xe9.obj"))
    named = tmp_path / os.fsdecode(b"caf\xe9.obj")
    os.rename(latin, named)
    frame = promin.Renderer(promin.Scene.load(named)).render(size=(4, 3))
    assert frame.metadata["promin:scene"] == r"caf\xe9.obj"
    frame.save(named.with_suffix(".exr"))
    assert promin.read_image(named.with_suffix(".exr")).shape == (3, 4, 3)


def test_sizes_that_no_picture_has(tmp_path: Path) -> None:
    with pytest.raises(promin.UsageError):
        promin.write_image(tmp_path / "none.png", np.zeros((0, 4, 3)))
    with pytest.raises(promin.UsageError):
        promin.write_image(tmp_path / "none.gif", np.zeros((2, 4, 3)))
    with pytest.raises(promin.RunError):
        promin.write_image(tmp_path / "nonexistent/none.png", np.zeros((2, 4, 3)))
    with pytest.raises(promin.InputError):
        promin.read_image(tmp_path / "nonexistent.png")
