"""The joints that a table's headers name: numbered (``motor_position_3_rad``) or named (``elbow.position [rad]``)."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import lru_cache

from jointid.base.values import dataclass
from jointid.recording.headers import LONGEST, parsed
from jointid.recording.sides import JOINT
from jointid.recording.units import find_unit
from jointid.recording.wide.one_joint import MARK
from jointid.recording.wide.words import (
    CARRIERS,
    COMMAND,
    COMPUTED,
    KNOWN,
    NUMBERED,
    Meaning,
    meaning_of,
)

_UNIT = r"\s*[\[(]\s*[^\[\](){}]*[^\[\](){}\d\s:,][^\[\](){}]*[\])]\s*$"
_INDEX = r"\[(\d+)\]|\((?::,)?(\d+)(?:,:)?\)"
_DASH = r"^\s*-\s*"  # dash of a list item before the whole header
_SEPARATORS = r"[\s_.\-/]+"
_CAMEL = r"(?<=[a-z])(?=[A-Z])"
_LETTERS_DIGITS = r"([^\W\d]+)(\d+)"


@dataclass(frozen=True, kw_only=True)
class JointHeader:
    """A header that belongs to one joint.

    Attributes
    ----------
    index : int
        0-based number of the column.
    joint : str
        The joint's name, or its number as written.
    header : str
        Header without the joint: ``motor_position_rad``.
    pattern : str
        Header with ``{joint}`` at the joint's place: ``motor_position_{joint}_rad``.
    meaning : Meaning or None
        Meaning of the header. None: no signal is recognised.
    """

    index: int
    joint: str
    header: str
    pattern: str
    meaning: Meaning | None


def joint_headers(headers: Sequence[str]) -> Mapping[str, Sequence[JointHeader]]:
    """Return the joints of a table, each with its columns, in the order in which they first appear.

    A joint needs a position; a link's position counts. The number of a joint is an index in brackets (``q[2]``,
    ``position(:,2)``), a separate word (``position.3``, ``actual_q_0``), or the end of a word that is a signal or
    "joint" (``q3``, ``joint3_pos``). The name of a joint precedes a point, slash or underscore and the signal
    (``elbow.position``, ``elbow_position``), or follows the signal and a point (``position.elbow``).

    Parameters
    ----------
    headers : sequence of str
    """
    found = _joints(tuple(headers))
    return {joint: columns for joint, columns in found.items() if _is_joint(columns)}


def columns_of(headers: Sequence[str], joint: str) -> Sequence[JointHeader]:
    """Return the columns of one joint, also if no header names its position."""
    return _joints(tuple(headers)).get(joint, ())


@lru_cache(maxsize=4)  # called for each joint of a robot
def _joints(headers: tuple[str, ...]) -> Mapping[str, Sequence[JointHeader]]:
    found: dict[str, list[JointHeader]] = {}
    for index, whole in enumerate(headers):
        if len(whole) > LONGEST:
            continue
        header = re.sub(_DASH, "", whole)
        numbered = _numbered(index, header)
        each = _indexed(index, header) or _dotted(index, header)
        if each is None and (numbered is None or numbered.meaning is None):
            each = _named(index, header)
        each = each or numbered
        if each is not None:
            dash = whole[: len(whole) - len(header)]
            found.setdefault(each.joint, []).append(replace(each, pattern=f"{dash}{each.pattern}"))
    return _with_numbers_named(found)


def _with_numbers_named(
    found: dict[str, list[JointHeader]],
) -> Mapping[str, Sequence[JointHeader]]:
    """Merge joints that are only a number and have no position into the named joints of that number.

    ``joint_1.position`` names the joint "joint_1", ``joint_1_effort`` the joint "1".
    """
    whole = [joint for joint, columns in found.items() if _is_joint(columns)]
    for number in [joint for joint in found if joint.isdigit() and joint not in whole]:
        named = [each for each in whole if re.fullmatch(rf"\D*0*{int(number)}", each)]
        if len(named) == 1:
            found[named[0]] = [
                *found[named[0]],
                *(replace(each, joint=named[0]) for each in found.pop(number)),
            ]
    return found


def _is_joint(columns: Sequence[JointHeader]) -> bool:
    signals = {each.meaning.signal for each in columns if each.meaning}
    return bool(signals & {"position", "link_position"})


def _without_unit(header: str) -> tuple[str, str]:
    """Return a header in two parts: the header without a unit in brackets, and this unit."""
    bracketed = re.search(_UNIT, header)
    cut = bracketed.start() if bracketed else len(header)
    return header[:cut], header[cut:]


def words_of(header: str) -> tuple[str, ...]:
    """Return the words of a header without its unit."""
    name, _, _ = parsed(re.sub(r"[^\W_]+", _single_words, header))
    return tuple(word for word in name.split("_") if word)


def _single_words(word: re.Match[str]) -> str:
    """Split a word in camel case; a unit (mNm, mA) stays one word."""
    return word[0] if find_unit(word[0]) is not None else re.sub(_CAMEL, "_", word[0])


def _column(index: int, joint: str, shown: str, pattern: str) -> JointHeader:
    meaning = meaning_of(words_of(shown))
    if meaning is not None and meaning.signal in ("torque", "motor_torque") and _in_amperes(shown):
        meaning = Meaning(signal="current", side=JOINT, asked=meaning.asked)
    return JointHeader(index=index, joint=joint, header=shown, pattern=pattern, meaning=meaning)


def _in_amperes(header: str) -> bool:
    """Whether a header's unit is a unit of current, regardless of its words."""
    _, unit, _ = parsed(header)
    return unit is not None and unit.dimension == "current"


