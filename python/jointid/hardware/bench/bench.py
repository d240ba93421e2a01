"""A bench: a joint, its drive, a motion, a controller and limits."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from jointid import _core
from jointid.base.errors import InputError
from jointid.hardware.bench.drive_types import DEFAULT_TYPE, drive_type
from jointid.hardware.bench.first_motion_options import FirstMotionOptions
from jointid.hardware.can.bus import check_bitrates, check_interface
from jointid.hardware.session.limits import SessionLimits
from jointid.hardware.session.options import SessionOptions
from jointid.hardware.session.realtime import RealTimeOptions
from jointid.joint.joint import Joint
from jointid.simulation.arguments import Controller
from jointid.simulation.designed_for import DesignedFor
from jointid.simulation.trajectory import Trajectory


@dataclass(frozen=True, slots=True, kw_only=True)
class BusOptions:
    """A CAN bus, as python-can names it.

    Attributes
    ----------
    interface : str
        "socketcan", "pcan", "kvaser", … Default "socketcan".
    channel : str
        Default "can0".
    bitrate : int
        [bit/s]; with socketcan it is set with the interface, not here. Default 500 000.
    fd : bool
        Frames of CAN FD may be sent and received. Default False.
    data_bitrate : int, optional
        Of the data of CAN FD frames [bit/s]. Default: the same as `bitrate`.
    """

    interface: str = "socketcan"
    channel: str = "can0"
    bitrate: int = 500_000
    fd: bool = False
    data_bitrate: int | None = None

    def __post_init__(self) -> None:
        check_bitrates(self.bitrate, fd=self.fd, data_bitrate=self.data_bitrate)
        if self.interface != "socketcan":  # a bench without a CAN bus needs no python-can
            check_interface(self.interface)


@dataclass(frozen=True, slots=True, kw_only=True)
class Emulation:
    """The true values of an emulated bench; a session does not know them.

    Attributes
    ----------
    truth : mapping of str to float
        Values of the joint's parameters, by name [SI]. With "ripple_sin_2" and "ripple_cos_2" the gear
        itself ripples, if the joint's model has this order; without, it does not.
    sensors : Sensors
        Noise, ripple and the rest of the torque sensor. Encoder and converter are the drive's.
    integration_step : float
        Of the joint, at most [s].
    position : float
        Angle of the joint at first [rad].
    drive : object, optional
        Options of the emulated drive, of its type's own kind. Default: the type's default.
    """

    truth: Mapping[str, float]
    sensors: _core.Sensors = field(default_factory=_core.Sensors)
    integration_step: float = 2.5e-4
    position: float = 0.0
    drive: Any = None

    def __post_init__(self) -> None:
        if not 0.0 < self.integration_step <= 0.01:
            raise InputError(
                "more than 0 and at most 0.01 s is expected",
                argument="integration_step",
                value=self.integration_step,
            )
        if not math.isfinite(self.position):
            raise InputError("a finite angle is expected", argument="position", value=self.position)


@dataclass(frozen=True, slots=True, kw_only=True)
class Bench:
    """All that a session needs but the bus itself.

    Attributes
    ----------
    joint : Joint
        Its parameters' values are those that the controller assumes at first.
    controller : AdaptiveRobust, CompensatedPid, LugreObserver, …
        With the joint's values, where it uses estimates.
    trajectory : Trajectory
    drive : object
        Options of the drive, of its type's own kind.
    limits : SessionLimits
    options : SessionOptions
    bus : BusOptions
    real_time : RealTimeOptions
    emulation : Emulation or None
        What an emulated drive moves.
    drive_type : str
        Name of the drive's type, see `DriveType`. Default: that of a joint file that names none.
    first_motion : FirstMotionOptions
    designed_for : DesignedFor or None
        What the trajectory was designed for, where a file says it. Default None.
    """

    joint: Joint
    controller: Controller
    trajectory: Trajectory
    drive: Any
    limits: SessionLimits
    options: SessionOptions
    bus: BusOptions = field(default_factory=BusOptions)
    real_time: RealTimeOptions = field(default_factory=RealTimeOptions)
    emulation: Emulation | None = None
    drive_type: str = DEFAULT_TYPE
    first_motion: FirstMotionOptions = field(default_factory=FirstMotionOptions)
    designed_for: DesignedFor | None = None

    @property
    def motion_warning(self) -> str:
        """In what this bench differs from the one its motion was designed for; empty where it does not."""
        if self.designed_for is None:
            return ""
        return self.designed_for.warning(
            self.trajectory, self.joint, self.controller, self.options.period
        )

    @property
    def address(self) -> str:
        """Where the real drive is, e.g. "socketcan can0, node 127"."""
        return drive_type(self.drive_type).address(self)

    @classmethod
    def load(cls, path: str | Path) -> Bench:
        """Read a joint file with a table `[session]`; `examples/hardware/joint.toml` explains it.

        Raises
        ------
        InputError
            Names file, table and key.

        Examples
        --------
        >>> bench = jid.hardware.Bench.load("examples/hardware/joint.toml")
        >>> bench.address
        'socketcan can0, node 127'
        """
        from jointid.hardware.bench.bench_file import load_bench

        return load_bench(path)


def joint_with_truth(joint: Joint, truth: Mapping[str, float]) -> Joint:
    """A joint with true parameters, and ripple only where the truth has it.

    Raises
    ------
    InputError
        A parameter that the joint's model does not have.
    """
    orders = tuple(
        order for order in joint.model.resolved.ripple if f"ripple_sin_{order:g}" in truth
    )
    return joint.replace(model=joint.model.replace(ripple=orders), parameters=dict(truth))
