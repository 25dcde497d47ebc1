# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import dataclasses
import json
import os
import pickle
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any, Callable

import numpy as np
import pytest
from conftest import fails, make_box

import promin
from promin import _promin


@pytest.mark.parametrize(
    "name, options, words",
    [
        ("showcase.gltf", {"size": (96, 64)}, ["--size", 96, 64]),
        ("metallic_roughness.gltf", {"size": (64, 48), "spp": 2}, ["--size", 64, 48, "--spp", 2]),
        # Kernels with glass take longest to compile.
        pytest.param(
            "glass.gltf", {"crop": (600, 300, 640, 330)}, ["--crop", 600, 300, 640, 330], marks=pytest.mark.long
        ),
        ("box.gltf", {"crop": (600, 300, 640, 330)}, ["--crop", 600, 300, 640, 330]),
        ("obj_materials.obj", {"size": (40, 30), "target_error": 0.05}, ["--size", 40, 30, "--target-error", 0.05]),
        ("cameras.gltf", {"camera": 1, "filter": "gauss"}, ["--camera", 1, "--filter", "gauss"]),
        (
            "box.gltf",
            {"size": (40, 30), "spp": 3, "filter": "tent", "filter_width": 2.5, "depth": "plane", "shadows": False},
            [*"--size 40 30 --spp 3 --filter tent --filter-width 2.5 --depth plane --no-shadows".split()],
        ),
        (
            "box.gltf",
            {"size": (40, 30), "target_error": 0.01, "min_spp": 4, "max_spp": 32},
            [*"--size 40 30 --target-error 0.01 --min-spp 4 --max-spp 32".split()],
        ),
        (
            "mirrors.gltf",
            {"size": (40, 30), "target_error": 0.02, "error_in": "display"},
            [*"--size 40 30 --target-error 0.02 --error-in display".split()],
        ),
        (
            "metallic_roughness.gltf",
            {"size": (24, 18), "target_error": 0.02, "error_in": "display"},
            [*"--size 24 18 --target-error 0.02 --error-in display".split()],
        ),
    ],
)
def test_a_file_has_the_bits_of_promin_render(
    name: str,
    options: dict[str, object],
    words: list[object],
    scenes: Path,
    tmp_path: Path,
    run_promin: Callable[..., None],
) -> None:
    aovs = ("depth", "normal", "object", "albedo", "samples")
    frame = promin.Renderer(promin.Scene.load(scenes / name), aovs=aovs).render(**options)  # type: ignore[arg-type]
    frame.save(tmp_path / "ours.png")
    frame.save(tmp_path / "ours.exr")
    outputs = ["-o", tmp_path / "theirs.png", "-o", tmp_path / "theirs.exr"]
    run_promin("render", scenes / name, *words, *outputs, "--aov", ",".join(aovs))
    assert (tmp_path / "ours.png").read_bytes() == (tmp_path / "theirs.png").read_bytes()
    assert (tmp_path / "ours.exr").read_bytes() == (tmp_path / "theirs.exr").read_bytes()


def test_mattes_are_those_of_cryptomatte(scenes: Path, tmp_path: Path, run_promin: Callable[..., None]) -> None:
    names = ("cryptomatte", "object", "depth")
    for name in ("showcase.gltf", "obj_materials.obj"):
        renderer = promin.Renderer(promin.Scene.load(scenes / name), aovs=names)
        frame = renderer.render(size=(48, 32), spp=4)
        frame.save(tmp_path / "ours.exr")
        words = ["--size", 48, 32, "--spp", 4, "--aov", ",".join(names)]
        run_promin("render", scenes / name, *words, "-o", tmp_path / "theirs.exr")
        assert (tmp_path / "ours.exr").read_bytes() == (tmp_path / "theirs.exr").read_bytes()
        assert set(frame.aovs) == {"object", "depth", "cryptomatte_object", "cryptomatte_material"}
        manifests = [json.loads(v) for k, v in frame.metadata.items() if k.endswith("/manifest")]
        assert len(manifests) == 2
        for of, manifest in zip(("object", "material"), manifests):
            layer = frame.aovs[f"cryptomatte_{of}"]
            assert layer.shape == (32, 48, 6, 2) and layer.dtype == np.float32
            for one, number in manifest.items():
                assert promin.cryptomatte_id(one).view(np.uint32) == int(number, 16)
            covered = sum(frame.matte(one, of) for one in manifest)
            assert np.allclose(covered, layer[..., 1].sum(axis=-1)) and 0.1 < covered.mean() <= 1
        assert not frame.matte("nobody").any()


