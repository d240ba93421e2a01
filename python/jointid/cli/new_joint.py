"""Command `new`: a joint file from options, a recording, and answers at a terminal."""

from __future__ import annotations

import argparse
import shlex
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.cli.arguments import by_name, decimal, file_kinds, reading_arguments
from jointid.cli.joint_options import fact_arguments, facts_of, weighed
from jointid.cli.outputs import check_folder
from jointid.cli.parser import CommandParser
from jointid.cli.reading import load_all
from jointid.cli.scenario import number_or_angle

if TYPE_CHECKING:
    from jointid.joint.joint import Joint
    from jointid.recording.recording import Recording

_LIMITS = ("position", "velocity", "torque", "current")
# For each option: the argument of the reading that an advice changes.
_READING = {
    "columns": "column",
    "units": "unit",
    "scale": "scale",
    "where": "where",
    "side": "side",
}
_ASKED = ("gear_ratio", "torque_constant", "rotor_inertia", *_LIMITS[:3])
_OF_LIMIT = "largest "


def add_new(new: CommandParser) -> None:
    """Add the command's grammar."""
    new.epilog = (
        "examples:\n  jointid new joint.toml\n"
        "  jointid new joint.toml run.csv --gear-ratio 101 --rotor-inertia 2.5e-4\n"
        "  jointid new elbow.toml arm.csv --joints 3 --gear-ratio -48 --name elbow\n"
        "at a terminal, the command asks for the facts that most joints need; Enter skips a fact (written as a comment)"
    )
    new.add_argument("file", type=Path, help="joint file to write (.toml); the file must not exist")
    recording = new.add_argument("recording", type=Path, nargs="?", help="recording of the joint")
    new.help_later(
        recording,
        lambda: f"recording that gives the joint's kind, sensor, columns and units: {file_kinds()}",
    )
    new.add_argument("--name", help="name of the joint (default: the file's name)")
    new.add_argument(
        "--kind", help="revolute or prismatic (default: as in the recording, or revolute)"
    )
    fact_arguments(new)
    new.add_argument(
        "--inertia", metavar="VALUE", help="inertia of the drive alone at the output [kg·m²]"
    )
    new.add_argument(
        "--position",
        metavar="LOW,HIGH",
        help="position limits: rad, or as -60deg,60deg; m for a prismatic joint",
    )
    for option, explanation in (
        ("--velocity", "largest velocity [rad/s]"),
        ("--torque", "largest torque at the output [N·m]"),
        ("--current", "largest current in the motor [A]"),
    ):
        new.add_argument(option, type=decimal, metavar="VALUE", help=explanation)
    new.add_argument(
        "--no-questions", action="store_true", help="ask no questions, even at a terminal"
    )
    reading_arguments(new)


def new(arguments: argparse.Namespace) -> None:
    """Write a new joint file."""
    from jointid.base.files import write_new
    from jointid.joint.joint import Joint
    from jointid.joint.new_file import new_joint_text

    _check_file(arguments.file)
    facts = _stated(arguments)
    recording, found = _read(arguments)
    if not arguments.no_questions and sys.stdin.isatty() and sys.stdout.isatty():
        facts = _answers(arguments, facts, recording)
    joint = _joint(arguments, facts, recording)
    following = _next(arguments)
    text = new_joint_text(joint, ["A joint file of jointid.", *found, following])
    try:
        write_new(arguments.file, text.encode())
    except FileExistsError:
        raise _exists(arguments.file) from None
    Joint.load(arguments.file)
    for line in found:
        print(line)
    print(f"joint file: {arguments.file}\nnext: {following}")


def _check_file(path: Path) -> None:
    if path.suffix != ".toml":
        raise InputError("a joint is saved as .toml", place=str(path))
    if path.exists():
        raise _exists(path)
    check_folder("file", path)


def _exists(path: Path) -> InputError:
    return InputError(
        "the file exists and is not overwritten", place=str(path), remedy="give another name"
    )


def _stated(arguments: argparse.Namespace) -> dict[str, Any]:
    """Return the facts of the options."""
    if arguments.kind not in (None, "revolute", "prismatic"):
        raise InputError("revolute or prismatic is expected", argument="kind", value=arguments.kind)
    facts = facts_of(arguments)
    limits = {
        name: getattr(arguments, name) for name in _LIMITS if getattr(arguments, name) is not None
    }
    if "position" in limits:
        limits["position"] = _range(limits["position"])
    return facts | limits


def _range(text: str) -> tuple[float, float]:
    numbers = [number_or_angle(part.strip()) for part in text.split(",")]
    if len(numbers) != 2 or any(isinstance(each, str) for each in numbers):
        raise InputError(
            "two numbers such as -1,1 or -60deg,60deg are expected", argument="position", value=text
        )
    return float(numbers[0]), float(numbers[1])


