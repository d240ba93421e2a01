"""Joint that an emulated drive moves, with its true parameters."""

from __future__ import annotations

from dataclasses import replace

from jointid import _core
from jointid.base.errors import InputError
from jointid.hardware.bench.bench import Bench
from jointid.hardware.bench.emulation import Emulation, joint_with_truth
from jointid.joint.joint import Joint
from jointid.simulation.stepped import stepped_joint


def true_joint(bench: Bench, *, gear_ratio: float | None = None) -> Joint:
    """Return the emulated joint, with its true parameters.

    Parameters
    ----------
    bench : Bench
    gear_ratio : float, optional
        True gear ratio, if the joint file states a wrong one. Default: the gear ratio in the joint file.

    Raises
    ------
    InputError
        The bench does not describe an emulated joint.
    """
    joint = joint_with_truth(bench.joint, _emulation(bench).truth)
    return joint if gear_ratio is None else joint.replace(gear_ratio=gear_ratio)


def emulated_joint(
    bench: Bench,
    seed: int = 0,
    *,
    gear_ratio: float | None = None,
    sensor_sign: float = 1.0,
    unlimited: bool = False,
) -> _core.SteppedJoint:
    """Return the simulated joint of this bench's emulated drive, at its initial position.

    Parameters
    ----------
    bench : Bench
    seed : int
        Seed of the torque sensor's noise. Default 0.
    gear_ratio : float, optional
        True gear ratio, if the joint file states a wrong one. Default: the gear ratio in the joint file.
    sensor_sign : float
        Sign of the torque sensor's gain: -1 for a sensor with inverted wiring. Default 1.
    unlimited : bool
        Whether the true torque may exceed the joint file's torque limit, as with a drive that limits only its current.
        Default False.

    Raises
    ------
    InputError
        The bench does not describe an emulated joint completely.
    """
    joint, emulation = true_joint(bench, gear_ratio=gear_ratio), _emulation(bench)
    gain = joint.parameters.get("sensor_gain")
    if sensor_sign < 0 and gain is not None and gain.value is not None:
        joint = joint.with_parameters({"sensor_gain": -gain.value})
    if unlimited:
        joint = joint.replace(limits=replace(joint.limits, torque=None, current=None))
    return stepped_joint(
        joint,
        sensors=emulation.sensors,
        period=bench.options.period,
        integration_step=emulation.integration_step,
        position=emulation.position,
        seed=seed,
    )


def _emulation(bench: Bench) -> Emulation:
    if bench.emulation is None:
        raise InputError("the joint file has no table [session.emulated] for the emulated joint")
    return bench.emulation
