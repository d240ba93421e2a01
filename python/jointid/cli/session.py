"""Command `run`: a joint on a real or emulated bench is moved and identified in turn."""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from jointid.base.errors import InputError
from jointid.cli.arguments import whole, whole_seed
from jointid.cli.outputs import check_folder, check_output_folder
from jointid.cli.proof import missing_certificate
from jointid.cli.run_messages import (
    document,
    motor_and_recording,
    motor_off,
    motor_off_before,
    refused,
    stopped,
)
from jointid.cli.wording import ADVICE, Wording

if TYPE_CHECKING:
    from jointid.commissioning import Commissioning
    from jointid.estimate.estimate import Estimate
    from jointid.hardware.bench.bench import Bench
    from jointid.hardware.live.console import Observers

STOPPED = 3
"""Exit code if a limit, a fault or the user stopped a session, or if it was refused."""


def add_run(run: argparse.ArgumentParser) -> None:
    """Add the command's grammar."""
    run.epilog = (
        "examples:\n"
        "  jointid run joint.toml --cycles 2 --emulate --output runs\n"
        "  jointid run joint.toml --dry-run\n"
        "  jointid run joint.toml --cycles 2 --output runs --save joint.toml\n"
        "the joint file has a table [session]: examples/hardware/joint.toml; read docs/safety.md before\n"
        "the first motion of a real joint. Exit code 3: stopped by a limit, a fault or you, or refused."
    )
    run.add_argument("joint", type=Path, help="joint file (.toml) with a table [session]")
    run.add_argument(
        "--cycles", type=whole, default=2, help="number of cycles (default 2); 0: only record"
    )
    run.add_argument(
        "--emulate", action="store_true", help="use an emulated drive and joint on virtual time"
    )
    run.add_argument(
        "--dry-run", action="store_true", help="only run the pre-flight checks; the motor stays off"
    )
    run.add_argument("--yes", action="store_true", help="do not ask before a real joint moves")
    run.add_argument(
        "--force",
        action="store_true",
        help="move a real joint whose bench has no valid certificate of `jointid first-motion`",
    )
    run.add_argument(
        "--seed",
        type=whole_seed,
        default=0,
        help="seed of emulated noise and search (default 0)",
    )
    run.add_argument(
        "--threads", type=whole, default=0, help="threads of the search (default 0: all cores)"
    )
    run.add_argument(
        "--output",
        type=Path,
        help=("folder for recordings, frame logs, estimates, report.html, ring.json and ring.txt"),
    )
    run.add_argument("--save", type=Path, help="write the last estimate to a joint file (.toml)")
    run.add_argument("--plot", action="store_true", help="show the motion in a window")
    run.add_argument("--json", action="store_true", help="print the outcome as JSON")
    run.add_argument("--quiet", action="store_true", help="no progress messages")


