"""The session that the benchmarks run: the thesis's joint on an emulated drive, on the virtual clock."""

import dataclasses
import math
from pathlib import Path

import jointid as jid
from jointid.hardware.elmo.drive import ElmoDrive
from jointid.hardware.elmo.emulated_converter import EmulatedConverter
from jointid.hardware.elmo.emulated_drive import EmulatedElmo
from jointid.hardware.emulated.bus import EmulatedBus
from jointid.hardware.session.limits import SessionLimits
from jointid.hardware.session.session import Session
from jointid.simulation.stepped import stepped_joint

PERIOD = 2e-3  # [s]
_TRUTH = {
    "coulomb": 25.0,
    "static": 20.0,
    "stribeck": 100.0,
    "viscous": 20.0,
    "sensor_gain": 2.4,
    "sensor_offset": 15.0,
}


def _joint() -> jid.Joint:
    """Return the joint with its link about the vertical."""
    joint = jid.thesis_joint()
    assert joint.link is not None
    return joint.replace(link=dataclasses.replace(joint.link, angle=-math.pi / 2.0))


def devices(seed: int = 0) -> tuple[EmulatedElmo, EmulatedConverter]:
    """Return the drive and the sensor's converter."""
    true = _joint().with_parameters(_TRUTH)
    sensors = jid.Sensors(torque_noise=0.5)
    drive = EmulatedElmo(stepped_joint(true, sensors=sensors, period=PERIOD, seed=seed))
    return drive, EmulatedConverter(drive)


def run(bus: EmulatedBus, seconds: float, output: Path | None = None) -> jid.Recording:
    """Run a session of this duration [s] on a bus with the devices; the bus is shut down."""
    joint = _joint()
    believed = jid.control_estimates(joint.with_parameters(_TRUTH))
    law = jid.AdaptiveRobust(**believed).replace(friction_velocity="reference")
    swing = jid.Trajectory.thesis(math.radians(60.0), cycle=3.0, duration=seconds)
    limits = SessionLimits.of(joint)
    recording = Session(ElmoDrive(bus, joint), law, swing, limits, output=output).run()
    bus.shutdown()
    assert recording is not None
    return recording
