"""An Elmo SimplIQ drive and its torque sensor's converter on CANopen, real or emulated."""

from jointid.hardware.elmo.codec import Command, DriveError, Reply
from jointid.hardware.elmo.drive import ElmoDrive
from jointid.hardware.elmo.emulated_bench import ElmoEmulation
from jointid.hardware.elmo.emulated_converter import EmulatedConverter
from jointid.hardware.elmo.emulated_drive import ElmoSettings, EmulatedElmo
from jointid.hardware.elmo.options import ElmoOptions
from jointid.hardware.elmo.torque_source import AnalogInput, SensorScaling, SyncedConverter

__all__ = [
    "AnalogInput",
    "Command",
    "DriveError",
    "ElmoDrive",
    "ElmoEmulation",
    "ElmoOptions",
    "ElmoSettings",
    "EmulatedConverter",
    "EmulatedElmo",
    "Reply",
    "SensorScaling",
    "SyncedConverter",
]
