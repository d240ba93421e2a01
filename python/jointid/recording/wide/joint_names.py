"""Lookup of a joint by name or number."""

import re
from collections.abc import Sequence

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.recording.signals import closest
from jointid.recording.wide.words import CARRIERS

_DIGITS = r"(\d+)"
_BETWEEN = r"[\W\d_]+"


def joint_named(
    joint: object,
    joints: Sequence[str],
    place: str,
    argument: str = "joint",
    function: str = "",
) -> str:
    """Return the name of the joint that a name or number refers to.

    Parameters
    ----------
    joint : str or int
        A name, or a joint's number: 3 is "3" or "03". It is also "joint_3" if all names have the same form with
        different numbers. Otherwise a robot's third joint need not be "wrist_3_joint".
    joints : sequence of str
    place : str
        For messages.
    argument : str
        Name of the argument, for messages.
    function : str
        The called function, for the call that a message proposes. Default: no proposal.

    Raises
    ------
    InputError
        There is no such joint.
    """
    if isinstance(joint, bool) or not isinstance(joint, str | int):
        raise InputError(
            "a joint's name or number is expected", argument=argument, value=joint, place=place
        )
    text = str(joint)
    if text in joints:
        return text
    number = int(text) if text.isdecimal() else None
    numbered = {} if number is None else _numbered_alike(joints)
    if number in numbered:
        return numbered[number]
    names = (
        f"{'the only one is' if len(joints) == 1 else 'there are'} {', '.join(joints) or 'none'}"
    )
    if number is not None and not numbered:
        names += "; the joints have no common numbering" if len(joints) > 1 else ""
    near = _near(text, joints) if number is None else ""
    remedy: str | Action | tuple[()] = f"did you mean {near!r}" if near else ()
    if number is not None and not numbered and function and joints:
        value = joints[0] if argument == "joint" else [joints[0]]
        other = "or another joint" if len(joints) > 1 else ""
        remedy = Action("call", {argument: value}, function=function, text=other)
    raise InputError(
        f"there is no such joint; {names}",
        argument=argument,
        value=joint,
        place=place,
        remedy=remedy,
    )


def _numbered_alike(joints: Sequence[str]) -> dict[int, str]:
    """Return number → name if the text around the number is the same in all names; otherwise empty."""
    parts = [re.split(_DIGITS, name) for name in joints]
    if len({len(each) for each in parts}) != 1:
        return {}
    if len(joints) > 1:
        places = range(len(parts[0]))
        differing = [place for place in places if len({each[place] for each in parts}) > 1]
    else:  # the joint's number is the last one, if the name says "joint"
        before = _words(parts[0][-3])[-1:] if len(parts[0]) > 1 else ["no number"]
        differing = [len(parts[0]) - 2] if set(before) <= CARRIERS else []
    if len(differing) != 1 or differing[0] % 2 == 0:
        return {}
    found = {int(each[differing[0]]): name for each, name in zip(parts, joints, strict=True)}
    return found if len(found) == len(joints) else {}


def _near(text: str, joints: Sequence[str]) -> str:
    """Return the name closest to a misspelt name or word of a name; empty if it is ambiguous."""
    whole = closest(text, joints)
    if whole:
        return whole
    words: dict[str, list[str]] = {}
    for name in joints:
        for word in dict.fromkeys(_words(name)):
            words.setdefault(word, []).append(name)
    owners = words.get(closest(text, words) or "", [])
    return owners[0] if len(owners) == 1 else ""


def _words(name: str) -> list[str]:
    return re.sub(_BETWEEN, " ", name).casefold().split()
