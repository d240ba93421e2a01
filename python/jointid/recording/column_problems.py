"""Errors about the columns of a table, each with a remedy, and several of them joined into one."""

from collections.abc import Mapping, Sequence
from typing import Any

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.recording.blocks import OF_BLOCKS
from jointid.recording.column_evidence import (
    by_numbers,
    is_counter,
    is_external,
    shows_position,
    shows_time,
    speaks_for,
    values_of,
)
from jointid.recording.column_lookup import listed
from jointid.recording.column_units import unit_by_values
from jointid.recording.columns import Candidates, Column
from jointid.recording.even_rows import EVENLY
from jointid.recording.headers import plain, understood
from jointid.recording.signals import NEEDED, TORQUES, dimensions
from jointid.recording.table import Table
from jointid.recording.units import UNITS, is_mega, unit_names

_UNLIKELY = ("target", "cmd", "command", "des", "ref", "set", "err", "lim", "max", "min")
_MEASURED = ("meas", "actual")
_SHORT = 2  # letters: in "qm" and "qg" the second letter names the side of the gear
_OF_ONE_JOINT, _AT_MOST = 5, 7  # columns of one joint in a file without headers: usually, at most
_MOST_TRIED = 200  # columns without a meaningful name


def of_both_kinds(table: Table, signal: str, columns: Sequence[Column]) -> InputError:
    """Return the error for a signal with columns in units of a revolute and of a prismatic joint."""
    first, second = (table.headers[column.index] for column in columns)
    return InputError(
        f"{first!r} and {second!r} are both recognised as {signal}; one has a unit of revolute joints, "
        "the other has a unit of prismatic joints",
        place=table.header_place,
        remedy=tuple(_chosen(signal, column) for column in columns),
    )


def ambiguous(table: Table, signal: str, columns: Sequence[Column]) -> InputError:
    """Return the error for a signal that several columns fit."""
    names = " and ".join(
        f"{table.headers[column.index]!r} (column {column.index})" for column in columns
    )
    return InputError(
        f"{names} are both recognised as {signal}",
        place=table.header_place,
        remedy=tuple(_chosen(signal, column) for column in columns[:2]),
    )


def in_other_unit(column: Column) -> str:
    """Return the problem with a column's unit as text."""
    if is_mega(column.unknown):
        return f"is in {column.unknown}, where M means mega (milli is m{column.unknown[1:]})"
    if column.unit is None:
        return f"has the unknown unit {column.unknown!r}"
    if column.documented is not None and column.documented.asked:
        return f"is {column.documented.asked} ({column.documented.source})"
    if column.unit is UNITS["lerobot"]:
        return (
            "has no stated unit: LeRobot datasets use degrees, rad, or "
            "−100…100 for each joint's calibrated range"
        )
    if column.unit.dimension == "raw reading":
        return "is a raw reading"
    return f"is in {column.unit.name} ({column.unit.dimension})"


def wrong_unit(table: Table, signal: str, column: Column, kind: str) -> InputError:
    """Return the error for a column with a unit that does not fit the signal."""
    known = unit_names(dimensions(signal, kind))
    remedy: Action | None
    if is_mega(column.unknown):
        remedy = Action(
            "call",
            {"units": {signal: f"m{column.unknown[1:]}"}},
            function="load",
            text="if milli is meant",
        )
    elif column.documented is not None:
        factor = column.documented.factor or "the factor from file units to SI"
        remedy = Action("call", {"scale": {signal: ...}}, function="load", text=factor)
    elif column.unit is UNITS["lerobot"]:
        remedy = _of_dataset(table)
    elif column.unit and column.unit.dimension in ("raw reading", "voltage"):
        remedy = Action(
            "call",
            {"scale": {signal: ...}},
            function="load",
            text="with the factor from file units to SI",
        )
    elif column.unit and column.unit.dimension == "current" and signal == "torque":
        header = table.headers[column.index]
        name = header if table.headers.count(header) == 1 else column.index
        remedy = Action("call", {"columns": {"torque": None, "current": name}}, function="load")
    elif column.unit:  # do not override the header's unit
        remedy = None
    else:
        remedy = Action(
            "call",
            {"units": {signal: known[0]}},
            function="load",
            text="if the column has this unit",
        )
    other: str | Action = "choose another column"
    if signal not in NEEDED:  # this signal is optional
        other = Action("call", {"columns": {signal: None}}, function="load")
    return InputError(
        f"{signal} of a {kind} joint {in_other_unit(column)}; "
        f"{' or '.join(dimensions(signal, kind))} is expected, in {', '.join(known)}",
        place=f"{table.header_place}, column {table.headers[column.index]!r}",
        remedy=(other,) if remedy is None else (remedy, other),
    )


def _of_dataset(table: Table) -> Action:
    """Return the call that states the unit of a dataset's states and actions; both have the same unit."""
    read = [understood(header) for header in table.headers]
    signals = [
        each.meaning.signal for each in read if each.meaning and each.unit is UNITS["lerobot"]
    ]
    units = [each for each in ("position", "reference") if each in signals]
    return Action(
        "call",
        {"units": dict.fromkeys(units, "deg")},
        "write rad instead of deg for positions in rad; for values from −100 to 100, state "
        "scale = half of the joint's range in rad / 100",
        function="load",
    )


