# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import pickle
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Callable

import numpy as np
import pytest
from conftest import fails, make_box, make_rays
from numpy.typing import NDArray
from peers import make_ball

import promin
from promin import _promin
from promin._arrays import pack_rays
from promin._caster import PROBE


@pytest.mark.parametrize("name", ["showcase.gltf", "obj_materials.obj", "all_primitives.gltf"])
def test_hits_of_a_file_are_those_of_promin_cast(
    name: str, scenes: Path, tmp_path: Path, run_promin: Callable[..., None]
) -> None:
    rays = make_rays(2000)
    np.save(tmp_path / "rays.npy", rays)
    caster = promin.Caster(promin.Scene.load(scenes / name))
    for words, is_any in (((), False), (("--any",), True)):
        run_promin("cast", scenes / name, tmp_path / "rays.npy", "-o", tmp_path / "hits.npy", *words)
        expected = np.load(tmp_path / "hits.npy")
        assert expected.dtype == promin.HIT_DTYPE
        if is_any:
            assert (caster.occluded(rays) == (expected["t"] == 0)).all()
        else:
            assert caster.cast(rays).tobytes() == expected.tobytes()


def test_hits_equal_those_of_the_program(tmp_path: Path, run_promin: Callable[..., None]) -> None:
    scene = tmp_path / "two.nff"
    scene.write_text(
        "v\nfrom 0 0 9\nat 0 0 0\nup 0 1 0\nangle 45\nhither 1\nresolution 32 32\nf 1 0 0 1 0 0 0 1\n"
        "s 0 0 0 1\ns 3 0 0 1\nf 0 1 0 1 0 0 0 1\ns 0 3 0 1\n"
    )
    rays = make_rays(500)
    np.save(tmp_path / "rays.npy", rays)
    run_promin("cast", scene, tmp_path / "rays.npy", "-o", tmp_path / "hits.npy")
    hits = promin.Caster(promin.Scene.load(scene)).cast(rays)
    assert set(hits["object"]) == {-1, 0, 1, 2}
    assert hits.tobytes() == np.load(tmp_path / "hits.npy").tobytes()


def test_all_forms_of_rays_give_the_same_hits(box_caster: promin.Caster) -> None:
    rays = make_rays(24)
    expected = box_caster.cast(rays)
    origins, directions = rays[:, 0:3], rays[:, 4:7]
    assert 0 < (expected["object"] >= 0).sum() < 24
    forms = [
        rays.astype(np.float64),
        rays.tolist(),
        np.asfortranarray(rays),
        np.repeat(rays, 2, axis=0)[::2],
        rays[::-1][::-1],
        (origins, directions),
        (origins, directions, 0, np.inf),
        (origins.tolist(), directions.astype(np.float64), np.zeros(24)),
    ]
    for form in forms:
        assert box_caster.cast(form).tobytes() == expected.tobytes()
    grid = box_caster.cast(rays.reshape(2, 3, 4, 8))
    assert grid.shape == (2, 3, 4) and grid.tobytes() == expected.tobytes()
    one = box_caster.cast(rays[3])
    assert one.shape == () and one.tobytes() == expected[3].tobytes()
    assert box_caster.cast(np.empty((0, 8))).shape == (0,)
    fan = box_caster.cast((np.zeros(3), rays[:, 4:7].reshape(4, 6, 3)))
    assert fan.shape == (4, 6) and (fan["object"] == 0).all()


@pytest.mark.parametrize("center", [(0.0, 0.0, 0.0), (1e5, -3.1, 0.7)])
@pytest.mark.parametrize("shape", [(), (0,), (7,), (2**15,), (2**15 + 1,), (3, 30011), (70001, 1), (2, 3, 20001)])
def test_many_rays_are_packed_by_all_cores_as_few_are_by_one(
    shape: tuple[int, ...], center: tuple[float, float, float]
) -> None:
    random = np.random.default_rng(4)
    rays = random.normal(size=(*shape, 16))[..., ::2] * 10.0 ** random.integers(-50, 50, size=(*shape, 8))
    taken = np.array(center)
    lines = rays.reshape(-1, 8)
    expected = np.empty(lines.shape, np.float32)
    with np.errstate(over="ignore"):
        for i in range(0, len(lines), 1000):
            some = lines[i : i + 1000].copy()
            some[:, :3] -= taken
            expected[i : i + 1000] = some
    packed, leading = pack_rays(rays, taken)
    assert leading == shape and packed.dtype == np.float32 and packed.tobytes() == expected.tobytes()
    parts = (rays[..., 0:3], rays[..., 4:7], rays[..., 3], rays[..., 7])
    assert pack_rays(parts, taken)[0].tobytes() == expected.tobytes()
    # All rays have the same origin and the same tmin.
    expected[:, :3], expected[:, 3], expected[:, 7] = np.subtract((1.5, 2.5, 1e9), taken), 0.25, np.inf
    assert pack_rays(((1.5, 2.5, 1e9), parts[1], 0.25), taken)[0].tobytes() == expected.tobytes()