def _indexed(index: int, header: str) -> JointHeader | None:
    """Parse ``q[2]``, ``states.position[2] [rad]``, ``position(:,2)``."""
    stem, unit = _without_unit(header)
    found = list(re.finditer(_INDEX, stem))
    if len(found) != 1:
        return None
    (place,) = found
    number = place[1] or place[2]
    start = place.start(1) if place[1] else place.start(2)
    pattern = f"{stem[:start]}{MARK}{stem[start + len(number) :]}{unit}"
    shown = f"{stem[: place.start()]}{stem[place.end() :]}"
    # The part before the last point or slash is the source of the signal; it may say "command", or no signal.
    *path, last = re.split(r"[./]", shown)
    source = {word.casefold() for part in path for word in _split(re.sub(_CAMEL, "_", part))}
    column = _column(index, number, "_".join([*sorted(source & COMMAND), f"{last}{unit}"]), pattern)
    return replace(column, meaning=None) if source & COMPUTED else column


def _dotted(index: int, header: str) -> JointHeader | None:
    """Parse ``elbow.position [rad]``, ``/arm/elbow/position``, ``position.elbow``."""
    stem, unit = _without_unit(header)
    for separator in (".", "/"):
        before, found, behind = stem.rpartition(separator)
        name = before.strip().rpartition("/")[2]  # last part of a path
        if not found or not name:
            continue
        pattern = f"{before[: len(before.rstrip()) - len(name)]}{MARK}{found}{behind}{unit}"
        column = _column(index, name, f"{behind}{unit}", pattern)
        if column.meaning and not set(words_of(name)) <= KNOWN:
            return column
        joint = behind.strip()
        other = _column(index, joint, f"{before}{unit}", f"{before}{found}{MARK}{unit}")
        named = joint and not joint.isdigit() and not set(words_of(joint)) <= KNOWN
        if other.meaning and named and find_unit(joint) is None:
            return other
    return None


def _numbered(index: int, header: str) -> JointHeader | None:
    """Parse ``motor_position_3_rad``, ``joint3_pos``, ``q3``, ``actual_q_0``, ``A1_torque``."""
    stem, unit = _without_unit(header)
    places = [place for place in re.finditer(r"\d+", stem) if _is_number_word(stem, place)]
    if len(places) != 1:
        return None
    (place,) = places
    before, behind = stem[: place.start()], stem[place.end() :]
    kept = [*_split(before), *_split(behind)]
    carrier = len(_split(before)) - 1
    if carrier >= 0 and kept[carrier].casefold() in CARRIERS and len(kept) > 1:
        del kept[carrier]
    if not kept:
        return None
    shown = f"{'_'.join(kept)}{unit}"
    return _column(index, place[0], shown, f"{before}{MARK}{behind}{unit}")


def _split(text: str) -> list[str]:
    return [word for word in re.split(_SEPARATORS, text) if word]


def _is_number_word(stem: str, place: re.Match[str]) -> bool:
    """Whether digits are a separate word, or follow a word that may precede a joint's number."""
    if place.end() < len(stem) and not re.match(_SEPARATORS, stem[place.end() :]):
        return False
    before = stem[: place.start()]
    if not before or re.search(_SEPARATORS, before[-1]):
        return True
    word = re.split(r"[\W\d_]+", before)[-1]
    return bool({word.casefold(), re.split(_CAMEL, word)[-1].casefold()} & NUMBERED)


def _named(index: int, header: str) -> JointHeader | None:
    """Parse ``shoulder_pan_position``, ``elbow_2_motor_torque_Nm``: the signal's words come last."""
    stem, unit = _without_unit(header)
    words = _split(stem)
    behind = len(words)
    # A unit among the last words does not belong to the signal.
    for first in range(1, len(words)):
        suffix = "_".join(words[first:])
        if not unit and not suffix[0].isdigit() and find_unit(suffix):
            behind = first
            break
    first = behind
    while first > 1 and words[first - 1].casefold() in KNOWN:
        first -= 1
    if first == behind:
        return None
    name = "_".join(words[:first])
    if words[0].casefold() in KNOWN or not stem.startswith(name):
        return None
    shown = f"{'_'.join(words[first:])}{unit}"
    column = _column(index, name, shown, f"{MARK}{stem[len(name) :]}{unit}")
    return column if column.meaning else None