def missing(
    table: Table, signals: Sequence[str], found: Candidates, kind: str | None
) -> InputError:
    """Return the error for signals without a column. Its remedy names possible columns.

    Parameters
    ----------
    table : Table
    signals : sequence of str
        Those of "time" and "position" that have no column.
    found : Candidates
    kind : str, optional
        Kind of the joint, if known.

    Raises
    ------
    InputError
        The call chooses the only matching column as another signal, so that no column can be proposed.
    """
    owners = {column.index: other for other, each in found.of.items() for column in each}
    for signal in signals:
        for index, owner in owners.items():
            meaning = understood(table.headers[index]).meaning
            if meaning is not None and meaning.signal == signal:
                raise InputError(
                    f"no column is left for {signal}: {table.headers[index]!r} is chosen as {owner}",
                    argument=f"columns.{owner}",
                    place=table.header_place,
                )
    unnamed = all(header == f"column {k}" for k, header in enumerate(table.headers))
    count = len(table.headers) if unnamed else 0
    if set(signals) == set(NEEDED) and count > _AT_MOST:
        return InputError(
            f"the {count} columns have no headers, and the values do not identify the signals",
            place=table.header_place,
            remedy=OF_BLOCKS,
        )
    headerless = by_numbers(table) if set(signals) == set(NEEDED) else {}
    proposed: dict[str, int] = dict(headerless)
    shown = [table.headers[index] for index in proposed.values()]
    for signal in signals if not headerless else ():
        possible = _possible(table, signal, {*owners, *proposed.values()}, kind)
        best = _best(table, signal, possible, found)
        if not possible and signal == "position":
            return InputError(
                f"the file has no position column; headers are {listed(table.headers) or 'none'}",
                place=table.header_place,
            )
        if best:
            proposed[signal] = best[0]
            shown += [table.headers[k] for k in best if table.headers[k] not in shown]
    absent = [signal for signal in signals if signal not in proposed]
    if not any(found.of.get(signal) or signal in proposed for signal in TORQUES) and proposed:
        proposed |= _torque(table, found, {*owners, *proposed.values()}, proposed, kind)
    blocks = [OF_BLOCKS] if count > _OF_ONE_JOINT else []
    question = _asked(table, found, proposed) if headerless else ""
    return InputError(
        _not_recognised(table, signals, absent, shown) + question,
        place=table.header_place,
        remedy=(_with_absent(_proposal(table, proposed, kind), absent), *blocks),
    )


def _not_recognised(
    table: Table, signals: Sequence[str], absent: Sequence[str], shown: Sequence[str]
) -> str:
    if list(absent) == ["time"] == list(signals):
        return f"the file has no time column; headers are {listed(table.headers) or 'none'}"
    names = " or ".join(signals)
    if not shown:
        return f"no column is recognised as {names}; columns are {listed(table.headers) or 'none'}"
    return f"no column is recognised as {names}; candidates are {listed(shown)}"


def _asked(table: Table, found: Candidates, proposed: Mapping[str, int]) -> str:
    """Return the question about the torque's column, if nothing indicates it."""
    known = {each.index for columns in found.of.values() for each in columns}
    left = len(table.headers) - len({*known, *proposed.values()})
    if left < 1 or any(found.of.get(signal) or signal in proposed for signal in TORQUES):
        return ""
    return "; which column is the torque or current? The values do not identify this column"


def _with_absent(proposal: Action | None, absent: Sequence[str]) -> Action:
    """Return the proposal with placeholders for the user's facts: the sample period, the position's column."""
    arguments: dict[str, Any] = dict(proposal.arguments) if proposal else {}
    if "position" in absent:
        arguments["columns"] = {**arguments.get("columns", {}), "position": ...}
    if "time" in absent:
        arguments["sample_period"] = ...
    text = proposal.text if proposal else EVENLY.text if list(absent) == ["time"] else ""
    return Action("call", arguments, function="load", text=text)


def together(table: Table, problems: Sequence[InputError]) -> InputError:
    """Return several errors as one, with one remedy for all of them."""
    if len(problems) == 1:
        return problems[0]
    arguments: dict[str, Any] = {}
    purposes = []
    for problem in problems:
        action = next((each for each in problem.remedy if isinstance(each, Action)), None)
        if action is not None:
            for name, value in action.arguments.items():
                both = isinstance(value, Mapping)
                arguments[name] = {**arguments.get(name, {}), **value} if both else value
            purposes += [action.text] if action.text else []
    reasons = []
    for problem in problems:
        column = problem.place.removeprefix(table.header_place).lstrip(", ")
        reasons.append(f"{column}: {problem.reason}" if column else problem.reason)
    return InputError(
        "; ".join(reasons),
        place=table.header_place,
        remedy=Action("call", arguments, function="load", text="; ".join(dict.fromkeys(purposes)))
        if arguments
        else (),
    )