def test_mattes_follow_names(box: promin.Scene) -> None:
    box.add_sphere((3, 0, 0), name="ball")
    renderer = promin.Renderer(box, aovs=("cryptomatte",))
    frame = renderer.render(size=(64, 32))
    assert 0 < frame.matte("ball").sum() < frame.matte("object 0").sum()
    assert (frame.matte("material 0", "material") > 0).any()
    renderer.update(materials=[promin.Phong(name="clay")])
    assert (renderer.render(size=(64, 32)).matte("clay", "material") == frame.matte("material 0", "material")).all()
    with pytest.raises(promin.UsageError, match="there are no mattes of 'objects'"):
        frame.matte("ball", "objects")
    with pytest.raises(promin.UsageError, match="cryptomatte"):
        renderer.render(size=(8, 8), aovs=()).matte("ball")


def test_exr_files_are_kept_as_asked(box: promin.Scene, tmp_path: Path, run_promin: Callable[..., None]) -> None:
    frame = promin.Renderer(box, aovs=("depth", "normal")).render(size=(48, 32))
    frame.save(tmp_path / "plain.exr")
    frame.save(tmp_path / "half.exr", half=True, compression="piz")
    plain, half = (promin.read_image(tmp_path / f"{name}.exr") for name in ("plain", "half"))
    assert (plain == frame.rgb).all() and (half == frame.rgb.astype(np.float16)).all() and (half != plain).any()
    with fails(promin.UsageError, "python.name.unknown", '"lossy"', "none, rle, zips, zip, piz"):
        frame.save(tmp_path / "none.exr", compression="lossy")


def test_a_renderer_has_a_view_of_its_own(box: promin.Scene) -> None:
    view = promin.View(size=(16, 12), debug_view="normals", shadows=False)
    renderer = pickle.loads(pickle.dumps(promin.Renderer(box, view=view)))
    own = renderer.render()
    assert own.size == (16, 12)
    other = promin.Renderer(box)
    assert (other.render(view).rgb == own.rgb).all() and (renderer.render(debug_view="uv").rgb != own.rgb).any()
    with pytest.raises(promin.UsageError, match="is not a promin.View"):
        promin.Renderer(box, view=(16, 12))  # type: ignore[arg-type]


@pytest.mark.parametrize("name", ["error", "alpha"])
def test_debug_views_have_neither_error_nor_background(box: promin.Scene, name: str) -> None:
    renderer = promin.Renderer(box, aovs=(name,))
    with pytest.raises(promin.UsageError, match=f'aovs with "{name}" and debug_view="uv" contradict each other'):
        renderer.render(size=(8, 8), debug_view="uv")
    assert renderer.render(size=(8, 8), debug_view="uv", aovs=()).aovs == {}
    assert name in renderer.render(size=(8, 8)).aovs


def test_frames_tell_what_they_show(box: promin.Scene, tmp_path: Path) -> None:
    renderer = promin.Renderer(box, aovs=("depth", "object", "normal"))
    frame = renderer.render(size=(48, 32))
    assert frame.rgb.shape == (32, 48, 3) and frame.rgb.dtype == np.float32 and frame.size == (48, 32)
    assert frame.aovs["object"].dtype == np.uint32 and frame.aovs["normal"].shape == (32, 48, 3)
    hit = frame.aovs["object"] == 0
    assert (
        0.05 < hit.mean() < 0.9
        and np.isfinite(frame.aovs["depth"][hit]).all()
        and np.isinf(frame.aovs["depth"][~hit]).all()
    )
    assert frame._repr_png_().startswith(b"\x89PNG")
    assert frame.srgb().shape == (32, 48, 3) and frame.metadata["promin:size"] == "48x32"
    frame.save(tmp_path / "a.png")
    shown = promin.read_image(tmp_path / "a.png")
    assert np.abs(shown * 255 - frame.srgb()).max() < 1.01


