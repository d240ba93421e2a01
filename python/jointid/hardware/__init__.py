"""A session on a real joint, or an emulated one: drives over CAN, limits, recording. No analysis here.

>>> bench = jid.hardware.Bench.load("joint.toml")
>>> with jid.hardware.open_bus(interface="socketcan", channel="can0", drive=bench.drive) as bus:
...     drive = jid.hardware.ElmoDrive(bus, bench.joint, bench.drive)
...     recording = jid.hardware.Session(drive, bench.controller, bench.trajectory, bench.limits).run()
"""

from jointid.hardware.bench import Bench, BusOptions, Emulation
from jointid.hardware.bus import open_bus
from jointid.hardware.clock import MonotonicClock
from jointid.hardware.drive import Drive, DriveEnd, DriveFaultError, DriveSample
from jointid.hardware.elmo_codec import Command, DriveError, Reply
from jointid.hardware.elmo_drive import ElmoDrive
from jointid.hardware.elmo_options import ElmoOptions
from jointid.hardware.emulated.bench import emulated_devices, true_joint
from jointid.hardware.emulated.bus import EmulatedBus
from jointid.hardware.emulated.converter import EmulatedConverter
from jointid.hardware.emulated.elmo import ElmoSettings, EmulatedElmo
from jointid.hardware.emulated.faults import BusFault
from jointid.hardware.emulated.thread import EmulatorThread
from jointid.hardware.limits import SessionLimits
from jointid.hardware.live import ConsoleLine
from jointid.hardware.live_plot import LivePlot
from jointid.hardware.realtime import RealTimeOptions
from jointid.hardware.replaying import replay
from jointid.hardware.session import (
    Session,
    SessionOptions,
    SessionRefusedError,
    SessionStoppedError,
)
from jointid.hardware.stop import Stop
from jointid.hardware.torque_source import AnalogInput, SensorScaling, SyncedConverter

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
