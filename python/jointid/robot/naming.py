"""Findings that name a given fact that is wrong, and the call that has it otherwise."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.estimate.wording import percent, two_digits
from jointid.robot.error_candidates import CENTRE, LINK, PAYLOAD, TILT, TORQUE, ZERO, SmallError
from jointid.robot.inertia import FREE, SCALED
from jointid.robot.robot import Robot
from jointid.robot.wrong_facts import WrongFact
from jointid.robot.zeros import Zeros


def turned_zeros(zeros: Zeros, robot: Robot) -> Finding:
    """The finding that the recording counts from another pose than the URDF."""
    turned = [
        f"{name} by {np.rad2deg(angle):+.0f} degrees"
        for name, angle in zip(robot.names, zeros.offsets, strict=True)
        if angle
    ]
    return Finding(
        code="turned_zero",
        severity="warning",
        evidence={"before": Measured(zeros.before), "after": Measured(zeros.after)},
        title=f"the recording counts {' and '.join(turned)} from another zero than the URDF: with the URDF's inertias "
        f"{percent(zeros.before)} of the torque stays unexplained without these offsets, and {percent(zeros.after)} "
        "with them; they are taken into account",
        advice=(
            Action(
                "call",
                {"zero_offsets": [round(each, 6) for each in zeros.offsets]},
                text="if that is so",
                function="Robot.from_urdf",
            ),
        ),
    )


def named_fact(wrong: WrongFact, shown: str) -> Finding:
    """The finding that one fact, if it were otherwise, would explain most of what is left; `shown`: of which joint."""
    first, *others = wrong.joints
    both = " and ".join(wrong.joints)
    coupling = f"motor {first} turns with {' and '.join(others)} by {wrong.coupling or 0.0:g}"
    texts = {
        "swapped_joints": f"the columns of {both} are probably exchanged",
        "swapped_torques": f"the torques of {both} are probably exchanged",
        "wrong_sign": f"{first} probably turns the other way: its position and torque have the wrong sign, or its gear "
        f"ratio{_or_other(wrong)}",
        "wrong_motion_sign": f"{first} is probably recorded with its position of the wrong sign, and its torque of the "
        "right one",
        "wrong_torque_sign": f"the torque of {first} probably has the wrong sign",
        "wrong_coupling": f"a coupling is probably wrong: if {coupling}, and not as given, more is "
        f"explained{_or(wrong)}",
    }
    advice: tuple[Action, ...] = (Action("inspect", text="the order and names of the columns"),)
    if wrong.kind == "wrong_sign":
        advice = (_call({"directions": _plain(wrong.robot.directions)}),)
    if wrong.kind == "wrong_motion_sign":
        turned = {
            "directions": _plain(wrong.robot.directions),
            "torque_scales": _plain(wrong.robot.torque_scales),
        }
        advice = (_call(turned),)
    if wrong.kind == "wrong_torque_sign":
        advice = (_call({"torque_scales": _plain(wrong.robot.torque_scales)}),)
    if wrong.kind == "wrong_coupling":
        advice = (_call({"couplings": {first: {others[0]: wrong.coupling}}}),)
    return Finding(
        code=wrong.kind,
        severity="warning",
        evidence={"before": Measured(wrong.before), "after": Measured(wrong.after)},
        title=f"{texts[wrong.kind]}: {percent(wrong.before)} of the torque of {shown} stays unexplained as it is, "
        f"and {percent(wrong.after)} so",
        advice=advice,
    )


def named_error(error: SmallError, names: Sequence[str]) -> Finding:
    """The finding that a fact is somewhat wrong.

    Parameters
    ----------
    error : SmallError
    names : sequence of str
        Of the joints.
    """
    text, evidence, advice = _WORDED[error.kind](
        error, "" if error.joint is None else names[error.joint]
    )
    also = "".join(f", or {_NOUNS[kind].format(names[joint or 0])}" for kind, joint in error.others)
    return Finding(
        code=error.kind,
        severity="warning",
        evidence={**evidence, "share": Measured(error.share)},
        title=f"{text}{also}; that explains {percent(error.share)} of the squared residual in stretches of motion that "
        "it was not taken from",
        advice=advice,
    )


_NOUNS = {
    TILT: "the base is not upright",
    ZERO: "the zero of {} is off",
    TORQUE: "the torque of {} is scaled",
    LINK: "the link that {} moves has another weight",
    CENTRE: "the link that {} moves has another centre of mass",
    PAYLOAD: "the link that {} moves carries a body",
}

_Worded = tuple[str, dict[str, Measured], tuple[Action, ...]]


def _tilted(error: SmallError, _: str) -> _Worded:
    gravity = error.robot.tree.gravity
    before = error.given.tree.gravity
    across = np.linalg.norm(np.cross(before, gravity))
    degrees = float(np.rad2deg(np.arctan2(across, before @ gravity)))
    spread = float(np.rad2deg(np.linalg.norm(error.errors)))
    text = f"gravity is not where it is said to be: the base is tilted by {degrees:.1f} ± {two_digits(spread)} degrees"
    return (
        text,
        {"tilt": Measured(degrees, "deg"), "tilt_error": Measured(spread, "deg")},
        (_call({"gravity": [round(float(each), 3) for each in gravity]}),),
    )


def _moved(error: SmallError, name: str) -> _Worded:
    spread, joint = float(error.errors[0]), error.joint or 0
    offsets = error.robot.zero_offsets or ()
    value = offsets[joint] - (error.given.zero_offsets or (0.0,) * len(offsets))[joint]
    degrees, of_degrees = np.rad2deg(value), np.rad2deg(spread)
    text = f"the zero of {name} is off: the URDF's angle is {degrees:+.2f} ± {two_digits(of_degrees)} degrees from it"
    evidence = {"offset": Measured(value, "rad"), "offset_error": Measured(spread, "rad")}
    return text, evidence, (_call({"zero_offsets": [round(each, 5) for each in offsets]}),)


def _torque(error: SmallError, name: str) -> _Worded:
    value, spread = float(error.values[0]), float(error.errors[0])
    text = (
        f"the torque of {name} is {100.0 * abs(value):.1f} ± {two_digits(100.0 * spread)} % too {_side(value)}, beside "
        "what the links' weight and the other joints say: its torque constant or gear ratio is probably wrong"
    )
    evidence = {"scale": Measured(1.0 + value), "scale_error": Measured(spread)}
    return text, evidence, (_call({"torque_scales": _plain(error.robot.torque_scales)}),)


def _link(error: SmallError, name: str) -> _Worded:
    value, spread = 1.0 + float(error.values[0]), float(error.errors[0])
    text = (
        f"the link that {name} moves is not as in the URDF: {value:.3g} ± {two_digits(spread)} times its inertial "
        "parameters fit"
    )
    evidence = {"scale": Measured(value), "stderr": Measured(spread)}
    return text, evidence, (Action("call", {"inertia": SCALED}, function="identify_robot"),)


def _centre(error: SmallError, name: str) -> _Worded:
    mass = float(error.robot.tree.inertias[error.joint or 0, 0])
    way = 1e3 * error.values / mass if mass else error.values
    text = (
        f"the centre of mass of the link that {name} moves is not where the URDF has it, by "
        f"({', '.join(f'{each:.0f}' for each in way)}) mm in the link's frame"
    )
    evidence = {
        axis: Measured(float(each) * 1e-3, "m") for axis, each in zip("xyz", way, strict=True)
    }
    return text, evidence, _freed()


def _carried(error: SmallError, name: str) -> _Worded:
    mass, spread = float(error.values[0]), float(error.errors[0])
    place = ", ".join(f"{each:.2f}" for each in error.values[1:] / mass)
    text = (
        f"the link that {name} moves carries {mass:.2f} ± {two_digits(spread)} kg that the URDF does not know, at "
        f"({place}) m in its frame"
    )
    return text, {"mass": Measured(mass, "kg"), "mass_error": Measured(spread, "kg")}, _freed()


_WORDED = {
    TILT: _tilted,
    ZERO: _moved,
    TORQUE: _torque,
    LINK: _link,
    CENTRE: _centre,
    PAYLOAD: _carried,
}


def _or(wrong: WrongFact) -> str:
    nearly = " and ".join(f"{each.coupling or 0.0:g}" for each in wrong.others)
    return f" ({nearly} is nearly as good; the sign rests on little)" if nearly else ""


def _or_other(wrong: WrongFact) -> str:
    names = [name for each in wrong.others for name in each.joints]
    return f" (or {' or '.join(names)} does: this motion does not tell them apart)" if names else ""


def _call(arguments: Mapping[str, object]) -> Action:
    return Action("call", arguments, function="Robot.from_urdf")


def _freed() -> tuple[Action, ...]:
    return (Action("call", {"inertia": FREE}, function="identify_robot"),)


def _plain(values: Sequence[float] | None) -> list[float]:
    return [round(each, 4) for each in values or ()]


def _side(value: float) -> str:
    return "high" if value > 0.0 else "low"
