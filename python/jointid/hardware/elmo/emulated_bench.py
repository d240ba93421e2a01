"""An emulated bench: the drive and the converter of a bench, moving a simulated joint."""

from __future__ import annotations

from dataclasses import dataclass

from jointid.base.errors import InputError
from jointid.hardware.bench.bench import Bench
from jointid.hardware.bench.emulated_joints import emulated_joint, true_joint
from jointid.hardware.elmo.emulated_converter import EmulatedConverter
from jointid.hardware.elmo.emulated_drive import ElmoSettings, EmulatedElmo
from jointid.hardware.elmo.torque_source import AnalogInput, SensorScaling, SyncedConverter
from jointid.simulation.plant import torque_limit


@dataclass(frozen=True, slots=True, kw_only=True)
class ElmoEmulation:
    """What an emulated drive does to a command.

    Attributes
    ----------
    idle_loop : float
        Time between two interpreter commands of the drive [s].
    mantissa_bits : int
        Of a current command that count: 24 for a float, 4 for the thesis's link.
    """

    idle_loop: float = 0.3e-3
    mantissa_bits: int = 24

    def __post_init__(self) -> None:
        if not 0.0 <= self.idle_loop <= 0.01:
            raise InputError("0 to 0.01 s is expected", argument="idle_loop", value=self.idle_loop)
        if not 1 <= self.mantissa_bits <= 24:
            raise InputError(
                "1 to 24 is expected", argument="mantissa_bits", value=self.mantissa_bits
            )


def elmo_devices(
    bench: Bench, seed: int = 0
) -> tuple[EmulatedElmo, EmulatedConverter] | tuple[EmulatedElmo]:
    """Return the emulated drive of a bench, and the torque sensor's converter if it has one.

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
    joint, stepped = true_joint(bench), emulated_joint(bench, seed)
    emulation = bench.emulation.drive if bench.emulation is not None else None
    if emulation is None:
        emulation = ElmoEmulation()
    if joint.torque_constant is None:
        raise InputError(
            "missing, so no torque can be commanded; it stands in the joint file under [drive]",
            argument="torque_constant",
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
