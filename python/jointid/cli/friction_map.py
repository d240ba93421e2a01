"""Tables of steady speeds and torques: the output of `identify` and `info` for files without time and position."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from jointid.base.errors import InputError
from jointid.cli.reading import how_to_read

if TYPE_CHECKING:
    from jointid.estimate.steady_speeds import SteadyFriction
    from jointid.recording.columns import Column

_USED = frozenset(
    (
        "--column",
        "--unit",
        "--scale",
        "--topic",
        "--group",
        "--unpacked",
        "--json",
        "--verbose",
        "--quiet",
    )
)
"""Options for a table of steady speeds. Another option would have no effect."""


def printed_map(paths: Sequence[Path], arguments: argparse.Namespace, error: InputError) -> None:
    """Print the friction in tables of steady speeds and torques. Raise the error again for any other file."""
    found = _friction_map(paths, arguments)
    if found is None:
        raise error
    for word in arguments.typed:
        option = word.partition("=")[0]
        if option.startswith("--") and option not in _USED:
            raise InputError(
                "this file is a table of steady speeds and torques; its friction map has no such option",
                place=option,
                remedy="leave this option out; --json prints the map for programs",
            ) from None
    if arguments.json:
        import json

        print(json.dumps(found.document(), indent=1, ensure_ascii=False))
    else:
        print(found.report())


def _friction_map(paths: Sequence[Path], arguments: argparse.Namespace) -> SteadyFriction | None:
    from jointid.estimate.steady_speeds import steady_friction

    tables = [_steady(path, arguments) for path in paths]
    known = [each for each in tables if each is not None]
    if len(known) < len(tables) or len({each[2] for each in known}) > 1:
        return None
    velocity = np.concatenate([each[0] for each in known])
    torque = np.concatenate([each[1] for each in known])
    assumed = tuple(dict.fromkeys(signal for each in known for signal in each[3]))
    try:
        return replace(steady_friction(velocity, torque, known[0][2]), assumed=assumed)
    except InputError as error:
        raise error.at(", ".join(map(str, paths))) from None


def _add_friction(headers: Sequence[str], found: dict[str, list[Column]]) -> None:
    """Use the column next to the velocity as the torque if it has a unit of torque: ``friction [Nm]``."""
    from jointid.recording.columns import Column
    from jointid.recording.headers import understood
    from jointid.recording.signals import dimensions

    if len(headers) == 2 and found.get("velocity") and not found.get("torque"):
        other = 1 - found["velocity"][0].index
        unit = understood(headers[other]).unit
        if unit is not None and unit.dimension in dimensions("torque", None):
            found["torque"] = [Column(index=other, unit=unit)]


def _steady(
    path: Path, arguments: argparse.Namespace
) -> tuple[np.ndarray, np.ndarray, str, list[str]] | None:
    """Return velocity, torque, kind, and the signals with an assumed unit; None for any other file."""
    from jointid.recording.columns import candidates_of
    from jointid.recording.readers.loading import table_of

    reading = how_to_read(arguments)
    parts = {name: reading[name] for name in ("topic", "group", "unpacked")}
    try:
        table = table_of(path, **parts)
        how = {name: reading[name] for name in ("columns", "units", "scale")}
        found = candidates_of(table, **how, kind=None).of
    except InputError:
        return None
    _add_friction(table.headers, found)
    known = {column.index for columns in found.values() for column in columns}
    # An unknown column may be the time or the position.
    if (
        table.saved is not None
        or len(known) < len(table.headers)
        or {"time", "position"} & {*found}
    ):
        return None
    for kind in ("revolute", "prismatic"):
        pair = [
            [column for column in found.get(signal, []) if column.fits(signal, kind)]
            for signal in ("velocity", "torque")
        ]
        if [len(columns) for columns in pair] == [1, 1]:
            (velocity,), (torque,) = pair
            values = table.numbers([velocity.index, torque.index])
            v, tau = velocity.to_si(values[0]), torque.to_si(values[1])
            if not (np.isfinite(v).all() and np.isfinite(tau).all()):
                return None
            stated = reading["scale"] or {}
            signals = {"velocity": velocity, "torque": torque}
            unstated = [n for n, c in signals.items() if c.unit is None and n not in stated]
            return v, tau, kind, unstated
    return None
