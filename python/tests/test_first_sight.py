# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""The first calls of a new user: a picture in one line, the words of the programs, materials by name, and advice after
mistakes."""

from __future__ import annotations

import base64
import dataclasses
import json
import pickle
import re
from pathlib import Path
from typing import Any, Callable

import numpy as np
import pytest
from conftest import fails, make_box

import promin
from promin import _renderer, _view


def test_one_line_makes_the_picture_of_promin_render(
    scenes: Path, tmp_path: Path, run_promin: Callable[..., None]
) -> None:
    promin.render(scenes / "box.gltf", size="96x64", from_="left").save(tmp_path / "ours.png")
    run_promin("render", scenes / "box.gltf", "-o", tmp_path / "theirs.png", "--size", "96x64", "--from", "left")
    assert (tmp_path / "ours.png").read_bytes() == (tmp_path / "theirs.png").read_bytes()
    promin.render(promin.Scene.load(scenes / "box.gltf"), size=48, quality="draft").save(tmp_path / "ours.jpg")
    words = ["-o", tmp_path / "theirs.jpg", "--size", 48, "--quality", "draft"]
    run_promin("render", scenes / "box.gltf", *words)
    assert (tmp_path / "ours.jpg").read_bytes() == (tmp_path / "theirs.jpg").read_bytes()


def test_a_background_is_that_of_promin_render(
    box: promin.Scene, scenes: Path, tmp_path: Path, run_promin: Callable[..., None]
) -> None:
    for background, words in (((0.5, 0.25, 1), [0.5, 0.25, 1]), ("environment", ["environment"])):
        promin.render(scenes / "box.gltf", size="32x24", background=background).save(tmp_path / "ours.png")
        out = tmp_path / "theirs.png"
        run_promin("render", scenes / "box.gltf", "-o", out, "--size", "32x24", "--background", *words)
        assert (tmp_path / "ours.png").read_bytes() == out.read_bytes()
    with pytest.raises(promin.UsageError, match="background .*environment"):
        promin.render(box, size=8, background="enviroment")
    with pytest.raises(promin.UsageError, match="^background is 5; give three numbers"):
        promin.render(box, size=8, background=5)  # type: ignore[arg-type]
    with pytest.raises(promin.UsageError, match="contradict each other"):
        promin.render(box, size=8, background=(1, 1, 1), aovs=("alpha",))


def test_an_exposure_is_that_of_promin_render(
    scenes: Path, tmp_path: Path, run_promin: Callable[..., None]
) -> None:
    picture = promin.render(scenes / "box.gltf", size="32x24", exposure=1.5)
    picture.save(tmp_path / "ours.png")
    words = ["-o", tmp_path / "theirs.png", "--size", "32x24", "--exposure", 1.5]
    run_promin("render", scenes / "box.gltf", *words)
    assert (tmp_path / "ours.png").read_bytes() == (tmp_path / "theirs.png").read_bytes()
    assert picture.display.exposure_ev == 1.5
    for wrong in ("bright", 65, float("nan"), None):
        with pytest.raises(promin.UsageError, match='^exposure is .*; give stops from -64 to 64, or "auto"'):
            promin.render(scenes / "box.gltf", size=8, exposure=wrong)  # type: ignore[arg-type]


@pytest.fixture(scope="module")
def scene_with_cameras(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Returns a scene with a triangle, a bar below it, and two cameras: a perspective camera with an aspect ratio of 2
    and an orthographic one."""
    triangles = np.array([[0, 0, 0], [2, 0, 0], [0, 1, 0], [-1, -2, -3], [3, -2, -3], [0, -1, 0]], np.float32)
    data = base64.b64encode(triangles.tobytes()).decode()
    accessor = {"bufferView": 0, "componentType": 5126, "count": 6, "type": "VEC3"}
    bounds = {"min": triangles.min(axis=0).tolist(), "max": triangles.max(axis=0).tolist()}
    gltf = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0, 1, 2]}],
        "nodes": [{"mesh": 0}, {"camera": 0, "translation": [0.5, 0, 6]}, {"camera": 1, "translation": [0, 0, 9]}],
        "cameras": [
            {"type": "perspective", "perspective": {"yfov": 0.6, "aspectRatio": 2, "znear": 0.1}, "name": "wide"},
            {"type": "orthographic", "orthographic": {"xmag": 4, "ymag": 3, "znear": 0.1, "zfar": 99}, "name": "flat"},
        ],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{**accessor, **bounds}],
        "bufferViews": [{"buffer": 0, "byteLength": 72}],
        "buffers": [{"byteLength": 72, "uri": f"data:application/octet-stream;base64,{data}"}],
    }
    file = tmp_path_factory.mktemp("cameras") / "cameras.gltf"
    file.write_text(json.dumps(gltf))
    return file


