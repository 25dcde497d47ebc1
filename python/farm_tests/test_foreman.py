# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Tests of the foreman's loop with simulated workers, without processes and without Dask."""

from __future__ import annotations

import json
from collections import Counter, deque
from collections.abc import Callable
from typing import Any

import pytest
from conftest import Farm

from promin_farm.foreman import PROOF, Foreman, Tally
from promin_farm.settings import Settings


class Silent:
    """A watch that remembers its messages."""

    def __init__(self) -> None:
        self.said: list[str] = []
        self.done: list[int] = []

    def say(self, sentence: str) -> None:
        self.said.append(sentence)

    def piece_done(self, piece: Any, receipt: dict[str, object]) -> None:
        self.done.append(piece.number)

    def tick(self, worker_count: int) -> None:
        pass


class Scripted:
    """Workers a, b, … Each worker makes the oldest of its pieces when its turn comes."""

    patience_s = 0.0
    most_at_once = 4

    def __init__(self, farm: Farm, names: str = "ab") -> None:
        self.farm = farm
        self.there = set(names)
        self.sent: dict[str, deque[int]] = {name: deque() for name in names}
        self.most: Counter[str] = Counter()
        self.count = 0
        self.fingerprints = {name: "one" for name in names}
        self.proof: Callable[[str], dict[str, Any]] = lambda name: {
            "proof": self.fingerprints[name],
            "name": name,
            "device": "",
            "ends_at": float("inf"),
        }
        self.answer: Callable[[str, int], dict[str, Any] | None] = lambda name, number: {"done": {"ms": 1, "bytes": 1}}

    def members(self) -> set[str]:
        return set(self.there)

    def send(self, member: str, number: int) -> None:
        self.sent[member].append(number)
        self.most[member] = max(self.most[member], len(self.sent[member]))

    def next_answer(self, timeout_s: float) -> tuple[str, int, dict[str, Any] | None] | None:
        busy = sorted(name for name in self.there if self.sent[name])
        if not busy:
            return None
        self.count += 1
        name = busy[self.count % len(busy)]
        number = self.sent[name].popleft()
        answer = self.proof(name) if number == PROOF else self.answer(name, number)
        return (name, number, answer) if name in self.there else None

    def withdraw(self, member: str, number: int) -> None:
        self.sent[member].remove(number)

    def forget(self, member: str) -> None:
        self.sent[member].clear()

    def die(self, name: str, number: int, successor: str) -> None:
        """Lets the worker begin the piece and then end. The successor appears in its place."""
        ledger = self.farm.job / "ledger" / f"{name}.jsonl"
        with ledger.open("a") as file:
            file.write(json.dumps({"event": "begun", "number": number, "time_s": 1.0}) + "\n")
        self.there.discard(name)
        self.there.add(successor)
        self.sent[successor] = deque()
        self.fingerprints[successor] = "one"


def run(farm: Farm, crew: Scripted, settings: Settings = Settings(), **options: Any) -> tuple[Tally, Silent]:
    watch = Silent()
    job = farm.create()
    foreman = Foreman(job, crew, watch, settings=settings, **options)
    return foreman.run([piece.number for piece in job.pieces]), watch


def test_all_is_made_once_and_few_pieces_are_out(farm: Farm) -> None:
    farm.write_scene(100)
    crew = Scripted(farm)
    tally, watch = run(farm, crew)
    assert sorted(watch.done) == list(range(100)) and tally.done == 100 and tally.repeats == 0
    assert max(crew.most.values()) <= 4


def test_long_pieces_wait_one_behind_the_other(farm: Farm) -> None:
    farm.write_scene(30)
    crew = Scripted(farm)
    crew.answer = lambda name, number: {"done": {"ms": 5000, "bytes": 1}}
    run(farm, crew)
    assert max(crew.most.values()) == 2


