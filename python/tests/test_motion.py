# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Tests of animations and poses."""

from __future__ import annotations

import base64
import dataclasses
import json
import pickle
from pathlib import Path

import numpy as np
import pytest

import promin


@pytest.fixture(scope="module")
def moving_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Returns a file with a triangle that moves along +X in two seconds, and grows in another animation."""
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], "<f4")
    times = np.array([0, 2], "<f4")
    places = np.array([[0, 0, 0], [4, 0, 0]], "<f4")
    scales = np.array([[1, 1, 1], [3, 3, 3]], "<f4")
    document: dict[str, object] = {"asset": {"version": "2.0"}, "bufferViews": [], "accessors": []}
    data = b""
    for array, kind in ((corners, "VEC3"), (times, "SCALAR"), (places, "VEC3"), (scales, "VEC3")):
        views, accessors = document["bufferViews"], document["accessors"]
        assert isinstance(views, list) and isinstance(accessors, list)
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": array.nbytes})
        accessors.append({"bufferView": len(views) - 1, "componentType": 5126, "count": len(array), "type": kind})
        data += array.tobytes()
    uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    document["buffers"] = [{"byteLength": len(data), "uri": uri}]
    document["meshes"] = [{"primitives": [{"attributes": {"POSITION": 0}}]}]
    document["nodes"] = [{"mesh": 0}]

    def clip(name: str, path: str, output: int) -> dict[str, object]:
        channels = [{"sampler": 0, "target": {"node": 0, "path": path}}]
        return {"name": name, "channels": channels, "samplers": [{"input": 1, "output": output}]}

    document["animations"] = [clip("walk", "translation", 2), clip("grow", "scale", 3)]
    file = tmp_path_factory.mktemp("motion") / "moving.gltf"
    file.write_text(json.dumps(document))
    return file


def bounds_of(scene: promin.Scene) -> list[list[float]]:
    box = scene.bounds
    assert box is not None
    found: list[list[float]] = box.tolist()
    return found


def test_a_scene_lists_its_animations(moving_file: Path) -> None:
    walk, grow = promin.Scene.load(moving_file).animations
    assert (walk.name, walk.duration, walk.channels) == ("walk", 2.0, {"translation": 1})
    assert (grow.name, grow.channels) == ("grow", {"scale": 1})
    assert promin.Scene().animations == []


def test_a_scene_has_the_pose_of_a_time(moving_file: Path) -> None:
    scene = promin.Scene.load(moving_file)
    assert bounds_of(scene.at(1.0)) == [[2, 0, 0], [3, 1, 0]]
    assert bounds_of(scene.at(9.0)) == [[4, 0, 0], [5, 1, 0]]
    assert bounds_of(scene.at(9.0, loop=True)) == [[2, 0, 0], [3, 1, 0]]
    assert bounds_of(scene.at(1.0, "grow")) == [[0, 0, 0], [2, 2, 0]]
    assert bounds_of(scene.at(1.0, ["walk", 1])) == [[2, 0, 0], [4, 2, 0]]
    assert bounds_of(scene.at(1.0, "all")) == [[2, 0, 0], [4, 2, 0]]
    assert bounds_of(scene.at(1.0, None)) == [[0, 0, 0], [1, 1, 0]]
    assert bounds_of(scene) == [[0, 0, 0], [1, 1, 0]], "the scene itself does not move"
    assert bounds_of(scene.at(1.0).at(2.0)) == [[4, 0, 0], [5, 1, 0]], "an earlier pose has no effect"


def test_a_pose_keeps_additions_and_can_be_pickled(moving_file: Path) -> None:
    scene = promin.Scene.load(moving_file)
    scene.add_sphere(center=(0, 0, 9), radius=1)
    scene.set_material(0, name="mine")
    posed = scene.at(1.0)
    assert np.allclose(bounds_of(posed), [[-1, -1, 0], [3, 1, 10]], atol=1e-5)
    assert posed.materials[0].name == "mine"
    assert [each.primitive_count for each in posed.objects] == [1, 1]
    assert bounds_of(pickle.loads(pickle.dumps(posed))) == bounds_of(posed)


def test_what_does_not_exist_is_refused(moving_file: Path) -> None:
    scene = promin.Scene.load(moving_file)
    with pytest.raises(promin.UsageError, match='no animation "run"') as caught:
        scene.at(1.0, "run")
    assert caught.value.problems[0].code == "animation.unknown"
    with pytest.raises(promin.UsageError, match="no animation"):
        scene.at(1.0, 2)
    with pytest.raises(promin.UsageError, match="give the name or number"):
        scene.at(1.0, 1.5)  # type: ignore[arg-type]
    with pytest.raises(promin.InputError, match="not finite"):
        scene.at(float("nan"))
    with pytest.raises(promin.UsageError, match="no file"):
        promin.Scene().at(1.0)


def test_updates_show_poses(moving_file: Path) -> None:
    scene = promin.Scene.load(moving_file)
    scene.add_sphere((0, 0, -3), 1)
    view = promin.View(size=(24, 24), camera=promin.Camera(eye=(1, 0, 9)))
    rays = np.zeros((50, 8))
    rays[:, 0], rays[:, 1], rays[:, 2] = np.linspace(-1, 6, 50), 0.2, 5
    rays[:, 6], rays[:, 7] = -1, np.inf
    caster = promin.Caster(scene)
    renderer = promin.Renderer(scene, light="headlight")
    choices: list[tuple[float, str | int]] = [(1.0, 0), (1.5, "walk"), (2.0, "grow")]
    for time, animation in choices:
        caster.update(time=time, animation=animation)
        renderer.update(time=time, animation=animation)
        posed = scene.at(time, animation)
        assert (caster.cast(rays) == promin.Caster(posed).cast(rays)).all()
        fresh = promin.Renderer(posed, light="headlight").render(view)
        assert (renderer.render(view).rgb == fresh.rgb).all()
    # A moved object and replaced lights do not move with poses.
    lamp = promin.Light(position=(0, 9, 9), diffuse=(1, 0, 0))
    transform = np.eye(4)
    transform[1, 3] = 0.1
    renderer.update(transforms={0: transform}, lights=[lamp])
    rested = renderer.render(view)
    renderer.update(time=0.5)
    assert (renderer.render(view).rgb == rested.rgb).all()
    assert (pickle.loads(pickle.dumps(renderer)).render(view).rgb == rested.rgb).all()
    with pytest.raises(promin.UsageError):
        renderer.update(time=0.5, animation="fly")
    with pytest.raises(promin.UsageError):
        promin.Caster(promin.Scene()).update(time=1.0)
    assert (renderer.render(view).rgb == rested.rgb).all()


def test_the_movement_until_the_next_frame_is_an_aov(moving_file: Path) -> None:
    scene = promin.Scene.load(moving_file)
    # The picture has 16 pixels, which are 4 units of length. In half a second, the triangle moves along +X by 1 unit.
    camera = promin.Camera(eye=(2, 0.5, 5), projection="orthographic", ymag=2.0)
    view = promin.View(camera=camera, size=(16, 16), spp=1)
    renderer = promin.Renderer(scene.at(1.0), aovs=("motion", "object"), view=view, light="none")
    frame = renderer.render(next_scene=scene.at(1.5))
    is_hit = frame.aovs["object"] == 0
    assert is_hit.any() and not is_hit.all()
    assert set(frame.aovs) == {"motion", "object"}
    assert frame.aovs["motion"].shape == (16, 16, 2)
    assert np.allclose(frame.aovs["motion"][is_hit], (4, 0), atol=1e-5)
    assert (frame.aovs["motion"][~is_hit] == 0).all()
    higher = dataclasses.replace(camera, eye=(2, 1, 5))
    frame = renderer.render(next_camera=higher)
    assert np.allclose(frame.aovs["motion"][is_hit], (0, -2), atol=1e-5)
    with pytest.raises(promin.UsageError, match="need each other"):
        renderer.render()
    with pytest.raises(promin.UsageError, match="need each other"):
        renderer.render(aovs=("depth",), next_camera=higher)
    other = promin.Scene()
    other.add_triangles(np.eye(3), [[0, 1, 2], [2, 1, 0]])
    with pytest.raises(promin.InputError, match="another scene"):
        renderer.render(next_scene=other)
