"""Command `jointid identify --joints`: several joints of one file."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import replace

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.cli.arguments import with_terms
from jointid.cli.exit_codes import BAD_INPUT
from jointid.cli.joint_options import facts_of, joint_file, with_facts
from jointid.cli.options import stated_options
from jointid.cli.outputs import check_folder, check_page, estimate_file, say_written
from jointid.cli.progress import JointsProgress
from jointid.cli.reading import as_given, how_to_read, numbers_of_joints
from jointid.cli.requirement import required
from jointid.cli.wording import Wording

_MARK = "{joint}"
_OF_ONE_JOINT = ("checkpoint", "resume", "selftest", "bootstrap", "causes")


def identify_several(arguments: argparse.Namespace, joints: Sequence[str]) -> int:
    """Identify several joints of one file separately.

    Parameters
    ----------
    arguments : Namespace
        Arguments of `jointid identify`.
    joints : sequence of str
        Names of the joints; empty for all.
    """
    from jointid._core import GaOptions
    from jointid.identification.search.search import Search
    from jointid.joint.joint import Joint
    from jointid.joints.identifying import identify_joints
    from jointid.recording.readers.loading_robot import load_robot
    from jointid.report.saving import save_report

    _check(arguments)
    options = stated_options(arguments)
    budget = {
        name: getattr(arguments, name)
        for name in ("population", "generations")
        if getattr(arguments, name) is not None
    }
    of_each = arguments.joint is not None and _MARK in str(arguments.joint)
    joint: Joint | dict[str, Joint] | None = None
    model = with_terms(arguments.model, arguments)
    merged = model
    file = None if of_each else joint_file(arguments)
    if file is not None:
        merged = model.over(file.model)
    constants = numbers_of_joints(arguments, "torque_constant")
    try:
        robot = load_robot(
            arguments.recordings[0],
            list(joints) or None,
            gear_ratio=numbers_of_joints(arguments, "gear_ratio"),
            drop_invalid=arguments.drop_invalid,
            **how_to_read(arguments, [merged]),
        )
    except InputError as error:
        raise as_given(error, arguments) from None
    if constants is not None:
        robot = robot.with_torque_constants(constants)
    facts = {k: v for k, v in facts_of(arguments, file).items() if k != "torque_constant"}
    if of_each:
        wanted = joints or robot.names
        files = {name: Joint.load(str(arguments.joint).replace(_MARK, name)) for name in wanted}
        joint = {name: each.replace(**facts) for name, each in files.items()}
    elif facts.keys() <= {"gear_ratio"}:  # the recording contains it
        joint = file
    else:
        joint = with_facts(file, facts, "", robot.kind, sensor=robot.sensor is not None)
    with JointsProgress(enabled=not arguments.quiet) as progress:
        found = identify_joints(
            robot,
            joint=joint,
            model=model,
            search=Search(
                arguments.method,
                ga=GaOptions(**budget) if budget else None,
                seed=arguments.seed,
                threads=arguments.threads,
            ),
            callback=progress,
            **options,
        )
    wording, saved = Wording.of(arguments), estimate_file(arguments)
    if arguments.report is not None:
        # A page has the same wording for all joints, so its commands cannot name the joint to design for.
        save_report(found, arguments.report, action=replace(wording, saved="ESTIMATE").of_command)
    if saved is not None:
        found.save(saved)
    if arguments.json:
        print(found.to_json())
    else:
        from jointid.joints.answers import answer
        from jointid.joints.tables import text_report

        def of_joint(action: Action, joint: str) -> str:
            own = wording.joint_file.replace(_MARK, joint)
            return replace(wording, joint=joint, joint_file=own).of_command(action)

        if arguments.verbose:
            print(text_report(found, action=of_joint, error=wording.of_error))
        else:
            print(answer(found, of_joint, wording.of_error, wording.saved_file))
        say_written(report=arguments.report, estimate=saved)
    if not len(found):
        return BAD_INPUT
    verdicts = {
        name: None if each.estimate is None else each.estimate.verdict
        for name, each in found.results.items()
    }
    return required(verdicts, arguments)


def _check(arguments: argparse.Namespace) -> None:
    """Refuse options that are valid for one joint only, before the work."""
    if len(arguments.recordings) > 1:
        raise InputError(
            "several joints can only be identified from one recording",
            argument="joints",
            value=arguments.joints,
        )
    for name in _OF_ONE_JOINT:
        if getattr(arguments, name) not in (None, False):
            raise InputError(
                "this option is for one joint; name the joint with --joints",
                argument="n" if name == "bootstrap" else name,
            )
    if arguments.drop_copies:
        raise InputError("this option is for one joint", argument="drop_copies", value=True)
    save = arguments.save
    if save is not None and save.suffix != ".json":
        raise InputError(
            "the estimates of several joints are saved as .json", argument="save", value=save
        )
    check_folder("save", save)
    check_page("report", arguments.report)