def test_a_dead_workers_piece_is_made_again_and_what_it_had_not_begun_counts_no_death(farm: Farm) -> None:
    farm.write_scene(20)
    crew = Scripted(farm)
    died: list[int] = []

    def answer(name: str, number: int) -> dict[str, Any]:
        if name == "a":
            died.append(number)
            crew.die("a", number, "c")
        return {"done": {"ms": 5000, "bytes": 1}}

    crew.answer = answer
    watch = Silent()
    job = farm.create()
    foreman = Foreman(job, crew, watch, settings=Settings())
    tally = foreman.run(range(20))
    assert sorted(watch.done) == list(range(20)) and not tally.failed
    assert {n: t.deaths for n, t in foreman._tries.items() if t.deaths} == {died[0]: 1}


def test_a_piece_that_ends_its_workers_is_given_up_and_the_rest_is_made(farm: Farm) -> None:
    farm.write_scene(20)
    crew = Scripted(farm, "a")
    names = iter(f"w{i}" for i in range(100))

    def answer(name: str, number: int) -> dict[str, Any]:
        if number == 7:
            crew.die(name, number, next(names))
        return {"done": {"ms": 5000, "bytes": 1}}

    crew.answer = answer
    tally, watch = run(farm, crew)
    assert sorted(watch.done) == [n for n in range(20) if n != 7]
    assert list(tally.failed) == [7] and tally.failed[7].deaths == 5 and "ended while it made" in tally.failed[7].reason


def test_a_piece_that_fails_is_tried_three_times_and_the_last_reason_told(farm: Farm) -> None:
    farm.write_scene(20)
    crew = Scripted(farm)
    tries: list[int] = []

    def answer(name: str, number: int) -> dict[str, Any]:
        if number != 3:
            return {"done": {"ms": 1, "bytes": 1}}
        tries.append(number)
        return {"failed": f"reason {len(tries)}", "is_disk_full": False}

    crew.answer = answer
    tally, watch = run(farm, crew)
    assert len(tries) == 3 and tally.failed[3].reason == "reason 3" and tally.done == 19
    assert any("failed permanently after 3 failures, the last: reason 3" in sentence for sentence in watch.said)


def test_where_everything_fails_not_everything_is_tried(farm: Farm) -> None:
    farm.write_scene(1000)
    crew = Scripted(farm)
    crew.answer = lambda name, number: {"failed": "the driver is broken", "is_disk_full": False}
    tally, _ = run(farm, crew)
    assert "10 pieces in a row have failed, the last: the driver is broken" == tally.reason and tally.exit_code == 1


def test_a_full_disk_ends_the_run_at_once(farm: Farm) -> None:
    farm.write_scene(100)
    crew = Scripted(farm)
    crew.answer = lambda name, number: {"failed": "cannot write (No space left on device)", "is_disk_full": True}
    tally, _ = run(farm, crew)
    assert tally.reason.startswith("the disk is full: cannot write") and tally.exit_code == 1


def test_no_more_is_begun_than_the_disk_has_room_for(farm: Farm) -> None:
    farm.write_scene(100)
    crew = Scripted(farm)
    crew.answer = lambda name, number: {"done": {"ms": 1, "bytes": 10**15}}
    tally, _ = run(farm, crew)
    assert "MB left" in tally.reason and tally.done == 4


def test_a_worker_without_a_device_idles_and_the_others_make_all(farm: Farm) -> None:
    farm.write_scene(10)
    crew = Scripted(farm)
    proof = crew.proof
    crew.proof = lambda name: {"idle": "there is no Vulkan device", "exit_code": 4} if name == "a" else proof(name)
    tally, watch = run(farm, crew)
    assert tally.done == 10 and crew.most["a"] == 1 and "a makes no pieces: there is no Vulkan device" in watch.said


def test_where_all_refuse_the_run_ends_with_what_they_say(farm: Farm) -> None:
    farm.write_scene(10)
    crew = Scripted(farm)
    crew.proof = lambda name: {"refused": "the scene has changed", "exit_code": 3}
    tally, _ = run(farm, crew)
    assert (tally.reason, tally.exit_code, tally.done) == ("the scene has changed", 3, 0)


def test_without_workers_it_ends(farm: Farm) -> None:
    farm.write_scene(10)
    tally, _ = run(farm, Scripted(farm, ""))
    assert tally.reason == "no worker has joined for 0 s"