def _possible(table: Table, signal: str, taken: set[int], kind: str | None) -> list[int]:
    """Return the columns with a unit that fits the signal, or without a unit."""
    found = []
    for index, header in enumerate(table.headers):
        unit = understood(header).unit
        stamp = signal != "time" and any(part in plain(header) for part in ("stamp", "nanosec"))
        if (
            index not in taken
            and not stamp
            and not _is_other(header, signal)
            and (
                unit is None
                or unit.dimension in dimensions(signal, kind)
                or (unit.dimension == "raw reading" and _likely(table, signal, [index]))
            )
        ):
            found.append(index)
    return found


def _is_other(header: str, signal: str) -> bool:
    """Whether a header names a counter or an external torque: neither is a time or a joint's position."""
    if signal not in NEEDED:
        return is_external(header)
    return is_external(header) or (is_counter(header) and not speaks_for(header, signal))


def _best(table: Table, signal: str, possible: list[int], found: Candidates) -> list[int]:
    """Return the possible columns that a header or the numbers support, the likeliest first."""
    of_joints = [column.index for column in found.of_joints.get(signal, ())]
    if signal == "time":
        unrecognised = [k for k in possible if understood(table.headers[k]).meaning is None]
        best = [k for k in unrecognised[:_MOST_TRIED] if shows_time(table, k)]
        best.sort(key=lambda k: not speaks_for(table.headers[k], "time"))
    else:
        best = [k for k in of_joints if k in possible] or _likely(table, signal, possible)
    if not best and signal == "position":
        only = [k for k in possible[:1] if not possible[1:] and values_of(table, k) is not None]
        best = only or _of_velocity(table, possible, found)
    return sorted(best, key=lambda k: _doubts(plain(table.headers[k])))


def _of_velocity(table: Table, possible: list[int], found: Candidates) -> list[int]:
    """Return the columns with a rate of change equal to the recognised velocity."""
    beside = [found.of.get(signal) for signal in ("time", "velocity")]
    if not all(beside):
        return []
    time, velocity = (columns[0].index for columns in beside if columns)
    return [k for k in possible[:_MOST_TRIED] if shows_position(table, k, time, velocity)]


def _doubts(name: str) -> tuple[bool, bool]:
    """Return two doubts about a column: whether it is a command, and whether it is not marked as measured."""
    measured = any(part in name for part in _MEASURED) or (len(name) <= _SHORT and name[1:] == "m")
    return any(part in name for part in _UNLIKELY), not measured


def _likely(table: Table, signal: str, possible: list[int]) -> list[int]:
    return [k for k in possible if speaks_for(table.headers[k], signal)]


def _torque(
    table: Table, found: Candidates, taken: set[int], proposed: Mapping[str, int], kind: str | None
) -> dict[str, int]:
    """Return a column that may hold the torque of the joint with the proposed position."""
    of_joints = {column.index: column for each in found.of_joints.values() for column in each}
    position = of_joints.get(proposed.get("position", -1))
    number = position.joint if position else _number(table, proposed.get("position"))
    for signal in TORQUES:
        same = [c.index for c in found.of_joints.get(signal, ()) if c.joint == number]
        if same:
            return {signal: same[0]}
    for signal in ("torque", "current"):
        possible = _possible(table, signal, taken, kind)
        unit_stated = [k for k in possible if understood(table.headers[k]).unit is not None]
        likely = _likely(table, signal, possible) or unit_stated
        if likely:
            best = min(likely, key=lambda k: _doubts(plain(table.headers[k])))
            of_motor = signal == "torque" and _is_of_motor(table.headers[best])
            return {"motor_torque" if of_motor else signal: best}
    return {}


def _is_of_motor(header: str) -> bool:
    """Whether a header names the motor, also within a word (Motorwinkel), and nothing on the joint side."""
    name = plain(header)
    return "motor" in name and not any(part in name for part in ("link", "output", "load"))


def _number(table: Table, index: int | None) -> str:
    words = [] if index is None else plain(table.headers[index]).split("_")
    return next((word for word in words if word.isdigit()), "")


def _proposal(table: Table, proposed: Mapping[str, int], kind: str | None) -> Action | None:
    """Return the call with these columns; for more than one column also with the units to check."""
    if not proposed:
        return None
    columns: dict[str, Any] = {}
    units: dict[str, str] = {}
    for signal, index in proposed.items():
        header = table.headers[index]
        columns[signal] = header if table.headers.count(header) == 1 else index
        if understood(header).unit is None:
            units[signal] = unit_by_values(table, index, signal, kind or "revolute")
    units = {signal: unit for signal, unit in units.items() if unit}
    arguments: dict[str, Any] = {"columns": columns}
    if "position" in proposed and _is_of_motor(table.headers[proposed["position"]]):
        arguments["side"] = {"position": "motor"}
    if len(columns) > 1 and units:
        return Action(
            "call",
            {**arguments, "units": units},
            function="load",
            text="check the unit of each column",
        )
    return Action("call", arguments, function="load")


def _chosen(signal: str, column: Column) -> Action:
    return Action("call", {"columns": {signal: column.index}}, function="load")
