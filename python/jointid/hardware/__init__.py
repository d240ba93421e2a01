"""A session on a real joint, or an emulated one: drives over CAN, limits, recording. No analysis here.

>>> bench = jid.hardware.Bench.load("joint.toml")
>>> with jid.hardware.open_bus(interface="socketcan", channel="can0", drive=bench.drive) as bus:
...     drive = jid.hardware.ElmoDrive(bus, bench.joint, bench.drive)
...     recording = jid.hardware.Session(drive, bench.controller, bench.trajectory, bench.limits).run()
"""

from jointid.hardware.bench.bench import Bench, BusOptions, Emulation
from jointid.hardware.can.bus import open_bus
from jointid.hardware.elmo.codec import Command, DriveError, Reply
from jointid.hardware.elmo.drive import ElmoDrive
from jointid.hardware.elmo.frame_replay import replay
from jointid.hardware.elmo.options import ElmoOptions
from jointid.hardware.elmo.torque_source import AnalogInput, SensorScaling, SyncedConverter
from jointid.hardware.emulated.bench import emulated_devices, true_joint
from jointid.hardware.emulated.bus import EmulatedBus
from jointid.hardware.emulated.converter import EmulatedConverter
from jointid.hardware.emulated.elmo import ElmoSettings, EmulatedElmo
from jointid.hardware.emulated.faults import BusFault
from jointid.hardware.emulated.thread import EmulatorThread
from jointid.hardware.live.console import ConsoleLine
from jointid.hardware.live.plot import LivePlot
from jointid.hardware.session.clock import MonotonicClock
from jointid.hardware.session.drive import Drive, DriveEnd, DriveFaultError, DriveSample
from jointid.hardware.session.limits import SessionLimits
from jointid.hardware.session.realtime import RealTimeOptions
from jointid.hardware.session.session import (
    Session,
    SessionOptions,
    SessionRefusedError,
    SessionStoppedError,
)
from jointid.hardware.session.stop import Stop

__all__ = [
    "AnalogInput",
    "Bench",
    "BusFault",
    "BusOptions",
    "Command",
    "ConsoleLine",
    "Drive",
    "DriveEnd",
    "DriveError",
    "DriveFaultError",
    "DriveSample",
    "ElmoDrive",
    "ElmoOptions",
    "ElmoSettings",
    "EmulatedBus",
    "EmulatedConverter",
    "EmulatedElmo",
    "Emulation",
    "EmulatorThread",
    "LivePlot",
    "MonotonicClock",
    "RealTimeOptions",
    "Reply",
    "SensorScaling",
    "Session",
    "SessionLimits",
    "SessionOptions",
    "SessionRefusedError",
    "SessionStoppedError",
    "Stop",
    "SyncedConverter",
    "emulated_devices",
    "open_bus",
    "replay",
    "true_joint",
]
