"""An emulated bench: the emulated drive and converter move a simulated joint."""

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
    """Behavior of an emulated drive and its true wiring.

    The joint file describes the bench as it should be. These values emulate a bench with errors.

    Attributes
    ----------
    idle_loop : float
        Time between two interpreter commands of the drive [s]. Default 0.0003.
    mantissa_bits : int
        Bits of a current command that the drive keeps: 24 for a float, 4 over the thesis's link. Default 24.
    idle_jitter : float
        Largest random addition to `idle_loop` [s]. Default 0.
    enable_time : float
        Time from MO=1 until the motor is on [s], for brake release and commutation. Default 0.
    brake : float
        Torque at the joint of a brake that closes when the motor is off [N·m]. Default 0: no brake, and a
        load falls.
    clock_drift : float
        Relative speed error of the host's clock against the drive's; positive: host fast. 1e-4 is 100 ppm. Default 0.
    jitter : float
        Largest random delay of the host after each wait [s]. Default 0.
    torque_sign : float
        1, or -1: a positive current gives a negative torque. Default 1.
    encoder_sign : float
        1, or -1: the encoder counts down in the positive direction. Default 1.
    torque_scale : float
        True torque constant divided by the joint file's; 0: no torque. Default 1.
    gear_ratio : float, optional
        True gear ratio. Default: the joint file's.
    sensor_sign : float
        1, or -1: the torque sensor's reading decreases with a positive torque. Default 1.
    peak_current : float, optional
        PL[1] of the drive [A]. Default: as the joint file's torque or current limit allows.

    Raises
    ------
    InputError
        A value is not within its range.
    """

    idle_loop: float = 0.3e-3
    mantissa_bits: int = 24
    idle_jitter: float = 0.0
    enable_time: float = 0.0
    brake: float = 0.0
    clock_drift: float = 0.0
    jitter: float = 0.0
    torque_sign: float = 1.0
    encoder_sign: float = 1.0
    torque_scale: float = 1.0
    gear_ratio: float | None = None
    sensor_sign: float = 1.0
    peak_current: float | None = None

    def __post_init__(self) -> None:
        for name in ("torque_sign", "encoder_sign", "sensor_sign"):
            if getattr(self, name) not in (1, -1):
                raise InputError("1 or -1 is expected", argument=name, value=getattr(self, name))
        # 0 is a motor without current: a phase or the brake's supply is missing.
        if not 0.0 <= self.torque_scale <= 1e3:
            raise InputError(
                "0 to 1000 is expected", argument="torque_scale", value=self.torque_scale
            )
        ratio = self.gear_ratio
        if ratio is not None and not 1e-3 <= abs(ratio) <= 1e6:
            raise InputError("0.001 to 1e6 is expected", argument="gear_ratio", value=ratio)
        peak = self.peak_current
        if peak is not None and not 1e-3 <= peak <= 1e3:
            raise InputError("0.001 to 1000 A is expected", argument="peak_current", value=peak)
        if not 0.0 <= self.idle_loop <= 0.01:
            raise InputError("0 to 0.01 s is expected", argument="idle_loop", value=self.idle_loop)
        if not -0.01 <= self.clock_drift <= 0.01:
            raise InputError(
                "-0.01 to 0.01 is expected", argument="clock_drift", value=self.clock_drift
            )
        if not 0.0 <= self.brake <= 1e6:
            raise InputError("0 to 1e6 N·m is expected", argument="brake", value=self.brake)
        for name, most in (("idle_jitter", 0.01), ("enable_time", 2.0), ("jitter", 0.1)):
            if not 0.0 <= getattr(self, name) <= most:
                raise InputError(
                    f"0 to {most:g} s is expected", argument=name, value=getattr(self, name)
                )
        if not 1 <= self.mantissa_bits <= 24:
            raise InputError(
                "1 to 24 is expected", argument="mantissa_bits", value=self.mantissa_bits
            )


def elmo_emulation(bench: Bench) -> ElmoEmulation:
    """Return the behavior of a bench's emulated drive. Default where the joint file sets nothing."""
    found = bench.emulation.drive if bench.emulation is not None else None
    return found if found is not None else ElmoEmulation()


def elmo_devices(
    bench: Bench, seed: int = 0
) -> tuple[EmulatedElmo, EmulatedConverter] | tuple[EmulatedElmo]:
    """Return the emulated drive of a bench, and the torque sensor's converter if it has one.

    Parameters
    ----------
    bench : Bench
    seed : int
        Seed of the torque sensor's noise. Default 0.

    Raises
    ------
    InputError
        The bench does not describe an emulated joint completely.
    """
    emulation = elmo_emulation(bench)
    joint = true_joint(bench, gear_ratio=emulation.gear_ratio)
    stepped = emulated_joint(
        bench,
        seed,
        gear_ratio=emulation.gear_ratio,
        sensor_sign=emulation.sensor_sign,
        unlimited=emulation.torque_scale != 1.0 or emulation.gear_ratio is not None,
    )
    if joint.torque_constant is None:
        raise InputError(
            "missing, so no torque can be commanded; state torque_constant under [drive] of the joint file",
            argument="torque_constant",
        )
    limit = torque_limit(bench.joint)
    largest = (
        1e3 if limit is None else limit / (joint.torque_constant * abs(bench.joint.gear_ratio))
    )
    source = bench.drive.torque
    settings = ElmoSettings(
        node=bench.drive.node,
        # The drive does not know these signs, so they change its data: counts fall, current acts backward.
        counts_per_turn=int(emulation.encoder_sign) * bench.drive.counts_per_turn,
        gear_ratio=joint.gear_ratio,
        torque_constant=emulation.torque_sign * emulation.torque_scale * joint.torque_constant,
        peak_current=largest if emulation.peak_current is None else emulation.peak_current,
        continuous_current=largest,
        idle_loop=emulation.idle_loop,
        idle_jitter=emulation.idle_jitter,
        enable_time=emulation.enable_time,
        brake=emulation.brake,
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
