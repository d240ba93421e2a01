"""Checks of a design's arguments before a simulation."""

from __future__ import annotations

from collections.abc import Sequence
from typing import get_args

from jointid import _core
from jointid.base.errors import InputError
from jointid.excitation.prior import Ranges
from jointid.excitation.request import Request
from jointid.joint.joint import Joint
from jointid.simulation.arguments import LAWS, Controller

_FEWEST, _MOST = 8, 1_000_000  # control periods of a motion; more would fill the memory


def check_arguments(
    joint: Joint,
    controller: object = None,
    sensors: object = None,
    parameters: Sequence[str] | None = None,
    callback: object = None,
) -> None:
    """Check arguments of `design`."""
    if isinstance(controller, _core.OpenLoop):
        raise InputError(
            "a design needs a controller with feedback",
            argument="controller",
            value="open_loop",
            remedy="use another controller, or omit it",
        )
    if controller is not None and not isinstance(controller, get_args(Controller)):
        kinds = ", ".join(law.__name__ for law in LAWS.values() if law is not _core.OpenLoop)
        raise InputError(f"one of {kinds} is expected", argument="controller", value=controller)
    if sensors is not None and not isinstance(sensors, _core.Sensors):
        raise InputError("a Sensors value is expected", argument="sensors", value=sensors)
    if sensors is not None and sensors.torque_noise > 0.0 and not joint.sensor:
        raise InputError(
            "the joint has no torque sensor",
            argument="sensors.torque_noise",
            value=sensors.torque_noise,
            remedy="give the encoder's encoder_counts",
        )
    if parameters is not None and (
        isinstance(parameters, str) or not isinstance(parameters, Sequence)
    ):
        raise InputError("a list of names is expected", argument="parameters", value=parameters)
    if callback is not None and not callable(callback):
        raise InputError("a callable is expected", argument="callback", value=callback)


def check_signs(request: Request, ranges: Ranges) -> None:
    """Check that the prior has no range below 0 for a parameter that cannot be negative."""
    signed = {term.name: not term.non_negative for term in map(_core.term, request.terms)}
    for name, (low, high) in ranges.ranges.items():
        if low < 0.0 and not signed.get(name, False):
            raise InputError(
                "it cannot be below 0", argument=name, value=[low, high], place="prior"
            )


def check_length(duration: float, control_period: float) -> None:
    """Check that a motion is long enough for a recording, and short enough to be simulated many times."""
    if not _FEWEST <= duration / control_period <= _MOST:
        raise InputError(
            f"{_FEWEST} to {_MOST} control periods of {control_period:g} s are expected",
            argument="duration",
            value=duration,
        )


def check_gain(joint: Joint, request: Request) -> None:
    """Check that neither the prior nor the bounds of the sensor's gain contain 0."""
    gain = joint.parameters.get("sensor_gain")
    if gain is None or "sensor_gain" not in request.names or gain.min is None or gain.max is None:
        return
    if gain.min <= 0.0 <= gain.max:
        raise InputError(
            "the prior and the joint's bounds contain 0, but a sensor with gain 0 reads nothing",
            argument="sensor_gain",
            value=[gain.min, gain.max],
            place="prior",
            remedy="in the joint, give two bounds of the gain with the same sign",
        )
