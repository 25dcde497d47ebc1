# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""The command line of promin-farm."""

from __future__ import annotations

import argparse
import json
import os
import shlex
import sys
import time
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from promin import jobs

from promin_farm.alone import Signals, find_share, work
from promin_farm.audit import audit
from promin_farm.errors import exit_code_of
from promin_farm.foreman import Tally
from promin_farm.run import Options, carry_on, check_outputs
from promin_farm.settings import Settings
from promin_farm.page import Page
from promin_farm.status import describe, to_json
from promin_farm.survey import take_survey
from promin_farm.watch import Progress, of_pieces

_EPILOG = """Examples:
  promin-farm render model.glb -o model.png --job job
  promin-farm resume job

Exit codes: 0 done; 1 a failure at run time, or pieces that failed permanently; 2 wrong command line;
3 bad input; 4 no device.
docs/farm.md explains how to run on one machine, on several, and in queues."""
_SCENES = (".glb", ".gltf", ".nff", ".obj", ".ply", ".stl")


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs a command and returns its exit code."""
    words = sys.argv[1:] if arguments is None else list(arguments)
    try:
        _check_first(words)
        options, others = _make_parser().parse_known_args(words)
        if "folder" in options:
            _check_folder(options.folder)
            options.folder = os.path.abspath(options.folder)
        if options.command in ("render", "cast"):
            return _begin(options, [word for word in others if word != "--"])
        if others:
            raise jobs.UsageError(f"{others[0]} is not known; see promin-farm {options.command} -h")
        commands = {"resume": _resume, "work": _work, "status": _status, "verify": _verify, "audit": _audit}
        return commands[options.command](options)
    except jobs.Error as error:
        first, *rest = str(error).splitlines()
        print("\n".join([f"promin-farm: {first}", *rest]), file=sys.stderr)
        return exit_code_of(error)
    except KeyboardInterrupt:
        sentence = "the run stopped; finished pieces are kept, and promin-farm resume continues"
        print(f"promin-farm: {sentence}", file=sys.stderr)
        return 1
    except BrokenPipeError:
        return 1


def _check_first(words: list[str]) -> None:
    """Raises UsageError if the first word is a scene or a job and not a command."""
    first = Path(words[0]) if words else Path()
    if first.suffix.lower() in _SCENES:
        raise jobs.UsageError(f"{first} is a scene, not a command; use: {_render_words(first)}")
    if (first / "job.json").is_file():
        raise jobs.UsageError(
            f"{first} is a job's folder, not a command; use: promin-farm status {first}, or promin-farm resume {first}"
        )


def _check_folder(folder: str) -> None:
    """Raises UsageError if the argument is a scene and not a job's folder."""
    if Path(folder).is_file():
        cure = f"; to make a job of it, use: {_render_words(Path(folder))}"
        is_scene = Path(folder).suffix.lower() in _SCENES
        raise jobs.UsageError(f"{folder} is a file, not a job's folder{cure if is_scene else ''}")


def _render_words(scene: Path) -> str:
    """Returns the command that renders a scene."""
    return shlex.join(["promin-farm", "render", str(scene), "-o", f"{scene.stem}.png", "--job", f"{scene.stem}.job"])


def _make_parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="promin-farm",
        description="Renders pictures and casts rays piece by piece on many processes and machines.",
        epilog=_EPILOG,
        allow_abbrev=False,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")

    def add(name: str, words: str, usage: str | None = None) -> argparse.ArgumentParser:
        return commands.add_parser(name, help=words, description=words, usage=usage, allow_abbrev=False)

    render = add(
        "render", "Render pictures", "promin-farm render SCENE -o OUT --job DIR [options] [options of promin render]"
    )
    cast = add(
        "cast",
        "Cast rays and write their hits",
        "promin-farm cast SCENE RAYS.npy|RAYS.zarr -o HITS --job DIR [options] [options of promin cast]",
    )
    for command in (render, cast):
        command.add_argument("--job", metavar="DIR", help="the job's folder, which all workers must be able to access")
        command.add_argument(
            "--prepare", action="store_true", help="only make the job's folder; promin-farm work makes the pieces"
        )
    resume = add("resume", "Make the missing pieces of a job, then write its files")
    resume.add_argument(
        "-o",
        "--output",
        metavar="FILE",
        action="append",
        default=[],
        help="file to write instead of the files that the job names",
    )
    for command in (render, cast, resume):
        _add_run_options(command)
    alone = add("work", "Make a share of a job's pieces in this process, without Dask")
    alone.add_argument(
        "--array-task",
        metavar="I/N",
        help="make every N-th piece, beginning with piece I, then any piece that is still missing [the task's number "
        "in a Slurm array]",
    )
    status = add("status", "Show the progress of a job")
    status.add_argument("--json", action="store_true", help="print JSON")
    status.add_argument("--page", action="store_true", help="also write the job's page, DIR/index.html")
    verify = add("verify", "Check every piece of a job by its hash")
    check = add("audit", "Make a sample of a job's pieces again and compare the results")
    check.add_argument(
        "--share", metavar="P", default="1%", help="fraction of the pieces to make, such as 5%% or 0.05 [1%%]"
    )
    check.add_argument("--seed", metavar="N", type=int, default=0, help="number that selects the sample [0]")
    for command in (resume, alone, status, verify, check):
        command.add_argument("folder", metavar="DIR", help="the job's folder")
    for command in (alone, check):
        command.add_argument("--device", metavar="NAME|INDEX", help="device to use, as for promin render")
    for command in (alone, verify, check):
        command.add_argument("--quiet", action="store_true", help="print only errors")
    return parser


