"""Check of the connected bench: read only, the motor stays off."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from jointid.base.argument_checks import require_kind
from jointid.hardware.bench.bench import Bench
from jointid.hardware.bench.opened_drive import open_drive
from jointid.hardware.proof.sizes import resolution_of, sizes_of
from jointid.hardware.proof.watchdog_reach import NO_WATCHDOG, watchdog_of_bench
from jointid.hardware.session.drive import Drive, DriveFaultError
from jointid.hardware.session.drive_report import DriveReport
from jointid.hardware.session.gains import doubt_of_gains
from jointid.hardware.session.moving_joint import MovingJoint
from jointid.hardware.session.start_checks import problems_at_rest
from jointid.hardware.session.watchdog import Watchdog
from jointid.hardware.session.watchdog_check import WatchdogTravel, watchdog_problems

_DRIFT = 5.0  # counts, largest motion during the check
_LITTLE_ABOVE = (
    2.0  # times the joint's velocity; a higher speed limit of the drive does not protect
)


@dataclass(frozen=True, slots=True, kw_only=True)
class BenchCheck:
    """Result of a check of the connected bench.

    Attributes
    ----------
    address : str
        Address of the drive.
    identity : mapping
        Identity that the drive reported.
    report : DriveReport or None
        Settings of the drive; None if the drive reports no settings.
    position, velocity : float
        Output angle [rad] and mean speed [rad/s] during the check.
    reading, noise : float
        Mean and standard deviation of the torque sensor's raw readings; NaN without a sensor.
    differences : tuple of str
        Differences between the drive's settings and the settings that the joint file requires.
    problems : tuple of str
        Reasons not to move the joint.
    watchdog : WatchdogTravel or None
        Travel of the joint after a failure of the host; None if the drive declares no watchdog.
    remarks : tuple of str
        Recommended changes. A motion is also possible without them.
    first_motion : str
        Text on the travel of a first motion with this encoder.
    """

    address: str
    identity: Mapping[str, Any] = field(default_factory=dict)
    report: DriveReport | None = None
    position: float = math.nan
    velocity: float = math.nan
    reading: float = math.nan
    noise: float = math.nan
    differences: tuple[str, ...] = ()
    problems: tuple[str, ...] = ()
    watchdog: WatchdogTravel | None = None
    remarks: tuple[str, ...] = ()
    first_motion: str = ""

    @property
    def passed(self) -> bool:
        """Whether the check found no reason against a motion."""
        return not (self.differences or self.problems)

    @property
    def declared(self) -> Watchdog | None:
        """Watchdog that the drive declares."""
        return None if self.watchdog is None else self.watchdog.watchdog

    def to_dict(self) -> dict[str, Any]:
        """Return the fields as JSON types; an unknown number is None."""
        numbers = {
            name: value if math.isfinite(value) else None
            for name in ("position", "velocity", "reading", "noise")
            for value in (getattr(self, name),)
        }
        return {
            "passed": self.passed,
            "address": self.address,
            "identity": dict(self.identity),
            "report": None if self.report is None else self.report.to_dict(),
            **numbers,
            "differences": list(self.differences),
            "problems": list(self.problems),
            "watchdog": None if self.watchdog is None else self.watchdog.to_dict(),
            "remarks": list(self.remarks),
            "first_motion": self.first_motion,
        }

    def text(self) -> str:
        """Return the complete check as text."""
        lines = [f"drive: {self.address}"]
        if self.report is None:
            lines += [f"  {name}: {value}" for name, value in self.identity.items()]
        else:
            lines.append(f"  {self.report.drive}")
            for title, entries in (
                ("identity", self.report.identity),
                ("settings", self.report.settings),
                ("watchdog", self.report.watchdog),
            ):
                lines.append(f"{title}:")
                lines += [f"  {entry}" for entry in entries]
            lines += [
                f"{name}: {value:.4g} {unit}"
                for name, value, unit in (
                    ("supply", self.report.supply, "V"),
                    ("temperature", self.report.temperature, "°C"),
                )
                if math.isfinite(value)
            ]
        lines.append(f"position: {self.position:+.5f} rad, speed {self.velocity:+.5f} rad/s")
        if math.isfinite(self.reading):
            lines.append(f"torque sensor: reads {self.reading:+.3f} ± {self.noise:.3f}")
        if self.watchdog is not None:
            lines.append(f"if the host dies: {self.watchdog}")
        lines += [f"REMARK: {each}" for each in self.remarks]
        lines += [f"DIFFERENT: {each}" for each in self.differences]
        lines += [f"PROBLEM: {each}" for each in self.problems]
        if self.passed:
            lines.append(f"a first motion is possible: {self.first_motion}")
        return "\n".join(lines)


def check_bench(
    bench: Bench, *, emulate: bool = False, seed: int = 0, drive: Drive | None = None
) -> BenchCheck:
    """Read the connected drive and compare it with the joint file; the motor stays off.

    Parameters
    ----------
    bench : Bench
    emulate : bool
        Whether to use an emulated drive in virtual time. Default False: the real drive.
    seed : int
        Seed of the emulated noise. Default 0.
    drive : Drive, optional
        An open drive. The check closes this drive at its end. Default: the bench's drive.

    Returns
    -------
    BenchCheck

    Raises
    ------
    InputError
        `bench` is not a Bench, or its drive cannot be opened.

    Examples
    --------
    >>> jid.hardware.check_bench(bench, emulate=True).passed
    True
    """
    require_kind("bench", bench, Bench)
    if drive is not None:
        return _checked(bench, drive, bench.address)
    with open_drive(bench, emulate=emulate, seed=seed) as opened:
        return _checked(bench, opened, "emulated" if emulate else bench.address)


def _checked(bench: Bench, drive: Drive, address: str) -> BenchCheck:
    found: dict[str, Any] = {"address": address}
    try:
        _read(bench, drive, found)
    except DriveFaultError as error:
        found["problems"] = (*found.get("problems", ()), str(error))
    except OSError as error:
        found["problems"] = (*found.get("problems", ()), f"{type(error).__name__}: {error}")
    finally:
        try:
            drive.disable()
        finally:
            drive.close()
    return BenchCheck(**found)


def _read(bench: Bench, drive: Drive, found: dict[str, Any]) -> None:
    period, clock = bench.options.period, drive.clock
    drive.connect(period)
    found["identity"] = drive.identity()
    ask = getattr(drive, "report", None)
    report = ask() if callable(ask) else None
    found["report"] = report if isinstance(report, DriveReport) else None
    if found["report"] is not None:
        found["differences"] = tuple(str(each) for each in found["report"].differences)
    problems = list(drive.problems(bench.limits.torque))
    found["problems"] = tuple(problems)
    begin = clock.now()
    samples = []
    for k in range(max(2, round(bench.first_motion.still_time / period))):
        clock.sleep_until(begin + k * period)
        try:
            samples.append(drive.read(10.0 * period))
        except DriveFaultError as error:
            if error.kind != "stale_position" or len(samples) < 2:
                raise
    last = samples[-1]
    resolution = resolution_of(bench, drive)
    found["first_motion"] = str(sizes_of(bench.first_motion, resolution))
    if found["report"] is not None:
        found["remarks"] = tuple(_wide_speeds(found["report"], bench.limits.velocity))
    doubt = doubt_of_gains(bench.controller, MovingJoint.of(bench.joint), period)
    if doubt:
        found["remarks"] = (*found.get("remarks", ()), doubt)
    positions = np.array([each.position for each in samples])
    duration = max(last.time - samples[0].time, period)
    found["position"] = last.position
    found["velocity"] = (last.position - samples[0].position) / duration
    if bench.joint.sensor:
        readings = np.array([each.reading for each in samples])
        found["reading"], found["noise"] = float(readings.mean()), float(readings.std())
    problems += problems_at_rest(last, bench.limits)
    travel = watchdog_of_bench(bench, drive, last.position)
    if travel is None:
        found["remarks"] = (*found.get("remarks", ()), NO_WATCHDOG)
    else:
        found["watchdog"] = travel
        problems += watchdog_problems(travel, bench.options)
    moved = float(np.ptp(positions)) / resolution
    if not moved <= _DRIFT:
        problems.append(
            f"the joint moves: {moved:.0f} counts within {duration:.2f} s with the motor off; hold the joint "
            "still, and support it against gravity"
        )
    found["problems"] = tuple(problems)


def _wide_speeds(report: DriveReport, velocity: float) -> Iterator[str]:
    """Yield remarks on speed limits of the drive that are too high to stop an uncontrolled joint."""
    for each in report.settings:
        if (
            each.kind != "speed_limit"
            or each.output is None
            or not isinstance(each.value, int | float)
        ):
            continue
        times = abs(each.output) / velocity
        if times > _LITTLE_ABOVE:
            yield (
                f"the drive's own speed limit {each.name} is {each.value:.0f} {each.unit}, {times:.0f} times the "
                f"joint's velocity limit of {velocity:g} rad/s; set {each.name} slightly beyond "
                f"{each.value / times:.0f} {each.unit}"
            )
