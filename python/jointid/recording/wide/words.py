"""The words of a header in a log of several joints: what they say of a column."""

from dataclasses import dataclass

JOINT, MOTOR = "joint", "motor"
SIDES = (JOINT, MOTOR)

_NOUNS: dict[str, str] = {
    word: signal
    for signal, words in {
        "position": "position positions pos angle angles ang q qpos theta",
        "velocity": "velocity velocities vel speed speeds qd dq qdot qvel omega",
        "torque": "torque torques tau effort efforts trq eff qfrc",
        "current": "current currents cur",
        "temperature": "temperature temperatures temp temps",
        "sensor": "sensor sensors",
        "reference": "reference references ref",
    }.items()
    for word in words.split()
}
_MOTOR = frozenset(("motor", "mot", "rotor", "drive"))
_LINK = frozenset(("link", "output", "load", "linkside", "loadside"))
_LINK_SIDE = frozenset(("linkside", "loadside", "outputside"))
COMMAND = frozenset(
    (
        *("target", "desired", "des", "command", "commanded", "cmd", "goal", "setpoint"),
        *("reference", "ref"),
    )
)
_NEUTRAL = frozenset(
    (
        *("joint", "joints", "axis", "achse", "dof", "actual", "act", "measured", "meas", "state"),
        *("states", "encoder", "enc", "feedback", "fbk", "fb", "raw"),
    )
)
KNOWN = frozenset(_NOUNS) | _MOTOR | _LINK | _LINK_SIDE | COMMAND | _NEUTRAL
NUMBERED = frozenset(_NOUNS) | _MOTOR | _LINK | COMMAND | _NEUTRAL | {"j", "a"}
"""Words that a joint's number may follow without anything between: q3, joint3, A1."""
CARRIERS = frozenset(("joint", "axis", "achse", "dof", "j", "a"))
"""Words that say no more than that a joint's number follows."""
TORQUES = frozenset(("moment", "moments", "torque", "torques", "joint", "joints"))
"""Words of a commanded torque, as far as it is not read by itself."""
COMPUTED = frozenset(("error", "errors", "err", "output", "limit", "limits", "min", "max"))
"""Words that name the part of a message that is not measured: a controller's error and output."""
_RANKS = 3


@dataclass(frozen=True, kw_only=True)
class Meaning:
    """What a column of a joint is.

    Attributes
    ----------
    signal : str
        One of a recording's.
    side : str
        Of the gear: "joint" or "motor".
    rank : int
        Of several columns of one signal and side the one with the lowest rank is taken.
    """

    signal: str
    side: str
    rank: int = 0


def meaning_of(words: tuple[str, ...]) -> Meaning | None:
    """Return what a column is, by the words of its header without unit and joint; None if a word is unknown.

    A column is taken only if every word is known, so that what a model computed (``model_gravity_torque``), a
    tool's pose and the like are left alone.

    Parameters
    ----------
    words : tuple of str
        In lower case.

    Examples
    --------
    >>> meaning_of(("motor", "encoder", "pos", "linkside"))
    Meaning(signal='position', side='joint', rank=0)
    """
    said = set(words)
    if "qfrc" in said:  # MuJoCo's torques at the joints; what is not the actuators' is computed
        said -= {"actuator"}
    if not said or not said <= KNOWN:
        return None
    signals = {_NOUNS[word] for word in said if word in _NOUNS}
    if signals == {"torque", "sensor"}:
        return Meaning(signal="sensor", side=JOINT)
    commanded = bool(said & COMMAND)
    if commanded:
        signals -= {"reference"}
        if signals <= {"position"}:  # a reference without another word is a position's
            side = MOTOR if said & _MOTOR else JOINT
            return Meaning(signal="reference", side=side)
        # A commanded torque is taken where none is measured; other commands are no signals of a recording.
        return Meaning(signal="torque", side=JOINT, rank=_RANKS) if signals == {"torque"} else None
    if len(signals) != 1:
        return None
    (signal,) = signals
    if signal in ("current", "temperature", "sensor"):
        return Meaning(signal=signal, side=JOINT)
    at_link = bool(said & _LINK_SIDE) or not said & _MOTOR
    if signal == "torque" and not at_link:
        return Meaning(signal="motor_torque", side=MOTOR)
    if signal == "position" and said & (_LINK - _LINK_SIDE) and not said & _MOTOR:
        return Meaning(signal="link_position", side=JOINT)
    link = bool(said & (_LINK - _LINK_SIDE)) and not said & _MOTOR
    return Meaning(signal=signal, side=JOINT if at_link else MOTOR, rank=int(link))
