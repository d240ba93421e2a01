"""Commands `check` and `first-motion`, and the certificate that `run` requires before it moves a real joint."""

from __future__ import annotations

import argparse
import json
import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from jointid.base.errors import InputError
from jointid.cli.arguments import decimal, whole_seed

if TYPE_CHECKING:
    from jointid.hardware.bench.bench import Bench
    from jointid.hardware.proof.sizes import Sizes
    from jointid.hardware.session.watchdog import Watchdog

REFUSED = 3
"""Exit code if a bench is refused."""


def add_check(check: argparse.ArgumentParser) -> None:
    """Add the command's grammar."""
    check.epilog = (
        "examples:\n"
        "  jointid check joint.toml\n"
        "  jointid check joint.toml --emulate\n"
        "the command only reads; the motor stays off. Exit code 3: the joint must not be moved yet."
    )
    _add_common(check, "print the report as JSON")


def add_first_motion(first: argparse.ArgumentParser) -> None:
    """Add the command's grammar."""
    first.epilog = (
        "examples:\n"
        "  jointid first-motion joint.toml --emulate\n"
        "  jointid first-motion joint.toml\n"
        "  jointid first-motion joint.toml --unknown-friction --largest-torque 20\n"
        "a real bench that passes gets the certificate that `jointid run` needs, next to the joint file.\n"
        "First read docs/safety.md, and run `jointid check`: it shows how far the joint will move,\n"
        "0.4°, or 40 counts of a coarse encoder. Exit code 3: the bench is refused."
    )
    _add_common(first, "print result, reason, travel, torques, signs and unchecked items as JSON")
    first.add_argument("--yes", action="store_true", help="do not ask before a real joint moves")
    first.add_argument(
        "--largest-torque",
        type=decimal,
        help="largest torque until the joint first moves [N·m, by the joint file's constants]; default: five times the "
        "friction in the joint file, but not above the torque limit",
    )
    first.add_argument(
        "--unknown-friction",
        action="store_true",
        help="the joint file's friction is only a guess: do not check gear ratio and torque constant with this value",
    )
    first.add_argument(
        "--watchdog",
        action="store_true",
        help="at the end, command zero torque and stop sending; the drive must then stop its motor",
    )
    first.add_argument("--quiet", action="store_true", help="do not print the steps")


def _add_common(command: Any, printed: str) -> None:
    command.add_argument("joint", type=Path, help="joint file (.toml) with a table [session]")
    command.add_argument(
        "--emulate", action="store_true", help="use an emulated drive and joint on virtual time"
    )
    command.add_argument("--json", action="store_true", help=printed)
    command.add_argument(
        "--seed", type=whole_seed, default=0, help="seed of the emulated noise (default 0)"
    )


def check(arguments: argparse.Namespace) -> int:
    """Show the connected drive."""
    from jointid.cli.bench_settings import in_force
    from jointid.hardware.bench.bench import Bench
    from jointid.hardware.proof.check import check_bench

    bench = Bench.load(arguments.joint)
    settings = in_force(arguments.joint, bench)
    found = check_bench(bench, emulate=arguments.emulate, seed=arguments.seed)
    certified = (
        None
        if arguments.emulate
        else _objections(arguments.joint, bench, found.identity, found.declared)
    )
    if arguments.json:
        document = {**found.to_dict(), "certificate": certified, "in_force": settings.to_dict()}
        print(json.dumps(document, indent=1, ensure_ascii=False))
    else:
        print(settings.text())
        print(found.text())
        if certified is not None:
            remedy = "; run `jointid first-motion` before `jointid run`"
            print(f"certificate: {'; '.join(certified) + remedy if certified else 'holds'}")
            for note in _notes(arguments.joint, bench, found.identity):
                print(f"note: {note}")
    return 0 if found.passed else REFUSED


