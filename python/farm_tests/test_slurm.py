# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Tests of the farm on Slurm, as `--scheduler slurm` and as a plain array. This machine plays both nodes of the Slurm
cluster.

Needs slurm-wlm and munge (tools/setup --queue) and root, because the daemons switch users."""

from __future__ import annotations

import contextlib
import json
import os
import shlex
import shutil
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from conftest import Farm, wait_for

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "scontrol", "sinfo")
NODES = ("n1", "n2")

pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(
        any(shutil.which(program, path=f"{os.environ['PATH']}:/usr/sbin") is None for program in PROGRAMS),
        reason="slurm-wlm or munge is not installed: tools/setup --queue",
    ),
    pytest.mark.skipif(os.geteuid() != 0, reason="Slurm's daemons need root"),
]


def free_port() -> int:
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        port: int = one.getsockname()[1]
        return port


class Slurm:
    """A Slurm controller and two nodes of one processor each, whose files are in a folder."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        for name in ("state", "munge", *NODES):
            (folder / name).mkdir(parents=True)
        (folder / "munge").chmod(0o700)
        key = folder / "munge/key"
        key.write_bytes(os.urandom(128))
        key.chmod(0o600)
        host = socket.gethostname()
        ports = [free_port() for _ in range(3)]
        self.configuration = folder / "slurm.conf"
        lines = [
            "ClusterName=one",
            f"SlurmctldHost={host}(127.0.0.1)",
            f"SlurmctldPort={ports[2]}",
            "SlurmUser=root",
            f"AuthInfo=socket={folder}/munge/socket",
            "ProctrackType=proctrack/linuxproc",
            "TaskPlugin=task/none",
            "JobAcctGatherType=jobacct_gather/none",
            "SelectType=select/cons_tres",
            "ReturnToService=2",
            "SlurmdTimeout=5",
            "KillWait=1",
            "CommunicationParameters=NoCtldInAddrAny,NoInAddrAny",
            f"StateSaveLocation={folder}/state",
            f"SlurmdSpoolDir={folder}/%n",
            f"SlurmdPidFile={folder}/%n.pid",
            f"SlurmctldPidFile={folder}/slurmctld.pid",
            f"SlurmctldLogFile={folder}/slurmctld.log",
            f"SlurmdLogFile={folder}/%n.log",
            "SchedulerParameters=sched_min_interval=0,batch_sched_delay=0,sched_interval=1,bf_interval=1,requeue_delay=0",
        ]
        lines += [
            f"NodeName={name} NodeHostname={host} NodeAddr=127.0.0.1 Port={port} CPUs=1 RealMemory=1000"
            for name, port in zip(NODES, ports)
        ]
        lines.append("PartitionName=all Nodes=n[1-2] Default=YES MaxTime=INFINITE State=UP")
        self.configuration.write_text("\n".join(lines) + "\n")
        self.environment = {
            "SLURM_CONF": str(self.configuration),
            "PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}:/usr/sbin",
        }
        self._daemons: dict[str, subprocess.Popen[bytes]] = {}

    def start(self) -> None:
        munge = [f"--{name}={self.folder}/munge/{name.split('-')[0]}" for name in ("socket", "pid-file", "seed-file")]
        log = f"--log-file={self.folder}/munge/log"
        self._start("munged", "munged", "--foreground", f"--key-file={self.folder}/munge/key", "--force", log, *munge)
        wait_for((self.folder / "munge/socket").exists)
        self._start("slurmctld", "slurmctld", "-D", "-c")
        for name in NODES:
            self.start_node(name)
        wait_for(lambda: "idle" in self.run("sinfo", "-h", "-t", "idle", "-o", "%T %D"), 60)

    def start_node(self, name: str) -> None:
        self._start(name, "slurmd", "-D", "-N", name)

    def kill_node(self, name: str) -> None:
        """Kills the node's daemon and all its processes, as a power cut would."""
        self._daemons.pop(name).kill()
        # The next turn kills processes that started during this one.
        while pids := self.pids_of(name):
            for pid in pids:
                with contextlib.suppress(ProcessLookupError):
                    os.kill(pid, signal.SIGKILL)

    def pids_of(self, name: str) -> list[int]:
        """Returns the processes of the node's jobs."""
        found = []
        for process in Path("/proc").glob("[0-9]*"):
            try:
                words = (process / "environ").read_bytes().split(b"\0")
            except OSError:
                continue
            if f"SLURMD_NODENAME={name}".encode() in words and f"SLURM_CONF={self.configuration}".encode() in words:
                found.append(int(process.name))
        return found

    def run(self, *words: object) -> str:
        environment = {**os.environ, **self.environment}
        done = subprocess.run([*map(str, words)], env=environment, cwd=self.folder, capture_output=True, text=True)
        assert done.returncode == 0, (words, done.stdout, done.stderr)
        return done.stdout

    def submit(self, farm: Farm, command: list[str], *options: str) -> str:
        """Submits a command of promin-farm. Returns the number of its job."""
        words = ["sbatch", "--parsable", "--mem=100", *options, "--wrap"]
        line = shlex.join([sys.executable, "-m", "promin_farm", *command])
        environment = {**farm.environment(), **self.environment}
        return subprocess.check_output([*words, line], env=environment, cwd=farm.root, text=True).strip()

    def stop(self) -> None:
        for name in NODES:
            if name in self._daemons:
                self.kill_node(name)
        for daemon in reversed(list(self._daemons.values())):
            daemon.terminate()
        for daemon in self._daemons.values():
            daemon.wait(20)

    def _start(self, name: str, *words: str) -> None:
        environment = {**os.environ, **self.environment}
        with open(self.folder / f"{name}.out", "ab") as out:
            self._daemons[name] = subprocess.Popen(words, env=environment, stdout=out, stderr=out)


