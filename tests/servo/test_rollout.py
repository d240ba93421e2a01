"""Rollouts against references of other kinds: a stiff solver for smooth friction, events for friction that sticks."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from simulated_servo import (
    LENGTH,
    LOOP_GAIN,
    MASS,
    SUPPLY,
    Truth,
    bench_runs,
    changed,
    servo_joint,
    with_truth,
)

import jointid as jid
from jointid import _core

TRUTH = Truth()
WEIGHT = MASS * 9.80665 * LENGTH
SMOOTH = replace(TRUTH, coulomb=0.0, load_friction=0.0, viscous=0.02)


def run_of(gain: float, seed: int, hold: float = 0.02) -> jid.Recording:
    """Wanted positions that are held for `hold` seconds, and a motor that turns freely in between."""
    generator = np.random.default_rng(seed)
    time = np.arange(0.0, 3.0, hold)
    phase = generator.uniform(0.0, 6.0, 2)
    wanted = 0.7 * np.sin(3.0 * time + phase[0]) + 0.4 * np.sin(8.0 * time + phase[1])
    wanted[(time > 0.5) & (time < 1.1)] = wanted[int(0.5 / hold)]  # here it comes to rest
    driven = np.where((time > 1.5) & (time < 2.1), 0.0, 1.0)
    extra = {
        "duty": np.zeros(len(time)),
        "supply": np.full(len(time), SUPPLY),
        "driven": driven,
        "gain": np.full(len(time), gain),
    }
    return jid.Recording(
        time=time, position=np.zeros(len(time)), reference=wanted, extra=extra, name=f"{gain:g}"
    )


class Reference:
    """The same servo in continuous time, with an event where the velocity becomes zero."""

    def __init__(self, truth: Truth) -> None:
        self.truth = truth
        self.inertia = truth.inertia + MASS * LENGTH**2
        self.torque_per_voltage = truth.torque_constant / truth.resistance
        self.back_emf = truth.torque_constant**2 / truth.resistance

    def pushed(
        self, q: float, v: float, wanted: float, driven: float, gain: float
    ) -> tuple[float, float]:
        """What accelerates, and the level of dry friction."""
        duty = max(-1.0, min(1.0, LOOP_GAIN * gain * (wanted - q)))
        motor = driven * (self.torque_per_voltage * SUPPLY * duty - self.back_emf * v)
        load = WEIGHT * math.sin(q)
        level = self.truth.coulomb + self.truth.load_friction * abs(load + motor)
        return motor - load, level

    def positions(self, run: jid.Recording) -> np.ndarray:
        """Position at each of the run's time stamps."""
        assert run.reference is not None
        q, v, found = 0.0, 0.0, []
        gain = float(run.extra["gain"][0])
        for k, start in enumerate(run.time):
            found.append(q)
            if k + 1 == len(run.time):
                break
            held = (float(run.reference[k]), float(run.extra["driven"][k]), gain)
            q, v = self._interval(q, v, float(start), float(run.time[k + 1]), held)
        return np.array(found)

    def _interval(
        self, q: float, v: float, now: float, end: float, held: tuple[float, float, float]
    ) -> tuple[float, float]:
        dry = self.truth.coulomb > 0.0 or self.truth.load_friction > 0.0
        while now < end:
            push, level = self.pushed(q, v, *held)
            if dry and v == 0.0 and abs(push) <= level:
                return q, 0.0  # all is held, so it stays
            side = math.copysign(1.0, v if v != 0.0 else push)

            def slope(_: float, state: Any, side: float = side) -> list[float]:
                acts, dry_level = self.pushed(state[0], state[1], *held)
                friction = side * dry_level + self.truth.viscous * state[1]
                return [state[1], (acts - friction) / self.inertia]

            def stopped(_: float, state: Any, side: float = side) -> float:
                return side * float(state[1]) + 1e-13

            stopped.terminal = dry  # type: ignore[attr-defined]
            stopped.direction = -1.0  # type: ignore[attr-defined]
            done = solve_ivp(
                slope,
                (now, end),
                [q, v],
                method="LSODA" if dry else "Radau",
                rtol=1e-8,
                atol=1e-10,
                events=stopped,
            )
            now, q, v = float(done.t[-1]), float(done.y[0, -1]), float(done.y[1, -1])
            if done.status == 1:
                v = 0.0
        return q, v


@pytest.mark.parametrize("gain", [100.0, 400.0])
def test_smooth_friction_moves_as_a_stiff_solver_says(gain: float) -> None:
    run = run_of(gain, seed=1)
    rolled = jid.rollout(with_truth(SMOOTH, servo_joint()), run)
    wanted = Reference(SMOOTH).positions(run)
    assert np.ptp(wanted) > 0.3
    assert np.degrees(np.abs(rolled.runs[0].position - wanted).max()) < 0.01


