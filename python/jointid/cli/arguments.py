"""Options that several commands share: their grammar, and the conversion of their texts to values."""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from jointid.base.argument_checks import number_in
from jointid.base.errors import InputError

if TYPE_CHECKING:
    from jointid.cli.parser import CommandParser
    from jointid.joint.model import Model

_MOST_WINDOWS = 1_000_000_000


class Once(argparse.Action):
    """Option that keeps one value. It is refused if it occurs twice, so that no file is lost."""

    def __call__(
        self,
        parser: argparse.ArgumentParser,  # noqa: ARG002
        namespace: argparse.Namespace,
        values: Any,
        option_string: str | None = None,  # noqa: ARG002
    ) -> None:
        """Keep the value."""
        if getattr(namespace, self.dest) is not None:
            raise argparse.ArgumentError(
                self, "this option is given twice, but only one file can be written"
            )
        setattr(namespace, self.dest, values)


def file_kinds() -> str:
    """Return the endings of the files that can be read, for a sentence."""
    from jointid.recording.readers.registry import endings_text

    return endings_text()


def several_recordings(
    command: CommandParser, *, nargs: str = "+", use: str = "read with the same options"
) -> None:
    """Add the recordings and the options for reading them."""
    recordings = command.add_argument(
        "recordings", type=Path, nargs=nargs, metavar="recording", help="recording"
    )
    command.help_later(recordings, lambda: f"recording: {file_kinds()}; several are {use}")
    reading_arguments(command)


def reading_arguments(command: argparse.ArgumentParser) -> None:
    """Add the options for reading a recording."""
    for name, shown, explanation in (
        (
            "--column",
            "SIGNAL=HEADER",
            "column of a signal: header, number, none, or 1:6 for the columns of six joints; may be repeated",
        ),
        ("--unit", "SIGNAL=UNIT", "unit of a signal, instead of the unit in the header"),
        ("--scale", "SIGNAL=FACTOR", "factor from file units to SI"),
        (
            "--side",
            "SIGNAL=SIDE",
            "side of a signal (motor or joint), e.g. velocity=motor; needs --gear-ratio or --joint",
        ),
        ("--where", "COLUMN=VALUE", "keep only the rows with this value in this column"),
        ("--extra", "NAME=COLUMN", "keep a column as an extra signal with this name, for --term"),
    ):
        command.add_argument(
            name, action="append", type=pair, default=[], metavar=shown, help=explanation
        )
    command.add_argument(
        "--joints",
        metavar="JOINT[,JOINT...]",
        help="joint to read from a file with several joints: number or name in the headers; identify accepts "
        "several, or all",
    )
    command.add_argument(
        "--gear-ratio",
        metavar="RATIO[,RATIO...]",
        help="motor angle per joint angle, to convert motor columns to the joint side; for several --joints one for "
        "each, as in 32,45,-48",
    )
    command.add_argument(
        "--rate",
        type=decimal,
        metavar="HZ",
        help="rows per second, for a file without a time column",
    )
    command.add_argument(
        "--topic",
        metavar="TOPIC",
        help="topic to read from a message log (.mcap, .bag, .db3); default: the only topic with joints",
    )
    command.add_argument(
        "--group",
        metavar="PATH",
        help="group to read from an HDF5 or MATLAB 7.3 file (default: the only group)",
    )
    command.add_argument(
        "--unpacked",
        type=whole,
        metavar="BYTES",
        help="largest unpacked size of a compressed file (default: 64 MB or 50 times its size)",
    )
    command.add_argument(
        "--drop-copies",
        action="store_true",
        help="leave out rows that repeat the previous row, e.g. if the logger is faster than the bus",
    )
    command.add_argument(
        "--drop-invalid",
        action="store_true",
        help="leave out damaged rows: rows with a value that is not finite or too large for a joint",
    )


def pair(text: str) -> tuple[str, str]:
    """Return name and value of `name=value`."""
    name, separator, value = text.partition("=")
    if not separator or not name or not value:
        raise argparse.ArgumentTypeError(f"'{text}' is not of the form NAME=VALUE")
    return name, value