def test_tmin_and_tmax_bound_hits(box_caster: promin.Caster) -> None:
    origin, direction = (0, 0, 5), (0, 0, -2)
    assert box_caster.cast((origin, direction))["t"] == 2.0
    assert box_caster.cast((origin, direction, 2.0))["t"] == 3.0
    assert np.isinf(box_caster.cast((origin, direction, 0, 2.0))["t"])
    assert box_caster.occluded((origin, direction, [0.0, 3.0], np.inf)).tolist() == [True, False]


def test_a_centre_keeps_what_float32_would_lose() -> None:
    center = np.array([6.4e6, -1.2e6, 3.3e6])
    vertices, faces = make_box(center, 1e-3)
    scene = promin.Scene()
    scene.add_triangles(vertices, faces)
    assert np.abs(scene.center - center).max() < 1e-3
    caster = promin.Caster(scene)
    rays = (center + [2e-4, 1e-4, 1.0], (0.0, 0.0, -1.0))
    hit = caster.cast(rays)
    assert hit["t"] == pytest.approx(1.0 - 5e-4, abs=1e-7)
    assert np.abs(scene.positions(rays, hit) - (center + [2e-4, 1e-4, 5e-4])).max() < 2e-9
    unmoved = promin.Scene(center=(0, 0, 0))
    unmoved.add_triangles(vertices, faces)
    assert promin.Caster(unmoved).cast(rays)["object"] == -1


def test_scenes_of_float32_and_around_the_origin_are_not_moved() -> None:
    far = promin.Scene()
    far.add_triangles(make_box((1e4, 0, 0))[0].astype(np.float32), make_box()[1])
    near = promin.Scene()
    near.add_triangles(*make_box((0.1, 0, 0)))
    assert not far.center.any() and not near.center.any()


def _write_obj(file: Path, vertices: NDArray[np.float64], faces: NDArray[np.int64]) -> Path:
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in vertices.tolist()] + ["f " + " ".join(map(str, f)) for f in faces + 1]
    file.write_text("\n".join(lines))
    return file


def test_a_file_far_from_the_origin_has_a_centre(tmp_path: Path) -> None:
    center = np.array([6.4e6, -1.2e6, 3.3e6])
    vertices, faces = make_box(center, 0.5)
    scene = promin.Scene.load(_write_obj(tmp_path / "far.obj", vertices, faces))
    assert np.abs(scene.center - center).max() < 0.5
    assert scene.bounds is not None and np.abs(scene.bounds - (center + [[-0.25], [0.25]])).max() < 1e-7
    # Objects that are added later use the same center.
    scene.add_sphere(center + [2.0, 0.0, 0.0], 0.25)
    scene.add_camera(promin.Camera(eye=tuple(center + [0.0, 0.0, 4.0])))
    assert scene.cameras[0].eye == tuple(center + [0.0, 0.0, 4.0])
    rays = (center + [[0.1, 0.05, 1.0], [2.0, 0.0, 1.0]], (0.0, 0.0, -1.0))
    hits = promin.Caster(pickle.loads(pickle.dumps(scene))).cast(rays)
    assert hits["object"].tolist() == [0, 1] and hits["t"] == pytest.approx(0.75, abs=1e-6)
    assert np.abs(scene.positions(rays, hits)[0] - (center + [0.1, 0.05, 0.25])).max() < 1e-6
    near = promin.Scene.load(_write_obj(tmp_path / "near.obj", *make_box((10.0, 0.0, 0.0), 0.5)))
    assert not near.center.any()


