# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Workers that a queue starts through dask-jobqueue. Each job of the queue is one worker with one device."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from promin import jobs

from promin_farm.crews import DaskCrew, need, quiet

QUEUES = {"slurm": "SLURMCluster", "pbs": "PBSCluster", "lsf": "LSFCluster"}
_DEFAULTS = {"cores": 1, "memory": "4GB", "walltime": "01:00:00"}
_MARGIN_S = 60.0
"""Seconds before the end of its job at which a worker ends."""


def open_queue(job: jobs.Job, queue: str, count: int, config: str | None, stack: Any) -> tuple[DaskCrew, str]:
    """Requests `count` workers from the queue, and later new workers in place of lost ones. Raises UsageError and
    RunError."""
    quiet()
    distributed = need("distributed", "Dask distributed")
    cluster = stack.enter_context(make_cluster(queue, read_config(config)))
    client = stack.enter_context(distributed.Client(cluster))

    def keep_up() -> None:
        # A job that has ended frees its place. Requesting the same number again starts another job.
        cluster.scale(jobs=count)

    keep_up()
    return DaskCrew(client, job, float("inf"), keep_up), f"{count} jobs of {queue}"


def make_cluster(queue: str, config: dict[str, Any]) -> Any:
    """Returns a cluster of dask-jobqueue without starting any job. Raises UsageError."""
    jobqueue = need("dask_jobqueue", "dask-jobqueue")
    settings = {**_DEFAULTS, **config}
    cores, walltime = int(settings["cores"]), str(settings["walltime"])
    life_s = max(_MARGIN_S, seconds_of(walltime) - _MARGIN_S)
    settings["processes"] = 1
    settings["job_script_prologue"] = [
        *settings.get("job_script_prologue", []),
        f"export LP_NUM_THREADS={cores}",
        f"export PROMIN_FARM_ENDS_AT=$(( $(date +%s) + {life_s:.0f} ))",
    ]
    # Workers end before the queue kills them, and at different times.
    settings["worker_extra_args"] = [
        *settings.get("worker_extra_args", []),
        *("--nthreads", "1", "--lifetime", f"{life_s:.0f}s", "--lifetime-stagger", f"{_MARGIN_S / 2:.0f}s"),
    ]
    try:
        return getattr(jobqueue, QUEUES[queue])(**settings)
    except Exception as error:  # The type of the exception depends on the kind of fault.
        raise jobs.UsageError(
            f"the settings of the queue are not settings of dask-jobqueue ({error}), in --queue-config"
        ) from error


def read_config(file: str | None) -> dict[str, Any]:
    """Returns arguments for the classes of dask-jobqueue, read from a TOML file. Raises UsageError."""
    if file is None:
        return {}
    tomllib = need("tomllib", "Python 3.11")
    try:
        values: dict[str, Any] = tomllib.loads(Path(file).read_text())
    except (OSError, ValueError) as error:
        raise jobs.UsageError(f"the settings cannot be read ({error}), {file}; see docs/farm.md") from error
    return values


def seconds_of(walltime: str) -> float:
    """Returns the seconds of a time "HH:MM:SS", "HH:MM" or "D-HH:MM:SS". Raises UsageError."""
    found = re.fullmatch(r"(?:(\d+)-)?(\d+):(\d+)(?::(\d+))?", walltime)
    if not found:
        raise jobs.UsageError(f"walltime is {walltime!r}, in --queue-config; give HH:MM:SS")
    days, hours, minutes, seconds = (int(word or 0) for word in found.groups())
    return ((days * 24 + hours) * 60 + minutes) * 60.0 + seconds
