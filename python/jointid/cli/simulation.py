"""The command `simulate`, and a scenario in the words of a command line."""

from __future__ import annotations

import argparse
import json
import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from jointid.cli.arguments import TEXT, check_folder, number_or_text, pair, whole_seed

if TYPE_CHECKING:
    from jointid.simulation.arguments import Controller
    from jointid.simulation.scenario import Scenario
    from jointid.simulation.trajectory import Trajectory

CONTROLLERS = {
    "adaptive_robust": "AdaptiveRobust",
    "compensated_pid": "CompensatedPid",
    "lugre_observer": "LugreObserver",
    "pid": "Pid",
    "pd": "Pd",
    "open_loop": "OpenLoop",
}
TRAJECTORIES = ("thesis", "sine", "multisine", "sigmoid", "step", "trapezoid")


def add_simulate(commands: Any) -> None:
    """Add the command's grammar."""
    from jointid.base.error_text import alternatives
    from jointid.recording.saving import ENDINGS

    simulate = commands.add_parser(
        "simulate",
        help="simulate a joint that a controller moves",
        epilog=(
            "examples:\n"
            "  jointid simulate joint.toml --trajectory thesis:amplitude=60deg,cycle=3 --output run.csv\n"
            "  jointid simulate joint.toml --believe guess.toml --sensor torque_noise=0.5 --output run.csv\n"
            "  jointid simulate joint.toml --controller pd --gain stiffness=8000 --gain damping=400 \\\n"
            "      --trajectory sine:amplitude=0.3,frequency=0.5,duration=10 --output run.csv\n"
            "the joint file needs a value for each parameter, as `identify --save joint.toml` writes them"
        ),
        formatter_class=TEXT,
    )
    simulate.add_argument("joint", type=Path, help="joint file (.toml) with its parameters' values")
    scenario_arguments(simulate)
    simulate.add_argument("--seed", type=whole_seed, default=0, help="of the sensors' noise (0)")
    simulate.add_argument(
        "--output", type=Path, help=f"write the recording here: {alternatives(ENDINGS)}"
    )
    simulate.add_argument("--json", action="store_true", help="print the outcome as JSON")


def scenario_arguments(command: argparse.ArgumentParser) -> None:
    """Add what makes a scenario of a joint."""
    command.add_argument(
        "--controller",
        default="adaptive_robust",
        help=f"{', '.join(CONTROLLERS)} (default: adaptive_robust)",
    )
    command.add_argument(
        "--believe",
        type=Path,
        metavar="JOINT",
        help="joint file whose values the controller compensates with; default: the true ones",
    )
    command.add_argument(
        "--trajectory",
        default="thesis",
        metavar="NAME[:OPTION=VALUE,…]",
        help=f"{', '.join(TRAJECTORIES)}, or a recording to follow; angles in rad, or as 60deg",
    )
    for name, shown, told in (
        ("--gain", "NAME=VALUE", "of the controller; may be repeated"),
        (
            "--sensor",
            "NAME=VALUE",
            "such as torque_noise=0.5, encoder_counts=8000 (of a motor turn)",
        ),
    ):
        command.add_argument(name, action="append", type=pair, default=[], metavar=shown, help=told)
    command.add_argument(
        "--control-period", type=float, default=1e-3, help="between two commands [s] (0.001)"
    )
    command.add_argument("--duration", type=float, help="[s]; default: the trajectory's")


def simulate(arguments: argparse.Namespace) -> None:
    """Simulate a joint, and write what its sensors saw."""
    from jointid.base.errors import InputError

    check_folder("--output", arguments.output)
    scenario = scenario_of(arguments.joint, arguments)
    batch = scenario.simulate(arguments.seed)
    recording = batch.recordings[0]
    if arguments.output is not None:
        try:
            recording.save(arguments.output)
        except InputError as error:
            raise InputError(f"--output {error}") from error
    followed = recording.reference is not None
    facts = {
        "samples": len(recording),
        "duration": recording.duration,
        "tracking_error": float(batch.error[0]) if followed else None,
        "peak_error": float(batch.peak_error[0]) if followed else None,
        "peak_velocity": float(abs(recording.truth.signals["velocity"]).max()),
        "saturations": int(batch.saturations[0]),
        "truth": dict(recording.truth),
        "output": None if arguments.output is None else str(arguments.output),
    }
    if arguments.json:
        print(json.dumps(facts, indent=1, ensure_ascii=False))
        return
    print(f"{len(recording)} samples in {recording.duration:g} s")
    if followed:
        print(
            f"tracking error after the first sixth: rms {facts['tracking_error']:.3g} rad, "
            f"largest {facts['peak_error']:.3g} rad"
        )
    print(f"largest velocity {facts['peak_velocity']:.3g} rad/s")
    if facts["saturations"]:
        print(f"the torque limit cut the command in {facts['saturations']} control periods")
    if arguments.output is not None:
        print(f"recording: {arguments.output}")


