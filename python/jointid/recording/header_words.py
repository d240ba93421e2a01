"""Meaning of headers, word by word: the signal of names such as `joint1_pos`, `actual_q_0` or `Axis 1.ActPos`."""

import re
from functools import lru_cache

from jointid.base.values import dataclass


def _words_of(text: str) -> frozenset[str]:
    return frozenset(text.split())


QUANTITIES: dict[str, str] = {
    word: quantity
    for quantity, words in {
        "position": "position positions pos angle angles q qpos theta winkel",
        "velocity": "velocity velocities vel velo speed speeds omega dq qd qdot qvel dtheta "
        "geschwindigkeit drehzahl",
        "torque": "torque torques tau effort efforts moment drehmoment qfrc",
        "current": "current currents iq strom",
        "temperature": "temperature temperatures temp temperatur",
    }.items()
    for word in words.split()
}
"""Word → the quantity that it names."""
_MEASURED = _words_of(
    "actual act present measured meas measurement estimate estimated est feedback fbk"
)
_COMMANDED = _words_of(
    "desired des d target cmd command commanded set setpoint setpoints ref reference goal soll"
)
# Words without information about the signal.
_PLAIN = _words_of("joint joints jnt j dof state states msg msgs data field value main nc to plc")
# A header with one of these words is not the signal itself.
_OTHER = _words_of(
    "error err errors limit limits min max offset std sigma raw_offset gain ext "
    "filtered friction gravity inertia model enabled valid flag status count"
)
_NUMBERED = frozenset(["axis", "achse"])  # no information about the signal if a number follows
_ROLES: dict[str, str] = {
    **dict.fromkeys(("motor", "mot"), "motor"),
    **dict.fromkeys(("link", "load"), "link"),
    "sensor": "sensor",
}
_SIGNALS: dict[tuple[str, str], str] = {
    **{("", quantity): quantity for quantity in QUANTITIES.values()},
    ("motor", "torque"): "motor_torque",
    ("motor", "current"): "current",
    ("motor", "temperature"): "temperature",
    ("link", "position"): "link_position",
    ("sensor", "torque"): "sensor",
}
_TIMES = frozenset(
    {
        *(
            "time",
            "t",
            "tout",
            "timestamp",
            "timestamps",
            "time stamp",
            "stamp",
            "header stamp",
            "header timestamp",
        ),
        *(
            "secs",
            "seconds",
            "sec",
            "header stamp secs",
            "header stamp sec",
            "stamp secs",
            "stamp sec",
            "tv",
        ),
        *("elapsed", "elapsed time", "time elapsed", "ros time", "robot time", "controller time"),
        *("unix time", "epoch", "epoch time", "rosbag timestamp", "date time", "datetime", "zeit"),
    }
)
# Pairs of words with one meaning: q_dot is a velocity, i_q a current, time_stamp a stamp.
_JOINED = {("q", "dot"): "qdot", ("theta", "dot"): "dtheta", ("i", "q"): "iq", ("d", "q"): "dq"}
_JOINED |= {("qfrc", "actuator"): "qfrc"}  # MuJoCo; its other qfrc_... are computed
_WORD = re.compile(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])|\d+|[^\W\d_]+")
AT_THE_LINK = "torque_at_the_link"
"""Metadata key: header of a torque that may be measured on the link side, behind the drive's friction."""
_AT_THE_LINK = re.compile(
    r"(?<![a-z])(joint_?torques?|tau_?j(oint)?|torque_?sensor|sensor_?torque|link_?(side_?)?torque)(?![a-z])"
)


def is_at_the_link(header: str) -> bool:
    """Whether the header of a torque names the joint or a sensor, not the drive.

    Examples
    --------
    >>> [is_at_the_link(header) for header in ("tau_J_3", "joint_torque_Nm", "effort", "motor_torque")]
    [True, True, False, False]
    """
    return _AT_THE_LINK.search(re.sub(r"[\s.-]+", "_", header.casefold())) is not None


PLAIN, WORDS, OF_A_JOINT = range(3)  # how clearly a header names its signal, clearest first


@dataclass(frozen=True, slots=True)
class Meaning:
    """The meaning of a header.

    Attributes
    ----------
    signal : str
        ``"position"``, ...
    rank : int
        `PLAIN`: the signal's own name. `WORDS`: the name with words such as actual or measured.
        `OF_A_JOINT`: the name with the number or name of a joint.
    joint : str
        Number or name of the joint. Default: none.
    """

    signal: str
    rank: int
    joint: str = ""


@lru_cache(maxsize=4096)
def meaning_of(name: str) -> Meaning | None:
    """Return the meaning of a header without its unit, or None if a word in it is unknown.

    A commanded value is never taken for a measured one. A commanded position is the reference;
    a commanded torque or velocity is no signal.

    Parameters
    ----------
    name : str
        The header, e.g. ``"actual_q_0"``.

    Examples
    --------
    >>> meaning_of("actual_q_0")
    Meaning(signal='position', rank=2, joint='0')
    >>> meaning_of("target_q").signal
    'reference'
    >>> meaning_of("tau_cmd") is None
    True
    """
    *path, last = re.split(r"[./:]+", re.sub(r"\[(\d+)\]", r" \1 ", name).strip("./: ") or " ")
    prefix = [word for part in path for word in _words(part)]
    words = _words(last)
    if " ".join(word for word in (*prefix, *words) if word not in _PLAIN - {"stamp"}) in _TIMES:
        return Meaning("time", WORDS)
    found = _understood(prefix + words, "")
    if found is None and prefix and not _OTHER.intersection(prefix):
        known = [word for word in prefix if word in (*_COMMANDED, *_ROLES, *_MEASURED)]
        named = " ".join(word for word in prefix if word not in (*known, *_PLAIN))
        found = _understood(known + words, named)
    return found


def _understood(words: list[str], joint: str) -> Meaning | None:
    quantity = role = ""
    commanded = measured = False
    numbers: list[str] = []
    for k, word in enumerate(words):
        after = words[k + 1] if k + 1 < len(words) else ""
        if word == "current" and QUANTITIES.get(after) in ("position", "velocity"):
            measured = True  # "current position" means the actual position
        elif (word == "m" and quantity == "torque") or word in _ROLES:
            if role:
                return None
            role = _ROLES.get(word, "motor")
        elif word in QUANTITIES:
            if quantity:
                return None
            quantity = QUANTITIES[word]
        elif word in _MEASURED:
            measured = True
        elif word in _COMMANDED:
            commanded = True
        elif word.isdigit():
            numbers.append(word)
        elif not (word in _PLAIN or (word in _NUMBERED and after.isdigit())):
            return None
    if commanded and (measured or role or quantity != "position"):
        return None
    signal = "reference" if commanded else _SIGNALS.get((role, quantity))
    if signal is None or len(numbers) > 1:
        return None
    joint = " ".join([*([joint] if joint else []), *numbers])
    return Meaning(signal, OF_A_JOINT if joint else WORDS, joint)


def _words(text: str) -> list[str]:
    words = [word.casefold() for word in _WORD.findall(text)]
    for k in reversed(range(len(words) - 1)):
        if joined := _JOINED.get((words[k], words[k + 1])):
            words[k : k + 2] = [joined]
    return words
