"""An emulated bench: the drive and the converter of a bench, moving a simulated joint."""

from __future__ import annotations

from jointid.base.errors import InputError
from jointid.hardware.bench.bench import Bench, joint_with_truth
from jointid.hardware.elmo.torque_source import AnalogInput, SensorScaling, SyncedConverter
from jointid.hardware.emulated.converter import EmulatedConverter
from jointid.hardware.emulated.elmo import ElmoSettings, EmulatedElmo
from jointid.joint.joint import Joint
from jointid.simulation.plant import torque_limit
from jointid.simulation.stepped import stepped_joint


def true_joint(bench: Bench) -> Joint:
    """The emulated joint, with its true parameters.

    Raises
    ------
    InputError
        The bench says nothing about an emulated joint.
    """
    if bench.emulation is None:
        raise InputError(
            "there is no [session.emulated] in the joint file, which says what an emulated joint truly is"
        )
    return joint_with_truth(bench.joint, bench.emulation.truth)


def emulated_devices(
    bench: Bench, seed: int = 0
) -> tuple[EmulatedElmo, EmulatedConverter] | tuple[EmulatedElmo]:
    """The devices of a bench, to be put on an `EmulatedBus` or in an `EmulatorThread`.

    Parameters
    ----------
    bench : Bench
    seed : int
        Of the torque sensor's noise. Default 0.

    Raises
    ------
    InputError
        The bench says nothing about an emulated joint, or not enough.
    """
    joint, emulation = true_joint(bench), bench.emulation
    assert emulation is not None
    stepped = stepped_joint(
        joint,
        sensors=emulation.sensors,
        period=bench.options.period,
        integration_step=emulation.integration_step,
        position=emulation.position,
        seed=seed,
    )
    if joint.torque_constant is None:
        raise InputError(
            "the joint has no torque_constant, so no torque can be commanded; give it in the joint file under "
            "[drive]"
        )
    limit = torque_limit(joint)
    largest = 1e3 if limit is None else limit / (joint.torque_constant * abs(joint.gear_ratio))
    source = bench.drive.torque
    settings = ElmoSettings(
        node=bench.drive.node,
        counts_per_turn=bench.drive.counts_per_turn,
        gear_ratio=joint.gear_ratio,
        torque_constant=joint.torque_constant,
        peak_current=largest,
        continuous_current=largest,
        idle_loop=emulation.idle_loop,
        mantissa_bits=emulation.mantissa_bits,
        position_offset=bench.drive.position_offset,
        cob_command=bench.drive.cob_command,
        cob_reply=bench.drive.cob_reply,
        analog=source.scaling if isinstance(source, AnalogInput) else SensorScaling(),
    )
    drive = EmulatedElmo(stepped, settings)
    if not isinstance(source, SyncedConverter):
        return (drive,)
    converter = EmulatedConverter(
        drive,
        source.scaling,
        identifier=source.identifier,
        bits=source.bits,
        lowest=source.lowest,
        highest=source.highest,
        conversions=source.conversions,
    )
    return drive, converter
