"""Settings of `design` from its options and joint file: limits, controller, assumed parameters."""

from __future__ import annotations

import argparse
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from jointid.base.errors import InputError
from jointid.cli.arguments import by_name
from jointid.cli.scenario import checked_values, controller_of, number_or_angle, sensors_of
from jointid.excitation.motion_limits import MotionLimits
from jointid.joint.joint import Joint
from jointid.joint.link import Limits

if TYPE_CHECKING:
    from jointid._core import Sensors
    from jointid.estimate.estimate import Estimate
    from jointid.hardware.bench.bench import Bench
    from jointid.hardware.session.limits import SessionLimits
    from jointid.simulation.arguments import Controller

_SLIDING = {"position": "m", "velocity": "m/s", "acceleration": "m/s²"}  # of a prismatic joint
_LIMITS = ("position", "velocity", "acceleration", "torque", "sensor_range")


def joint_and_bench(path: Path) -> tuple[Joint, Bench | None]:
    """Return the joint of a file, and its bench if the file has one. The bench's motion is not read."""
    from jointid.hardware.bench.bench import Bench
    from jointid.hardware.bench.bench_file import bench_fields
    from jointid.joint.joint_file import read_document

    if "session" not in read_document(path):
        return Joint.load(path), None
    bench = Bench(**bench_fields(path, with_motion=False))
    return bench.joint, bench


def advised_motion(estimate: Estimate) -> dict[str, Any]:
    """Return the limits and the duration that the estimate's findings advise, except those that only a user knows."""
    for found in estimate.findings:
        for action in found.advice:
            if action.designs:
                limits = action.arguments.get("limits", {})
                known = {name: value for name, value in limits.items() if value is not ...}
                return {**action.arguments, "limits": known}
    return {}


def limits_of(
    arguments: argparse.Namespace,
    joint: Joint,
    bench: Bench | None,
    advised: Mapping[str, Any] | None = None,
) -> MotionLimits:
    """Return the limits of the options; by default the session's, the joint's, or the advised ones."""
    given: dict[str, Any] = {} if bench is not None else dict(advised or {})
    for name in _LIMITS:
        text = getattr(arguments, name)
        if text is not None:
            numbers = _numbers(name, text, 2 if name == "position" else 1, _unit_of(name, joint))
            given[name] = numbers if name == "position" else numbers[0]
    if bench is not None:
        own = bench.limits
        joint = joint.replace(
            limits=Limits(
                position=own.position,
                velocity=own.velocity,
                torque=own.torque if math.isfinite(own.torque) else None,
            )
        )
    limits = MotionLimits.of(given, joint)
    if bench is not None:
        _check_session(limits, bench.limits)
    return limits


def _check_session(limits: MotionLimits, session: SessionLimits) -> None:
    """Refuse a limit beyond the joint file's session limit, because the session would stop there."""
    low, high = session.position
    if limits.position[0] < low or limits.position[1] > high:
        raise InputError(
            f"the session of the joint file allows only {low:g} to {high:g}",
            argument="position",
            value=limits.position,
        )
    for name in ("velocity", "torque"):
        stated, allowed = getattr(limits, name), getattr(session, name)
        if stated > allowed:
            raise InputError(
                f"the session of the joint file allows at most {allowed:g}",
                argument=name,
                value=stated,
            )


def as_option(error: InputError) -> InputError:
    """Return an error about a limit without its place, because the option names it already."""
    if error.place != "limits":
        return error
    return InputError(error.reason, argument=error.argument, value=error.value, remedy=error.remedy)


