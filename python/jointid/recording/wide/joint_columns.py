"""The signals of a joint's columns, and the side of the gear of each."""

from collections.abc import Mapping, Sequence
from dataclasses import field

from jointid.base.advice import Action
from jointid.base.error_text import joint_phrase
from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.recording.headers import parsed, understood
from jointid.recording.sides import JOINT, MOTOR
from jointid.recording.signals import TORQUES, dimensions
from jointid.recording.table import Table
from jointid.recording.wide.finding_joints import JointHeader

_NEEDED = ("position", "velocity", "torque", "motor_torque")
_MOVING = ("velocity", "reference")
_TORQUES = ("torque", "motor_torque")


@dataclass(frozen=True, kw_only=True)
class OwnColumns:
    """The columns of a joint's signals.

    Attributes
    ----------
    of : dict of str to int or None
        Signal → column of the table. None: the user leaves the signal out, or no column may be used.
    side : str
        Side of the gear of the position: "joint" or "motor".
    other_sides : dict of str to str
        Signal → its side, if it differs from `side`.
    asked : tuple of JointHeader
        Commanded and filtered torques, which are used only if the user names them.
    """

    of: dict[str, int | None]
    side: str = JOINT
    other_sides: dict[str, str] = field(default_factory=dict)
    asked: tuple[JointHeader, ...] = ()


def own_columns(
    table: Table,
    mine: Sequence[JointHeader],
    shared: Sequence[int],
    given: Mapping[str, int | None],
) -> OwnColumns:
    """Return the column of each signal of a joint.

    Joint-side columns come before motor-side columns. Velocity and reference are on the side of the position. A
    link encoder is the position if there is no other. With a motor-side position, a torque without a stated side is
    refused. A commanded or filtered torque is used only if the user names it.

    Parameters
    ----------
    table : Table
    mine : sequence of JointHeader
        The joint's columns.
    shared : sequence of int
        Columns that belong to no joint.
    given : mapping of str to int or None
        Signal → column from the user.

    Raises
    ------
    InputError
        Two columns fit one signal, a torque's side is not known, or the only torque is a commanded one.
    """
    used = set(given.values())
    meant: dict[str, list[JointHeader]] = {}
    asked: list[JointHeader] = []
    for each in mine:
        if each.meaning and each.index not in used and _readable(each):
            if each.meaning.asked:
                asked.append(each)
            else:
                meant.setdefault(each.meaning.signal, []).append(each)
    side = _side(mine, meant, given.get("position"))
    chosen: dict[str, int | None] = dict(given)
    other_sides = _given_sides(mine, given, side)
    for signal, found in meant.items():
        if signal in given or (side == MOTOR and signal in _TORQUES):
            continue
        fitting = found
        if signal in ("position", *_MOVING):
            fitting = [each for each in found if each.meaning and each.meaning.side == side]
        if fitting:
            chosen[signal] = _only(table, signal, fitting).index
    if side == MOTOR and "torque" not in given:
        if given.get("motor_torque") is not None:
            chosen["torque"] = None
        else:
            _choose_torque(table, meant, chosen, other_sides)
    if asked and not any(chosen.get(signal) is not None for signal in TORQUES):
        _ask(table, mine, shared, given, asked)
    return OwnColumns(of=chosen, side=side, other_sides=other_sides, asked=tuple(asked))


def _side(
    mine: Sequence[JointHeader], meant: dict[str, list[JointHeader]], position: int | None
) -> str:
    """Return the side of the position; a link encoder becomes the position if there is no other."""
    if position is not None:
        column = _of_column(mine, position)
        return column.meaning.side if column and column.meaning else JOINT
    here = meant.get("position", [])
    if not here and "link_position" in meant:
        meant["position"] = here = meant.pop("link_position")
    at_joint = any(each.meaning and each.meaning.side == JOINT for each in here)
    return JOINT if at_joint or not here else MOTOR