def _add_run_options(command: argparse.ArgumentParser) -> None:
    add = command.add_argument
    add("--workers", metavar="N", type=int, help="number of processes, or of jobs in a queue [one per device]")
    add(
        "--device",
        metavar="NAME|INDEX|uuid:…",
        action="append",
        default=[],
        help="device of this machine to use. You may repeat this option; each device then gets separate workers",
    )
    add("--scheduler", metavar="tcp://…|slurm|pbs|lsf", help="a Dask scheduler, or the queue that starts workers")
    add(
        "--queue-config",
        metavar="FILE.toml",
        help="settings of the jobs in the queue, in the form that dask-jobqueue accepts",
    )
    add(
        "--allow-mixed",
        action="store_true",
        help="allow devices whose results differ in bits to share the work; each frame comes from one kind of device",
    )
    add("--quiet", action="store_true", help="print only errors")


def _begin(options: argparse.Namespace, arguments: list[str]) -> int:
    if not options.job:
        raise jobs.UsageError("there is no folder for the job; give one with --job DIR")
    spec = jobs.parse_arguments(options.command, arguments)
    options.output = _take_outputs(spec)
    if not options.output:
        raise jobs.UsageError("there is no output; give one with -o FILE")
    if options.command == "cast":
        from promin_farm.rays import prepare_rays  # Imported late, because loading NumPy takes a while.

        spec = prepare_rays(spec, Path(options.job))
    return _run(jobs.create(options.command, spec, os.path.abspath(options.job)), options)


def _take_outputs(spec: dict[str, Any]) -> list[str]:
    """Removes the outputs from a specification and returns them in the order in which the assembly writes them: first
    the pictures or hits, then the offsets of hits."""
    members = [spec.pop(name, []) for name in ("output", "offsets")]
    return [file for member in members for file in ([member] if isinstance(member, str) else member)]


def _resume(options: argparse.Namespace) -> int:
    return _run(jobs.open(options.folder), options)


def _run(job: jobs.Job, options: argparse.Namespace) -> int:
    folder = Path(job.folder)
    settings = Settings.read(folder).with_outputs(options.output)
    settings = replace(settings, allow_mixed=settings.allow_mixed or options.allow_mixed, retries_from=time.time())
    # A resumed job without output files needs no check.
    if settings.outputs:
        check_outputs(job, settings.outputs)
    settings.write(folder)
    if options.command != "resume" and options.prepare:
        if not options.quiet:
            pieces = of_pieces(len(job.pieces))
            print(f"{pieces} in {job.folder}; promin-farm work makes them, then promin-farm resume writes the files")
        return 0
    return carry_on(
        job,
        settings,
        Options(
            workers=options.workers,
            devices=options.device,
            scheduler=options.scheduler,
            queue_config=options.queue_config,
            is_quiet=options.quiet,
        ),
    )


def _work(options: argparse.Namespace) -> int:
    share = find_share(options.array_task)
    job = jobs.open(options.folder)
    watch = Progress(job, (), is_quiet=options.quiet)
    with Signals() as signals:
        tally = work(job, share, options.device, watch, signals)
    watch.close()
    if tally.reason:
        print(f"promin-farm: {tally.reason}", file=sys.stderr)
        return tally.exit_code
    survey = take_survey(job)
    left = survey.total - len(survey.done)
    if tally.was_stopped and left:
        print(f"promin-farm: the run stopped; promin-farm work {job.folder} continues", file=sys.stderr)
        return 1
    if not options.quiet:
        print(f"{of_pieces(tally.done)} made; {_words_of_left(left, job)}")
    return _tell_failed(tally)


def _words_of_left(left: int, job: jobs.Job) -> str:
    if left:
        return f"{left} of {len(job.pieces)} are missing or made by others"
    return f"all pieces are made; promin-farm resume {job.folder} writes the files"


def _tell_failed(tally: Tally) -> int:
    return 1 if tally.failed else 0


def _status(options: argparse.Namespace) -> int:
    job = jobs.open(options.folder)
    survey = take_survey(job)
    if options.page:
        Page(job).write(survey)
    print(json.dumps(to_json(job, survey), indent=1) if options.json else describe(job, survey))
    return 0


def _verify(options: argparse.Namespace) -> int:
    job = jobs.open(options.folder)
    states = {piece.number: job.state(piece.number) for piece in job.pieces}
    bad = [number for number, state in states.items() if state == "bad"]
    for number in bad:
        print(
            f"promin-farm: {job.pieces[number].file}: {job.why(number)}; promin-farm resume makes it again",
            file=sys.stderr,
        )
    missing = sum(state == "missing" for state in states.values())
    if not options.quiet:
        print(
            f"{len(states) - len(bad) - missing} of {len(states)} pieces are whole, {len(bad)} bad, {missing} missing"
        )
    return 1 if bad or missing else 0


def _audit(options: argparse.Namespace) -> int:
    job = jobs.open(options.folder)
    report = audit(job, options.share, options.seed, options.device)
    if not report.is_good:
        print(f"promin-farm: {job.folder}: an audit has found wrong pieces", file=sys.stderr)
    if not options.quiet or not report.is_good:
        print(report.describe(), file=sys.stdout if report.is_good else sys.stderr)
    return 0 if report.is_good else 1
