"""Findings that name a wrong fact, with the call that corrects it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.estimate.wording import percent, rounded, two_digits
from jointid.robot.facts.error_candidates import (
    CENTRE,
    LINK,
    PAYLOAD,
    TILT,
    TORQUE,
    ZERO,
    SmallError,
)
from jointid.robot.facts.wrong_facts import WrongFact
from jointid.robot.fit.zeros import Zeros
from jointid.robot.links.inertia_modes import FREE, SCALED
from jointid.robot.links.position_drive import facts_of_scales
from jointid.robot.links.robot import Robot
from jointid.robot.result.finding_types import TYPES, listed, titled

Array = NDArray[np.float64]


def turned_zeros(zeros: Zeros, robot: Robot) -> Finding:
    """Return the finding that the recording counts from another pose than the URDF."""
    turned = [
        f"{name} {np.rad2deg(angle):+.0f}°"
        for name, angle in zip(robot.names, zeros.offsets, strict=True)
        if angle
    ]
    return TYPES["turned_zero"].finding(
        titled("log and URDF have different zero positions", listed(turned)),
        Action(
            "call",
            {"zero_offsets": [round(each, 6) for each in zeros.offsets]},
            text="if these offsets are right",
            function="Robot.from_urdf",
        ),
        details=f"the offsets {', '.join(turned)} are applied; with the URDF's inertias, {percent(zeros.after)} of the "
        f"torque stays unexplained with these offsets, {percent(zeros.before)} without these offsets",
        evidence={"before": Measured(zeros.before), "after": Measured(zeros.after)},
    )


def stated_zeros(zeros: Zeros, robot: Robot) -> Finding:
    """Return the finding that stated zeros are wrong by quarter turns; `robot` has the corrected ones."""
    turned = [
        f"{name} by {np.rad2deg(angle):+.0f}°"
        for name, angle in zip(robot.names, zeros.offsets, strict=True)
        if angle
    ]
    return TYPES[ZERO].finding(
        titled("stated zeros are off", listed(turned)),
        _call({"zero_offsets": [round(each, 6) for each in robot.zero_offsets or ()]}),
        details=f"{', '.join(turned)}; with the URDF's inertias, {percent(zeros.before)} of the torque stays "
        f"unexplained with the stated zeros, {percent(zeros.after)} with the corrected zeros",
        evidence={"before": Measured(zeros.before), "after": Measured(zeros.after)},
    )


def named_fact(wrong: WrongFact, shown: str) -> Finding:
    """Return the finding that a corrected fact explains most of the residual; `shown`: the joint of the residual."""
    first, *others = wrong.joints
    both = " and ".join(wrong.joints)
    coupling = f"the coupling of motor {first} to {' and '.join(others)} is probably {wrong.coupling or 0.0:g}"
    texts = {
        "swapped_joints": (f"the columns of {both} are probably exchanged", ""),
        "swapped_torques": (f"the torques of {both} are probably exchanged", ""),
        "wrong_sign": (
            f"{first} probably turns in the opposite direction",
            f"its position and torque, or its gear ratio, have the wrong sign{_or_other(wrong)}; ",
        ),
        "wrong_motion_sign": (
            f"the position of {first} probably has the wrong sign",
            "its torque has the right sign; ",
        ),
        "wrong_torque_sign": (f"the torque of {first} probably has the wrong sign", ""),
        "wrong_coupling": (coupling, f"the facts state another coupling{_or(wrong)}; "),
    }
    title, details = texts[wrong.kind]
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
        advice = (_call({"couplings": _coupled(wrong.robot)}),)
    before, after = percent(wrong.before), percent(wrong.after)
    return TYPES[wrong.kind].finding(
        titled(title, f"{before} unexplained, {after} if corrected"),
        *advice,
        details=f"{details}{before} of the torque of {shown} stays unexplained, {after} after the correction",
        evidence={"before": Measured(wrong.before), "after": Measured(wrong.after)},
    )


def named_error(error: SmallError, names: Sequence[str]) -> Finding:
    """Return the finding of a small error of a fact."""
    title, details, evidence, advice = _WORDED[error.kind](
        error, "" if error.joint is None else names[error.joint]
    )
    others = [f"or {_NOUNS[kind].format(names[joint or 0])}" for kind, joint in error.others]
    held_out = (
        f"this error explains {percent(error.share)} of the squared residual in held-out motion"
    )
    return TYPES[error.kind].finding(
        title,
        *advice,
        details="; ".join(filter(None, (*others, details, held_out))),
        evidence={**evidence, "share": Measured(error.share)},
    )


_NOUNS = {
    TILT: "the base is not upright",
    ZERO: "the zero of {} is off",
    TORQUE: "the torque of {} has a wrong factor",
    LINK: "the weight of the link that {} moves differs from the URDF",
    CENTRE: "the centre of mass of the link that {} moves differs from the URDF",
    PAYLOAD: "the link that {} moves carries a body",
}

_Worded = tuple[str, str, dict[str, Measured], tuple[Action, ...]]
"""Title, details, evidence, advice."""


def _tilted(error: SmallError, _: str) -> _Worded:
    gravity = error.robot.tree.gravity
    before = error.given.tree.gravity
    across = np.linalg.norm(np.cross(before, gravity))
    degrees = float(np.rad2deg(np.arctan2(across, before @ gravity)))
    spread = float(np.rad2deg(np.linalg.norm(error.errors)))
    return (
        f"the base is tilted by {_with_error(degrees, spread)} degrees",
        "gravity has another direction than in the facts",
        {"tilt": Measured(degrees, "deg"), "tilt_error": Measured(spread, "deg")},
        (_call({"gravity": [round(float(each), 3) for each in gravity]}),),
    )


def _moved(error: SmallError, name: str) -> _Worded:
    spread, joint = float(error.errors[0]), error.joint or 0
    offsets = error.robot.zero_offsets or ()
    value = offsets[joint] - (error.given.zero_offsets or (0.0,) * len(offsets))[joint]
    degrees, of_degrees = np.rad2deg(value), np.rad2deg(spread)
    return (
        f"the zero of {name} is off by {_with_error(degrees, of_degrees)} degrees",
        "the URDF's angle is the recorded angle plus this offset",
        {"offset": Measured(value, "rad"), "offset_error": Measured(spread, "rad")},
        (_call({"zero_offsets": [round(each, 5) for each in offsets]}),),
    )


def _torque(error: SmallError, name: str) -> _Worded:
    value, spread = float(error.values[0]), float(error.errors[0])
    drive = error.robot.drive
    scales = facts_of_scales(drive, _plain(error.robot.torque_scales), error.given.torque_scales)
    what = "its torque constant or gear ratio is" if drive is None else "its gains are"
    return (
        f"the torque of {name} is {_with_error(100.0 * abs(value), 100.0 * spread)} % too {_side(value)}",
        f"compared with the links' weight and the other joints; {what} probably wrong",
        {"scale": Measured(1.0 + value), "scale_error": Measured(spread)},
        (_call(scales),),
    )


def _link(error: SmallError, name: str) -> _Worded:
    value, spread = 1.0 + float(error.values[0]), float(error.errors[0])
    return (
        f"the link that {name} moves has {_with_error(value, spread)} times the URDF's inertia",
        "one factor multiplies mass, first moment and inertia",
        {"scale": Measured(value), "stderr": Measured(spread)},
        (Action("call", {"inertia": SCALED}, function="identify_robot"),),
    )


def _centre(error: SmallError, name: str) -> _Worded:
    mass = float(error.robot.tree.inertias[error.joint or 0, 0])
    offset = 1e3 * error.values / mass if mass else error.values
    seen = _seen(error.values, error.errors)
    shown = ", ".join(f"{axis} {offset[place]:.0f}" for axis, place in seen.items())
    free = [axis for axis in "xyz" if axis not in seen]
    return (
        f"the centre of mass of the link that {name} moves is off by {shown} mm",
        "in the link's frame, measured from the URDF's centre of mass"
        + (f"; the motion does not show the offset along {' and '.join(free)}" if free else ""),
        {axis: Measured(float(offset[place]) * 1e-3, "m") for axis, place in seen.items()},
        _freed(),
    )


def _carried(error: SmallError, name: str) -> _Worded:
    mass, spread = float(error.values[0]), float(error.errors[0])
    centre = error.values[1:] / mass
    seen = _seen(error.values[1:], error.errors[1:])
    place = ", ".join(f"{axis} {centre[number]:.2f}" for axis, number in seen.items())
    return (
        f"the link that {name} moves carries {_with_error(mass, spread)} kg that is not in the URDF",
        f"at {place} m in the link's frame"
        if seen
        else "the motion does not show the place of this mass",
        {"mass": Measured(mass, "kg"), "mass_error": Measured(spread, "kg")},
        _freed(),
    )


_WORDED = {
    TILT: _tilted,
    ZERO: _moved,
    TORQUE: _torque,
    LINK: _link,
    CENTRE: _centre,
    PAYLOAD: _carried,
}


def _seen(values: Array, errors: Array) -> dict[str, int]:
    """Return the places of the components that the motion shows: their errors are smaller than the vector's size."""
    size = float(np.linalg.norm(values[np.isfinite(errors)]))
    clear = np.isfinite(errors) & (errors < size)
    return {axis: place for place, axis in enumerate("xyz") if clear[place]}


