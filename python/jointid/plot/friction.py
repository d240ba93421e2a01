"""Pictures of friction over velocity: models side by side, what a parameter does, what a run shows raw."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.argument_checks import require_kind, require_mapping
from jointid.base.errors import InputError
from jointid.estimate.estimate import Estimate
from jointid.estimate.friction_map import friction_torque
from jointid.joint.joint import Joint
from jointid.plot.appearance import MEASURED, SECOND, given_or_new, line_style
from jointid.recording.recording import Recording

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]
_SENSOR = ("sensor_gain", "sensor_offset")


def friction_curves(
    joints: Mapping[str, Joint | Estimate], axes: Axes | None = None, *, peak: float = 1.0
) -> Axes:
    """Friction over velocity of joints whose parameters have values, or of estimates, side by side.

    Parameters
    ----------
    joints : mapping of str to Joint or Estimate
    axes : Axes, optional
        Drawn into; default: new ones.
    peak : float
        Largest speed [rad/s or m/s]. Default 1.

    Raises
    ------
    InputError
        A joint without a value for any friction parameter.
    """
    require_mapping("joints", joints, "{'before': joint}")
    for each in joints.values():
        require_kind("joints", each, Joint, Estimate)
    axes = given_or_new(axes)
    for number, (name, joint) in enumerate(joints.items()):
        _draw(axes, _values(_joint(joint)), peak, number, name)
    kinds = {_joint(joint).kind for joint in joints.values()}
    _label(axes, "friction", "prismatic" if kinds == {"prismatic"} else "revolute")
    axes.legend(loc="best", frameon=False)
    return axes


def sensitivity(
    joint: Joint,
    parameter: str,
    axes: Axes | None = None,
    *,
    share: float = 0.1,
    peak: float = 0.6,
    reading: float = 5.0,
) -> Axes:
    """The torque at constant speed and constant sensor reading, and how a parameter's error moves it.

    This is the drive's torque by (4-20) without acceleration: friction + gain · reading + offset.
    Where the three curves part, a recording tells of the parameter. Forward motion is shown; backward,
    friction changes its sign.

    Parameters
    ----------
    joint : Joint
        With values for its parameters.
    parameter : str
        A friction parameter, `sensor_gain` or `sensor_offset`.
    axes : Axes, optional
        Drawn into; default: new ones.
    share : float
        Relative change of the parameter. Default 0.1.
    peak : float
        Largest speed [rad/s or m/s]. Default 0.6.
    reading : float
        Of the torque sensor, raw. Default 5.

    Raises
    ------
    InputError
        The parameter has no value.
    """
    require_kind("joint", joint, Joint)
    axes = given_or_new(axes)
    values = _values(joint)
    if parameter not in values:
        raise InputError(
            f"parameter '{parameter}' has no value; with one are {', '.join(values) or 'none'}"
        )
    for number, (name, factor) in enumerate(
        (
            ("as it is", 1.0),
            (f"+{100.0 * share:g} %", 1.0 + share),
            (f"−{100.0 * share:g} %", 1.0 - share),
        )
    ):
        changed = values | {parameter: values[parameter] * factor}
        link = 0.0
        if joint.sensor:
            link = changed.get("sensor_gain", 0.0) * reading + changed.get("sensor_offset", 0.0)
        _draw(axes, changed, peak, number, f"{parameter} {name}", above=link, forward=True)
    _label(axes, "torque at constant speed", joint.kind)
    axes.legend(loc="best", frameon=False)
    return axes


def torque_over_velocity(
    recording: Recording,
    axes: Axes | None = None,
    *,
    sensed_by: Joint | Estimate | None = None,
    curve: Joint | Estimate | None = None,
) -> Axes:
    """The recorded torque over the velocity, sample by sample: the friction map as it comes.

    Parameters
    ----------
    recording : Recording
    axes : Axes, optional
        Drawn into; default: new ones.
    sensed_by : Joint or Estimate, optional
        Whose gain and offset turn the sensor's reading into the link's torque, which is then subtracted.
    curve : Joint or Estimate, optional
        Whose friction is drawn over it.

    Raises
    ------
    InputError
        The recording has no torque, or nothing to subtract.
    """
    require_kind("recording", recording, Recording)
    if recording.torque is None:
        raise InputError("the recording has no torque; drawing it over velocity needs one")
    axes = given_or_new(axes)
    torque, what = recording.torque, "torque"
    if sensed_by is not None:
        known = _values(_joint(sensed_by))
        if recording.sensor is None or not set(_SENSOR) <= set(known):
            raise InputError(
                "the sensor cannot be subtracted: it takes a recorded sensor and values for "
                "sensor_gain and sensor_offset"
            )
        torque = torque - known["sensor_gain"] * recording.sensor - known["sensor_offset"]
        what = "torque less sensed link torque"
    axes.plot(
        recording.velocity,
        torque,
        ".",
        color=MEASURED,
        markersize=1.5,
        label="recorded samples",
        rasterized=True,
    )
    if curve is not None:
        peak = float(np.abs(recording.velocity).max())
        _draw(axes, _values(_joint(curve)), peak, 0, "friction, model", colour=SECOND)
    _label(axes, what, recording.kind)
    axes.legend(loc="lower right", frameon=False, markerscale=4.0, fontsize="small")
    return axes


def _joint(source: Joint | Estimate) -> Joint:
    return source.joint if isinstance(source, Estimate) else source


def _values(joint: Joint) -> dict[str, float]:
    return {name: p.value for name, p in joint.parameters.items() if p.value is not None}


def _friction(values: Mapping[str, float], velocity: Array) -> Array:
    """Friction of the terms for whose coefficient and shapes there are values."""
    terms = [
        term.key
        for term in _core.terms()
        if term.friction and not term.family and {term.name, *term.shapes} <= set(values)
    ]
    if not terms:
        raise InputError(
            "the joint has no values for its friction; give them with joint.with_parameters({...})"
        )
    return friction_torque(terms, values, velocity)


def _draw(
    axes: Axes,
    values: Mapping[str, float],
    peak: float,
    number: int,
    label: str,
    *,
    above: float = 0.0,
    forward: bool = False,
    colour: str | None = None,
) -> None:
    """One curve, broken at rest, where friction takes any value in between."""
    speed = peak * np.linspace(0.0, 1.0, 300) ** 2  # dense near rest, where friction bends
    speed[0] = 1e-9 * peak
    velocity = np.concatenate([-speed[::-1], speed])
    torque = _friction(values, velocity) + above
    keywords = line_style(number)
    if colour is not None:
        keywords["color"] = colour
    middle = len(speed)
    velocity, torque = np.insert(velocity, middle, 0.0), np.insert(torque, middle, np.nan)
    shown = slice(middle + 1, None) if forward else slice(None)
    axes.plot(velocity[shown], torque[shown], label=label, **keywords)


def _label(axes: Axes, what: str, kind: str) -> None:
    prismatic = kind == "prismatic"
    axes.set_xlabel("velocity [m/s]" if prismatic else "velocity [rad/s]")
    axes.set_ylabel(f"{what} [N]" if prismatic else f"{what} [N·m]")