def _given_sides(
    mine: Sequence[JointHeader], given: Mapping[str, int | None], side: str
) -> dict[str, str]:
    """Return the other sides of the user's columns: for motion from the header, for a torque from the signal."""
    sides = {}
    for signal in ("torque", *_MOVING):
        index = given.get(signal)
        if index is None:
            continue
        column = _of_column(mine, index)
        meaning = column.meaning if column else None
        said = meaning.side if meaning and meaning.side_said else None
        own = said or (JOINT if signal == "torque" else side)
        if own != side and not (signal == "torque" and side == JOINT):
            sides[signal] = own
    return sides


def _choose_torque(
    table: Table,
    meant: Mapping[str, list[JointHeader]],
    chosen: dict[str, int | None],
    other_sides: dict[str, str],
) -> None:
    """Enter the torque for a motor-side position: the motor's torque, or one that is marked as joint side."""
    at_motor = [] if "motor_torque" in chosen else meant.get("motor_torque", [])
    others = meant.get("torque", [])
    if at_motor:
        chosen["torque"] = _only(table, "motor torque", at_motor).index
    elif others:
        found = _only(table, "torque", others)
        if not (found.meaning and found.meaning.side_said):
            raise _without_side(table, found)
        chosen["torque"] = found.index
        other_sides["torque"] = JOINT


def _without_side(table: Table, column: JointHeader) -> InputError:
    return InputError(
        f"{table.headers[column.index]!r} does not show its side of the gear, and the position of joint "
        f"{column.joint} is on the motor side",
        place=table.header_place,
        remedy=(
            _naming("motor_torque", column, "for a motor-side torque"),
            _naming("torque", column, "for a joint-side torque"),
        ),
    )


def _ask(
    table: Table,
    mine: Sequence[JointHeader],
    shared: Sequence[int],
    given: Mapping[str, int | None],
    asked: Sequence[JointHeader],
) -> None:
    """Refuse a joint with only commanded or filtered torques; the user may name one, or leave it out."""
    if any(signal in given for signal in _TORQUES):
        return
    headers = [*(each.header for each in mine), *(table.headers[index] for index in shared)]
    meanings = [understood(header).meaning for header in headers]
    if any(meaning is not None and meaning.signal in TORQUES for meaning in meanings):
        return
    names = " and ".join(repr(table.headers[each.index]) for each in asked[:2])
    raise InputError(
        f"{joint_phrase(asked[0].joint)} has no measured torque or current; "
        f"{names} {'is' if len(asked) == 1 else 'are'} commanded or filtered and must be chosen explicitly",
        place=table.header_place,
        remedy=(
            *(_naming(each.meaning.signal, each) for each in asked[:2] if each.meaning),
            Action("call", {"columns": {"torque": None}}, function="load", text="without torque"),
        ),
    )


def _naming(signal: str, column: JointHeader, text: str = "") -> Action:
    return Action("call", {"columns": {signal: column.pattern}}, function="load", text=text)


def _readable(column: JointHeader) -> bool:
    """Whether a column's unit fits its signal; a wrong unit of an optional signal raises no error."""
    if column.meaning is None or column.meaning.signal in _NEEDED:
        return True
    _, unit, unknown = parsed(column.header)
    known = dimensions(column.meaning.signal, None)
    return not unknown and (unit is None or unit.dimension in known)


def _of_column(mine: Sequence[JointHeader], index: int) -> JointHeader | None:
    return next((each for each in mine if each.index == index), None)


def _only(table: Table, signal: str, found: list[JointHeader]) -> JointHeader:
    ranks = [each.meaning.rank for each in found if each.meaning]
    best = [each for each, rank in zip(found, ranks, strict=True) if rank == min(ranks)]
    if len(best) == 1:
        return best[0]
    names = " and ".join(f"{table.headers[each.index]!r}" for each in best[:3])
    argument = signal.replace(" ", "_")
    raise InputError(
        f"{names} could both be the {signal} of {joint_phrase(best[0].joint)}",
        place=table.header_place,
        remedy=tuple(_naming(argument, each) for each in best[:2]),
    )