def scenario_of(joint_file: Path, arguments: argparse.Namespace) -> Scenario:
    """The scenario of a joint file and these arguments.

    Raises
    ------
    InputError
        Anything that cannot be used.
    """
    from jointid._core import Sensors
    from jointid.base.errors import InputError
    from jointid.joint.joint import Joint
    from jointid.simulation.scenario import Scenario

    joint = Joint.load(joint_file)
    try:
        sensors = Sensors(**_values("--sensor", arguments.sensor))
    except (ValueError, TypeError) as error:
        raise InputError(f"--sensor: {error}") from None
    scenario = Scenario(
        joint,
        _controller(arguments.controller, arguments.gain),
        trajectory_of(arguments.trajectory),
        sensors,
        control_period=arguments.control_period,
        duration=arguments.duration,
    )
    given = {name for name, _ in arguments.gain}
    if "coulomb" not in scenario.controller.asdict():
        if arguments.believe is not None:
            raise InputError(
                f"--believe: the controller {arguments.controller} compensates nothing"
            )
        return scenario
    believed = joint if arguments.believe is None else Joint.load(arguments.believe)
    estimates = {
        f"controller.{name}": value
        for name, value in scenario.believing(believed).asdict().items()
        if name not in given
    }
    return scenario.changed(estimates)


def _controller(word: str, gains: Sequence[tuple[str, str]]) -> Controller:
    from jointid import _core
    from jointid.base.errors import InputError
    from jointid.joint.checks import suggestion

    if word not in CONTROLLERS:
        raise InputError(f"--controller '{word}' is not known; {suggestion(word, [*CONTROLLERS])}")
    given = _values("--gain", gains)
    if word in ("pd", "pid", "compensated_pid") and not given.get("stiffness"):
        raise InputError(
            f"--controller {word} needs --gain stiffness=VALUE [N·m/rad], and most likely damping"
        )
    try:
        controller: Controller = getattr(_core, CONTROLLERS[word])(**given)
    except (ValueError, TypeError) as error:
        raise InputError(f"--gain: {error}") from None
    return controller


def trajectory_of(text: str) -> Trajectory:
    """A trajectory of its name and options, or of a recording's file.

    Raises
    ------
    InputError
        No such trajectory, option or file.
    """
    from jointid.base.errors import InputError
    from jointid.recording.readers.loading import load
    from jointid.simulation.trajectory import Trajectory

    name, _, told = text.partition(":")
    if name not in TRAJECTORIES:
        if Path(text).exists():
            return Trajectory.from_recording(load(text))
        raise InputError(
            f"--trajectory '{text}' is neither a file nor one of {', '.join(TRAJECTORIES)}"
        )
    pairs = []
    for part in told.split(",") if told else []:
        option, separator, value = part.partition("=")
        if not separator or not value:
            raise InputError(f"--trajectory {text}: '{part}' is not of the form name=value")
        pairs.append((option, value))
    try:
        trajectory: Trajectory = getattr(Trajectory, name)(**_values("--trajectory", pairs))
    except TypeError as error:
        reason = str(error).replace("Trajectory.", "").replace("keyword argument", "option")
        raise InputError(f"--trajectory {text}: {reason}") from None
    return trajectory


def _values(option: str, pairs: Sequence[tuple[str, str]]) -> dict[str, Any]:
    """Numbers, angles such as 60deg, true and false, words."""
    from jointid.base.errors import InputError

    values: dict[str, Any] = {}
    for name, text in pairs:
        if name in values:
            raise InputError(f"{option}: {name} is given twice")
        degrees = number_or_text(text.removesuffix("deg"))
        if text.endswith("deg") and not isinstance(degrees, str):
            values[name] = math.radians(degrees)
        else:
            values[name] = {"true": True, "false": False}.get(text, number_or_text(text))
    return values
