"""Command `jointid identify` for a servo: the drive's input is a voltage, and the runs are files or folders."""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.cli.arguments import with_terms
from jointid.cli.joint_options import joint_of
from jointid.cli.options import stated_options
from jointid.cli.outputs import check_outputs, estimate_file, say_written
from jointid.cli.reading import as_given, how_to_read
from jointid.cli.requirement import required
from jointid.cli.wording import Wording

if TYPE_CHECKING:
    from jointid.joint.joint import Joint
    from jointid.joint.voltage_drive import VoltageDrive
    from jointid.recording.recording import Recording

# Options that need a known torque.
_OF_TORQUE = (
    *("checkpoint", "resume", "selftest", "bootstrap", "causes", "population", "generations"),
    "terms",
)
# For each option of `identify`: its name for a servo.
_OF_SERVOS = {"windows": "window", "min_speed": "slowest", "parameters": "parameters"}


def identify_runs(arguments: argparse.Namespace, joint: Joint) -> int:
    """Identify a servo from its runs. With --rollout, compare its simulated closed loop with them.

    Parameters
    ----------
    arguments : Namespace
        Arguments of `jointid identify`.
    joint : Joint
        Joint with a voltage drive.
    """
    from jointid.report.saving import save_report
    from jointid.servo.answers import answer
    from jointid.servo.identifying import identify_servo
    from jointid.servo.rolling_out import rollout
    from jointid.servo.tables import text_report

    options = _checked(arguments)
    drive = joint.voltage
    assert drive is not None
    values = options.pop("parameters", {})
    runs = _load(arguments, drive)
    joint = joint_of(arguments, joint, runs) or joint  # with the facts from options
    joint = joint.replace(parameters=_fixed(joint, values))
    found = identify_servo(
        runs, joint, model=with_terms(arguments.model, arguments), seed=arguments.seed, **options
    )
    wanted = arguments.rollout or arguments.report is not None
    rolled = rollout(found, runs, threads=arguments.threads) if wanted else None
    wording, saved = Wording.of(arguments), estimate_file(arguments)
    if arguments.report is not None:
        save_report(found, arguments.report, wording.of_command, rollout=rolled)
    for path in {saved, arguments.save} - {None}:
        found.save(path)
    if arguments.json:
        document = found.document() | ({} if rolled is None else {"rollout": rolled.document()})
        print(json.dumps(document, indent=1, ensure_ascii=False, allow_nan=False))
        return required({"": found.verdict}, arguments)
    if arguments.verbose:
        print(text_report(found, wording.of_command))
        if rolled is not None:
            print(f"\nRollouts of the closed loop, compared with the logs\n{rolled.report()}")
    else:
        error = None if rolled is None else rolled.median
        print(answer(found, wording.of_command, wording.saved_file, error))
    joint_file = arguments.save if arguments.save != saved else None
    say_written(report=arguments.report, estimate=saved, joint_file=joint_file)
    return required({"": found.verdict}, arguments)


def _checked(arguments: argparse.Namespace) -> dict[str, Any]:
    """Return the options of a servo. Refuse options that need a torque signal, before the work."""
    options = stated_options(arguments)
    stated = (name for name in _OF_TORQUE if getattr(arguments, name) not in (None, False))
    for name in (*stated, *(name for name in options if name not in _OF_SERVOS)):
        raise InputError(
            "a servo with a voltage as input has no such option",
            argument="n" if name == "bootstrap" else name,
        )
    check_outputs(arguments)
    if "windows" in options:
        options["windows"] = _duration(options["windows"])
    return {_OF_SERVOS[name]: value for name, value in options.items()}


def _duration(windows: object) -> float:
    if not isinstance(windows, float):
        raise InputError(
            "a duration such as 0.05s is expected for a servo", argument="windows", value=windows
        )
    return windows


def _fixed(joint: Joint, values: dict[str, float]) -> dict[str, Any]:
    return {
        **{name: replace(p) for name, p in joint.parameters.items()},
        **{name: _parameter(name, value) for name, value in values.items()},
    }


def _parameter(name: str, value: float) -> Any:
    from jointid.joint.parameters import Parameter

    return Parameter(name=name, value=value, vary=False)


def _load(arguments: argparse.Namespace, drive: VoltageDrive) -> list[Recording]:
    """Return the runs of files and folders, with the extra signals of a servo."""
    from jointid.recording.readers.folders import files_of
    from jointid.recording.readers.loading import load, load_runs
    from jointid.verbs.servo_log import servo_columns

    paths = files_of(arguments.recordings)
    reading = how_to_read(arguments)
    parts = {name: reading[name] for name in ("topic", "group", "unpacked")}
    try:
        first = servo_columns(paths[0], drive, reading.pop("extra") or {}, **parts)
        if arguments.by is None:
            drops = {name: getattr(arguments, name) for name in ("drop_copies", "drop_invalid")}
            return [load(path, extra=first, **drops, **reading) for path in paths]
        if reading.pop("where"):
            raise InputError("with --by, all rows of each run are read", argument="where")
        return [
            run
            for path in paths
            for run in load_runs(path, by=arguments.by, extra=first, **reading)
        ]
    except InputError as error:
        raise _of_all_runs(as_given(error, arguments)) from None


def _of_all_runs(error: InputError) -> InputError:
    """Return an error about a file of several runs. All runs are one fit; a single run is not sufficient."""
    every = [
        replace(each, function="identify")
        for each in error.remedy
        if isinstance(each, Action) and each.function == "load_runs"
    ]
    if not every:
        return error
    return InputError(
        error.reason,
        argument=error.argument,
        value=error.value,
        place=error.place,
        remedy=tuple(every),
    )


def _files(paths: Sequence[Path]) -> list[Path]:
    """Return the files, and those in folders, sorted by name."""
    from jointid.recording.readers.registry import endings

    found: list[Path] = []
    for path in paths:
        if not path.is_dir():
            found.append(path)
            continue
        inside = sorted(each for each in path.iterdir() if each.name.endswith(endings()))
        # A .json file next to other recordings is an estimate, or the settings of a logger.
        inside = [each for each in inside if each.suffix != ".json"] or inside
        if not inside:
            raise InputError("there is no recording in this folder", place=str(path))
        found += inside
    return found