def first_motion(arguments: argparse.Namespace) -> int:
    """Move a joint for the first time. A real joint that passes gets a certificate."""
    from jointid.hardware.bench.bench import Bench
    from jointid.hardware.bench.opened_drive import open_drive
    from jointid.hardware.proof.certificate import Certificate, certificate_path
    from jointid.hardware.proof.certified_limits import NO_SERIAL
    from jointid.hardware.proof.procedure import first_motion as move
    from jointid.hardware.proof.result import UNCHECKED
    from jointid.hardware.proof.sizes import resolution_of, sizes_of

    bench = Bench.load(arguments.joint)
    options = bench.first_motion
    if arguments.largest_torque is not None:
        options = replace(options, largest_torque=arguments.largest_torque)
    if arguments.unknown_friction:
        options = replace(options, compare_friction=False)
    bench = replace(bench, first_motion=options)
    if not (arguments.emulate or arguments.yes):
        with open_drive(bench) as drive:  # a missing bus is reported before the user is asked
            sizes = sizes_of(options, resolution_of(bench, drive))
    if not (arguments.emulate or arguments.yes or _agreed(bench, sizes)):
        print("jointid first-motion: not started", file=sys.stderr)
        return REFUSED
    show = not (arguments.quiet or arguments.json)
    result = move(
        bench,
        emulate=arguments.emulate,
        seed=arguments.seed,
        callback=_show if show else None,
        watchdog=arguments.watchdog,
    )
    if arguments.json:
        print(json.dumps(result.to_dict(), indent=1, ensure_ascii=False))
    else:
        print(result.verdict())
    if not result.passed and arguments.json:
        print(f"jointid first-motion: refused ({result.reason}): {result.message}", file=sys.stderr)
    if not result.passed:
        return REFUSED
    if not arguments.emulate:
        if result.uncertified:
            print(f"jointid first-motion: no certificate: {result.uncertified}", file=sys.stderr)
            return REFUSED
        path = certificate_path(arguments.joint)
        Certificate.of(bench, result).save(path)
        print(f"certificate: {path}", file=sys.stderr)
        if NO_SERIAL in result.unchecked:
            print(f"jointid first-motion: warning: {UNCHECKED[NO_SERIAL]}", file=sys.stderr)
    return 0


def missing_certificate(joint_file: Path, bench: Bench) -> str:
    """Return why `run` must not move a real joint; empty if its certificate is valid.

    Facts that the certificate does not prove are printed as notes. The drive reports its identity; its motor stays off.

    Parameters
    ----------
    joint_file : Path
    bench : Bench

    Raises
    ------
    InputError
        The certificate cannot be read, or the drive cannot be opened.
    """
    from jointid.hardware.bench.opened_drive import open_drive
    from jointid.hardware.session.drive import DriveFaultError
    from jointid.hardware.session.watchdog import watchdog_of

    objections = _objections(joint_file, bench, None, None)
    notes: list[str] = []
    if not objections:
        try:
            with open_drive(bench) as drive:
                try:
                    drive.connect(bench.options.period)
                    objections = _objections(
                        joint_file, bench, drive.identity(), watchdog_of(drive)
                    )
                    notes = _notes(joint_file, bench, drive.identity())
                finally:
                    drive.disable()
                    drive.close()
        except (DriveFaultError, OSError) as error:
            return f"the drive does not report its identity: {error}"
    if not objections:
        for note in notes:
            print(f"jointid run: note: {note}", file=sys.stderr)
        return ""
    return (
        "this bench is not certified: "
        + "; ".join(objections)
        + "; run `jointid first-motion` first, or use --force"
    )


def _objections(
    joint_file: Path, bench: Bench, identity: Any, watchdog: Watchdog | None
) -> list[str]:
    """Return the objections to the certificate of a joint file."""
    from jointid.hardware.proof.certificate import Certificate, certificate_path

    path = certificate_path(joint_file)
    if not path.exists():
        return [f"there is no {path.name}"]
    try:
        return Certificate.load(path).objections(bench, identity, watchdog=watchdog)
    except InputError as error:
        return [str(error)]


def _notes(joint_file: Path, bench: Bench, identity: Any) -> list[str]:
    """Return the facts that a joint file's certificate does not prove; empty without a certificate."""
    from jointid.hardware.proof.certificate import Certificate, certificate_path

    try:
        return Certificate.load(certificate_path(joint_file)).notes(bench, identity)
    except InputError:
        return []  # already reported as an objection


def _show(line: str) -> None:
    print(line, flush=True)


def _agreed(bench: Bench, sizes: Sizes) -> bool:
    """Return whether the user agrees that the real joint moves."""
    print(
        f"joint '{bench.joint.name}' ({bench.address}) will move by {sizes}. With a wrong gear ratio, the joint "
        "moves farther.",
        file=sys.stderr,
    )
    if not sys.stdin.isatty():
        print("use --yes to start without this question", file=sys.stderr)
        return False
    try:
        return (
            input("Is the space free, and the emergency stop at hand? [yes/no] ").strip() == "yes"
        )
    except EOFError:
        return False
