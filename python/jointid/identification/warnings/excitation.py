"""Deficits of a recording for a parameter: speeds, reversals, loads, accelerations, travel; with figures."""

from __future__ import annotations

import functools
import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from jointid.base.values import dataclass
from jointid.estimate.findings import Measured
from jointid.estimate.statistics import ParameterEstimate
from jointid.estimate.wording import percent
from jointid.identification.warnings.evidence import Evidence
from jointid.problem.terms import WEAK_READING
from jointid.recording.order_statistics import quantile

Array = NDArray[np.float64]

# Sufficient amount of each quantity.
_SPEEDS = 3.0  # ratio of fast to slow
_FRICTION = 0.1  # of the torque: change of friction over the range of speeds
_SLOW = 0.03  # of the windows: share slower than twice the Stribeck velocity
_REVERSALS = 4
_DIRECTION = 0.15  # of the time, in the rarer direction
_LOAD = 0.03  # spread of the sensed torque over the torque of the drive
_ACCELERATION = 0.1  # of the torque
_TRAVEL = 0.75  # of a period of a torque that depends on the angle
_GRAVITY = 1.0  # [rad]
_LONGEST = 10.0  # times the recording: longer recordings are not advised for one parameter


@dataclass(frozen=True, slots=True)
class Lack:
    """A quantity that a recording contains too little of.

    Attributes
    ----------
    quantity : str
        Name of the quantity; parameters with the same name lack the same.
    short : str
        Deficit in a few words.
    text : str
        Present and required amount, in figures.
    motion : str
        Motion to record.
    measured : mapping of str to Measured
        Figures of the text.
    wanted : float
        Required amount.
    """

    quantity: str
    short: str
    text: str
    motion: str
    measured: Mapping[str, Measured]
    wanted: float = 0.0


