"""The joint that an emulated drive moves, with its true parameters."""

from __future__ import annotations

from jointid import _core
from jointid.base.errors import InputError
from jointid.hardware.bench.bench import Bench, Emulation, joint_with_truth
from jointid.joint.joint import Joint
from jointid.simulation.stepped import stepped_joint


def true_joint(bench: Bench) -> Joint:
    """Return the emulated joint, with its true parameters.

    Raises
    ------
    InputError
        The bench does not describe an emulated joint.
    """
    return joint_with_truth(bench.joint, _emulation(bench).truth)


def emulated_joint(bench: Bench, seed: int = 0) -> _core.SteppedJoint:
    """Return the simulated joint that an emulated drive of this bench moves, at its first position.

    Parameters
    ----------
    bench : Bench
    seed : int
        Of the torque sensor's noise. Default 0.

    Raises
    ------
    InputError
        The bench does not describe an emulated joint, or not completely.
    """
    joint, emulation = true_joint(bench), _emulation(bench)
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
        raise InputError(
            "the joint file has no table [session.emulated], which describes the emulated joint"
        )
    return bench.emulation
