# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Compares promin's rays from Python with other libraries: the tables of docs/python.md.

    peers.py rates MESH...      rays a second, in turns, medians
    peers.py wrong [COUNT]      wrong answers of rays that are aimed at corners and edges

Uses trimesh, embreex and open3d. Libraries that are not installed are left out."""

from __future__ import annotations

import importlib.metadata
import platform
import sys
import time
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np
from conftest import make_box
from numpy.typing import NDArray

import promin

TURNS = 5
SIDE = 1000
RAYS_OF_SLOW = 2000
"""Number of rays for libraries that would need hours for all rays."""


class Peer(NamedTuple):
    """A library that casts rays at a mesh. `take` converts origins and directions (n, 3) float64 to the library's
    rays."""

    name: str
    take: Callable[[Any, Any], Any]
    hits: Callable[[Any], Any]
    """Returns whether each ray hits anything, according to the library's search for the nearest hit."""
    counts: Callable[[Any], Any]
    """Returns the number of crossings of each ray with the mesh."""
    is_slow: bool = False


def make_peers(vertices: Any, faces: Any) -> Iterator[Peer]:
    scene = promin.Scene()
    scene.add_triangles(vertices, faces)
    caster = promin.Caster(scene)

    def pack(origins: Any, directions: Any) -> NDArray[np.float32]:
        """Returns rays in float32, without subtracting the center, as an application of promin would store them."""
        zero = np.zeros((len(origins), 1))
        return np.hstack([origins - scene.center, zero, directions, zero + np.inf]).astype(np.float32)

    bare = promin.Scene(center=(0, 0, 0))
    bare.add_triangles(np.asarray(vertices, np.float64) - scene.center, faces)
    of_bare = promin.Caster(bare)
    yield Peer("promin, float32", pack, lambda r: of_bare.cast(r)["object"] >= 0, of_bare.count)
    yield Peer("promin, float64", lambda o, d: (o, d), lambda r: caster.cast(r)["object"] >= 0, caster.count)
    try:
        import open3d

        theirs = open3d.t.geometry.RaycastingScene()
        theirs.add_triangles(
            open3d.core.Tensor(np.asarray(vertices, np.float32)), open3d.core.Tensor(np.asarray(faces, np.uint32))
        )
        yield Peer(
            "Open3D",
            lambda o, d: open3d.core.Tensor(np.hstack([o, d]).astype(np.float32)),
            lambda r: np.isfinite(theirs.cast_rays(r)["t_hit"].numpy()),
            lambda r: theirs.count_intersections(r).numpy(),
        )
    except ImportError:
        pass
    try:
        import trimesh
        from trimesh.ray import ray_pyembree, ray_triangle

        mesh = trimesh.Trimesh(vertices, faces, process=False)
        for name, kind in (("embreex by trimesh", ray_pyembree), ("trimesh", ray_triangle)):
            ray = kind.RayMeshIntersector(mesh)
            yield Peer(
                name,
                lambda o, d: (o, d),
                lambda r, ray=ray: ray.intersects_first(*r) >= 0,
                lambda r, ray=ray: np.bincount(ray.intersects_id(*r)[1], minlength=len(r[0])),
                kind is ray_triangle,
            )
    except ImportError:
        pass


def make_rays(low: Any, high: Any) -> dict[str, tuple[Any, Any]]:
    """Returns rays of a camera in front of the mesh, in pixel order, and random rays from around the mesh towards
    it."""
    middle, radius = (low + high) / 2, np.linalg.norm(high - low) / 2
    x, y = np.meshgrid(*2 * [(np.arange(SIDE) + 0.5) / SIDE * 2 - 1])
    camera = np.stack([x * 0.45, -y * 0.45, -np.ones_like(x)], axis=-1).reshape(-1, 3)
    eye = np.broadcast_to(middle + [0, 0, 2 * radius], camera.shape)
    random = np.random.default_rng(0)
    around = random.normal(size=camera.shape)
    around = middle + radius * around / np.linalg.norm(around, axis=1, keepdims=True)
    targets = middle + 0.5 * radius * random.normal(size=camera.shape)
    return {"camera": (np.array(eye), camera), "random": (around, targets - around)}


