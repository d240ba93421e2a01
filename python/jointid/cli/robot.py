"""`jointid identify --robot`: all joints of a robot together."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import TYPE_CHECKING

from jointid.base.errors import InputError
from jointid.cli.arguments import as_given, gear_ratios, how_to_read, joints_wanted, with_terms
from jointid.cli.outputs import check_folder, check_page
from jointid.cli.wording import ADVICE, Wording

if TYPE_CHECKING:
    from jointid.robot.result import RobotEstimate

_OF_ONE_JOINT = (
    *("joint", "checkpoint", "resume", "selftest", "causes", "shift", "residual"),
    *("torque_hold", "population", "generations"),
)


def identify_whole_robot(arguments: argparse.Namespace) -> int:
    """Identify all joints of a robot from one recording or several."""
    from jointid.recording.readers.loading_robot import load_robot
    from jointid.report.robot_page import save_robot_report
    from jointid.robot.identifying import identify_robot
    from jointid.robot.robot import Robot

    _check(arguments)
    model = with_terms(arguments.model, arguments)
    robot = Robot.from_urdf(
        arguments.robot, gear_ratios=gear_ratios(arguments), facts=arguments.facts
    )
    try:
        recordings = [
            load_robot(
                path,
                joints_wanted(arguments) or None,
                gear_ratio=robot.gear_ratios,
                **how_to_read(arguments, [model]),
            )
            for path in arguments.recordings
        ]
    except InputError as error:
        raise as_given(error, arguments) from None
    found = identify_robot(
        recordings,
        robot,
        inertia=arguments.inertia or "urdf",
        model=model,
        windows=arguments.windows,
        min_speed=arguments.min_speed,
    )
    draws = arguments.bootstrap
    drawn = found.bootstrap(draws, arguments.seed) if draws is not None else None
    if arguments.report is not None:
        save_robot_report(found, arguments.report, action=ADVICE.of_action)
    if arguments.save is not None:
        found.save(arguments.save)
    if arguments.json:
        done = {} if drawn is None else {"bootstrap": drawn.document()}
        print(json.dumps(found.document() | done, indent=1, ensure_ascii=False, allow_nan=False))
    else:
        from jointid.robot.tables import text_report

        print(text_report(found, action=Wording.of(arguments).of_action))
        if drawn is not None:
            print(f"\n{drawn.report()}")
        lines = [
            f"{what}: {path}"
            for what, path in (("report", arguments.report), ("estimate", arguments.save))
            if path is not None
        ]
        if lines:
            print("", *lines, sep="\n")
    return 0


def saved_robot(path: Path) -> RobotEstimate | None:
    """The estimate of a whole robot that a file holds; None if it is another file.

    Raises
    ------
    InputError
        It is one, and cannot be used.
    """
    from jointid.base.schema import read_text
    from jointid.robot.document import KIND
    from jointid.robot.result import RobotEstimate

    if path.suffix.lower() != ".json":
        return None
    try:
        document = json.loads(read_text(path))
    except (ValueError, RecursionError):  # another reader says what is wrong
        return None
    kind = document.get("kind") if isinstance(document, dict) else None
    return RobotEstimate.load(path) if kind == KIND else None


def _check(arguments: argparse.Namespace) -> None:
    """Refuse what holds for one joint only, before the work."""
    for name in _OF_ONE_JOINT:
        if getattr(arguments, name) not in (None, False):
            raise InputError(
                "this is for one joint, not for a robot",
                argument=f"ga.{name}" if name in ("population", "generations") else name,
            )
    for name in ("set", "drop_copies", "drop_invalid"):
        if getattr(arguments, name):
            raise InputError(
                "this is for one joint, not for a robot",
                argument="parameters" if name == "set" else name,
            )
    save = arguments.save
    if save is not None and save.suffix != ".json":
        raise InputError("a robot's estimate is saved as .json", argument="save", value=save)
    check_folder("save", save)
    check_page("report", arguments.report)
