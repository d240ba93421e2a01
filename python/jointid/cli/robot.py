"""Commands `jointid identify --robot` and `compare --robot`: all joints of a robot together."""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from jointid.base.errors import InputError
from jointid.base.options import options_of
from jointid.cli.advice import without_options
from jointid.cli.arguments import models_by_joint, with_terms
from jointid.cli.options import stated_options
from jointid.cli.outputs import check_folder, check_page, estimate_file, say_written
from jointid.cli.reading import as_given, how_to_read, joints_wanted, numbers_of_joints
from jointid.cli.requirement import required
from jointid.cli.wording import Wording

if TYPE_CHECKING:
    from jointid.robot.links.robot import Robot
    from jointid.robot.result.result import RobotEstimate

_OF_ONE_JOINT = ("joint", "checkpoint", "resume", "selftest", "causes", "population", "generations")
_READ = ("torque_hold", "terms")  # used for the recordings and for the model


def identify_whole_robot(arguments: argparse.Namespace) -> int:
    """Identify all joints of a robot from one recording or several."""
    from jointid.report.saving import save_report
    from jointid.robot.identifying import identify_robot
    from jointid.robot.rollout.rolling_out import rollout_robot

    options = _checked(arguments)
    model = models_by_joint(arguments.model or "") or with_terms(arguments.model, arguments)
    robot, recordings = _read(arguments, [] if isinstance(model, dict) else [model])
    found = identify_robot(
        recordings,
        robot,
        inertia=arguments.inertia or "urdf",
        model=model,
        **options,
    )
    draws = arguments.bootstrap
    drawn = found.bootstrap(draws, arguments.seed) if draws is not None else None
    wording, saved = Wording.of(arguments), estimate_file(arguments)
    rolled, without = None, ""
    if arguments.rollout:
        try:
            rolled = rollout_robot(found, recordings)
        except InputError as error:
            without = f"no rollout: {error.reason}"
    if arguments.report is not None:
        save_report(found, arguments.report, wording.of_command, rollout=rolled)
    if saved is not None:
        found.save(saved)
    if arguments.json:
        done = {} if drawn is None else {"bootstrap": drawn.to_dict()}
        done |= {} if rolled is None else {"rollout": rolled.to_dict()}
        print(json.dumps(found.document() | done, indent=1, ensure_ascii=False, allow_nan=False))
    else:
        from jointid.robot.result.answers import answer
        from jointid.robot.result.tables import text_report

        if arguments.verbose:
            print(text_report(found, wording.of_command))
        else:
            print(answer(found, wording.of_command, wording.saved_file))
        if drawn is not None:
            print(f"\n{drawn.report()}")
        if rolled is not None:
            print(f"\n{rolled.sentence}\n{rolled.report()}")
        elif without:
            print(without)
        say_written(report=arguments.report, estimate=saved)
    return required({"": found.verdict}, arguments)


def compare_whole_robot(arguments: argparse.Namespace) -> int:
    """Compare inertias and friction models of a robot by held-out data."""
    from jointid.joint.model import Model
    from jointid.report.saving import save_report
    from jointid.robot.comparing import compare_robot_models
    from jointid.robot.result.comparison_result import answer_of_comparison

    options = _checked(arguments)
    asked = {"models": arguments.models, "inertia": arguments.inertia}
    robot, recordings = _read(arguments, [Model.of(each) for each in arguments.models or (None,)])
    found = compare_robot_models(
        recordings,
        robot,
        folds=arguments.folds,
        **options,
        **{name: given for name, given in asked.items() if given is not None},
    )
    wording, saved = _of_identify(arguments, found.winner.inertia), estimate_file(arguments)
    if arguments.report is not None:
        save_report(found, arguments.report, action=wording.of_command)
    if saved is not None:
        found.estimate.save(saved)
    if arguments.json:
        print(found.to_json())
        return 0
    if arguments.verbose:
        print(found.report(verbose=True))
    else:
        print(answer_of_comparison(found, wording.of_command, wording.saved_file))
    say_written(report=arguments.report, estimate=saved)
    return 0


def _of_identify(arguments: argparse.Namespace, inertia: str) -> Wording:
    """Return the wording of `identify` with the chosen inertia, because that command can follow the advice."""
    wording = Wording.of(arguments)
    compared = ("--model", "--folds", "--inertia", "--report", "--save")
    kept = without_options(wording.typed[1:], compared)
    typed = ("identify", *kept, "--inertia", inertia)
    return replace(wording, command="identify", typed=typed if wording.typed else ())


def _read(arguments: argparse.Namespace, models: Sequence[Any]) -> tuple[Robot, list[Any]]:
    """Return the robot and its recordings."""
    from jointid.recording.readers.loading_robot import load_robot
    from jointid.robot.links.robot import Robot

    robot = Robot.from_urdf(
        arguments.robot,
        gear_ratios=numbers_of_joints(arguments, "gear_ratio"),
        torque_constants=numbers_of_joints(arguments, "torque_constant"),
        facts=arguments.facts,
    )
    try:
        return robot, [
            load_robot(
                path,
                joints_wanted(arguments) or None,
                torque_hold=arguments.torque_hold,
                drop_invalid=arguments.drop_invalid,
                **how_to_read(arguments, models),
            )
            for path in arguments.recordings
        ]
    except InputError as error:
        raise as_given(error, arguments) from None


def saved_robot(path: Path) -> RobotEstimate | None:
    """Return the estimate of a whole robot in a file; None for another file.

    Raises
    ------
    InputError
        The file is a robot's estimate, but cannot be used.
    """
    from jointid.base.schema import read_text
    from jointid.robot.result.document import KIND
    from jointid.robot.result.result import RobotEstimate

    if path.suffix.lower() != ".json":
        return None
    try:
        document = json.loads(read_text(path))
    except (ValueError, RecursionError):  # another reader reports the problem
        return None
    kind = document.get("kind") if isinstance(document, dict) else None
    return RobotEstimate.load(path) if kind == KIND else None


def _checked(arguments: argparse.Namespace) -> dict[str, Any]:
    """Return the options of a robot. Refuse options that are valid for one joint only, before the work."""
    from jointid.robot.options import RobotFitOptions

    options, own = stated_options(arguments), options_of(RobotFitOptions)
    for name in _OF_ONE_JOINT:
        if getattr(arguments, name, None) not in (None, False):
            raise InputError(
                "this option is for one joint, not for a robot",
                argument=f"ga.{name}" if name in ("population", "generations") else name,
            )
    of_one = [name for name in options if name not in (*own, *_READ)]
    copies = ["drop_copies"] * bool(getattr(arguments, "drop_copies", False))
    for name in (*of_one, *copies):
        raise InputError("this option is for one joint, not for a robot", argument=name)
    save = arguments.save
    if save is not None and save.suffix != ".json":
        raise InputError("a robot's estimate is saved as .json", argument="save", value=save)
    check_folder("save", save)
    check_page("report", arguments.report)
    return {name: value for name, value in options.items() if name in own}
