# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Tests of threads, signals, forks and memory."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
import pytest
from conftest import make_box, make_rays

import promin


def make_scene(seed: int, count: int = 20000) -> promin.Scene:
    random = np.random.default_rng(seed)
    scene = promin.Scene()
    corners = random.normal(size=(count, 1, 3)) + 0.05 * random.normal(size=(count, 3, 3))
    scene.add_triangles(corners.reshape(-1, 3), np.arange(3 * count).reshape(-1, 3))
    return scene


def test_two_threads_cast_on_one_device() -> None:
    device = promin.Device()
    casters = [promin.Caster(make_scene(seed), device) for seed in (1, 2)]
    rays = [make_rays(20000, seed) for seed in (3, 4)]
    alone = [caster.cast(r).tobytes() for caster, r in zip(casters, rays)]
    with ThreadPoolExecutor(4) as pool:
        work = [pool.submit(casters[i % 2].cast, rays[i % 2]) for i in range(12)]
        for i, done in enumerate(work):
            assert done.result().tobytes() == alone[i % 2]


def test_two_devices_at_once() -> None:
    devices = [promin.Device(0), promin.Device(0)]
    scene = make_scene(1)
    rays = make_rays(20000)
    casters = [promin.Caster(scene, device) for device in devices]
    assert casters[0].device is not casters[1].device
    with ThreadPoolExecutor(2) as pool:
        first, second = pool.map(lambda caster: caster.cast(rays).tobytes(), casters)
    assert first == second


def test_a_cast_lets_other_threads_run() -> None:
    caster = promin.Caster(make_scene(1))
    rays = make_rays(400000)
    ticks = 0
    thread = threading.Thread(target=caster.cast, args=(rays,))
    thread.start()
    while thread.is_alive():
        ticks += 1
        time.sleep(0.001)
    thread.join()
    assert ticks > 5


def interrupt_soon(delay_s: float) -> list[float]:
    """Sends Ctrl-C to this process after the delay. The list contains the time."""
    sent: list[float] = []

    def send() -> None:
        time.sleep(delay_s)
        sent.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)

    threading.Thread(target=send, daemon=True).start()
    return sent


def test_ctrl_c_ends_a_cast_and_a_picture_within_half_a_second() -> None:
    scene = make_scene(1)
    caster = promin.Caster(scene)
    small, many = make_rays(100), np.tile(make_rays(200000, spread=1.0), (40, 1))
    before = caster.cast(small).tobytes()
    caster.cast(many[:200000])  # This call compiles the kernels.
    renderer = promin.Renderer(scene)
    renderer.render(size=(64, 64))
    for work in (lambda: caster.cast(many), lambda: renderer.render(size=(2000, 2000), spp=64)):
        sent = interrupt_soon(0.3)
        with pytest.raises(KeyboardInterrupt):
            work()
        assert sent and time.monotonic() - sent[0] < 0.5
    assert caster.cast(small).tobytes() == before


def test_progress_ends_work_and_hears_of_it() -> None:
    scene = make_scene(1)
    caster = promin.Caster(scene)
    many = np.tile(make_rays(200000, spread=1.0), (5, 1))
    heard: list[float] = []
    caster.cast(many, progress=heard.append)
    assert heard[-1] == 1.0 and heard == sorted(heard) and len(heard) > 1
    with pytest.raises(promin.Cancelled):
        caster.cast(many, progress=lambda _: False)
    with pytest.raises(ZeroDivisionError):
        caster.cast(many, progress=lambda _: 1 / 0)
    assert len(caster.cast(make_rays(10))) == 10


def test_progress_may_ask_for_lights_while_they_are_replaced() -> None:
    renderer = promin.Renderer(make_scene(1))
    update = threading.Thread(target=lambda: renderer.update(lights=[promin.Light()]), daemon=True)
    was_cancelled = threading.Event()

    def ask(_: float) -> bool:
        if not update.is_alive():
            update.start()
            time.sleep(0.3)
        return not renderer.lights

    def render() -> None:
        try:
            renderer.render(size=(2000, 2000), spp=64, progress=ask)
        except promin.Cancelled:
            was_cancelled.set()

    picture = threading.Thread(target=render, daemon=True)
    picture.start()
    picture.join(60)
    update.join(60)
    # Otherwise the two threads have waited for each other until the picture was done.
    assert was_cancelled.is_set()
    assert renderer.lights == [promin.Light()]


def _use(caster: promin.Caster, pipe: Any) -> None:
    try:
        caster.cast(make_rays(4))
    except RuntimeError as error:
        pipe.send(str(error))
    else:
        pipe.send("no error")


def _open(caster: promin.Caster, pipe: Any) -> None:
    pipe.send(caster.cast(make_rays(4)).tobytes())


def test_what_was_opened_before_a_fork_says_so() -> None:
    caster = promin.Caster(make_scene(1, 10))
    for work, method, expected in (
        (_use, "fork", "the device was opened before a fork; open it in the child or start with spawn"),
        (_open, "spawn", caster.cast(make_rays(4)).tobytes()),
    ):
        context = multiprocessing.get_context(method)
        ours, theirs = context.Pipe()
        child = context.Process(target=work, args=(caster, theirs))
        child.start()
        assert ours.poll(60) and ours.recv() == expected
        child.join(60)
        assert child.exitcode == 0
    assert len(caster.cast(make_rays(4))) == 4


def resident_mib() -> float:
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 2**20


def hold_memory(rounds: int) -> None:
    device = promin.Device()
    rays = make_rays(1000)

    def turn() -> None:
        scene = promin.Scene()
        scene.add_triangles(*make_box())
        corners = np.random.default_rng(0).normal(size=(10000, 1, 3)) + 0.01 * np.eye(3)
        scene.add_triangles(corners.reshape(-1, 3), np.arange(30000).reshape(-1, 3))
        caster = promin.Caster(scene, device)
        for _ in range(10):
            caster.cast(rays)
        caster.list(rays)

    for _ in range(4):
        turn()
    before = resident_mib()
    for _ in range(rounds):
        turn()
    after = resident_mib()
    print(f"{rounds} scenes, {10 * rounds} casts: {before:.1f} MiB before, {after:.1f} MiB after")
    assert after - before < 8.0


def hold_memory_apart(rounds: int) -> None:
    """Runs `hold_memory` in a process of its own, which holds no memory of other tests."""
    child = multiprocessing.get_context("spawn").Process(target=hold_memory, args=(rounds,))
    child.start()
    child.join()
    assert child.exitcode == 0


def test_memory_is_steady_over_scenes_and_casts() -> None:
    hold_memory_apart(12)


@pytest.mark.long
def test_memory_is_steady_over_many_scenes() -> None:
    hold_memory_apart(1000)