@pytest.fixture(scope="module")
def sky(tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = tmp_path_factory.mktemp("sky") / "sky.hdr"
    promin.write_image(file, np.random.default_rng(2).random((8, 16, 3)))
    return file


def as_options(keywords: dict[str, Any]) -> list[object]:
    """Returns the words of the same options for `promin render`."""
    words: list[object] = []
    for name, value in keywords.items():
        words.append("--" + name.rstrip("_").replace("_", "-"))
        words += value if isinstance(value, tuple) else [value]
    return words


@pytest.mark.parametrize(
    "scene, keywords",
    [
        ("ply_faces.ply", {"azimuth": 40, "elevation": -15.5, "roll": 7, "zoom": 1.3, "fit": 0.6}),
        ("box.gltf", {"eye": (3, 2, 5), "look_at": (0, 0.25, 0), "fov": 33, "near": 4}),
        ("box.gltf", {"from_": "back", "up": "-x", "environment": "sky", "environment_rotation": 70}),
        ("cameras", {"azimuth": -30, "environment": "sky", "environment_intensity": 0.5, "light_rotation": 9}),
        ("cameras", {"camera": "flat", "direction": (0.1, -0.2, -1), "up": (1, 0, 0)}),
        ("cameras", {"from_": "top", "size": "48x40"}),
        ("cameras", {}),
    ],
)
def test_a_pose_is_that_of_promin_render(
    scene: str,
    keywords: dict[str, Any],
    scenes: Path,
    scene_with_cameras: Path,
    sky: Path,
    tmp_path: Path,
    run_promin: Callable[..., None],
) -> None:
    file = scene_with_cameras if scene == "cameras" else scenes / scene
    whole = {"size": "40x48", "quality": "draft", **keywords}
    if "environment" in whole:
        whole["environment"] = sky
    promin.render(file, **whole).save(tmp_path / "ours.png")
    run_promin("render", file, "-o", tmp_path / "theirs.png", *as_options(whole))
    assert (tmp_path / "ours.png").read_bytes() == (tmp_path / "theirs.png").read_bytes()


@pytest.mark.parametrize(
    "keywords, said",
    [
        (
            {"look_at": (0, 0, 0), "direction": (0, 0, 1)},
            "look_at and direction contradict each other; remove one of them",
        ),
        ({"from_": "left", "camera": "wide"}, "from_ and camera contradict each other; remove one of them"),
        ({"fit": 0.5, "camera": "wide"}, "fit and camera contradict each other; remove one of them"),
        ({"from_": "lfet"}, "from_ takes three-quarter, front, .*, not .lfet"),
        ({"azimuth": "left"}, "azimuth takes a number from -3600 to 3600, not .left"),
        ({"azimuth": (1, 2, 3)}, r"azimuth is \(1, 2, 3\); give a number"),
        ({"eye": (1, 2)}, r"eye is \(1, 2\); give three numbers"),
        ({"up": 3}, 'up is 3; give three numbers or a word as "z"'),
        ({"zoom": float("nan")}, "zoom takes a number"),
        ({"direction": (0, 0, 1), "up": "z"}, "the camera's direction of view and its up direction are zero, not finite or parallel"),
        ({"camera": "none"}, r"the scene has no camera .none.; choose one of: 0 \(wide\), 1 \(flat\)"),
        ({"environment": 3}, "environment is 3; give a panorama's file"),
        ({"environment_rotation": "up"}, "environment_rotation takes a number"),
    ],
)
def test_poses_that_cannot_be_are_refused_with_keywords(
    keywords: dict[str, Any], said: str, scene_with_cameras: Path
) -> None:
    with pytest.raises(promin.UsageError, match="^" + said) as refused:
        promin.render(scene_with_cameras, size=8, **keywords)
    assert "--" not in str(refused.value) and "command line" not in str(refused.value)


def test_what_is_given_takes_the_place_of_what_contradicts_it(scene_with_cameras: Path) -> None:
    view = promin.View(camera="flat", azimuth=10, fov=20)
    assert _view.change_view(view, {"camera": 0}) == promin.View(camera=0)
    assert _view.change_view(view, {"from_": "left"}) == promin.View(from_="left", azimuth=10, fov=20)
    looks = promin.View(eye=(1, 2, 3), look_at=(0, 0, 0))
    assert _view.change_view(looks, {"direction": (1, 0, 0)}) == promin.View(eye=(1, 2, 3), direction=(1, 0, 0))
    assert _view.change_view(looks, {"from_": "top"}) == promin.View(from_="top")
    renderer = promin.Renderer(scene_with_cameras, view=promin.View(size=(32, 16), spp=1, azimuth=25, zoom=2))
    camera = renderer.camera()
    assert (renderer.render(camera=camera).rgb == renderer.render().rgb).all(), "it is not turned twice"
    assert camera != renderer.camera("wide")


def test_a_camera_of_ones_own_is_posed_too(box: promin.Scene) -> None:
    moved = promin.Scene()
    moved.add_triangles(*make_box((1e6, 0, 0)))
    frames = []
    for scene, offset in ((box, 0.0), (moved, 1e6)):
        camera = promin.Camera.look_at((offset + 2, 1, 6), (offset, 0, 0))
        pose = {"azimuth": 30, "look_at": (offset, 0.5, 0), "zoom": 1.5}
        frames.append(promin.render(scene, camera=camera, size=(24, 18), spp=1, debug_view="normals", **pose).rgb)
        eye = {"eye": (offset + 2, 1, 6), "direction": (-2, -1, -6)}
        frames.append(promin.render(scene, size=(24, 18), spp=1, debug_view="normals", **eye).rgb)
    assert (frames[0] == frames[2]).all() and (frames[1] == frames[3]).all() and (frames[0] != frames[1]).any()


def test_a_picture_of_nothing_warns(box: promin.Scene) -> None:
    with pytest.warns(UserWarning, match="the picture shows nothing of the scene; look_at 0 0 0 .* from_ three-qu"):
        promin.render(box, eye=(0, 0, 9), direction=(0, 0, 1), size=8, spp=1)


@pytest.mark.parametrize(
    "size, sides",
    [("hd", (1280, 720)), ("640", (640, 0)), ("x480", (0, 480)), (640, (640, 0)), ((64, 48), (64, 48)), (None, (0, 0))],
)
def test_sizes_are_those_of_the_command_line(size: Any, sides: tuple[int, int]) -> None:
    assert tuple(_view.size_of(promin.View(size=size))) == sides


def test_qualities_are_those_of_the_command_line() -> None:
    def numbers(view: promin.View) -> tuple[Any, ...]:
        whole = _view.settle_quality(view)
        return whole.spp, whole.target_error, whole.error_in

    assert numbers(promin.View()) == numbers(promin.View(quality="normal")) == (8, None, "linear")
    for integrator in ("direct", "path"):
        assert numbers(promin.View(integrator=integrator)) == (32, None, "linear")
        assert numbers(promin.View(integrator=integrator, quality="draft")) == (4, None, "linear")
        assert numbers(promin.View(integrator=integrator, debug_view="uv")) == (8, None, "linear")
        assert numbers(promin.View(integrator=integrator, spp=3)) == (3, None, "linear")
    assert numbers(promin.View(quality="draft")) == (1, None, "linear")
    assert numbers(promin.View(quality="best"))[1:] == (1 / 256, "display")
    assert numbers(promin.View(quality="best", debug_view="uv")) == (128, None, "linear")
    best = promin.View(quality="best")
    assert numbers(_view.change_view(best, {"spp": 3})) == (3, None, "linear")
    assert numbers(_view.change_view(promin.View(target_error=0.5), {"quality": "draft"})) == (1, None, "linear")
    for wrong, said in (("hihh", "did you mean high"), ("", "quality takes")):
        with pytest.raises(promin.UsageError, match=said):
            _view.settle_quality(promin.View(quality=wrong))
    with pytest.raises(promin.UsageError, match="quality and spp contradict each other"):
        _view.settle_quality(promin.View(quality="best", spp=2))
    assert _view.limit_of(promin.View(time_limit="2min")) == 120.0


def test_rays_have_many_forms(box_caster: promin.Caster) -> None:
    origins = np.random.default_rng(5).normal(size=(50, 3))
    along = (0.0, 0.1, -1.0)
    whole = np.concatenate([origins, np.zeros((50, 1)), np.broadcast_to(along, (50, 3)), np.full((50, 1), 2.0)], axis=1)
    expected = box_caster.cast(whole)
    for rays in (
        box_caster.cast(origins, along, tmax=2.0),
        box_caster.cast(origins, along, 0, np.full(50, 2.0)),
        box_caster.cast((origins, along), tmax=2.0),
        box_caster.cast((origins, along, 0.0, 2.0)),
    ):
        assert (rays == expected).all()
    assert (box_caster.count(origins, along) == box_caster.count((origins, along))).all()
    assert (box_caster.occluded((0, 0, 0), origins) == box_caster.occluded(((0, 0, 0), origins))).all()
    assert (box_caster.list(origins, along)[0] == box_caster.list((origins, along))[0]).all()
    assert sum(len(hits) for _, _, hits in box_caster.iter_list(origins, along)) == len(box_caster.list(origins, along)[1])
    for wrong in (origins, (0, 0, 1), np.float32(origins)):
        with pytest.raises(promin.UsageError, match=r"points without directions; .* cast\(origins, directions\)"):
            box_caster.cast(wrong)
    with pytest.raises(promin.UsageError, match="tmin and tmax need origins and directions"):
        box_caster.cast(whole, tmax=1)


def test_materials_and_lights_are_changed_by_name(scenes: Path) -> None:
    scene = promin.Scene.load(scenes / "metallic_roughness.gltf")
    name = next(m.name for m in scene.materials if isinstance(m, promin.MetallicRoughness) and m.name)
    place = [m.name for m in scene.materials].index(name)
    others = [m for m in scene.materials if m.name != name]
    before = promin.render(scene, size="32x18", quality="draft")
    renderer = promin.Renderer(scene)
    for target in (scene, renderer):
        target.set_material(name, base_color=(1, 0, 0), base_color_texture=None)
        changed = target.materials[place]
        assert isinstance(changed, promin.MetallicRoughness) and changed.base_color == (1, 0, 0)
    assert [m for m in scene.materials if m.name != name] == others
    frames = [promin.render(scene, size="32x18", quality="draft"), renderer.render(size="32x18", quality="draft")]
    assert (frames[0].rgb == frames[1].rgb).all() and (frames[0].rgb != before.rgb).any()
    twin = pickle.loads(pickle.dumps(scene))
    assert twin.materials == scene.materials and twin.add_material(promin.Phong()) == len(scene.materials)
    scene.set_material(place, promin.Phong(name="clay"))
    assert isinstance(scene.materials[place], promin.Phong)
    with pytest.raises(promin.UsageError, match=f"no material '{name}'"):
        scene.set_material(name, ior=2)
    with pytest.raises(promin.UsageError, match="a Phong has no field 'base_color'"):
        scene.set_material("clay", base_color=(1, 1, 1))
    with pytest.raises(dataclasses.FrozenInstanceError, match="scene.set_material"):
        scene.materials[place].ior = 3  # type: ignore[attr-defined]


def test_lights_are_changed_and_replaced(box: promin.Scene) -> None:
    box.add_light(promin.Light(name="key", position=(4, 5, 6)))
    box.set_light("key", diffuse=(0, 1, 0))
    box.set_light(0, specular=(0, 0, 0))
    assert box.lights == [promin.Light(name="key", position=(4, 5, 6), diffuse=(0, 1, 0), specular=(0, 0, 0))]
    green = promin.render(box, size="16x12", quality="draft").rgb
    assert (green[..., 1] > green[..., 0]).any()
    box.lights = []
    assert box.lights == [] and box.add_light(promin.Light()) == 0
    box.materials = [promin.Unlit(color=(1, 0, 0)), promin.Unlit()]
    with pytest.raises(promin.UsageError, match=r"2 materials are named ''; give the number of one: \[0, 1\]"):
        box.set_material("", alpha=0.5)


@pytest.mark.parametrize(
    "fields",
    [{"base_color": "blue"}, {"base_color": (1, 0)}, {"roughness": "rough"}, {"alpha_mode": "glass"}, {"name": 3}],
)
def test_a_wrong_value_of_a_material_is_refused_at_once(fields: dict[str, Any]) -> None:
    scene = promin.Scene()
    scene.add_sphere(material=scene.add_material(promin.MetallicRoughness(name="clay")))
    before = scene.materials
    with pytest.raises(promin.UsageError, match=next(iter(fields)).split("_")[0]):
        scene.set_material("clay", **fields)
    with pytest.raises(promin.UsageError):
        scene.add_material(promin.MetallicRoughness(**{"name": "other", **fields}))
    with pytest.raises(promin.UsageError):
        scene.materials = [promin.MetallicRoughness(**fields)]
    assert scene.materials == before
    scene.validate()


def test_wrong_values_of_lights_cameras_and_surroundings_are_refused_at_once(box: promin.Scene) -> None:
    box.add_light(promin.Light(name="key"))
    for wrong in ({"kind": "lamp"}, {"diffuse": "white"}, {"position": (1, 2)}, {"is_on": "yes"}):
        with pytest.raises(promin.UsageError, match=next(iter(wrong))):
            box.set_light("key", **wrong)
        with pytest.raises(promin.UsageError):
            box.add_light(promin.Light(**wrong))  # type: ignore[arg-type]
        with pytest.raises(promin.UsageError):
            box.lights = [promin.Light(**wrong)]  # type: ignore[arg-type]
    with pytest.raises(promin.UsageError, match="yfov"):
        box.add_camera(promin.Camera(yfov="wide"))  # type: ignore[arg-type]
    with pytest.raises(promin.UsageError, match="ambient"):
        box.environment = promin.Environment(ambient="dark")  # type: ignore[arg-type]
    assert box.lights == [promin.Light(name="key")] and box.cameras == []
    assert box.environment == promin.Environment()
    box.validate()


def test_things_show_themselves_in_a_line(box: promin.Scene, box_caster: promin.Caster, scenes: Path) -> None:
    assert repr(box) == "<promin.Scene: 1 object, 12 primitives, 1 material, 0 lights, 0 cameras>"
    assert repr(promin.Scene.load(scenes / "box.gltf")).startswith("<promin.Scene box.gltf: ")
    frame = promin.render(box, size="16x12", quality="draft", aovs=("depth",))
    assert re.fullmatch(r"<promin.Frame 16x12, aovs depth, [0-9.]+ s of tracing>", repr(frame))
    hits = box_caster.cast((0, 0, 5), [(0, 0, -1), (0, 1, 0)])
    assert repr(hits) == str(hits) == "<promin.Hits (2,): 1 of 2 rays hit, t from 4 to 4>"
    assert type(hits["t"]) is np.ndarray and isinstance(hits[:1], promin.Hits) and hits.dtype == promin.HIT_DTYPE
    assert type(pickle.loads(pickle.dumps(hits))) is promin.Hits


@pytest.mark.parametrize(
    "keywords, cure",
    [
        ({"samples": 4}, "did you mean spp?"),
        ({"resolution": 64}, "did you mean size?"),
        ({"framing": "left"}, "did you mean from_?"),
        ({"backgrund": "environment"}, "did you mean background?"),
        ({"shading": "uv"}, "did you mean debug_view?"),
        ({"look": (0, 0, 0)}, "a point to look at is look_at, a direction of view is direction"),
        ({"azimut": 45}, "did you mean azimuth?"),
        ({"transparent": True}, 'give aovs=("alpha",)'),
        ({"variant": "red"}, "promin.Scene.load(file, ...) has it"),
    ],
)
def test_unknown_keywords_are_told_with_the_one_that_is_meant(
    box: promin.Scene, keywords: dict[str, Any], cure: str
) -> None:
    with pytest.raises(TypeError, match=re.escape(f"render() has no keyword '{next(iter(keywords))}'; {cure}")):
        promin.render(box, **keywords)


def test_a_renderer_tells_where_fields_of_a_view_go(box: promin.Scene) -> None:
    with pytest.raises(TypeError, match=re.escape("Renderer() has no keyword 'size'; give it to render, or in view=")):
        promin.Renderer(box, size=64)  # type: ignore[call-arg]


def test_files_stand_for_scenes(scenes: Path) -> None:
    bounds = promin.Scene.load(scenes / "sphere.gltf").bounds
    assert bounds is not None
    hits = promin.Caster(scenes / "sphere.gltf").cast(bounds.mean(axis=0), [(0, 0, -1), (0, 1, 0)])
    assert (hits["object"] >= 0).all()
    with pytest.raises(promin.UsageError, match="is not a promin.Scene"):
        promin.Renderer(3)  # type: ignore[arg-type]
    with fails(promin.InputError, "file.missing"):
        promin.render("none.glb")
    assert _renderer._count_samples(promin.View(size="100x50")) == 100 * 50 * 8