def test_other_aovs_are_for_one_picture(box: promin.Scene) -> None:
    renderer = promin.Renderer(box, aovs=(name for name in ("depth", "object")))
    frame = renderer.render(size=(48, 32))
    other = renderer.render(size=(48, 32), aovs=(name for name in ("albedo",)))
    assert set(other.aovs) == {"albedo"} and (other.rgb == frame.rgb).all()
    assert "promin:depth" in frame.metadata and "promin:depth" not in other.metadata
    assert set(renderer.render(size=(8, 8)).aovs) == set(frame.aovs) == {"depth", "object"}
    assert set(renderer.render(size=(8, 8), aovs=[]).aovs) == set()


def test_threads_may_ask_for_different_aovs(box: promin.Scene) -> None:
    renderer = promin.Renderer(box)
    choices = [("depth",), ("normal", "object"), (), ("position",)] * 4
    with ThreadPoolExecutor(4) as pool:
        frames = list(pool.map(lambda names: renderer.render(size=(8, 8), aovs=names), choices))
    for names, frame in zip(choices, frames):
        assert set(frame.aovs) == set(names) and ("promin:depth" in frame.metadata) == ("depth" in names)


def test_the_pipeline_is_that_of_the_first_picture(box: promin.Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    pickled = pickle.dumps(promin.Renderer(box))
    made = _promin.Renderer
    told = []

    def note(device: object, scene: object, aovs: object, builder: object, bvh: object, *others: object) -> object:
        told.append(others[1:3])
        return made(device, scene, aovs, builder, bvh, *others)  # type: ignore[arg-type]

    monkeypatch.setattr(_promin, "Renderer", note)
    for options in ({}, {"target_error": 0.5}, {"time_limit": 9.0}):
        pickle.loads(pickled).render(size=(8, 8), **options)
    promin.Renderer(box, view=promin.View(target_error=0.5))
    promin.Renderer(box, view=promin.View(debug_view="uv", shadows=False))
    light = {"debug_view": "full", "has_shadows": True, "integrator": "whitted"}
    flat = {"debug_view": "uv", "has_shadows": False, "integrator": "whitted"}
    # A picture with a time limit starts with one sample per pixel.
    assert told == [(False, light), (True, light), (False, light), (True, light), (False, flat)]


def test_soft_light_has_soft_shadows_and_a_ground(box: promin.Scene) -> None:
    view = promin.View(size=(24, 18), spp=4)
    # Light that the floor scatters reaches the sides of the box.
    box.add_triangles([[-4, -1, -4], [0, -1, 6], [4, -1, -4]], [[0, 1, 2]])
    soft = promin.Renderer(box, light="soft", view=view)
    assert soft.materials[-1].catches_shadows and soft.lights[-1].angle > 0.17  # type: ignore[attr-defined]
    assert (soft.render().rgb == soft.render(integrator="direct").rgb).all()
    assert (soft.render().rgb != soft.render(integrator="whitted").rgb).any()
    assert soft.render(integrator="path").rgb.mean() > soft.render().rgb.mean()
    bare = promin.Renderer(box, light="soft", ground=False, view=view, aovs=("ambient_occlusion",))
    assert len(bare.materials) == len(soft.materials) - 1
    occlusion = bare.render().aovs["ambient_occlusion"]
    assert occlusion.shape == (18, 24) and occlusion.max() == 1


def test_surfaces_that_emit_much_light_light_others() -> None:
    def lit_by(radiance: float, light: str = "none", integrator: str | None = None) -> promin.Renderer:
        scene = promin.Scene()
        scene.add_triangles([[-2, 0, -2], [0, 0, 4], [2, 0, -2]], [[0, 1, 2]])
        lamp = scene.add_material(promin.MetallicRoughness(emissive=(radiance,) * 3))
        scene.add_triangles([[-1, 1, -1], [0, 1, 1], [1, 1, -1]], [[0, 1, 2]], material=lamp)
        view = promin.View(size=(24, 18), spp=4, integrator=integrator)
        return promin.Renderer(scene, light=light, view=view)

    bright, dim = lit_by(9.0), lit_by(1.0)
    assert (bright.render().rgb == bright.render(integrator="direct").rgb).all()
    assert (bright.render().rgb != bright.render(integrator="whitted").rgb).any()
    assert (dim.render().rgb == dim.render(integrator="whitted").rgb).all()
    # A scene that its lamp lights gets only the fill, unless the lamp lights nothing.
    assert (lit_by(9.0, "auto").render().rgb == lit_by(9.0, "fill").render().rgb).all()
    assert not lit_by(9.0, "auto").lights and lit_by(1.0, "auto").lights
    assert lit_by(9.0, "auto", "whitted").lights


def test_a_centre_moves_camera_light_and_positions() -> None:
    frames = []
    for offset in (0.0, 1e6):
        scene = promin.Scene()
        scene.add_triangles(*make_box((offset, 0, 0)))
        scene.add_light(promin.Light(position=(offset + 3, 4, 5)))
        camera = promin.Camera.look_at((offset + 2, 2, 6), (offset, 0, 0))
        renderer = promin.Renderer(scene, aovs=("position",))
        frame = renderer.render(camera=camera, size=(24, 24))
        frame.aovs["position"][..., 0][frame.aovs["position"].any(axis=2)] -= offset
        frames.append(frame)
        assert renderer.lights[0].position == (offset + 3, 4, 5)
        assert abs(renderer.camera().eye[0] - offset) < 20
        assert set(frame.aovs) == {"position"}
    assert (frames[0].rgb == frames[1].rgb).all() and frames[0].rgb.max() > 0.2
    assert np.abs(frames[0].aovs["position"] - frames[1].aovs["position"]).max() < 1e-6


def test_a_scene_is_framed_from_any_side(box: promin.Scene) -> None:
    def camera(**pose: Any) -> promin.Camera:
        return promin.Renderer(box, view=promin.View(**pose)).camera()

    left = camera(from_="left")
    assert left.look == (1, 0, 0)
    assert camera(from_="left", fit=0.1).eye[0] < left.eye[0] - 1
    with pytest.raises(promin.UsageError, match="0.05"):
        camera(from_="left", fit=2)
    box.add_camera(promin.Camera(eye=(0, 0, 9)))
    assert camera().eye == (0, 0, 9)
    assert camera(from_="left") == left, "whatever cameras there are"


def test_a_hit_may_be_at_the_centre() -> None:
    scene = promin.Scene(center=(5, 0, 0))
    scene.add_box((5, 0, -1), (1, 1, 1))
    renderer = promin.Renderer(scene, aovs=("position", "depth"))
    frame = renderer.render(camera=promin.Camera.look_at((5, 0, 4), (5, 0, 0)), size=(9, 9), spp=1)
    assert frame.aovs["depth"][4, 4] == 4 and frame.aovs["position"][4, 4].tolist() == [5, 0, 0]
    assert np.isinf(frame.aovs["depth"][0, 0]) and frame.aovs["position"][0, 0].tolist() == [0, 0, 0]


def test_no_display_changes_unlit_colours(tmp_path: Path) -> None:
    scene = promin.Scene()
    scene.add_box((-1, 0, 0), material=scene.add_material(promin.MetallicRoughness(metallic=0)))
    scene.add_box((1, 0, 0), material=scene.add_material(promin.Unlit(color=(0.5, 0.25, 0.02))))
    camera = promin.Camera.look_at((0, 0, 6), (0, 0, 0), yfov=0.6)
    behind = "linear:0.2,0.2,0.2"
    frame = promin.Renderer(scene, background=behind).render(camera=camera, size=(60, 30), spp=1)
    assert not frame.aovs and frame.unlit is not None
    row, column = 15, int(np.argmax(frame.unlit[15, :, 3]))
    assert (frame.unlit[row, column] == np.float32((0.5, 0.25, 0.02, 1))).all()
    codes = (188, 137, 39)
    for display in (None, promin.Display(exposure_ev=3, tone_mapping="aces"), promin.Display(exposure_ev=-2)):
        assert tuple(frame.srgb(display)[row, column]) == codes
        frame.save(tmp_path / "frame.png", display)
        saved = promin.read_image(tmp_path / "frame.png")
        assert (saved[row, column] * 255 == np.float32(codes)).all()
    brighter = frame.srgb(promin.Display(exposure_ev=3)).astype(int) - frame.srgb(promin.Display())
    assert (brighter[frame.unlit[..., 3] == 0] >= 0).all() and (brighter[frame.unlit[..., 3] == 0] > 20).any()
    plain = promin.Scene()
    plain.add_box()
    assert promin.Renderer(plain, background=behind).render(size=(8, 8)).unlit is None
    assert promin.Renderer(plain).render(size=(8, 8)).unlit[0, 0, 3] == 1, "the backdrop is shown as it is"


def test_updates_are_whole_or_none() -> None:
    scene = promin.Scene()
    scene.add_triangles(*make_box((1e6, 0, 0)))
    scene.add_light(promin.Light(position=(1e6 + 0.1, 9, 9)))
    renderer = promin.Renderer(scene)
    view = promin.View(size=(32, 32))
    red = {"lights": [promin.Light(position=(1e6, 9, 9), diffuse=(1, 0, 0))]}
    white = {"materials": [promin.Unlit()]}
    blue = {"environment": promin.Environment(background=(0, 0, 1))}
    wrong = {"environment": promin.Environment(background=(0, 0, float("nan")))}
    for change in ({}, blue, red, white):
        renderer.update(**change)  # type: ignore[arg-type]
        before = renderer.render(view).rgb
        known = renderer.lights, renderer.materials, renderer.environment
        for attempt in (
            {**red, "materials": [promin.Phong(), promin.Phong()]},
            {"lights": [], "materials": [promin.Unlit(color=(0, 1, 0))], **wrong},
        ):
            with pytest.raises(promin.InputError):
                renderer.update(**attempt)  # type: ignore[arg-type]
            assert (renderer.render(view).rgb == before).all()
            assert (renderer.lights, renderer.materials, renderer.environment) == known


def test_what_a_renderer_tells_is_a_copy(box: promin.Scene) -> None:
    renderer = promin.Renderer(box)
    for _ in range(2):
        renderer.lights.clear()
        renderer.materials.clear()
        assert renderer.lights and renderer.materials
        renderer.update(lights=renderer.lights, materials=renderer.materials)


@pytest.mark.parametrize(
    "view, sentence",
    [
        (promin.View(min_spp=8), "min_spp needs a target error; give target_error as well"),
        (promin.View(max_spp=8), "max_spp needs a target error; give target_error as well"),
        (promin.View(spp=2, target_error=0.5), "target_error and spp=2 contradict each other"),
        (promin.View(error_in="display"), "error_in needs a target error; give target_error as well"),
        (promin.View(target_error=0.5, error_in="log"), 'error_in is \'log\'; give "linear" or "display"'),
        (promin.View(spp=2, time_limit=0.5), "time_limit and spp=2 contradict each other"),
    ],
)
def test_samples_that_contradict_each_other(box: promin.Scene, view: promin.View, sentence: str) -> None:
    renderer = promin.Renderer(box)
    with pytest.raises(promin.UsageError, match=sentence):
        renderer.render(view, size=(4, 4))
    assert renderer.render(size=(4, 4), spp=1, target_error=0.5).error


def test_few_expected_samples_take_other_kernels_and_give_the_same_bits(box: promin.Scene, tmp_path: Path) -> None:
    few = promin.Renderer(box, expected_samples=np.uint32(1000)).render(size=(24, 16))
    assert (few.rgb == promin.Renderer(box).render(size=(24, 16)).rgb).all()
    for wrong in (-1, 1.5, 2**64, "many"):
        with pytest.raises(promin.UsageError, match="expected_samples is .*; give a whole number of 0 or more"):
            promin.Renderer(box, expected_samples=wrong)  # type: ignore[arg-type]
    # Each test process gets a folder of its own for the driver's cache of compiled kernels.
    code = """if True:
        import sys, promin
        scene = promin.Scene()
        scene.add_sphere((0, 0, 0), radius=1)
        promin.Renderer(scene, expected_samples=eval(sys.argv[1]))
    """
    environment = {**os.environ, "MESA_SHADER_CACHE_DIR": str(tmp_path), "MESA_DISK_CACHE_MULTI_FILE": "true"}

    def count_kernels(expected_samples: str) -> int:
        words = [sys.executable, "-c", code, expected_samples]
        subprocess.run(words, env=environment, check=True, timeout=300)
        return sum(file.is_file() for file in tmp_path.rglob("*"))

    kernels = [count_kernels(samples) for samples in ("2**30", "None", "1000", "1000")]
    if kernels[0] == 0:
        pytest.skip("the driver is not Mesa's")
    assert kernels[0] == kernels[1] < kernels[2] == kernels[3]


def test_updates_change_pictures_and_are_kept(box: promin.Scene) -> None:
    renderer = promin.Renderer(box)
    view = promin.View(size=(32, 32))
    first = renderer.render(view)
    nodes = renderer.setup["nodes"]
    renderer.update(
        lights=[promin.Light(position=(0, 9, 9), diffuse=(1, 0, 0))],
        environment=promin.Environment(background=(0, 0, 1)),
    )
    red = renderer.render(view)
    assert (red.rgb[0, 0] == (0, 0, 1)).all() and red.rgb[16, 16, 1] == 0 < red.rgb[16, 16, 0]
    renderer.update(materials=[promin.Unlit(color=(0.25, 0.5, 0.75))])
    flat = renderer.render(view)
    assert flat.rgb[16, 16].tolist() == [0.25, 0.5, 0.75]
    assert renderer.setup["nodes"] == nodes and (first.rgb != red.rgb).any()
    again = pickle.loads(pickle.dumps(renderer))
    assert (again.render(view).rgb == flat.rgb).all()
    with pytest.raises(promin.InputError):
        renderer.update(materials=[promin.Phong(), promin.Phong()])
    with pytest.raises(promin.InputError):
        renderer.update(lights=[promin.Light(kind="spot", inner_cone_angle=2.0)])
    assert (renderer.render(view).rgb == flat.rgb).all()


def test_skies_and_light_choices(box: promin.Scene) -> None:
    view = promin.View(size=(16, 16))
    pictures = {light: promin.Renderer(box, light=light).render(view).rgb for light in ("studio", "headlight", "none")}
    assert pictures["none"][8, 8].max() == 0 < pictures["headlight"][8, 8].max()
    assert (pictures["studio"] != pictures["headlight"]).any()
    with fails(promin.UsageError, "python.name.unknown", "sun"):
        promin.Renderer(box, light="sun")
    for sky in (
        promin.GradientSky(top=(0, 1, 0)),
        promin.Panorama(np.full((4, 8, 3), 0.5, np.float32)),
        promin.Studio(),
    ):
        box.environment = promin.Environment(sky=sky, shows_sky=True)
        renderer = promin.Renderer(box)
        assert renderer.render(view).rgb[0, 0].max() > 0
        assert type(renderer.environment.sky) is type(sky)


def test_records_have_the_fields_of_the_library(scenes: Path) -> None:
    scene = promin.Scene.load(scenes / "showcase.gltf")
    for records in (scene.lights, scene.materials, scene.cameras, [scene.environment]):
        assert records
        for record in records:
            assert dataclasses.is_dataclass(record)
    twin = promin.Renderer(scene)
    view = promin.View(size=(32, 18))
    first = twin.render(view)
    twin.update(lights=twin.lights, materials=twin.materials, environment=twin.environment)
    assert (twin.render(view).rgb == first.rgb).all()


def test_no_time_gives_the_first_picture_alone(box: promin.Scene) -> None:
    renderer = promin.Renderer(box)
    frame = renderer.render(size=(8, 8), time_limit=1e-9)
    assert frame.error is None and frame.metadata["promin:spp"] == "1"
    assert (renderer.render(size=(8, 8), spp=1).rgb == frame.rgb).all()
    with fails(promin.UsageError, "spec.member.value", "time_limit", "soon"):
        renderer.render(size=(8, 8), time_limit="soon")  # type: ignore[arg-type]


def test_a_camera_may_ask_for_a_size(box: promin.Scene) -> None:
    renderer = promin.Renderer(box, view=promin.View(debug_view="uv"))
    for options, size in (({"resolution": (24, 16)}, (24, 16)), ({"aspect_ratio": 0.0125}, (9, 720))):
        camera = dataclasses.replace(renderer.camera(), **options)
        assert renderer.render(camera=camera).size == size
        assert renderer.render(camera=camera, size=(8, 8)).size == (8, 8)
    with pytest.raises(promin.UsageError, match="aspect_ratio of 1000000.0 is too extreme .*; give size"):
        renderer.render(camera=promin.Camera(aspect_ratio=1e6))


def test_unknown_names_are_refused(box: promin.Scene) -> None:
    renderer = promin.Renderer(box)
    for options in (
        {"aovs": ("deep",)},
        {"filter": "sinc"},
        {"camera": "none"},
        {"size": (0, 4)},
        {"crop": (1, 2, 3)},
        {"spp": 0},
    ):
        with pytest.raises(promin.UsageError):
            renderer.render(**{"size": (8, 8), **options})  # type: ignore[arg-type]
    assert renderer.render(size=(8, 8)).rgb.shape == (8, 8, 3)
