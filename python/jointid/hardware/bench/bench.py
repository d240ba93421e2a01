"""Bench: a joint with its drive, motion, controller and limits, and the type of its drive."""

from __future__ import annotations

from contextlib import AbstractContextManager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from jointid.base.errors import InputError
from jointid.hardware.bench.bus_options import BusOptions
from jointid.hardware.bench.drive_format import DriveFormat
from jointid.hardware.bench.drive_types import DEFAULT_TYPE, adapter_of
from jointid.hardware.bench.emulation import Emulation
from jointid.hardware.bench.first_motion_options import FirstMotionOptions
from jointid.hardware.session.limits import SessionLimits
from jointid.hardware.session.options import SessionOptions
from jointid.hardware.session.realtime import RealTimeOptions
from jointid.joint.joint import Joint
from jointid.simulation.arguments import Controller
from jointid.simulation.designed_for import DesignedFor
from jointid.simulation.trajectory import Trajectory

if TYPE_CHECKING:
    from jointid.hardware.emulated.device import Device
    from jointid.hardware.session.drive import Drive


@dataclass(frozen=True, slots=True, kw_only=True)
class Bench:
    """Everything that a session needs, except the open bus.

    Attributes
    ----------
    joint : Joint
        Joint on the bench. Its parameter values are the controller's initial assumptions.
    controller : AdaptiveRobust, CompensatedPid, LugreObserver, …
        Controller of the session. If it uses estimates, it has the joint's parameter values.
    trajectory : Trajectory
    drive : object
        Options of the drive, as its drive type defines them.
    limits : SessionLimits
    options : SessionOptions
    bus : BusOptions
    real_time : RealTimeOptions
    emulation : Emulation or None
        The joint that an emulated drive moves.
    drive_type : str
        Name of the drive's type, see `DriveType`. Default: the type for a joint file that names no type.
    first_motion : FirstMotionOptions
    designed_for : DesignedFor or None
        Joint, controller and period that the trajectory was designed for, if its file states them. Default None.
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
        """Differences from the bench that the motion was designed for; empty if there are none."""
        if self.designed_for is None:
            return ""
        return self.designed_for.warning(
            self.trajectory, self.joint, self.controller, self.options.period
        )

    @property
    def address(self) -> str:
        """Address of the real drive, e.g. "socketcan can0, node 127"."""
        return drive_type(self.drive_type).address(self)

    @classmethod
    def load(cls, path: str | Path) -> Bench:
        """Read a joint file with a table `[session]`. `examples/hardware/joint.toml` is an example with comments.

        Raises
        ------
        InputError
            A value cannot be used. The error names file, table and key.

        Examples
        --------
        >>> bench = jid.hardware.Bench.load("examples/hardware/joint.toml")
        >>> bench.address
        'socketcan can0, node 127'
        """
        from jointid.hardware.bench.bench_file import bench_fields

        return cls(**bench_fields(path))


class DriveType(DriveFormat):
    """Adapter for one type of drive. A new type needs a subclass and an entry point.

    A subclass must define `options`, `open` and `emulate`; `tests/third_party_drive` is an example.

    Attributes
    ----------
    tables : tuple of str
        Tables under `[session]` that `options` reads in addition to `[session.drive]`. Default: none.

    Examples
    --------
    In the `pyproject.toml` of the package with the subclass::

        [project.entry-points."jointid.drives"]
        acme = "acme_drive:AcmeType"
    """

    def open(self, bench: Bench) -> AbstractContextManager[Drive]:
        """Return a context manager that yields the real drive and closes its bus at the end.

        Raises
        ------
        InputError
            The bus cannot be opened.
        """
        raise NotImplementedError

    def address(self, bench: Bench) -> str:
        """Return the address of the real drive, which is shown before a joint moves. Default: the drive's options."""
        return str(bench.drive)

    def emulate(self, bench: Bench, seed: int) -> AbstractContextManager[Drive]:
        """Return a context manager that yields an emulated drive in virtual time.

        Parameters
        ----------
        bench : Bench
        seed : int
            Seed of the emulated noise.

        Raises
        ------
        InputError
            The bench does not describe an emulated joint.
        """
        raise NotImplementedError

    def devices(self, bench: Bench, seed: int) -> tuple[Device, ...]:
        """Return the emulated devices for a CAN bus that other programs use. Default: raises InputError."""
        del seed
        raise InputError(
            "jointid cannot emulate this type of drive on a CAN bus",
            argument="type",
            value=bench.drive_type,
            place="[session.drive]",
        )


def drive_type(name: str) -> DriveType:
    """Return the adapter of a drive type.

    Raises
    ------
    InputError
        The name is not a text, or the type is unknown. Several packages register the type, or a package registers a
        built-in name. The entry point cannot be used; `__cause__` is then the package's error.
    """
    return adapter_of(name, DriveType)