def _joint(
    arguments: argparse.Namespace, facts: Mapping[str, Any], recording: Recording | None
) -> Joint:
    """Return the joint with all known facts."""
    from jointid.joint.joint import Joint
    from jointid.joint.link import Limits
    from jointid.joint.model import Model

    own = {name: value for name, value in facts.items() if name not in _LIMITS}
    limits = {name: value for name, value in facts.items() if name in _LIMITS}
    shown = arguments.kind or (recording.kind if recording is not None else "revolute")
    sensor = recording is not None and recording.sensor is not None
    if shown == "revolute":
        own = weighed(own, Model(), sensor=sensor)
    name = arguments.file.stem if arguments.name is None else arguments.name
    try:
        return Joint(
            **{"name": name, "kind": shown, "sensor": sensor, **own, "limits": Limits(**limits)}
        )
    except InputError as error:
        raise InputError(
            error.reason, argument=error.argument, value=error.value, remedy=error.remedy
        ) from None


def _read(arguments: argparse.Namespace) -> tuple[Recording | None, list[str]]:
    """Return the recording and remarks on it. Advised columns and units are added to the arguments."""
    if arguments.recording is None:
        return None, []
    found = []
    try:
        (recording,) = load_all([arguments.recording], arguments, usable=_with_torque)
    except InputError as error:
        advised = _obeyed(arguments, error)
        (recording,) = load_all([arguments.recording], arguments)
        found.append(f"proposed: {advised}; check whether this is right")
    from jointid.recording.plausible_units import proposed_units

    for signal, proposed in proposed_units(recording).items():
        arguments.unit.append((signal, proposed.unit))
        found.append(f"proposed: {signal} in {proposed.unit} ({proposed.reason})")
    if arguments.unit:
        (recording,) = load_all([arguments.recording], arguments)
    assumed = recording.metadata.get("assumed_units")
    if assumed and isinstance(assumed, list | tuple):
        found.append(f"SI units assumed: {', '.join(map(str, assumed))}")
    low, high = recording.position.min(), recording.position.max()
    unit = "m" if recording.kind == "prismatic" else "rad"
    largest = float(abs(recording.velocity).max())
    shown = f"position {low:.3g} to {high:.3g} {unit}, up to {largest:.3g} {unit}/s"
    return recording, [f"{arguments.recording.name}: {recording.duration:.3g} s, {shown}", *found]


def _with_torque(recording: Recording) -> None:
    """Refuse a recording without torque, so that the column that may be the torque is proposed, too."""
    if recording.torque is None and recording.motor_torque is None and recording.current is None:
        raise InputError(
            "the recording has no signal torque",
            argument="torque",
            remedy=Action("call", {"columns": {"torque": ...}}, function="load"),
        )


def _obeyed(arguments: argparse.Namespace, error: InputError) -> str:
    """Apply the advice of an error to the arguments. Return it as options.

    Raises
    ------
    InputError
        The same error, if only the user knows the remedy.
    """
    action = error.remedy[0] if error.remedy else None
    if not isinstance(action, Action) or action.kind != "call" or action.function != "load":
        raise error
    changes = dict(action.arguments)
    if "joint" in changes:
        arguments.joints = str(changes.pop("joint"))
    for name, value in changes.items():
        if name not in _READING or ... in value.values():
            raise error
        pairs = getattr(arguments, _READING[name])
        if name == "units":  # for other signals SI is a guess; the values give a better one
            value = {key: unit for key, unit in value.items() if key == "time"}
        pairs += [(key, "none" if each is None else str(each)) for key, each in value.items()]
    return shlex.join(_reading_options(arguments))


def _reading_options(arguments: argparse.Namespace) -> list[str]:
    """Return how the recording is read, as options of any command."""
    options: list[str] = []
    for name in (*_READING.values(), "extra"):
        pairs = by_name(name, getattr(arguments, name))
        options += [word for pair in pairs.items() for word in (f"--{name}", "=".join(pair))]
    for name in ("joints", "topic", "group", "rate"):
        if getattr(arguments, name) is not None:
            options += [f"--{name}", _plain(getattr(arguments, name))]
    for name in ("drop_copies", "drop_invalid"):
        options += [f"--{name.replace('_', '-')}"] * getattr(arguments, name)
    return options


def _plain(value: object) -> str:
    return f"{value:.15g}" if isinstance(value, float) else str(value)


def _next(arguments: argparse.Namespace) -> str:
    """Return the command that identifies with the new file."""
    recording = "run.csv" if arguments.recording is None else str(arguments.recording)
    options = _reading_options(arguments)
    return shlex.join(["jointid", "identify", recording, "--joint", str(arguments.file), *options])


def _answers(
    arguments: argparse.Namespace, facts: Mapping[str, Any], recording: Recording | None
) -> dict[str, Any]:
    """Return the user's answers for the facts that no option states. Unknown facts are left out."""
    from jointid.joint.new_file import FACTS

    known = dict(facts)
    print("Press Enter to skip a fact that you do not know.")
    for fact in FACTS:
        if fact.key in known or fact.key not in _ASKED:
            continue
        if fact.key == "torque_constant" and recording is not None and recording.current is None:
            continue
        example = "-60deg,60deg" if fact.key == "position" else fact.example
        while True:
            try:
                text = input(
                    f"{fact.key.replace('_', ' ')} ({fact.meaning}; e.g. {example}): "
                ).strip()
            except EOFError:
                print()
                return known
            if not text:
                break
            try:
                value: Any = _range(text) if fact.key == "position" else number_or_angle(text)
                _joint(arguments, {**known, fact.key: value}, recording)
            except InputError as error:
                print(f"{text}: {error.reason}")
                continue
            known[fact.key] = value
            break
    return known
