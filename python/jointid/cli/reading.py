"""Recordings of a command: the arguments for reading them, and advice if they cannot be read."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from jointid.base.errors import InputError
from jointid.cli.arguments import by_name, number_or_text, numbers_by_name

if TYPE_CHECKING:
    from jointid.joint.model import Model
    from jointid.recording.recording import Recording


def load_all(
    paths: Sequence[Path],
    arguments: argparse.Namespace,
    models: Sequence[Model] = (),
    *,
    usable: Callable[[Recording], object] | None = None,
) -> list[Recording]:
    """Return the recordings of a command, each read with the same --column, --unit and --where.

    Parameters
    ----------
    models : sequence of Model
        Models. Columns of their own terms are read as extra signals, unless --extra names others. Default: none.
    usable : callable, optional
        Function that raises if a recording is not sufficient for the command. Default: no check.

    Raises
    ------
    InputError
        A recording cannot be read. The error names all that is missing, as far as possible; see `looked_ahead`.
    """
    from jointid.recording.readers.loading import load
    from jointid.recording.sides import MOTOR

    several, ratios = joints_wanted(arguments), numbers_of_joints(arguments, "gear_ratio")
    if several is not None and len(several) != 1:
        raise InputError(
            "this command reads one joint; only identify reads several",
            argument="joints",
            value=arguments.joints,
        )
    for name in ("gear_ratio", "torque_constant"):
        if len(numbers_of_joints(arguments, name) or ()) > 1:
            what = name.replace("_", " ")
            raise InputError(
                f"one {what} is expected for one joint",
                argument=name,
                value=getattr(arguments, name),
            )
    of_file = None if ratios else _ratio_of_file(arguments)
    reading = {
        "joint": several[0] if several else None,
        "gear_ratio": ratios[0] if ratios else of_file if arguments.side else None,
        "drop_copies": arguments.drop_copies,
        "drop_invalid": arguments.drop_invalid,
        **how_to_read(arguments, models),
    }

    def read(path: Path, changes: Mapping[str, Any]) -> Recording:
        how = with_changes(reading, changes)
        recording = load(path, **how)
        if of_file not in (None, 1.0) and recording.metadata.get("side") == MOTOR:
            recording = load(path, **{**how, "gear_ratio": of_file})
        if usable is not None:
            usable(recording)
        return recording

    recordings = []
    for path in paths:
        try:
            recordings.append(read(path, {}))
        except InputError as error:
            from jointid.cli.complete_advice import looked_ahead
            from jointid.cli.torque_column import torque_or_servo

            further = looked_ahead(
                error,
                partial(read, path),
                lambda changes, path=path: torque_or_servo(  # type: ignore[misc]
                    path, with_changes(reading, changes)
                ),
            )
            raise as_given(_of_joints(further), arguments) from None
    return recordings


def _ratio_of_file(arguments: argparse.Namespace) -> float | None:
    """Return the gear ratio of the joint file, for signals of the motor; None without such a file."""
    file = getattr(arguments, "joint", None)
    if file is None:
        return None
    from jointid.joint.joint import Joint

    return Joint.load(file).gear_ratio


def with_changes(reading: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """Return arguments of `load` with changes; columns, units and factors change for each signal separately."""
    changed = dict(reading)
    for name, value in changes.items():
        both = isinstance(value, Mapping) and changed.get(name)
        changed[name] = {**changed[name], **value} if both else value
    return changed


def how_to_read(arguments: argparse.Namespace, models: Sequence[Model] = ()) -> dict[str, Any]:
    """Return the arguments of `load` and `load_robot` for the recordings of a command."""
    columns = {
        signal: int(header) if header.isdigit() else None if header == "none" else header
        for signal, header in by_name("columns", arguments.column).items()
    }
    where = {
        column: number_or_text(value) for column, value in by_name("where", arguments.where).items()
    }
    extra: dict[str, str | int] = {
        name: int(header) if header.isdigit() else header
        for name, header in by_name("extra", arguments.extra).items()
    }
    for model in models:
        for signal in model.resolved.terms.signals:
            extra.setdefault(signal, signal)
    return {
        "columns": columns or None,
        "units": by_name("units", arguments.unit) or None,
        "scale": numbers_by_name("scale", arguments.scale) or None,
        "extra": extra or None,
        "where": where or None,
        "side": by_name("side", arguments.side) or None,
        "sample_period": _period(arguments),
        "topic": arguments.topic,
        "group": arguments.group,
        "unpacked": arguments.unpacked,
    }


def _period(arguments: argparse.Namespace) -> float | None:
    """Return the time between rows from --rate; None without the option."""
    rate = arguments.rate
    if rate is not None and not 0.0 < rate < float("inf"):
        raise InputError("a rate above 0 is expected", argument="sample_period", value=rate)
    return None if rate is None else 1.0 / rate


def joints_wanted(arguments: argparse.Namespace) -> list[str] | None:
    """Return the joints of --joints; an empty list for all, None without the option."""
    text = arguments.joints
    if text is None:
        return None
    names = [] if text == "all" else [name.strip() for name in text.split(",")]
    if "" in names:
        raise InputError(
            "names or numbers such as 1,3,5 are expected, or all", argument="joints", value=text
        )
    return names


def numbers_of_joints(arguments: argparse.Namespace, name: str) -> list[float] | None:
    """Return the numbers of an option that has one for each joint; None without the option."""
    text = getattr(arguments, name, None)
    if text is None:
        return None
    found = [number_or_text(part.strip()) for part in text.split(",")]
    if any(isinstance(each, str) for each in found):
        raise InputError("numbers such as 32,45,-48 are expected", argument=name, value=text)
    return [float(each) for each in found]


def as_given(error: InputError, arguments: argparse.Namespace) -> InputError:
    """Return an error about an extra signal as one about --term, if only an own term names the signal."""
    root, _, name = error.argument.partition(".")
    if root != "extra" or name not in by_name("terms", getattr(arguments, "terms", None) or []):
        return error
    if name in by_name("extra", arguments.extra):
        return error
    return InputError(
        error.reason, argument="terms", value=name, place=error.place, remedy=error.remedy
    )


def _of_joints(error: InputError) -> InputError:
    """Return an error about `joint` as one about --joints, because --joint is a file."""
    if error.argument != "joint":
        return error
    return InputError(
        error.reason,
        argument="joints",
        value=error.value,
        place=error.place,
        remedy=error.remedy,
    )