def run(arguments: argparse.Namespace) -> int:
    """Run and identify a joint on its bench in turn. Return the exit code."""
    from jointid.base.files import write_whole
    from jointid.cli.bench_settings import in_force
    from jointid.commissioning import commission
    from jointid.hardware.bench.bench import Bench
    from jointid.hardware.bench.opened_drive import open_drive
    from jointid.hardware.session.session import Session, SessionRefusedError, SessionStoppedError

    _check(arguments)
    bench = Bench.load(arguments.joint)
    _check_motion(arguments)
    as_json, output = arguments.json, arguments.output
    if bench.motion_warning:
        print(f"jointid run: warning: {bench.motion_warning}", file=sys.stderr)
    if arguments.dry_run and not as_json:
        print(in_force(arguments.joint, bench).text())
    try:
        if not (arguments.emulate or arguments.force):
            missing = missing_certificate(arguments.joint, bench)
            if missing:
                refused("run", "certificate", missing, as_json=as_json)
                return STOPPED
        if arguments.dry_run:
            with open_drive(bench, emulate=arguments.emulate, seed=arguments.seed) as drive:
                Session(
                    drive, bench.controller, bench.trajectory, bench.limits, options=bench.options
                ).run(dry_run=True)
            _say_passed(arguments, bench)
            return 0
        if not (arguments.emulate or arguments.yes):
            with open_drive(bench):  # a missing bus is reported before the user is asked
                pass
        if not (arguments.emulate or arguments.yes or _agreed(bench)):
            refused("run", "not_agreed", "not started", as_json=as_json)
            return STOPPED
        with _observers(arguments) as observers:
            result = commission(
                bench,
                cycles=arguments.cycles,
                emulate=arguments.emulate,
                seed=arguments.seed,
                threads=arguments.threads,
                output=arguments.output,
                observer=observers,
                callback=None if arguments.quiet else _say,
                agree=None if arguments.emulate or arguments.yes else _agreed_again,
            )
    except SessionRefusedError as error:
        moved, off = motor_off_before(error)
        if moved:  # a later run was refused
            stopped("preflight", str(error), off, output, as_json=as_json)
        else:
            refused("run", "preflight", str(error), as_json=as_json)
        return STOPPED
    except SessionStoppedError as error:
        stop = error.stop
        stopped(stop.limit, str(error), stop.motor_off, output, as_json=as_json)
        _write_page_of(error, arguments.output)
        return STOPPED
    except (Exception, KeyboardInterrupt) as error:
        moved, off = motor_off_before(error)
        if moved and isinstance(error, KeyboardInterrupt):
            print(motor_and_recording(off, output), file=sys.stderr)
        elif moved:  # shown below the traceback
            error.add_note(motor_and_recording(off, output))
        raise
    if arguments.save is not None and result.blocked is None:
        if not arguments.save.exists():  # comments and the table [session] are kept
            write_whole(arguments.save, arguments.joint.read_bytes())
        result.estimates[-1].save(arguments.save)
    if arguments.output is not None:
        _write(result, arguments.output, _wording(arguments, result, output))
    if as_json:
        print(json.dumps(document(result, output), indent=1, ensure_ascii=False))
    else:
        print(result.report(_wording(arguments, result, output).of_action))
        if arguments.output is not None:
            written = "recordings, frame logs" + (", estimates" if result.estimates else "")
            print(f"\n{written} and report.html: {arguments.output}")
        print(motor_and_recording(motor_off(result), output))
    if result.blocked is not None:
        unsaved = "" if arguments.save is None else f"; {arguments.save} was not written"
        print(
            f"jointid run: the finding {result.blocked.code} is blocking: the joint was not moved with the "
            f"estimate{unsaved}",
            file=sys.stderr,
        )
        return STOPPED
    return 0


def _say_passed(arguments: argparse.Namespace, bench: Bench) -> None:
    from jointid.cli.bench_settings import in_force

    if arguments.json:
        found = {
            "status": "passed",
            "motion_warning": bench.motion_warning,
            "in_force": in_force(arguments.joint, bench).to_dict(),
        }
        print(json.dumps(found, indent=1, ensure_ascii=False))
    else:
        print("all pre-flight checks passed")


def _check(arguments: argparse.Namespace) -> None:
    """Refuse outputs that cannot be written, before the joint moves."""
    if arguments.cycles < 0:
        raise InputError("at least 0 is expected", argument="cycles", value=arguments.cycles)
    if arguments.cycles == 0 and arguments.save is not None:
        raise InputError(
            "with 0 cycles, nothing is identified and no joint file is written",
            argument="save",
            value=arguments.save,
        )
    if arguments.cycles == 0 and arguments.output is None and not arguments.dry_run:
        raise InputError(
            "with 0 cycles, the session only records, but no folder for the recording is given",
            argument="cycles",
            value=arguments.cycles,
            remedy="give a folder: --output runs",
        )
    if arguments.save is not None and arguments.save.suffix != ".toml":
        raise InputError("a joint file ends in .toml", argument="save", value=arguments.save)
    check_folder("save", arguments.save)
    output = arguments.output
    if output is not None:
        check_output_folder("output", output)
        if output.is_dir() and any(output.iterdir()):
            raise InputError(
                "the folder is not empty, and a session does not overwrite files",
                argument="output",
                value=output,
                remedy="give another name",
            )


