"""How far a bench's joint goes before the drive's own watchdog ends its motion."""

from __future__ import annotations

from jointid.hardware.bench.bench import Bench
from jointid.hardware.proof.axis import Axis
from jointid.hardware.session.drive import Drive
from jointid.hardware.session.watchdog import watchdog_of
from jointid.hardware.session.watchdog_check import (
    WatchdogTravel,
    watchdog_problems,
    watchdog_travel,
)

NO_WATCHDOG = "the drive declares no watchdog: it may go on when this program dies, so the bench gets no certificate"


def watchdog_of_bench(bench: Bench, drive: Drive, position: float) -> WatchdogTravel | None:
    """Return how far a bench's joint goes when the host dies in its motion; None: its drive declares no watchdog.

    Parameters
    ----------
    bench : Bench
    drive : Drive
        Connected.
    position : float
        Where the joint stands [rad].
    """
    watchdog = watchdog_of(drive)
    if watchdog is None:
        return None
    return watchdog_travel(
        *(watchdog, bench.joint, bench.controller, bench.trajectory, bench.limits, bench.options),
        position=position,
    )


def slow_on_bench(bench: Bench, drive: Drive, axis: Axis) -> list[str]:
    """Return why a bench's joint must not be moved with the watchdog that its drive declares; empty: it may."""
    travel = watchdog_of_bench(bench, drive, axis.sample.position)
    return [] if travel is None else [*watchdog_problems(travel, bench.options)]
