"""The joint, its truth, the motions and the estimates that the thesis's figures are about."""

import math
from dataclasses import replace

import numpy as np

import jointid as jid
from jointid import _core

# Simulation truth: coulomb is printed, the others follow from section 5.5; the offset is ours.
TRUTH = {
    "coulomb": 25.0,
    "static": 20.0,
    "stribeck": 100.0,
    "viscous": 20.0,
    "sensor_gain": 2.4,
    "sensor_offset": 15.0,
}
# Table 6-3, first row and second.
INITIAL = dict(zip(TRUTH, (10.0, 20.0, 200.0, 10.0, 1.0, 0.0), strict=True))
BENCH = dict(zip(TRUTH, (25.0, 3.0, 94.0, 19.0, 1.3, 2.5), strict=True))
# Table 6-2, friction only: "the sensor characteristics are assumed to be known".
GOOD = {"coulomb": 20.0, "static": 10.0, "stribeck": 110.0, "viscous": 20.0}
POOR = {"coulomb": 10.0, "static": 40.0, "stribeck": 300.0, "viscous": 50.0}

NOISE = jid.Sensors(torque_noise=0.5)
# (6-1): w = 3 / (2 pi) rad/s, so a cycle of (2 pi)² / 3 s.
CYCLE = 4.0 * math.pi**2 / 3.0


def hanging_joint() -> jid.Joint:
    """The joint as a user knows it; its link hangs down at position 0."""
    joint = jid.thesis_joint()
    assert joint.link is not None
    return joint.replace(link=replace(joint.link, angle=-math.pi / 2.0))


def wide_motion() -> jid.Trajectory:
    """60 degrees in cycles of 3 s: a motion that determines all six parameters."""
    return jid.Trajectory.thesis(math.radians(60.0), cycle=3.0, duration=12.0)


def bench_motion(amplitude: float = 4.0) -> jid.Trajectory:
    """(6-1) as printed: 4 degrees, one slow cycle."""
    return jid.Trajectory.thesis(math.radians(amplitude), cycle=CYCLE, duration=CYCLE)


def controller(joint: jid.Joint, values: dict[str, float]) -> jid.AdaptiveRobust:
    """Table 6-1 with these estimates; adaptation off, which diverges with an encoder at its gain."""
    known = {name: value for name, value in values.items() if name in TRUTH}
    drive = jid.control_estimates(joint.with_parameters(TRUTH))
    return jid.AdaptiveRobust(**{**drive, **known})


def found(estimate: jid.Estimate) -> dict[str, float]:
    """The six values of an estimate."""
    return {name: estimate.parameters[name].value for name in TRUTH}


def first_recording() -> jid.SimulatedRecording:
    """The wide motion under Table 6-3's initial estimates."""
    joint = hanging_joint()
    true = joint.with_parameters(TRUTH)
    return jid.simulate(true, controller(joint, INITIAL), wide_motion(), sensors=NOISE)


def domain(joint: jid.Joint, name: str) -> tuple[float, float]:
    """Where the search looks for a parameter."""
    parameter = joint.parameters[name]
    assert parameter.min is not None
    assert parameter.max is not None
    return parameter.min, parameter.max


class Penalty:
    """The penalty of one recording, ready for many searches: made once, then O(1) a candidate."""

    def __init__(self, recording: jid.Recording, joint: jid.Joint) -> None:
        core = _core.Recording(
            time=recording.time,
            position=recording.position,
            velocity=recording.velocity,
            torque=joint.output_torque(recording),
            sensor=recording.sensor,
            torque_hold=_core.Hold.zero_order,
            gap_after=[],
        )
        direct = _core.Penalty(
            recordings=[core],
            terms=["inertia", "coulomb", "static", "viscous", "sensor_gain", "sensor_offset"],
            windows=_core.WindowOptions(),
            residual=_core.Residual.sensor,
        )
        inertia = jid.control_estimates(joint.with_parameters(TRUTH))["inertia"]
        bounds = {name: domain(joint, name) for name in TRUTH} | {"inertia": (inertia, inertia)}
        self.names = direct.names
        self.lower = np.array([bounds[name][0] for name in self.names], dtype=float)
        self.upper = np.array([bounds[name][1] for name in self.names], dtype=float)
        self.form = _core.CompressedPenalty(direct, self.lower, self.upper)
        assert self.form.exact

    def genetic(self, options: jid.GaOptions, trial: int) -> tuple[dict[str, float], float]:
        """The best of a genetic search, and its penalty."""
        result = _core.minimise_genetic(
            self.form, self.lower, self.upper, options=options, trial=trial
        )
        return self._named(result)

    def random(self, options: jid.GaOptions, trial: int) -> tuple[dict[str, float], float]:
        """The best of as many random candidates."""
        result = _core.minimise_random(
            self.form, self.lower, self.upper, options=options, trial=trial
        )
        return self._named(result)

    def _named(self, result: _core.GaResult) -> tuple[dict[str, float], float]:
        values = dict(zip(self.names, result.best.tolist(), strict=True))
        return {name: values[name] for name in TRUTH}, result.penalty


def errors(values: dict[str, float]) -> dict[str, float]:
    """Relative error of each of the six [%]."""
    return {name: 100.0 * (values[name] / true - 1.0) for name, true in TRUTH.items()}


def all_within(values: dict[str, float], percent: float = 5.0) -> bool:
    """The thesis's acceptance."""
    return all(abs(error) <= percent for error in errors(values).values())