def controller_for(
    arguments: argparse.Namespace, joint: Joint, bench: Bench | None
) -> Controller | None:
    """Return the controller of the options or of the session; None for the default one."""
    from jointid.simulation.arguments import law_name
    from jointid.simulation.scenario import believing

    gains, name, believe = arguments.gain, arguments.controller, arguments.believe
    own = None if bench is None else bench.controller
    if name is None and own is not None:
        found = own.replace(**checked_values("gain", gains, own.asdict()))
        if believe is None:
            return found
    elif name is None and not gains and believe is None:
        return None
    else:
        found = controller_of("adaptive_robust" if name is None else name, gains)
    if "coulomb" not in found.asdict():
        if believe is not None:
            raise InputError(
                f"the controller {law_name(found)} does not compensate friction", argument="believe"
            )
        return found
    chosen = {key: found.asdict()[key] for key, _ in gains}
    assumed = believing(found, joint if believe is None else Joint.load(believe))
    controller: Controller = assumed.replace(**chosen)
    return controller


def sensors_for(
    pairs: Sequence[tuple[str, str]], limits: MotionLimits, joint: Joint, bench: Bench | None
) -> Sensors | None:
    """Return the sensors of the options, with the session's encoder and default values; None for the default ones."""
    from jointid.excitation.balance_noise import assumed_sensors

    # Properties with other names in a drive's type are not known here. They keep their defaults.
    counts = getattr(None if bench is None else bench.drive, "counts_per_turn", None)
    assert limits.torque is not None  # MotionLimits.of checks this
    own = assumed_sensors(joint, limits.torque)
    if bench is not None and counts is not None:
        own = own.replace(
            encoder_counts=float(counts),
            velocity="counts",
            velocity_counts=bench.options.velocity_counts,
            velocity_time=bench.options.velocity_time,
        )
    elif not pairs:
        return None
    stated = sensors_of(pairs).asdict()
    return own.replace(**{name: stated[name] for name, _ in pairs})


def controller_after(
    arguments: argparse.Namespace, estimated: Joint, bench: Bench | None
) -> Controller | None:
    """Return the same controller with the values of an estimate. A session's own assumptions are older."""
    from jointid.simulation.scenario import believing

    found = controller_for(arguments, estimated, bench)
    stated = arguments.controller is not None or arguments.believe is not None
    if found is None or stated or "coulomb" not in found.asdict():
        return found
    chosen = {key: found.asdict()[key] for key, _ in arguments.gain}
    assumed: Controller = believing(found, estimated).replace(**chosen)
    return assumed


def sensors_after(
    pairs: Sequence[tuple[str, str]], sensors: Sensors | None, estimate: Estimate
) -> Sensors | None:
    """Return the same sensors, with the noise of an estimate's residuals if no option states it."""
    from jointid.excitation.posterior import sensors_of

    seen = sensors_of(estimate)
    if sensors is None or seen is None or "torque_noise" in dict(pairs):
        return sensors
    return sensors.replace(torque_noise=seen.torque_noise)


def prior_of(pairs: Sequence[tuple[str, str]]) -> dict[str, tuple[float, float]] | None:
    """Return the ranges of parameters by name."""
    found = {}
    for name, text in by_name("prior", pairs).items():
        low, high = _numbers(f"prior.{name}", text, 2, "two numbers LOW,HIGH")
        found[name] = (low, high)
    return found or None


def _unit_of(name: str, joint: Joint) -> str:
    """Return the unit of a limit that is no angle, with the reason; empty if it may be an angle."""
    if joint.kind == "prismatic":
        return f"{_SLIDING.get(name, 'N')}: the joint is prismatic"
    return "" if name in _SLIDING else "N·m"


def _numbers(argument: str, text: str, count: int, unit: str) -> tuple[float, ...]:
    """Return numbers separated by commas; angles such as 60deg are allowed if `unit` is empty."""
    parts = [part.strip() for part in text.split(",")]
    if unit and any(part.endswith("deg") for part in parts):
        raise InputError(
            f"this quantity is not an angle; a value in {unit} is expected",
            argument=argument,
            value=text,
        )
    values = [number_or_angle(part) for part in parts]
    if len(values) != count or any(isinstance(value, str) for value in values):
        expected = "a number is expected" if count == 1 else "two numbers LOW,HIGH are expected"
        raise InputError(expected, argument=argument, value=text)
    return tuple(float(value) for value in values)