def test_a_transform_places_a_mesh_and_its_shapes() -> None:
    place = np.eye(4)
    place[:3, :3] = [[0, 0, 2], [2, 0, 0], [0, 2, 0]]
    place[:3, 3] = 1e5, 0, 7
    scene = promin.Scene()
    mesh = scene.add_triangles(*make_box((1, 0, 0)), transform=place)
    ball = scene.add_sphere((1e5, 0, 20), 1.5)
    hits = promin.Caster(scene).cast(([(1e5, 3, 0), (1e5, 0, 30)], [(0, 0, 1), (0, 0, -1)]))
    assert hits["object"].tolist() == [mesh, ball]
    assert hits["t"].tolist() == [5.0, 8.5]


def test_shapes_have_their_fields() -> None:
    scene = promin.Scene()
    scene.add_plane((0, -3, 0), (0, 2, 0))
    scene.add_sphere((0, 0, 0), 1)
    scene.add_box((4, 0, 0), (1, 2, 1))
    scene.add_cylinder((8, 0, 0), (1, 0, 0), 3, 0.5)
    scene.add_cone((16, 0, 0), (0, 1, 0), 2, 1, 0.5)
    scene.add_capsule((24, 0, 0), (0, 1, 0), 1, 0.5, 0.25)
    scene.add_cylinder((32, 0, 0), (0, 1, 0), 1, 1, is_open=True)
    places = [(x, 10, 0) for x in (40, 0, 4, 10, 16, 24, 32, 32.9999)]
    hits = promin.Caster(scene).cast((places, (0, -1, 0)))
    assert hits["t"].tolist() == [13, 9, 8, 9.5, 8, 8.75, 13, 13] and hits["object"].tolist() == [
        0,
        1,
        2,
        3,
        4,
        5,
        0,
        0,
    ]


def test_counts_and_lists_agree(box_caster: promin.Caster) -> None:
    rays = make_rays(300)
    rays[0] = 5, 5, 5, 0, -1, -1, -1, np.inf  # through two corners
    rays[1] = 0, 0, 0, 0, 1, 1, 0, np.inf  # out through an edge
    rays[2] = 0.5, 0.5, 5, 0, 0, 0, -1, np.inf  # through two diagonals
    counts = box_caster.count(rays)
    assert counts.dtype == np.int32 and counts[:3].tolist() == [2, 1, 2]
    inside = (np.abs(rays[:, 0:3]) < 1).all(axis=1)
    assert (counts % 2 == inside).all() and counts.max() == 2
    splits, hits = box_caster.list(rays.reshape(3, 100, 8))
    assert splits.dtype == np.int64 and (np.diff(splits) == counts).all() and hits.dtype == promin.HIT_DTYPE
    nearest = box_caster.cast(rays)
    for i in np.flatnonzero(counts)[3:]:
        assert hits[splits[i]]["t"] == nearest[i]["t"]
        assert (np.diff(hits["t"][splits[i] : splits[i + 1]]) > 0).all()
    splits, hits = box_caster.list(np.empty((0, 8)))
    assert splits.tolist() == [0] and len(hits) == 0


def test_answers_go_to_the_array_of_the_caller(box_caster: promin.Caster) -> None:
    rays = make_rays(24).reshape(4, 6, 8)
    for query, dtype in (("cast", promin.HIT_DTYPE), ("occluded", bool), ("count", np.int32)):
        ask = getattr(box_caster, query)
        out = np.zeros((4, 6), dtype)
        assert ask(rays, out=out) is out and (out == ask(rays)).all()
        stripes = np.zeros((4, 12), dtype)[:, ::2]
        frozen = out.copy()
        frozen.flags.writeable = False
        for wrong, sentence in (
            (np.zeros((6, 4), dtype), "the shape"),
            (np.zeros((4, 6), np.float64), "give an array of"),
            (out.tolist(), "give an array of"),
            (stripes, "not C-contiguous"),
            (frozen, "cannot be written"),
        ):
            with pytest.raises(promin.UsageError, match=sentence):
                ask(rays, out=wrong)
    with pytest.raises(promin.UsageError, match="shares memory"):
        box_caster.cast(rays, out=rays.view(promin.HIT_DTYPE)[..., 0])