def by_name(argument: str, pairs: Sequence[tuple[str, str]]) -> dict[str, str]:
    """Return the values by name.

    Raises
    ------
    InputError
        A name is given twice.
    """
    values: dict[str, str] = {}
    for name, value in pairs:
        if name in values:
            raise InputError("it is given twice", argument=f"{argument}.{name}", value=value)
        values[name] = value
    return values


def number_or_text(text: str) -> Any:
    """Return an int, a float, or the text itself."""
    number = number_in(text)
    return text if number is None else number


def whole(text: str) -> int:
    """Return a whole number."""
    value = number_or_text(text)
    if not isinstance(value, int):
        raise argparse.ArgumentTypeError(f"'{text}' is not a whole number")
    return value


def decimal(text: str) -> float:
    """Return a number."""
    value = number_or_text(text)
    if isinstance(value, str):
        raise argparse.ArgumentTypeError(f"'{text}' is not a number")
    return float(value)


def windows(text: str) -> int | float | str:
    """Return a number of windows, a duration such as 0.05s, or cumulative."""
    if text == "cumulative":
        return text
    value = (
        number_or_text(text.removesuffix("s").strip())
        if text.endswith("s")
        else number_or_text(text)
    )
    if isinstance(value, str):
        raise argparse.ArgumentTypeError(
            f"'{text}' is not a number (400), a duration (0.05s) or cumulative"
        )
    if value > _MOST_WINDOWS:
        raise argparse.ArgumentTypeError(f"'{text}' is larger than any recording")
    return float(value) if text.endswith("s") else value


def whole_seed(text: str) -> int:
    """Return a seed."""
    value = number_or_text(text)
    if not isinstance(value, int) or not 0 <= value < 2**64:
        raise argparse.ArgumentTypeError(f"'{text}' is not a whole number from 0 to 2^64 - 1")
    return value


def method_argument(command: CommandParser) -> None:
    """Add the option for the method of the search."""
    command.add_argument(
        "--method",
        help="search method: separable (default), ga (genetic algorithm, implied by its options) or random; for "
        "stribeck_general, ga takes seven times as long as separable",
    )


def with_terms(model: str | None, arguments: argparse.Namespace) -> Model:
    """Return the model of --model, with the own terms of --term.

    Raises
    ------
    InputError
        The model or the terms cannot be used.
    """
    from jointid.joint.model import Model

    stated = Model.of(model)
    if not arguments.terms:
        return stated
    return stated.replace(terms={**(stated.terms or {}), **by_name("terms", arguments.terms)})


def models_by_joint(text: str) -> dict[str, str]:
    """Return a robot's models by joint from "elbow,wrist=auto:load_friction;shoulder=stribeck"; empty for one model.

    Raises
    ------
    InputError
        A part names no joint, or one is named twice.
    """
    if "=" not in text.partition(":")[0]:
        return {}
    found: dict[str, str] = {}
    for part in text.split(";"):
        names, separator, model = part.partition("=")
        for name in names.split(","):
            if not (separator and name and model):
                raise InputError(
                    "JOINT[,JOINT...]=MODEL is expected, or several such entries separated by ;",
                    argument="model",
                    value=part,
                )
            if name in found:
                raise InputError(f"{name} is named twice", argument="model", value=text)
            found[name] = model
    return found


def text_by_joint(models: Mapping[str, str]) -> str:
    """Return the text that `models_by_joint` reads. Joints with the same model share an entry."""
    groups: dict[str, list[str]] = {}
    for name, model in models.items():
        groups.setdefault(model, []).append(name)
    return ";".join(f"{','.join(names)}={model}" for model, names in groups.items())


def numbers_by_name(argument: str, pairs: Sequence[tuple[str, str]]) -> dict[str, float]:
    """Return numbers by name.

    Raises
    ------
    InputError
        A value is not a number, or a name is given twice.
    """
    numbers: dict[str, float] = {}
    for name, value in by_name(argument, pairs).items():
        number = number_or_text(value)
        if isinstance(number, str):
            raise InputError("a number is expected", argument=f"{argument}.{name}", value=value)
        numbers[name] = float(number)
    return numbers


def verbose_argument(command: CommandParser) -> None:
    """Add `-v`, which prints the complete report."""
    command.add_argument(
        "-v",
        "--verbose",
        action="store_true",
        help="print the complete report, not only the answer",
    )
