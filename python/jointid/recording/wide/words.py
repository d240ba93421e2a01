"""Meaning of the words in a header of a log of several joints."""

from dataclasses import replace

from jointid.base.values import dataclass
from jointid.recording.header_words import QUANTITIES
from jointid.recording.sides import JOINT, MOTOR

# Next to a joint's number or name, these shorter words are clear.
_NOUNS: dict[str, str] = QUANTITIES | {
    word: signal
    for signal, words in {
        "position": "ang",
        "torque": "trq eff moments",
        "current": "cur",
        "temperature": "temps",
        "sensor": "sensor sensors",
        "reference": "reference references ref",
    }.items()
    for word in words.split()
}
_MOTOR = frozenset(("motor", "mot", "rotor", "drive"))
_LINK = frozenset(("link", "output", "load", "linkside", "loadside"))
_BEHIND = frozenset(("link", "load"))
_LINK_SIDE = frozenset(("linkside", "loadside", "outputside"))
COMMAND = frozenset(
    (
        *("target", "desired", "des", "command", "commanded", "cmd", "goal", "setpoint"),
        *("reference", "ref"),
    )
)
_NEUTRAL = frozenset(
    (
        *("joint", "joints", "axis", "achse", "dof", "actual", "act", "present", "measured"),
        *("meas", "state", "states", "encoder", "enc", "feedback", "fbk", "fb", "raw"),
        *("estimate", "estimated", "est"),
    )
)
KNOWN = frozenset(_NOUNS) | _MOTOR | _LINK | _LINK_SIDE | COMMAND | _NEUTRAL
NUMBERED = frozenset(_NOUNS) | _MOTOR | _LINK | COMMAND | _NEUTRAL | {"j", "a"}
"""Words that a joint's number may follow directly: q3, joint3, A1."""
CARRIERS = frozenset(("joint", "axis", "achse", "dof", "j", "a"))
"""Words that only announce a joint's number."""
_FILTERED = frozenset(("filtered", "filt", "smoothed"))
_AT_OUTPUT = _LINK_SIDE | {"output"}
_SAYS_JOINT = _AT_OUTPUT | {"joint", "joints"}
COMPUTED = frozenset(("error", "errors", "err", "output", "limit", "limits", "min", "max"))
"""Words for parts of a message that are not measured: a controller's error and output."""


@dataclass(frozen=True, kw_only=True)
class Meaning:
    """The meaning of a joint's column.

    Attributes
    ----------
    signal : str
        Signal of a recording.
    side : str
        Side of the gear: "joint" or "motor".
    rank : int
        Among several columns of one signal and side, the lowest rank is chosen.
    side_said : bool
        Whether a word states the side; otherwise it is assumed.
    asked : bool
        Whether the column is not a measurement, such as a commanded torque; used only if the user names it.
    """

    signal: str
    side: str
    rank: int = 0
    side_said: bool = False
    asked: bool = False


def meaning_of(words: tuple[str, ...]) -> Meaning | None:
    """Return the meaning of a column from its header's words without unit and joint; None if a word is unknown.

    A column is used only if every word is known. Computed torques (``model_gravity_torque``), tool poses and the like
    are therefore ignored.

    Parameters
    ----------
    words : tuple of str
        Words in lower case.

    Examples
    --------
    >>> meaning_of(("motor", "encoder", "pos", "linkside"))
    Meaning(signal='position', side='joint', rank=0, side_said=True, asked=False)
    """
    said = set(words)
    if said & _FILTERED and said <= KNOWN | _FILTERED:
        # A filter delays: only a filtered torque is offered to the user, other filtered signals are ignored.
        found = meaning_of(tuple(said - _FILTERED))
        torque = found is not None and found.signal in ("torque", "motor_torque")
        return replace(found, asked=True) if found and torque else None
    if "qfrc" in said:  # MuJoCo's joint torques; those not from actuators are computed
        said -= {"actuator"}
    if not said or not said <= KNOWN:
        return None
    signals = {_NOUNS[word] for word in said if word in _NOUNS}
    if signals == {"torque", "sensor"}:
        return Meaning(signal="sensor", side=JOINT)
    commanded = bool(said & COMMAND)
    if commanded:
        signals -= {"reference"}
        if signals <= {"position"}:  # a reference without another word is a position
            side = MOTOR if said & _MOTOR else JOINT
            return Meaning(signal="reference", side=side)
        # A commanded value is never taken for a measured one; commands of other quantities are no signals.
        found = _torque(said) if signals == {"torque"} else None
        return replace(found, asked=True) if found else None
    if len(signals) != 1:
        return None
    (signal,) = signals
    if signal in ("current", "temperature", "sensor"):
        return Meaning(signal=signal, side=JOINT)
    if signal == "torque":
        return _torque(said)
    at_link = bool(said & _LINK_SIDE) or not said & _MOTOR
    if signal == "position" and said & (_LINK - _LINK_SIDE) and not said & _MOTOR:
        return Meaning(signal="link_position", side=JOINT)
    link = bool(said & (_LINK - _LINK_SIDE)) and not said & _MOTOR
    side_said = bool(said & (_MOTOR | _SAYS_JOINT | _LINK))
    side = JOINT if at_link else MOTOR
    return Meaning(signal=signal, side=side, rank=int(link), side_said=side_said)


def _torque(said: set[str]) -> Meaning | None:
    if said & _MOTOR and not said & _AT_OUTPUT:
        return Meaning(signal="motor_torque", side=MOTOR, side_said=True)
    if said & _BEHIND and not said & _AT_OUTPUT:
        return None  # a torque that acts on the link is not the drive's torque
    return Meaning(signal="torque", side=JOINT, side_said=bool(said & _SAYS_JOINT))