def measure(file: str) -> None:
    import trimesh

    mesh = trimesh.load(file, force="mesh", process=False)
    vertices, faces = np.asarray(mesh.vertices), np.asarray(mesh.faces)
    peers = list(make_peers(vertices, faces))
    for kind, rays in make_rays(vertices.min(axis=0), vertices.max(axis=0)).items():
        times: dict[str, list[float]] = {}
        shares = {}
        for turn in range(TURNS + 1):
            for peer in peers:
                if peer.is_slow and turn > 1:
                    continue
                some = slice(None, None, SIDE**2 // RAYS_OF_SLOW if peer.is_slow else 1)
                taken = peer.take(rays[0][some], rays[1][some])
                if not peer.is_slow:
                    peer.hits(taken)  # Keeps caches of the previous library out of the time.
                start = time.perf_counter()
                hits = peer.hits(taken)
                # The first turn only warms up.
                times.setdefault(peer.name, []).append((time.perf_counter() - start) / len(hits))
                shares[peer.name] = hits.mean()
        for name, all_times in times.items():
            rate = 1e-6 / float(np.median(all_times[1:]))
            print(f"| {file.rsplit('/')[-1]} | {kind} | {name} | {rate:.3g} | {shares[name]:.4f} |", flush=True)


def make_ball(levels: int) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Returns a closed mesh: the quads of a cube, cut `levels` times in each direction and projected onto a sphere."""
    vertices, faces = make_box()
    for _ in range(levels):
        edges = np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        pairs, which = np.unique(edges, axis=0, return_inverse=True)
        middles = len(vertices) + which.reshape(-1, 3)
        vertices = np.concatenate([vertices, vertices[pairs].mean(axis=1)])
        a, b, c = faces.T
        ab, bc, ca = middles.T
        faces = np.concatenate([np.stack(t, axis=-1) for t in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])
    return vertices / np.linalg.norm(vertices, axis=1, keepdims=True), faces


def aim(vertices: Any, faces: Any, count: int) -> tuple[Any, Any]:
    """Returns rays from inside. One half is aimed at corners, the other half at the middles of edges."""
    random = np.random.default_rng(1)
    corners = vertices[random.integers(len(vertices), size=count // 2)]
    ends = faces[random.integers(len(faces), size=count - count // 2)][:, :2]
    targets = np.concatenate([corners, vertices[ends].mean(axis=1)])
    # The origins have few bits, so that rays towards a box's corners hit them exactly.
    origins = np.round(random.uniform(-0.3, 0.3, targets.shape) * 64) / 64
    return origins, targets - origins


def find_wrong(peer: Peer, origins: Any, directions: Any) -> tuple[int, int, int]:
    """Returns three numbers for rays from inside a closed mesh: the rays that hit nothing, the rays with an even number
    of crossings, and all rays."""
    some = slice(None, None, max(1, len(origins) // RAYS_OF_SLOW) if peer.is_slow else 1)
    taken = peer.take(origins[some], directions[some])
    hits, counts = np.asarray(peer.hits(taken)), np.asarray(peer.counts(taken))
    return int((~hits).sum()), int((counts % 2 == 0).sum()), len(hits)


def list_wrong(count: int) -> None:
    for name, (vertices, faces) in {"cube": make_box(), "ball": make_ball(5)}.items():
        origins, directions = aim(vertices, faces, count)
        for offset in (0.0, 1e4, 1e6):
            away = np.array([offset, offset, -offset])
            for peer in make_peers(vertices + away, faces):
                missed, even, cast = find_wrong(peer, origins + away, directions)
                print(f"| {name} | {offset:g} | {peer.name} | {missed} | {even} | {cast} |", flush=True)


def version_of(package: str) -> str:
    try:
        return importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        return "is not there"


def main() -> None:
    words = sys.argv[1:]
    with open("/proc/cpuinfo") as file:
        lines = dict(line.split("\t", 1) for line in file.read().split("\n\n")[0].split("\n") if "\t" in line)
    cpu = {name.strip(): value.strip(" \t:") for name, value in lines.items()}
    versions = [f"{n} {version_of(n)}" for n in ("numpy", "trimesh", "embreex", "open3d")]
    print(
        f"Python {platform.python_version()}, {', '.join(versions)}; {promin.Device().fingerprint}; {cpu['model name']}"
    )
    print(f"family {cpu['cpu family']} model {cpu['model']}")
    if words[:1] == ["rates"]:
        for file in words[1:]:
            measure(file)
    elif words[:1] == ["wrong"]:
        list_wrong(int(words[1]) if len(words) > 1 else 10**6)
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main()