@dataclass(frozen=True)
class Excitation:
    """Excitation in the windows of an estimate."""

    evidence: Evidence

    @functools.cached_property
    def _speed(self) -> Array:
        return np.abs(self.evidence.table.velocity)

    @functools.cached_property
    def speeds(self) -> tuple[float, float]:
        """Slow and fast speed: 10 % of the windows are slower, 5 % faster."""
        slow, fast = quantile(self._speed, 0.1), quantile(self._speed, 0.95)
        return float(slow), float(fast)

    @functools.cached_property
    def reversals(self) -> int:
        """Number of changes of direction."""
        table = self.evidence.table
        moving = np.abs(table.velocity) > 0.02 * self.speeds[1]
        turned = np.sign(table.velocity[moving])
        same = np.diff(table.recording[moving]) == 0
        return int(np.count_nonzero((turned[1:] != turned[:-1]) & same))

    @functools.cached_property
    def rarer(self) -> float:
        """Share of the time in the rarer direction."""
        table = self.evidence.table
        forward = float(table.duration[table.velocity > 0.0].sum() / table.duration.sum())
        return min(forward, 1.0 - forward)

    @functools.cached_property
    def travel(self) -> float:
        """Largest range of positions of a recording [rad or m]."""
        return max(float(np.ptp(run.position)) for run in self.evidence.recordings)

    def _unit(self, rate: bool = False) -> str:
        length = "m" if self.evidence.recordings[0].kind == "prismatic" else "rad"
        return f"{length}/s" if rate else length

    def _torque(self) -> str:
        return "N" if self.evidence.recordings[0].kind == "prismatic" else "N·m"

    @functools.cached_property
    def _few(self) -> Lack | None:
        """Lack of windows if there are hardly more than parameters."""
        windows, free = self.evidence.residuals.windows, len(self.evidence.chance)
        if windows > 3 * free:
            return None
        text = f"the log has {windows} windows for {free} parameters"
        return Lack(
            "windows",
            f"only {windows} windows",
            text,
            "more motion",
            {"windows": Measured(float(windows)), "free_parameters": Measured(float(free))},
        )

    def lack(self, p: ParameterEstimate) -> Lack | None:
        """Return the deficit of the recordings for a parameter; None if they contain enough."""
        if self._few is not None:
            return self._few
        name = p.name.partition("[")[0]
        base = name.removesuffix("_positive").removesuffix("_negative")
        if base == "inertia":
            return self._acceleration(p)
        if base == "viscous":
            return self._both_ways(name) or self._speed_range() or self._viscous_share(p)
        if base == "coulomb":
            return self._both_ways(name) or self._speed_range()
        if base in ("static", "stribeck", "stribeck_velocity", "stribeck_exponent"):
            return self._both_ways(name) or self._slow_motion()
        if base == "torque_offset":
            return self._both_ways("")
        if base in ("sensor_gain", "sensor_offset"):
            return self._load()
        if base == "load_friction":
            return self._load()
        if base.startswith(("gravity", "position", "ripple")):
            return self._angle(base)
        return None

    def longer(self, name: str, error: float, wanted: float) -> Lack:
        """Return the lack of time, if only noise limits the accuracy."""
        duration = float(self.evidence.table.duration.sum())
        needed = duration * min((error / wanted) ** 2, 1e6)
        text = f"the log has {_two(duration)} s of motion, but about {_two(needed)} s are needed with this noise"
        short = f"{_two(duration)} of {_two(needed)} s recorded"
        motion = f"about {_two(needed)} s of such motion"
        measured = {"duration": Measured(duration, "s"), "duration.needed": Measured(needed, "s")}
        if needed > _LONGEST * duration:
            text = (
                f"noise hides {name}: the log has {_two(duration)} s of motion, but {_two(needed / duration)} times "
                "this duration is needed"
            )
            measured["duration.factor"] = Measured(float(_two(needed / duration)))
            short, motion = "too much noise", f"motion in which {name} has more effect"
        return Lack("duration", short, text, motion, measured, needed)

    def noise(self) -> Lack:
        """Return the lack of resolution, if the velocity's noise hides the inertia."""
        share = self.evidence.residuals.noise_share
        text = f"velocity noise is {percent(share)} of the velocity's change over a window"
        motion = "the position with a finer resolution"
        return Lack(
            "velocity_noise", "noisy velocity", text, motion, {"velocity_noise": Measured(share)}
        )

    def _both_ways(self, name: str) -> Lack | None:
        if self.reversals < _REVERSALS and not name.endswith(("_positive", "_negative")):
            count = self.reversals
            return Lack(
                "reversals",
                f"{count} of {_REVERSALS} reversals",
                f"the log has {count} reversal{'s' * (count != 1)}, but {_REVERSALS} or more are needed",
                f"motion with {_REVERSALS} or more reversals",
                {
                    "reversals": Measured(float(count)),
                    "reversals.needed": Measured(float(_REVERSALS)),
                },
            )
        if self.rarer < _DIRECTION:
            share = f"{100.0 * (1.0 - self.rarer):.0f} %"
            return Lack(
                "direction",
                f"{share} in one direction",
                f"the joint moves in one direction for {share} of the time",
                "equal motion in both directions",
                {"direction": Measured(1.0 - self.rarer)},
            )
        return None

    def _speed_range(self) -> Lack | None:
        slow, fast = self.speeds
        if fast >= _SPEEDS * slow:
            return None
        unit = self._unit(rate=True)
        return Lack(
            "speed_range",
            f"speeds {_two(slow)} to {_two(fast)} {unit} only",
            f"the log's speeds are {_two(slow)} to {_two(fast)} {unit}, but a wider range is needed, e.g. "
            f"{_two(0.2 * fast)} to {_two(fast)} {unit}",
            f"motion at several speeds from {_two(0.2 * fast)} to {_two(fast)} {unit}",
            {
                "speed.slow": Measured(slow, unit),
                "speed.fast": Measured(fast, unit),
                "speed.needed": Measured(0.2 * fast, unit),
            },
        )

    def _viscous_share(self, p: ParameterEstimate) -> Lack | None:
        fast = self.speeds[1]
        share = abs(p.value) * fast / max(self.evidence.torque_level, 1e-300)
        if share >= _FRICTION:
            return None
        unit = self._unit(rate=True)
        return Lack(
            "top_speed",
            f"top speed {_two(fast)} {unit} only",
            f"at the top speed, {_two(fast)} {unit}, viscous friction is {percent(share)} of the torque",
            f"motion faster than {_two(fast)} {unit}",
            {"speed.fast": Measured(fast, unit), "viscous.share": Measured(share)},
        )

    def _slow_motion(self) -> Lack | None:
        slow, fast = self._stribeck_velocity(), self.speeds[1]
        if slow is None:
            return None
        unit = self._unit(rate=True)
        share = float(np.mean(self._speed < 2.0 * slow))
        if share < _SLOW:
            return Lack(
                "slow_motion",
                f"{percent(share)} slow motion",
                f"{percent(share)} of the windows are slower than {_two(2.0 * slow)} {unit}, where static friction "
                "acts",
                f"slow motion through zero speed, below {_two(2.0 * slow)} {unit}",
                {"slow_windows": Measured(share), "speed.slow": Measured(2.0 * slow, unit)},
            )
        if fast < 2.0 * slow:
            return Lack(
                "top_speed",
                f"top speed {_two(fast)} {unit} only",
                f"the top speed, {_two(fast)} {unit}, is below twice the decay speed of static friction, "
                f"{_two(slow)} {unit}",
                f"motion faster than {_two(2.0 * slow)} {unit}",
                {"speed.fast": Measured(fast, unit), "speed.decay": Measured(slow, unit)},
            )
        return None

    def _stribeck_velocity(self) -> float | None:
        found = self.evidence.parameters
        if "stribeck" in found and found["stribeck"].value > 0.0:
            return 1.0 / math.sqrt(found["stribeck"].value)
        return found["stribeck_velocity"].value if "stribeck_velocity" in found else None

    def _acceleration(self, p: ParameterEstimate) -> Lack | None:
        evidence = self.evidence
        column = evidence.at_best.norm(p.name) * abs(p.value)
        share = column / max(evidence.at_best.target, 1e-300)
        if share >= _ACCELERATION:
            return None
        return Lack(
            "acceleration",
            "little acceleration",
            f"acceleration causes {percent(share)} of the log's torque, but {percent(_ACCELERATION)} is needed",
            "harder acceleration",
            {"acceleration": Measured(share), "acceleration.needed": Measured(_ACCELERATION)},
        )

    def _load(self) -> Lack | None:
        evidence = self.evidence
        if "sensor_gain" not in evidence.parameters:
            return None
        sensed = [run.sensor for run in evidence.recordings if run.sensor is not None]
        # White noise of the reading is no load. It is the difference between neighbouring samples.
        noise = float(np.mean([0.5 * np.mean(np.diff(each) ** 2) for each in sensed]))
        level = float(np.concatenate(sensed).var())
        spread = abs(evidence.parameters["sensor_gain"].value) * math.sqrt(max(level - noise, 0.0))
        share = spread / max(evidence.torque_level, 1e-300)
        weak = (
            evidence.problem.choice.residual_reason == WEAK_READING
        )  # the gain is uncertain then, too
        if share >= _LOAD and not weak:
            return None
        unit = self._torque()
        short = f"load varies by {_two(spread)} {unit} only"
        motion = "a wider range of gravity torque"
        if share >= _LOAD:
            return Lack(
                "load_range",
                short,
                f"{WEAK_READING}; without noise, the reading varies by {_two(spread)} {unit}",
                motion,
                {"load_range": Measured(spread, unit), "load_range.share": Measured(share)},
            )
        return Lack(
            "load_range",
            short,
            f"the sensed torque varies by {_two(spread)} {unit}; this is {percent(share)} of the drive's torque, "
            f"but {percent(_LOAD)} is needed",
            motion,
            {
                "load_range": Measured(spread, unit),
                "load_range.share": Measured(share),
                "load_range.needed": Measured(_LOAD),
            },
        )

    def _angle(self, base: str) -> Lack | None:
        order = base.rpartition("_")[2]
        if base.startswith("gravity"):
            needed = _GRAVITY
        else:
            joint = self.evidence.joint
            gear = abs(joint.gear_ratio) if joint is not None and base[0] == "r" else 1.0
            needed = _TRAVEL * 2.0 * math.pi / (float(order) * gear)
        if self.travel >= needed:
            return None
        return Lack(
            "travel",
            f"{_below(self.travel, needed)} of {_two(needed)} rad travelled",
            f"the log's angles cover {_below(self.travel, needed)} rad, but {_two(needed)} rad are needed",
            f"motion through {_two(needed)} rad or more",
            {"travel": Measured(self.travel, "rad"), "travel.needed": Measured(needed, "rad")},
            needed,
        )


def _below(value: float, needed: float) -> str:
    """Return a value that is too small, with enough digits to show that it is below the need."""
    shown = (f"{float(f'{value:.{digits}g}'):g}" for digits in range(2, 7))
    return next((text for text in shown if float(text) < float(_two(needed))), f"{value!r}")


def _two(value: float) -> str:
    return f"{float(f'{value:.2g}'):g}"
