"""Scenario from the command line: controller, trajectory, sensors."""

from __future__ import annotations

import argparse
import inspect
import math
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from jointid.base.errors import InputError
from jointid.cli.arguments import by_name, decimal, number_or_text, pair
from jointid.simulation.arguments import LAWS

if TYPE_CHECKING:
    from jointid._core import Sensors
    from jointid.simulation.arguments import Controller
    from jointid.simulation.scenario import Scenario
    from jointid.simulation.trajectory import Trajectory

TRAJECTORIES = ("thesis", "sine", "multisine", "sigmoid", "step", "trapezoid")


def scenario_arguments(command: argparse.ArgumentParser) -> None:
    """Add the options for a joint's scenario."""
    command.add_argument(
        "--controller",
        default="adaptive_robust",
        help=f"{', '.join(LAWS)} (default: adaptive_robust)",
    )
    command.add_argument(
        "--believe",
        type=Path,
        metavar="JOINT",
        help="joint file with the parameters that the controller assumes; default: the true parameters",
    )
    command.add_argument(
        "--trajectory",
        default="thesis",
        metavar="NAME[:OPTION=VALUE,…]",
        help=f"{', '.join(TRAJECTORIES)}, a motion of `jointid design` (.toml), or a recording to follow; "
        "angles in rad, or as 60deg",
    )
    for name, shown, explanation in (
        ("--gain", "NAME=VALUE", "a setting of the controller; may be repeated"),
        (
            "--sensor",
            "NAME=VALUE",
            "a sensor's property, such as torque_noise=0.5, encoder_counts=8000 (per motor turn)",
        ),
    ):
        command.add_argument(
            name, action="append", type=pair, default=[], metavar=shown, help=explanation
        )
    command.add_argument(
        "--control-period",
        type=decimal,
        default=1e-3,
        help="time between two commands [s] (default 0.001)",
    )
    command.add_argument(
        "--duration",
        type=decimal,
        help="duration of the motion [s]; default: the duration of the trajectory",
    )


def scenario_of(joint_file: Path, arguments: argparse.Namespace) -> Scenario:
    """Return the scenario of a joint file and these arguments.

    Raises
    ------
    InputError
        A value cannot be used.
    """
    from jointid.joint.joint import Joint
    from jointid.simulation.scenario import Scenario

    joint = Joint.load(joint_file)
    scenario = Scenario(
        joint,
        controller_of(arguments.controller, arguments.gain),
        trajectory_of(arguments.trajectory),
        sensors_of(arguments.sensor),
        control_period=arguments.control_period,
        duration=arguments.duration,
    )
    chosen = {name for name, _ in arguments.gain}
    if "coulomb" not in scenario.controller.asdict():
        if arguments.believe is not None:
            raise InputError(
                f"the controller {arguments.controller} does not compensate friction",
                argument="believe",
            )
        return scenario
    assumed = joint if arguments.believe is None else Joint.load(arguments.believe)
    estimates = {
        f"controller.{name}": value
        for name, value in scenario.believing(assumed).asdict().items()
        if name not in chosen
    }
    return scenario.changed(estimates)


def controller_of(name: str, gains: Sequence[tuple[str, str]]) -> Controller:
    """Return a controller from its name and the texts of its gains.

    Raises
    ------
    InputError
        The controller or a gain does not exist, or a required gain is missing.
    """
    from jointid.joint.checks import suggestion

    if name not in LAWS:
        raise InputError(suggestion(name, [*LAWS]), argument="controller", value=name)
    kind = LAWS[name]
    usual = kind().asdict()
    chosen = checked_values("gain", gains, usual)
    if "stiffness" in usual and not chosen.get("stiffness"):
        raise InputError(
            "this controller needs a stiffness [N·m/rad], and usually damping",
            argument="controller",
            value=name,
            remedy="add --gain stiffness=VALUE",
        )
    controller: Controller = kind(**chosen)
    return controller


def sensors_of(pairs: Sequence[tuple[str, str]]) -> Sensors:
    """Return sensors from the texts of their properties.

    Raises
    ------
    InputError
        A property does not exist, or its value is not possible.
    """
    from jointid._core import Sensors

    return Sensors(**checked_values("sensors", pairs, Sensors().asdict()))


def trajectory_of(text: str) -> Trajectory:
    """Return a trajectory from its name and options, or from the file of a motion or a recording.

    Raises
    ------
    InputError
        The trajectory, an option or the file does not exist.
    """
    from jointid.recording.readers.loading import load
    from jointid.simulation.motion_file import load_motion
    from jointid.simulation.trajectory import Trajectory

    name, _, options = text.partition(":")
    if name not in TRAJECTORIES:
        if Path(text).suffix.lower() == ".toml":
            return load_motion(text).trajectory
        if Path(text).exists():
            return Trajectory.from_recording(load(text))
        raise InputError(
            f"neither a file nor one of {', '.join(TRAJECTORIES)}",
            argument="trajectory",
            value=text,
        )
    pairs = []
    for part in options.split(",") if options else []:
        option, separator, value = part.partition("=")
        if not separator or not value:
            raise InputError(
                f"{part} is not of the form NAME=VALUE", argument="trajectory", value=text
            )
        pairs.append((option, value))
    make = getattr(Trajectory, name)
    known = inspect.signature(make).parameters
    chosen = _values("trajectory", pairs)
    _check_names("trajectory", chosen, known)
    missing = [
        key
        for key, entry in known.items()
        if entry.default is inspect.Parameter.empty and key not in chosen
    ]
    if missing:
        raise InputError(f"{name} needs {_and(missing)}", argument="trajectory", value=text)
    trajectory: Trajectory = make(**chosen)
    return trajectory


def _and(names: Sequence[str]) -> str:
    return " and ".join([", ".join(names[:-1])] * (len(names) > 1) + [names[-1]])


def _check_names(argument: str, chosen: Mapping[str, Any], known: Collection[str]) -> None:
    from jointid.recording.signals import closest

    for name, value in chosen.items():
        if name not in known:
            close = closest(name, [*known], cutoff=0.75)  # a lower cutoff matches unrelated names
            raise InputError(
                f"there is no {name}; "
                + (f"did you mean '{close}'?" if close else f"choose one of {', '.join(known)}"),
                argument=f"{argument}.{name}",
                value=value,
            )


def checked_values(
    argument: str, pairs: Sequence[tuple[str, str]], usual: Mapping[str, Any]
) -> dict[str, Any]:
    """Return values of the same types as the defaults."""
    chosen = _values(argument, pairs)
    _check_names(argument, chosen, usual)
    for name, value in chosen.items():
        kind = type(usual[name])
        if type(value) is not kind and (kind, type(value)) != (float, int):
            expected = {float: "a number", int: "a whole number", bool: "true or false"}
            raise InputError(
                f"{expected.get(kind, 'a name')} is expected",
                argument=f"{argument}.{name}",
                value=value,
            )
    return chosen


def _values(argument: str, pairs: Sequence[tuple[str, str]]) -> dict[str, Any]:
    """Return the values: numbers, angles such as 60deg, true and false, texts."""
    return {
        name: {"true": True, "false": False}.get(text, number_or_angle(text))
        for name, text in by_name(argument, pairs).items()
    }


def number_or_angle(text: str) -> Any:
    """Return an int, a float, an angle such as 60deg in [rad], or the text itself."""
    degrees = number_or_text(text.removesuffix("deg"))
    if text.endswith("deg") and not isinstance(degrees, str):
        return math.radians(degrees)
    return number_or_text(text)