@pytest.fixture
def slurm(tmp_path: Path) -> Iterator[Slurm]:
    one = Slurm(tmp_path / "slurm")
    try:
        one.start()
        yield one
    finally:
        one.stop()


def is_at_a_piece(farm: Farm, pids: list[int]) -> bool:
    """Returns whether a worker of one of these processes has begun a piece and not finished it."""
    for ledger in farm.job.glob("ledger/*.jsonl"):
        lines = ledger.read_text().splitlines()
        if int(ledger.stem.rpartition("-")[2]) in pids and lines and json.loads(lines[-1])["event"] == "begun":
            return True
    return False


def test_workers_of_slurm_of_which_a_node_dies(farm: Farm, slurm: Slurm) -> None:
    pytest.importorskip("dask_jobqueue")
    farm.write_scene(40, ms=500)
    configuration = farm.root / "queue.toml"
    configuration.write_text(
        'cores = 1\nmemory = "900MB"\nwalltime = "00:30:00"\ninterface = "lo"\njob_extra_directives = ["--no-requeue"]\n'
    )
    process = farm.start(
        "render", farm.scene, "-o", farm.out, "--job", farm.job, "--scheduler", "slurm", "--workers", 2,
        "--queue-config", configuration, **slurm.environment,
    )  # fmt: skip
    wait_for(lambda: len(set(farm.worker_pids())) == 2 and len(set(farm.events("done"))) > 4, 90)
    wait_for(lambda: is_at_a_piece(farm, slurm.pids_of("n2")))
    slurm.kill_node("n2")
    out, err = process.communicate(timeout=200)
    assert process.returncode == 0, (out, err)
    assert farm.out.read_bytes() == farm.expected()
    assert sorted(set(farm.events("done"))) == list(range(40))
    assert len(farm.events("begun")) > len(farm.events("done")), "the node died in no piece"


def test_an_array_of_slurm_of_which_a_node_dies(farm: Farm, slurm: Slurm) -> None:
    farm.write_scene(24, ms=500)
    farm.render("--prepare")
    array = slurm.submit(farm, ["work", str(farm.job), "--quiet"], "--array=0-3")
    after = slurm.submit(farm, ["resume", str(farm.job), "--quiet"], f"--dependency=afterany:{array}")
    wait_for(lambda: len(set(farm.events("done"))) > 3 and is_at_a_piece(farm, slurm.pids_of("n2")), 60)
    slurm.kill_node("n2")
    time.sleep(1)
    slurm.start_node("n2")
    wait_for(lambda: not slurm.run("squeue", "-h", "-j", f"{array},{after}").strip(), 180)
    assert farm.out.read_bytes() == farm.expected()
    assert sorted(set(farm.events("done"))) == list(range(24))
    assert len(farm.events("begun")) > len(farm.events("done")), "the node died in no piece"
