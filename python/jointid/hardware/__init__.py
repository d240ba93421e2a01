"""A session on a real joint, or an emulated one: drives, limits, recording. No analysis here.

Each make of drive has a package of its own and is found by its `DriveType`.

>>> bench = jid.hardware.Bench.load("joint.toml")
>>> with jid.hardware.open_drive(bench, emulate=True) as drive:
...     recording = jid.hardware.Session(drive, bench.controller, bench.trajectory, bench.limits).run()
"""

from jointid.hardware.bench.bench import Bench, DriveType, drive_type
from jointid.hardware.bench.bus_options import BusOptions
from jointid.hardware.bench.drive_types import drive_type_names
from jointid.hardware.bench.emulated_joints import emulated_joint, true_joint
from jointid.hardware.bench.emulation import Emulation
from jointid.hardware.bench.first_motion_options import FirstMotionOptions
from jointid.hardware.bench.frame_replay import replay
from jointid.hardware.bench.opened_drive import emulated_devices, open_drive
from jointid.hardware.bench.table import Table
from jointid.hardware.can.bus import open_bus
from jointid.hardware.can.frame_log import LoggedFrame
from jointid.hardware.emulated.bus import EmulatedBus
from jointid.hardware.emulated.faults import BusFault
from jointid.hardware.emulated.thread import EmulatorThread
from jointid.hardware.live.console import ConsoleLine
from jointid.hardware.live.plot import LivePlot
from jointid.hardware.proof.certificate import Certificate, certificate_path
from jointid.hardware.proof.check import BenchCheck, check_bench
from jointid.hardware.proof.procedure import first_motion
from jointid.hardware.proof.result import FirstMotion
from jointid.hardware.session.clock import Clock, MonotonicClock
from jointid.hardware.session.cycle import LoggedCycle
from jointid.hardware.session.drive import Drive, DriveEnd, DriveFaultError, DriveSample
from jointid.hardware.session.drive_report import DriveReport, Reported
from jointid.hardware.session.limits import SessionLimits
from jointid.hardware.session.realtime import RealTimeOptions
from jointid.hardware.session.session import (
    Session,
    SessionOptions,
    SessionRefusedError,
    SessionStoppedError,
)
from jointid.hardware.session.silence import DriveSilence
from jointid.hardware.session.stop import Stop
from jointid.hardware.session.watchdog import Watchdog

__all__ = [
    "Bench",
    "BenchCheck",
    "BusFault",
    "BusOptions",
    "Certificate",
    "Clock",
    "ConsoleLine",
    "Drive",
    "DriveEnd",
    "DriveFaultError",
    "DriveReport",
    "DriveSample",
    "DriveSilence",
    "DriveType",
    "EmulatedBus",
    "Emulation",
    "EmulatorThread",
    "FirstMotion",
    "FirstMotionOptions",
    "LivePlot",
    "LoggedCycle",
    "LoggedFrame",
    "MonotonicClock",
    "RealTimeOptions",
    "Reported",
    "Session",
    "SessionLimits",
    "SessionOptions",
    "SessionRefusedError",
    "SessionStoppedError",
    "Stop",
    "Table",
    "Watchdog",
    "certificate_path",
    "check_bench",
    "drive_type",
    "drive_type_names",
    "emulated_devices",
    "emulated_joint",
    "first_motion",
    "open_bus",
    "open_drive",
    "replay",
    "true_joint",
]