def _with_error(value: float, error: float) -> str:
    return f"{rounded(value, error)} ± {two_digits(error)}"


def _coupled(robot: Robot) -> dict[str, dict[str, float]]:
    """Return all couplings, by motor and joint. A call that states couplings replaces all earlier ones."""
    return {
        motor: {
            joint: float(share)
            for joint, share in zip(robot.names, robot.couplings[number], strict=True)
            if share != (joint == motor)
        }
        for number, motor in enumerate(robot.names)
        if robot.coupled[number]
    }


def _or(wrong: WrongFact) -> str:
    nearly = " and ".join(f"{each.coupling or 0.0:g}" for each in wrong.others)
    return f" (a coupling of {nearly} fits nearly as well; the sign is uncertain)" if nearly else ""


def _or_other(wrong: WrongFact) -> str:
    names = [name for each in wrong.others for name in each.joints]
    return (
        f" (or the signs of {' or '.join(names)} are wrong: this motion does not separate the joints)"
        if names
        else ""
    )


def _call(arguments: Mapping[str, object]) -> Action:
    return Action("call", arguments, function="Robot.from_urdf")


def _freed() -> tuple[Action, ...]:
    return (Action("call", {"inertia": FREE}, function="identify_robot"),)


def _plain(values: Sequence[float] | None) -> list[float]:
    return [round(each, 4) for each in values or ()]


def _side(value: float) -> str:
    return "high" if value > 0.0 else "low"