def test_pieces_of_another_fingerprint_go_to_its_workers(farm: Farm) -> None:
    farm.write_scene(160, names="frames", per_frame=8)
    crew = Scripted(farm)
    crew.fingerprints["b"] = "two"
    owners: dict[int, str] = {}
    asked: list[int] = []
    made: dict[int, str] = {}

    def answer(name: str, number: int) -> dict[str, Any]:
        mine = crew.fingerprints[name]
        owner = owners.setdefault(number // 8, mine)
        if owner != mine:
            asked.append(number // 8)
            return {"elsewhere": owner}
        made[number] = mine
        return {"done": {"ms": 1, "bytes": 1}}

    crew.answer = answer
    tally, watch = run(farm, crew, Settings(allow_mixed=True))
    assert tally.done == 160 and not tally.foreign and set(made.values()) == {"one", "two"}
    assert all(made[number] == made[number // 8 * 8] for number in made)
    # A worker that has learnt which fingerprint a frame needs gets no further pieces of this frame, except those
    # already sent.
    assert len(asked) <= 20 * 3


def test_pieces_of_a_fingerprint_that_nobody_has_are_told(farm: Farm) -> None:
    farm.write_scene(4, names="frames")
    crew = Scripted(farm)
    crew.answer = lambda name, number: {"elsewhere": "two"} if number < 2 else {"done": {"ms": 1, "bytes": 1}}
    tally, _ = run(farm, crew, Settings(allow_mixed=True))
    assert tally.done == 2 and tally.foreign == {0: "two", 1: "two"}


def test_a_worker_whose_time_is_nearly_over_gets_no_piece(farm: Farm) -> None:
    farm.write_scene(10)
    crew = Scripted(farm)
    proof = crew.proof
    crew.proof = lambda name: {**proof(name), "ends_at": 0.0 if name == "a" else float("inf")}
    tally, _ = run(farm, crew)
    assert tally.done == 10 and crew.most["a"] == 1


def test_a_stop_waits_for_what_is_at_hand(farm: Farm) -> None:
    farm.write_scene(50)
    crew = Scripted(farm)
    watch = Silent()
    job = farm.create()
    tally = Foreman(job, crew, watch, settings=Settings(), stop=lambda: len(watch.done) >= 5).run(range(50))
    assert tally.was_stopped and 5 <= tally.done <= 7 and not any(crew.sent.values())


@pytest.mark.parametrize("answer", [None, {"left": True}])
def test_an_answer_that_is_lost_is_asked_for_again(farm: Farm, answer: dict[str, Any] | None) -> None:
    farm.write_scene(10)
    crew = Scripted(farm)
    lost = {4}

    def reply(name: str, number: int) -> dict[str, Any] | None:
        if number in lost:
            lost.discard(number)
            return answer
        return {"done": {"ms": 1, "bytes": 1}}

    crew.answer = reply
    tally, _ = run(farm, crew)
    assert tally.done == 10 and tally.repeats == 1 and not tally.failed


def test_a_worker_whose_proofs_are_lost_is_done_without(farm: Farm) -> None:
    farm.write_scene(10)
    crew = Scripted(farm)
    asked = []

    def proof(name: str) -> Any:
        asked.append(name)
        return {"proof": "x", "name": "b", "ends_at": float("inf")} if name == "b" else None

    crew.proof = proof
    tally, _ = run(farm, crew)
    assert tally.done == 10 and 1 < asked.count("a") < 10


def test_workers_that_end_before_they_begin_end_the_run(farm: Farm) -> None:
    farm.write_scene(10)
    crew = Scripted(farm, "a")
    names = iter(f"w{i}" for i in range(100))

    def proof(name: str) -> dict[str, Any]:
        crew.there = {successor := next(names)}
        crew.sent[successor] = deque()
        return {}

    crew.proof = proof
    tally, _ = run(farm, crew)
    assert tally.reason.startswith("5 workers in a row ended while they opened the job") and tally.exit_code == 1