def test_lists_come_part_by_part(box_caster: promin.Caster, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("promin._caster._RAYS_AT_A_TIME", 200)
    rays = make_rays(500)
    splits, hits = box_caster.list(rays)
    assert len(hits) > 100
    for budget, most_hits in ((1, 2), (32 * 7, 7), (10**6, 10**6)):
        parts = list(box_caster.iter_list(rays.reshape(5, 100, 8), budget=budget))
        ends = [first + len(own) - 1 for first, own, _ in parts]
        assert [first for first, _, _ in parts] == [0, *ends[:-1]] and ends[-1] == 500
        assert max(len(own) for _, _, own in parts) <= most_hits
        counts = np.concatenate([np.diff(own) for _, own, _ in parts])
        assert (counts == np.diff(splits)).all()
        assert np.concatenate([own for _, _, own in parts]).tobytes() == hits.tobytes()
    assert len(parts) == 3
    assert list(box_caster.iter_list(np.empty((0, 8)))) == []
    for wrong in (0, 1.5, "1 GB"):
        with pytest.raises(promin.UsageError, match="budget is"):
            box_caster.iter_list(rays, budget=wrong)  # type: ignore[arg-type]


def test_threads_open_a_caster_once(box: promin.Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    caster = pickle.loads(pickle.dumps(promin.Caster(box)))
    make, made = _promin.Caster, []

    def make_slowly(*words: object) -> object:
        time.sleep(0.1)
        made.append(words)
        return make(*words)  # type: ignore[arg-type]

    monkeypatch.setattr(_promin, "Caster", make_slowly)
    with ThreadPoolExecutor(4) as pool:
        hits = list(pool.map(lambda _: caster.cast(((0, 0, 9), (0, 0, -1)))["t"], range(4)))
    assert hits == [8] * 4 and len(made) == 1


def test_casters_and_scenes_are_pickled(box: promin.Scene, scenes: Path) -> None:
    box.add_light(promin.Light(position=(1, 2, 3)))
    rays = make_rays(100)
    caster = promin.Caster(box, builder="median")
    again = pickle.loads(pickle.dumps(caster))
    assert again._opened is None
    assert again.cast(rays).tobytes() == caster.cast(rays).tobytes()
    assert again.setup["builder"] == "median"
    assert again.scene.lights == box.lights
    file = pickle.loads(pickle.dumps(promin.Scene.load(scenes / "box.gltf")))
    assert file.objects == promin.Scene.load(scenes / "box.gltf").objects


def test_a_pickled_scene_refuses_another_file(tmp_path: Path, scenes: Path) -> None:
    file = tmp_path / "scene.ply"
    text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    text += "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
    file.write_text(text)
    data = pickle.dumps(promin.Scene.load(file))
    file.write_text(text.replace("1 0 0", "2 0 0"))
    with pytest.raises(promin.InputError, match="the file has changed since the scene was pickled"):
        pickle.loads(data).objects


def test_a_scene_keeps_its_arrays() -> None:
    vertices, faces = make_box()
    scene = promin.Scene()
    scene.add_triangles(vertices, faces)
    vertices += 100
    faces[:] = 0
    assert promin.Caster(scene).cast(((0, 0, 9), (0, 0, -1)))["t"] == 8


def test_a_caster_keeps_its_scene(box: promin.Scene) -> None:
    caster = promin.Caster(box)
    box.add_sphere((0, 0, 5), 1)
    hit = caster.cast(((0, 0, 9), (0, 0, -1)))
    assert hit["object"] == 0 and len(caster.scene.objects) == 1 and len(box.objects) == 2
    assert pickle.loads(pickle.dumps(caster)).cast(((0, 0, 9), (0, 0, -1)))["object"] == 0
    assert promin.Caster(box).cast(((0, 0, 9), (0, 0, -1)))["object"] == 1


def test_a_scene_keeps_what_was_loaded(scenes: Path, tmp_path: Path) -> None:
    file = tmp_path / "box.gltf"
    file.write_bytes((scenes / "box.gltf").read_bytes())
    scene = promin.Scene.load(file)
    rays = make_rays(64)
    hits = promin.Caster(scene).cast(rays)
    file.unlink()
    assert (promin.Caster(scene).cast(rays) == hits).all()
    scene.add_sphere((0, 0, 50))
    with_ball = promin.Caster(scene).cast(((0, 0, 100), (0, 0, -1)))
    assert with_ball["t"] == 49.5 and promin.Renderer(scene).render(size=(4, 4)).size == (4, 4)


def test_builders_and_bvh_files(box: promin.Scene, scenes: Path, tmp_path: Path) -> None:
    rays = make_rays(500)
    hits = {b: promin.Caster(box, builder=b).cast(rays).tobytes() for b in ("sah", "median", "spatial")}
    assert len(set(hits.values())) == 1
    with fails(promin.UsageError, "bvh.builder.unknown", "best"):
        promin.Caster(box, builder="best")
    (tmp_path / "bad.pbvh").write_bytes(b"nothing")
    with pytest.raises(promin.InputError):
        promin.Caster(box, bvh=tmp_path / "bad.pbvh")


def test_positions() -> None:
    hits = np.zeros(2, promin.HIT_DTYPE)
    hits["t"], hits["object"] = (0.5, np.inf), (0, -1)
    points = promin.positions(((1, 2, 3), [(2, 0, 0), (1, 0, 0)]), hits)
    assert points[0].tolist() == [2, 2, 3] and np.isnan(points[1]).all()
    with pytest.raises(promin.UsageError, match="hits"):
        promin.positions(((1, 2, 3), (1, 0, 0)), np.zeros(2))


def cut_ball(radius: float) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Returns a ball of triangles. The corners are multiples of 1/64, and the middles of edges are multiples of
    1/128."""
    vertices, faces = make_ball(2)
    return np.round(vertices * radius * 64) / 64, faces


def lies_within(
    points: NDArray[np.float64], vertices: NDArray[np.float64], faces: NDArray[np.int64]
) -> NDArray[np.bool_]:
    """Returns whether points are inside a mesh around the origin, in float64. A ray from the origin must leave the mesh
    once. A point is inside if the tetrahedron of the origin and a triangle contains it, including the tetrahedron's
    inner sides."""
    result = np.zeros(len(points), bool)
    for corners in vertices[faces]:
        weights = np.linalg.solve(corners.T, points.T)
        result |= (weights >= -1e-12).all(axis=0) & (weights.sum(axis=0) < 1)
    return result


def test_points_are_inside_whatever_their_rays_are_aimed_at(recwarn: pytest.WarningsRecorder) -> None:
    outer, faces = cut_ball(2.0)
    inner, _ = cut_ball(0.75)
    scene = promin.Scene()
    scene.add_triangles(outer, faces)
    scene.add_triangles(inner, faces[:, ::-1])
    caster = promin.Caster(scene)
    corners = np.concatenate([outer, inner])
    triangles = np.concatenate([faces, faces + len(outer)])
    middles = (corners[triangles] + corners[np.roll(triangles, 1, axis=1)]).reshape(-1, 3) / 2
    aims = np.concatenate([corners, middles])
    # Each ray, or the ray in the opposite direction, hits a corner or the middle of an edge exactly.
    steps = np.array([-4, -2, -1, -0.5, -0.25, 0.25, 0.5, 1, 2, 4]).reshape(-1, 1, 1)
    points = (aims - steps * PROBE.astype(np.float64)).reshape(-1, 3)
    assert (points == points.astype(np.float32)).all(), "no number is rounded"
    bulk = np.random.default_rng(8).normal(size=(20000, 3))
    for chosen in (points, bulk):
        expected = lies_within(chosen, outer, faces) & ~lies_within(chosen, inner, faces)
        assert 0.05 < expected.mean() < 0.95
        assert (caster.inside(chosen) == expected).all()
    assert caster.inside((1.5, 0, 0)).shape == () and caster.inside(bulk.reshape(10, 2000, 3)).shape == (10, 2000)
    assert not recwarn.list


def test_surfaces_that_are_not_closed_are_told() -> None:
    vertices, faces = make_box()
    scene = promin.Scene()
    scene.add_triangles(vertices, faces[:-2])
    with pytest.warns(UserWarning, match=r"^\d+ of 8000 points are on the surface, or the surface is not closed"):
        told = promin.Caster(scene).inside(np.random.default_rng(3).uniform(-2, 2, (8000, 3)))
    assert told.any()
    with pytest.warns(UserWarning, match="^1 of 2 points is on the surface"):
        plane = promin.Scene()
        plane.add_plane()
        assert not promin.Caster(plane).inside([(0, -1, 0), (0, np.nan, 0)]).any()
