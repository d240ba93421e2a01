"""Plots of friction over velocity: compared models, the effect of a parameter, the samples of a recording."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from jointid.base.argument_checks import require_kind, require_mapping
from jointid.base.errors import InputError
from jointid.estimate.estimate import Estimate
from jointid.joint.joint import Joint
from jointid.joint.units import torque_unit, velocity_label
from jointid.panels.curves import friction_line, friction_terms, known_values
from jointid.panels.marks import Mark, Panel, Points
from jointid.panels.palette import LOOKS
from jointid.plot.appearance import axes_or_new
from jointid.plot.drawing import draw
from jointid.recording.recording import Recording

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_SENSOR = ("sensor_gain", "sensor_offset")


def friction_curves(
    joints: Mapping[str, Joint | Estimate],
    ax: Axes | None = None,
    *,
    peak: float = 1.0,
    **style: Any,
) -> Axes:
    """Draw friction over velocity of several joints or estimates, for comparison.

    Parameters
    ----------
    joints : mapping of str to Joint or Estimate
        Joints with values for their friction parameters, or estimates, by label.
    ax : Axes, optional
        Axes to draw into. Default: new axes.
    peak : float
        Largest speed [rad/s] or [m/s]. Default 1.
    **style
        Keywords of Matplotlib's `Axes.plot` for the curves, e.g. ``color="black"``.

    Returns
    -------
    Axes
        Axes with velocity [rad/s] or [m/s] and friction [N·m] or [N].

    Raises
    ------
    InputError
        There is no joint, or a joint has no value for any friction parameter.

    Examples
    --------
    >>> jid.plot.friction_curves({"monday": estimate, "tuesday": estimate.joint}, peak=0.5)
    """
    require_mapping("joints", joints, "{'before': joint}")
    for each in joints.values():
        require_kind("joints", each, Joint, Estimate)
    if not joints:
        raise InputError("at least one joint or estimate is expected", argument="joints", value={})
    for name, joint in joints.items():
        _check_friction(known_values(_joint(joint)), f"joints.{name}")
    lines = tuple(
        friction_line(
            known_values(_joint(joint)),
            peak,
            look=LOOKS[number % len(LOOKS)],
            label=name,
            series=True,
        )
        for number, (name, joint) in enumerate(joints.items())
    )
    kinds = {_joint(joint).kind for joint in joints.values()}
    panel = _panel("friction", "prismatic" if kinds == {"prismatic"} else "revolute", *lines)
    return draw(axes_or_new(ax), panel, style, lines)


def sensitivity(
    joint: Joint,
    parameter: str,
    ax: Axes | None = None,
    *,
    share: float = 0.1,
    peak: float = 0.6,
    reading: float = 5.0,
    **style: Any,
) -> Axes:
    """Draw the torque over constant speed, at a constant sensor reading, for three values of a parameter.

    The torque is the drive's torque in equation (4-20) without acceleration: friction + gain · reading + offset.
    The values are the parameter's own, a larger and a smaller value. A recording contains information about the
    parameter at speeds where the three curves differ. The plot shows forward motion. In backward motion, friction
    changes its sign.

    Parameters
    ----------
    joint : Joint
        A joint with values for its parameters.
    parameter : str
        A friction parameter, `sensor_gain` or `sensor_offset`.
    ax : Axes, optional
        Axes to draw into. Default: new axes.
    share : float
        Relative increase and decrease of the parameter. Default 0.1.
    peak : float
        Largest speed [rad/s] or [m/s]. Default 0.6.
    reading : float
        Raw reading of the torque sensor. Default 5.
    **style
        Keywords of Matplotlib's `Axes.plot` for the curves, e.g. ``color="black"``.

    Returns
    -------
    Axes
        Axes with velocity [rad/s] or [m/s] and torque [N·m] or force [N].

    Raises
    ------
    InputError
        The parameter has no value, or the joint has no values for its friction.

    Examples
    --------
    >>> jid.plot.sensitivity(estimate.joint, "viscous", share=0.2)
    """
    require_kind("joint", joint, Joint)
    values = known_values(joint)
    if parameter not in values:
        raise InputError(
            f"this parameter has no value; parameters with a value are {', '.join(values) or 'none'}",
            argument="parameter",
            value=parameter,
        )
    _check_friction(values, "joint")
    lines = []
    for look, name, factor in (
        ("measured", "nominal", 1.0),
        ("fitted", f"+{100.0 * share:g} %", 1.0 + share),
        ("second", f"−{100.0 * share:g} %", 1.0 - share),
    ):
        changed = values | {parameter: values[parameter] * factor}
        link = 0.0
        if joint.sensor:
            link = changed.get("sensor_gain", 0.0) * reading + changed.get("sensor_offset", 0.0)
        label = f"{parameter} {name}"
        line = friction_line(
            changed, peak, above=link, forward=True, look=look, label=label, series=True
        )
        lines.append(line)
    panel = _panel("torque at constant speed", joint.kind, *lines)
    return draw(axes_or_new(ax), panel, style, lines)


def torque_over_velocity(
    recording: Recording,
    ax: Axes | None = None,
    *,
    sensed_by: Joint | Estimate | None = None,
    curve: Joint | Estimate | None = None,
    **style: Any,
) -> Axes:
    """Draw the recorded torque over velocity, sample by sample: a friction map without a fit.

    Parameters
    ----------
    recording : Recording
        A recording with torque.
    ax : Axes, optional
        Axes to draw into. Default: new axes.
    sensed_by : Joint or Estimate, optional
        Joint or estimate with sensor gain and offset, which convert the reading to the link's torque. The link's
        torque is subtracted. Default: nothing is subtracted.
    curve : Joint or Estimate, optional
        Joint or estimate with the friction to draw over the samples. Default: no curve.
    **style
        Keywords of Matplotlib's `Axes.plot` for the samples, e.g. ``color="black"``.

    Returns
    -------
    Axes
        Axes with velocity [rad/s] or [m/s] and torque [N·m] or force [N].

    Raises
    ------
    InputError
        The recording has no torque, or no sensor signal to subtract, or a joint lacks values.
    """
    require_kind("recording", recording, Recording)
    if recording.torque is None:
        raise InputError("it has no torque", argument="recording")
    if curve is not None:
        _check_friction(known_values(_joint(curve)), "curve")
    torque, what = recording.torque, "torque"
    if sensed_by is not None:
        known = known_values(_joint(sensed_by))
        if recording.sensor is None:
            raise InputError("the recording has no torque sensor to subtract", argument="recording")
        if not set(_SENSOR) <= set(known):
            raise InputError(
                f"values of {' and '.join(_SENSOR)} are expected", argument="sensed_by"
            )
        torque = torque - known["sensor_gain"] * recording.sensor - known["sensor_offset"]
        what = "torque minus sensed link torque"
    samples = Points(
        look="measured", label="recorded samples", across=recording.velocity, up=torque
    )
    lines = []
    if curve is not None:
        peak = float(np.abs(recording.velocity).max())
        values = known_values(_joint(curve))
        lines.append(friction_line(values, peak, look="second", label="friction of the model"))
    panel = _panel(what, recording.kind, samples, *lines)
    return draw(axes_or_new(ax), panel, style, (samples,), loc="lower right", fontsize="small")


def _joint(source: Joint | Estimate) -> Joint:
    return source.joint if isinstance(source, Estimate) else source


def _check_friction(values: Mapping[str, float], argument: str) -> None:
    if not friction_terms(values):
        raise InputError(
            "the joint has no values for its friction",
            argument=argument,
            remedy=("give its parameters values", "use an estimate"),
        )


def _panel(what: str, kind: str, *marks: Mark) -> Panel:
    return Panel(across=velocity_label(kind), up=f"{what} [{torque_unit(kind)}]", marks=marks)
