"""Joint of a command: a joint file, options for the facts that most joints need, or both."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from jointid.base.errors import InputError
from jointid.cli.arguments import decimal, number_or_text
from jointid.cli.reading import numbers_of_joints

if TYPE_CHECKING:
    from jointid.joint.joint import Joint
    from jointid.joint.model import Model
    from jointid.recording.recording import Recording

_DRIVE = ("rotor_inertia",)
# Field of a joint's link for each option.
_LINK = {"mass": "mass", "centre_of_mass": "centre_of_mass", "link_angle": "angle"}


def joint_arguments(command: argparse.ArgumentParser) -> None:
    """Add the joint file, and the facts that may replace or complement it."""
    command.add_argument("--joint", type=Path, help="joint file (.toml)")
    fact_arguments(command)


def fact_arguments(command: argparse.ArgumentParser) -> None:
    """Add the facts of a drive and its link. The gear ratio is an option of the reading."""
    command.add_argument(
        "--torque-constant",
        metavar="VALUE[,VALUE...]",
        help="torque constant of the motor [N·m/A], for a recorded current; one value for each joint",
    )
    for option, explanation in (
        (
            "--rotor-inertia",
            "inertia of the motor and all parts that turn with it, motor side [kg·m²]",
        ),
        ("--mass", "mass of the link [kg]; with --centre-of-mass, the weight of the link is known"),
        ("--centre-of-mass", "distance of the link's centre of mass from the axis [m]"),
    ):
        command.add_argument(option, type=decimal, metavar="VALUE", help=explanation)
    command.add_argument(
        "--link-angle",
        type=_angle,
        metavar="ANGLE",
        help="angle of the centre of mass above the horizontal at position 0: rad, or as 90deg (default 0)",
    )


def _angle(text: str) -> float:
    from jointid.joint.angles import in_radians

    number = number_or_text(text)
    value = in_radians(text) if isinstance(number, str) else number
    if isinstance(value, str):
        raise argparse.ArgumentTypeError(f"'{text}' is neither a number nor an angle such as 90deg")
    return float(value)


def joint_file(arguments: argparse.Namespace) -> Joint | None:
    """Return the joint of --joint; None without one. Options are checked, too, before a recording is read.

    Raises
    ------
    InputError
        The file does not exist or is not a joint file, or an option is not a number.
    """
    from jointid.joint.joint import Joint

    _inertia(arguments)
    return None if arguments.joint is None else Joint.load(arguments.joint)


def joint_of(
    arguments: argparse.Namespace, file: Joint | None, recordings: Sequence[Recording]
) -> Joint | None:
    """Return the joint of a command: its file with the options' facts, which have priority; None if nothing is known.

    Without a file, the joint has the kind of the recordings, and a sensor if they have one.

    Parameters
    ----------
    arguments : Namespace
        Arguments of a command with `joint_arguments`.
    file : Joint or None
        Result of `joint_file`.
    recordings : sequence of Recording

    Raises
    ------
    InputError
        A value cannot be used; the error names the option.
    """
    first = recordings[0]
    sensor = all(each.sensor is not None for each in recordings)
    return with_facts(file, facts_of(arguments, file), first.name, first.kind, sensor=sensor)


def with_facts(
    file: Joint | None, facts: Mapping[str, Any], name: str, kind: str, *, sensor: bool
) -> Joint | None:
    """Return a joint with some fields changed, or a new one with these fields; None without both.

    Parameters
    ----------
    file : Joint or None
    facts : mapping of str to object
        Fields of a joint, as from `facts_of`.
    name, kind, sensor
        Fields of a joint without a file.

    Raises
    ------
    InputError
        A value cannot be used; the error names the option.
    """
    from jointid.joint.joint import Joint
    from jointid.joint.model import Model

    if not facts:
        return file
    try:
        if file is not None:
            return file.replace(**weighed(facts, file.model, sensor=file.sensor))
        facts = weighed(facts, Model(), sensor=sensor) if kind == "revolute" else facts
        own: dict[str, Any] = {"name": name, "kind": kind, "sensor": sensor}
        return Joint(**own, **facts)
    except InputError as error:
        raise _of_option(error) from None


def weighed(facts: Mapping[str, Any], model: Model, *, sensor: bool) -> dict[str, Any]:
    """Return facts of a joint with the weight of a stated link: with a sensor it is measured, otherwise known.

    Parameters
    ----------
    facts : mapping of str to object
    model : Model
        Model of the joint file; its gravity is kept.
    sensor : bool
        Whether the joint has a torque sensor.
    """
    if "link" not in facts or sensor or model.gravity is not None:
        return dict(facts)
    return {**facts, "model": model.replace(gravity="known")}


def torque_needed(arguments: argparse.Namespace, file: Joint | None) -> Callable[[Recording], Any]:
    """Return a check that raises if a recording has no torque that the joint can convert to one at the output."""
    from jointid.problem.recordings import output_torque

    def check(recording: Recording) -> None:
        joint = joint_of(arguments, file, [recording])
        current = recording.torque is None and recording.motor_torque is None
        if current and file is None and (joint is None or joint.torque_constant is None):
            joint = None  # the error then names all missing options
        output_torque(recording, joint)

    return check


def facts_of(arguments: argparse.Namespace, file: Joint | None = None) -> dict[str, Any]:
    """Return the fields of a joint that the options state.

    Parameters
    ----------
    arguments : Namespace
    file : Joint or None
        Joint with the link that the options change. Default: none.

    Raises
    ------
    InputError
        A value cannot be used, or the link is incomplete; the error names the option.
    """
    from jointid.joint.link import Link

    facts: dict[str, Any] = _stated(arguments, {name: name for name in _DRIVE})
    for name in ("gear_ratio", "torque_constant"):
        if (values := numbers_of_joints(arguments, name)) is not None and len(values) == 1:
            facts[name] = values[0]
    if (inertia := _inertia(arguments)) is not None:
        facts["inertia"] = inertia
    link = _stated(arguments, _LINK)
    if not link:
        return facts
    link = {**({} if file is None or file.link is None else _fields(file.link)), **link}
    for name in ("mass", "centre_of_mass"):
        if name not in link:
            remedy = f"add --{name.replace('_', '-')} VALUE"
            raise InputError("a link needs it, too", argument=name, remedy=remedy)
    try:
        facts["link"] = Link(**link)
    except InputError as error:
        raise _of_option(error) from None
    return facts


def _inertia(arguments: argparse.Namespace) -> float | None:
    """Return the inertia of one joint. For a robot, the option selects the inertias to identify."""
    stated = getattr(arguments, "inertia", None)
    if isinstance(stated, list):  # compare --robot accepts several
        if len(stated) > 1:
            raise InputError(
                "state only one inertia for one joint", argument="inertia", value=stated
            )
        stated = stated[0]
    if stated is None:
        return None
    number = number_or_text(stated)
    if isinstance(number, str):
        raise InputError(
            "for one joint, a number [kg·m²] is expected; for a robot, name its URDF with --robot",
            argument="inertia",
            value=stated,
        )
    return float(number)


def _stated(arguments: argparse.Namespace, names: dict[str, str]) -> dict[str, Any]:
    found = {field: getattr(arguments, option, None) for option, field in names.items()}
    return {field: value for field, value in found.items() if value is not None}


def _fields(link: Any) -> dict[str, Any]:
    from dataclasses import fields

    return {each.name: getattr(link, each.name) for each in fields(link)}


def _of_option(error: InputError) -> InputError:
    """Return an error about a field without the place in Python, because the option names it already."""
    options = {field: option for option, field in _LINK.items()}
    of_link = error.place == "link"
    return InputError(
        error.reason,
        argument=options.get(error.argument, error.argument) if of_link else error.argument,
        value=error.value,
        remedy=error.remedy,
    )