def _check_motion(arguments: argparse.Namespace) -> None:
    """Refuse to copy a bench file to a folder without its motion file."""
    from jointid.joint.joint_file import read_document

    save = arguments.save
    if save is None or save.exists() or save.resolve().parent == arguments.joint.resolve().parent:
        return
    motion = read_document(arguments.joint)["session"]["trajectory"].get("file", "/")
    if not Path(motion).is_absolute():
        raise InputError(
            f"the motion file {motion} is in the folder of {arguments.joint}; a joint file in another folder "
            "would not find this motion file",
            argument="save",
            value=save,
            remedy="give a name in the same folder",
        )


def _observers(arguments: argparse.Namespace) -> Observers:
    """Return a line on the console and a window; for an emulated joint only a requested window."""
    from jointid.hardware.live.console import ConsoleLine, Observers
    from jointid.hardware.live.plot import LivePlot

    shown: list[Any] = []
    if not arguments.quiet and not arguments.emulate:
        shown.append(ConsoleLine(sys.stderr))
    if arguments.plot:
        shown.append(LivePlot())
    return Observers(*shown)


def _say(step: str) -> None:
    print(step, file=sys.stderr)


def _agreed(bench: Bench) -> bool:
    """Return whether the user agrees that the real joint moves."""
    low, high = bench.limits.position
    print(
        f"joint '{bench.joint.name}' ({bench.address}) will move between {low:.3g} and {high:.3g} rad with up to "
        f"{bench.limits.torque:.4g} N·m, about {bench.trajectory.duration:.3g} s per run.",
        file=sys.stderr,
    )
    if not sys.stdin.isatty():
        print("use --yes to start without this question", file=sys.stderr)
        return False
    return _yes("Is the space free, and the emergency stop at hand? [yes/no] ")


def _agreed_again(estimate: Estimate) -> bool:
    """Return whether the user agrees that the joint moves with the identified values."""
    print(Wording("run").of_answer(estimate, verbose=False), file=sys.stderr)
    return _yes("Move the joint with these values? Is the space free? [yes/no] ")


def _yes(question: str) -> bool:
    """Return whether the user answers yes; the end of the input means no."""
    try:
        return input(question).strip() == "yes"
    except EOFError:
        return False


def _write_page_of(error: Exception, folder: Path | None) -> None:
    """Write the page of a stopped session from the data recorded until then."""
    from jointid.report.saving import save_report

    result = vars(error).get("outcome")
    if folder is None or result is None:
        return
    try:
        page = save_report(result, folder / "report.html", action=ADVICE.of_action)
    except OSError as failure:  # the cause may also have stopped the recording
        print(f"no report was written: {failure}", file=sys.stderr)
    else:
        print(f"report: {page}", file=sys.stderr)


def _wording(arguments: argparse.Namespace, result: Commissioning, output: Path | None) -> Wording:
    """Return the wording of the command's advice, with its joint file and its last written estimate."""
    saved = "ESTIMATE" if output is None else str(output / f"cycle_{len(result.estimates)}.json")
    return Wording("run", joint_file=str(arguments.joint), saved=saved)


def _write(result: Commissioning, folder: Path, wording: Wording) -> None:
    """Write the session's page, and its outcome as text and numbers."""
    from jointid.base.files import write_whole
    from jointid.report.saving import save_report

    save_report(result, folder / "report.html", action=ADVICE.of_action)
    write_whole(folder / "ring.txt", (result.report(wording.of_action) + "\n").encode())
    write_whole(folder / "ring.json", json.dumps(result.to_dict(), indent=1).encode())