@pytest.mark.parametrize("gain", [100.0, 400.0, 800.0])
@pytest.mark.parametrize("seed", [2, 3])
def test_friction_that_sticks_moves_as_events_say(gain: float, seed: int) -> None:
    run = run_of(gain, seed)
    rolled = jid.rollout(with_truth(TRUTH, servo_joint()), run)
    wanted = Reference(TRUTH).positions(run)
    assert (np.diff(wanted) == 0.0).any()  # it sticks somewhere
    assert np.degrees(np.abs(rolled.runs[0].position - wanted).max()) < 0.1


def test_the_bits_do_not_depend_on_threads() -> None:
    runs = bench_runs(TRUTH, seed=5, runs=6)
    joint = with_truth(TRUTH, servo_joint())
    one, many = (jid.rollout(joint, runs, threads=threads) for threads in (1, 3))
    for a, b in zip(one.runs, many.runs, strict=True):
        assert a.position.tobytes() == b.position.tobytes()
        assert a.velocity.tobytes() == b.velocity.tobytes()


def test_a_rollout_of_the_truth_follows_the_log_and_a_wrong_one_does_not() -> None:
    runs = bench_runs(TRUTH, seed=6, runs=8)
    joint = with_truth(TRUTH, servo_joint())
    right = jid.rollout(joint, runs)
    wrong = jid.rollout(joint.with_parameters({"load_friction": 0.0}), runs)
    assert np.degrees(right.median) < 0.5
    assert wrong.median > 2.0 * right.median
    assert not right.bistable
    assert "median" in right.report()
    assert right.document()["median"] == right.median


def test_a_load_on_its_peak_is_bistable() -> None:
    """A freely turning motor under a load that stands upright falls to either side."""
    time = np.arange(0.0, 3.0, 0.005)
    extra = {
        "duty": np.full(len(time), 0.001),
        "driven": np.ones(len(time)),
        "supply": np.full(len(time), SUPPLY),
    }
    start = math.asin(0.001 * SUPPLY * 0.09 / WEIGHT)
    run = jid.Recording(time=time, position=np.full(len(time), math.pi - start), extra=extra)
    joint = with_truth(replace(TRUTH, coulomb=0.0, load_friction=0.0), servo_joint())
    assert joint.voltage is not None
    joint = joint.replace(voltage=replace(joint.voltage, position_loop=None))
    rolled = jid.rollout(joint, run)
    assert rolled.bistable == (rolled.runs[0].name,)
    assert "bistable" in rolled.report()
    assert not rolled.runs[0].closed


def test_a_delay_of_the_loop_is_simulated() -> None:
    run = run_of(800.0, 4)
    joint = with_truth(TRUTH, servo_joint())
    assert joint.voltage is not None
    assert joint.voltage.position_loop is not None
    late = replace(joint.voltage.position_loop, delay=0.02)
    other = joint.replace(voltage=replace(joint.voltage, position_loop=late))
    step = changed(run, reference=np.where(run.time >= 0.4, 0.5, 0.0))
    prompt = jid.rollout(joint, step).runs[0].position
    delayed = jid.rollout(other, step).runs[0].position
    moved = [float(run.time[np.flatnonzero(np.abs(p) > 0.02)[0]]) for p in (prompt, delayed)]
    assert moved[1] - moved[0] == pytest.approx(0.02, abs=0.021)
    assert moved[1] > moved[0]


def test_what_a_rollout_needs_is_named() -> None:
    run = run_of(100.0, 1)
    with pytest.raises(jid.InputError, match="torque_constant"):
        jid.rollout(servo_joint(), run)
    with pytest.raises(jid.InputError, match="step"):
        jid.rollout(with_truth(TRUTH, servo_joint()), run, step=0.0)
    loop = _core.ServoLoop(joint=_core.SimulatedJoint(inertia=1e-9), torque_per_voltage=1e9)
    time = np.arange(0.0, 1.0, 0.01)
    log = (time, np.ones(100), np.full(100, 1e6), np.ones(100))
    with pytest.raises(jid.InputError, match="the simulation diverges"):
        _core.roll_out_servos([loop.replace(closed=False)], [log], step=1e-3)


def test_the_picture_shows_both() -> None:
    import matplotlib

    matplotlib.use("Agg")
    rolled = jid.rollout(with_truth(TRUTH, servo_joint()), bench_runs(TRUTH, seed=7, runs=4))
    axes = jid.plot.rolled_out(rolled, run="run 2")
    assert len(axes.lines) == 2
    assert "mean error" in str(axes.lines[1].get_label())
    with pytest.raises(jid.InputError, match="run"):
        jid.plot.rolled_out(rolled, run=4)
