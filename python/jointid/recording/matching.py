"""Choice of one column per signal: from its candidates, left out with a reason, or refused."""

from collections.abc import Mapping
from dataclasses import field

from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.recording.columns import Column, candidates_of
from jointid.recording.signals import NEEDED, SIGNALS, TORQUES, dimensions
from jointid.recording.table import Table

# Signals with a dimension that shows the kind of joint, clearest first.
_SHOWING_KIND = ("position", "link_position", "reference", "velocity", "torque")


@dataclass(frozen=True, kw_only=True)
class Match:
    """The column of each signal.

    Attributes
    ----------
    found : dict of str to Column
        Signal → its column, in the order of `SIGNALS`.
    kind : str
        Kind of the joint, as stated or from the units.
    left_out : list of dict
        Columns that match a signal but are not read: ``"column"`` (the header), ``"signal"`` and
        ``"reason"``.
    """

    found: dict[str, Column]
    kind: str
    left_out: list[dict[str, str]] = field(default_factory=list)


def match_columns(
    table: Table,
    *,
    columns: Mapping[str, str | int | None] | None,
    units: Mapping[str, str] | None,
    scale: Mapping[str, float] | None,
    kind: str | None,
) -> Match:
    """Return the column of each signal present.

    Time and position are needed, and one of torque, motor torque and current. For any other signal, a column
    is left out if its unit does not fit, or if another column fits equally well.

    Parameters
    ----------
    table : Table
    columns, units, scale, kind
        As in `load`.

    Raises
    ------
    InputError
        A needed signal has no column, two columns, or a unit of another dimension; one error names all of
        them. Or a header, signal or unit does not exist.
    """
    found = candidates_of(table, columns=columns, units=units, scale=scale, kind=kind)
    absent = [signal for signal in NEEDED if not found.of.get(signal)]
    problems = []
    if absent:
        from jointid.recording.column_problems import missing

        problems.append(missing(table, absent, found, kind))
    match = Match(found={}, kind=kind or _kind_shown(table, found.of))
    refused = {
        signal: problem
        for signal in SIGNALS
        if found.of.get(signal)
        and (problem := _take(table, signal, found.of[signal], match)) is not None
    }
    other_torque = any(signal in match.found for signal in TORQUES)
    for signal, problem in refused.items():
        if signal in NEEDED or not other_torque or found.of[signal][0].chosen:
            problems.append(problem)
        else:
            _leave_out(table, signal, found.of[signal], problem.reason, match)
    if problems:
        from jointid.recording.column_problems import together

        raise together(table, problems)
    return match


def _take(table: Table, signal: str, candidates: list[Column], match: Match) -> InputError | None:
    """Enter the column of a signal, or why it is left out; return the error if the signal is needed."""
    fitting = [column for column in candidates if column.fits(signal, match.kind)]
    clearest = [c for c in fitting if c.rank == min(each.rank for each in fitting)]
    strict = table.saved is not None or candidates[0].chosen
    if len(clearest) == 1:
        match.found[signal] = clearest[0]
        others = [column for column in fitting if column is not clearest[0]]
        reason = f"{signal} is read from {table.headers[clearest[0].index]!r}"
        _leave_out(table, signal, others, reason, match)
        return None
    from jointid.recording.column_problems import ambiguous, in_other_unit, wrong_unit

    if clearest:
        if strict or signal in (*NEEDED, *TORQUES):
            return ambiguous(table, signal, clearest)
        _leave_out(table, signal, clearest, f"several columns are recognised as {signal}", match)
        return None
    asked = signal in TORQUES and candidates[0].documented is not None
    if strict or asked or signal in (*NEEDED, "torque"):
        return wrong_unit(table, signal, candidates[0], match.kind)
    for column in candidates:
        _leave_out(table, signal, [column], f"{signal} {in_other_unit(column)}", match)
    return None


def _leave_out(table: Table, signal: str, columns: list[Column], reason: str, match: Match) -> None:
    match.left_out.extend(
        {"column": table.headers[column.index], "signal": signal, "reason": reason}
        for column in columns
    )


def _kind_shown(table: Table, candidates: Mapping[str, list[Column]]) -> str:
    """Return the kind of joint from the units.

    Raises
    ------
    InputError
        The columns of one signal have units of a revolute and of a prismatic joint.
    """
    for signal in _SHOWING_KIND:
        kinds = {
            kind: column
            for kind in ("revolute", "prismatic")
            for column in candidates.get(signal, [])
            if column.unit and column.unit.dimension in dimensions(signal, kind)
        }
        if len(kinds) == 2:
            clear = [c for c in kinds.values() if c.rank == min(k.rank for k in kinds.values())]
            if len(clear) == 1:
                return next(kind for kind, column in kinds.items() if column is clear[0])
            from jointid.recording.column_problems import of_both_kinds

            raise of_both_kinds(table, signal, tuple(kinds.values()))
        if kinds:
            return next(iter(kinds))
    return "revolute"
