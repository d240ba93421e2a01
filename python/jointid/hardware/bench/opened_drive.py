"""Open a bench's drive: the real one over its bus, or an emulated one in virtual time."""

from __future__ import annotations

from contextlib import AbstractContextManager
from typing import TYPE_CHECKING

from jointid.base.argument_checks import require_kind
from jointid.hardware.bench.bench import Bench, drive_type

if TYPE_CHECKING:
    from jointid.hardware.emulated.device import Device
    from jointid.hardware.session.drive import Drive


def open_drive(
    bench: Bench, *, emulate: bool = False, seed: int = 0
) -> AbstractContextManager[Drive]:
    """Open a bench's drive, for a `Session`.

    Parameters
    ----------
    bench : Bench
    emulate : bool
        Whether to use an emulated drive and a simulated joint, in virtual time. Default False: the real drive.
    seed : int
        Seed of the emulated noise. Default 0.

    Returns
    -------
    context manager of Drive
        Context manager that yields the drive and closes its bus at the end.

    Raises
    ------
    InputError
        `bench` is not a Bench, the bus cannot be opened, or the bench does not describe an emulated joint.

    Examples
    --------
    >>> bench = jid.hardware.Bench.load("joint.toml")
    >>> with jid.hardware.open_drive(bench, emulate=True) as drive:
    ...     recording = jid.hardware.Session(
    ...         drive, bench.controller, bench.trajectory, bench.limits, options=bench.options
    ...     ).run()
    """
    require_kind("bench", bench, Bench)
    adapter = drive_type(bench.drive_type)
    return adapter.emulate(bench, seed) if emulate else adapter.open(bench)


def emulated_devices(bench: Bench, seed: int = 0) -> tuple[Device, ...]:
    """Return the emulated devices of a bench, for an `EmulatedBus` or an `EmulatorThread`.

    Parameters
    ----------
    bench : Bench
    seed : int
        Seed of the emulated noise. Default 0.

    Raises
    ------
    InputError
        `bench` is not a Bench, it does not describe an emulated joint, or its drive type has no emulation on a CAN
        bus.
    """
    require_kind("bench", bench, Bench)
    return drive_type(bench.drive_type).devices(bench, seed)
