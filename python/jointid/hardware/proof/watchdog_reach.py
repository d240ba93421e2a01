"""Travel of a bench's joint until the drive's own watchdog ends its motion."""

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

NO_WATCHDOG = "the drive declares no watchdog: the motor may go on if this program dies, so no certificate is written"


def watchdog_of_bench(bench: Bench, drive: Drive, position: float) -> WatchdogTravel | None:
    """Return the travel of a bench's joint after its host dies; None if its drive declares no watchdog.

    Parameters
    ----------
    bench : Bench
    drive : Drive
        Connected drive.
    position : float
        Position of the joint [rad].
    """
    watchdog = watchdog_of(drive)
    if watchdog is None:
        return None
    return watchdog_travel(
        *(watchdog, bench.joint, bench.controller, bench.trajectory, bench.limits, bench.options),
        position=position,
    )


def slow_on_bench(bench: Bench, drive: Drive, axis: Axis) -> list[str]:
    """Return the reasons why the drive's watchdog forbids a motion of a bench's joint; empty if it does not."""
    travel = watchdog_of_bench(bench, drive, axis.sample.position)
    return [] if travel is None else [*watchdog_problems(travel, bench.options)]
