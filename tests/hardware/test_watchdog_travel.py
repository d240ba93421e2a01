"""How far a joint goes when its host dies: judged before it moves, refused with the longest time that passes."""

import math
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from killed_host import travel_after_death, waiting

import jointid as jid
from jointid.base.errors import InputError
from jointid.hardware import Bench, Session, SessionLimits, SessionOptions, Watchdog, open_drive
from jointid.hardware.session.host_failure_travel import DeadHost, Moments
from jointid.hardware.session.watchdog import watchdog_of
from jointid.hardware.session.watchdog_check import (
    WatchdogTravel,
    watchdog_problems,
    watchdog_travel,
)

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "hardware" / "joint.toml"
KILLS = 20
TIMES = (0.05, 0.08, 0.2)  # [s]


@pytest.fixture(scope="module")
def bench() -> Bench:
    return Bench.load(EXAMPLE)


@pytest.fixture(scope="module")
def truthful(bench: Bench) -> Bench:
    """A joint file that states the joint as it is: the way that is foretold has no reserve."""
    return replace(bench, joint=jid.hardware.true_joint(bench))


def judged(bench: Bench, time: float, **more: Any) -> WatchdogTravel:
    """The way in a bench's session, with a watchdog of this time [s]."""
    return watchdog_travel(
        Watchdog(time=time, fed_by="heartbeat", then=more.pop("then", "off"), read_back=True),
        **{
            "joint": bench.joint,
            "controller": bench.controller,
            "trajectory": bench.trajectory,
            "limits": bench.limits,
            "options": bench.options,
            "position": 0.0,
            **more,
        },
    )


def refused(bench: Bench, time: float) -> list[str]:
    """Reasons of the session not to start, with the drive's heartbeat awaited for so long [s]."""
    slow = replace(bench, drive=replace(bench.drive, heartbeat=time))
    with open_drive(slow, emulate=True) as drive:
        session = Session(
            *(drive, slow.controller, slow.trajectory, slow.limits), options=slow.options
        )
        try:
            return session.check()
        finally:
            drive.close()


def test_the_shipped_time_passes_and_ten_seconds_are_refused_with_the_longest(bench: Bench) -> None:
    assert refused(bench, 0.05) == []
    (reason,) = refused(bench, 10.0)
    found = judged(bench, 10.0)
    assert found.longest is not None
    assert found.travel > math.radians(900.0)
    assert f"goes up to {math.degrees(found.travel):.4g}°" in reason
    assert f"the longest acceptable time is {found.longest:g} s" in reason
    assert "watchdog_travel" in reason
    assert refused(bench, found.longest) == []


def test_every_time_above_the_longest_is_refused(bench: Bench) -> None:
    longest = judged(bench, 0.5).longest
    assert longest is not None
    joint = DeadHost(bench.joint, bench.limits.torque)
    worst = joint.worst_moments(joint.moments(bench.trajectory, bench.options.period))
    near = [longest + 1e-3 * k for k in (-2, -1, 0, 1, 2)]
    times = np.unique(np.round([*np.linspace(0.0, 0.5, 26), *near, 1.0, 2.0, 5.0, 10.0], 6))
    ways = np.array([joint.travel(worst, float(time)) for time in times])
    assert (np.diff(ways) > 0.0).all()
    allowed = judged(bench, 0.05).allowed
    assert np.array_equal(ways <= allowed, times <= longest + 1e-9)
    assert not judged(bench, longest + 1e-6).passed


def test_the_worst_moments_are_enough(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    joint = DeadHost(bench.joint, bench.limits.torque)
    worst = joint.worst_moments(joint.moments(bench.trajectory, bench.options.period))
    assert len(worst.position) < 200
    monkeypatch.setattr(DeadHost, "_worst", lambda _self, position, *_: np.arange(len(position)))
    every = joint.moments(bench.trajectory, 0.02)
    for time in (0.0, 0.05, 1.0):
        assert joint.travel(worst, time) == pytest.approx(joint.travel(every, time), rel=5e-3)


def test_the_way_is_that_of_a_joint_computed_by_hand() -> None:
    known = jid.Joint(inertia=2.0, model=jid.Model("coulomb_viscous"))
    known = known.with_parameters({"coulomb": 10.0, "viscous": 0.0})
    joint = DeadHost(known, 1e3)
    # 30 N·m held for 0.2 s from 1 rad/s on, then 10 N·m of friction alone.
    begin = Moments(np.zeros(1), np.ones(1), np.full(1, 30.0))
    faster = 1.0 + 20.0 / 2.0 * 0.2
    way = 0.5 * (1.0 + faster) * 0.2 + 2.0 * faster**2 / (2.0 * 10.0)
    assert joint.travel(begin, 0.2) == pytest.approx(way, rel=2e-3)


def test_the_allowance_is_stated_or_a_share_of_the_window(bench: Bench) -> None:
    found = judged(bench, 0.05)
    assert found.allowed == pytest.approx(found.at_once + 0.28)
    assert found.at_once < found.travel < found.allowed
    narrow = judged(bench, 0.05, limits=replace(bench.limits, watchdog_travel=0.6))
    assert (narrow.allowed, narrow.passed, narrow.stated) == (0.6, False, True)
    assert narrow.longest is not None
    assert "stated as watchdog_travel" in narrow.problem()
    none = judged(bench, 0.05, limits=replace(bench.limits, watchdog_travel=0.1))
    assert none.longest is None
    assert "no watchdog time is short enough" in none.problem()
    assert SessionLimits().watchdog_share == pytest.approx(math.radians(10.0))
    assert SessionLimits(position=(0.0, 0.01)).watchdog_share == pytest.approx(math.radians(2.0))


def test_without_friction_the_way_until_the_time_out_counts(bench: Bench) -> None:
    bare = bench.joint.replace(parameters={}, model="coulomb_viscous")
    found = judged(bench, 0.05, joint=bare)
    _, speed, _ = bench.trajectory.sample(np.arange(0.0, bench.trajectory.duration, 0.01))
    assert found.travel == pytest.approx(0.05 * np.abs(speed).max(), rel=0.05)
    assert "coasts on" in str(found)
    assert not judged(bench, 10.0, joint=bare).passed
    # Nothing is stated at all: the acceleration remains what it is.
    unknown = judged(bench, 0.05, joint=None)
    assert unknown.travel == pytest.approx(found.travel, rel=0.01)


def test_a_motion_by_torques_is_judged_too(bench: Bench) -> None:
    push = {"controller": jid.OpenLoop(), "trajectory": jid.Trajectory.step(60.0, duration=0.5)}
    joint = bench.joint.replace(model="stribeck")
    assert judged(bench, 0.05, joint=joint, **push).passed
    assert not judged(bench, 1.0, joint=joint, **push).passed


@pytest.mark.parametrize(
    ("changes", "options", "says"),
    [
        ({"then": "nothing"}, {}, "does nothing when the host is gone"),
        ({"then": "damped"}, {}, "acknowledge_damped = true"),
        ({"then": "braked"}, {"acknowledge_damped": True}, None),
        ({}, {"period": 0.02}, None),
        ({}, {"period": 0.021}, "too long for a watchdog of 0.05 s: at most 0.02 s"),
    ],
)
def test_what_a_watchdog_must_do_is_asked(
    bench: Bench, changes: dict[str, Any], options: dict[str, Any], says: str | None
) -> None:
    found = [*watchdog_problems(judged(bench, 0.05, **changes), SessionOptions(**options))]
    assert len(found) == (says is not None)
    assert says is None or says in found[0]


@pytest.mark.parametrize(
    "changes",
    [{"time": 0.0}, {"time": "1"}, {"fed_by": "hope"}, {"then": "stop"}, {"read_back": None}],
)
def test_a_watchdog_that_is_none_is_refused(changes: dict[str, Any]) -> None:
    given = {"time": 0.05, "fed_by": "command", "then": "off", "read_back": True}
    with pytest.raises(InputError) as error:
        Watchdog(**given | changes)  # type: ignore[arg-type]
    assert error.value.argument == next(iter(changes))
    with pytest.raises(InputError, match="a Watchdog is expected"):
        watchdog_of(SimpleNamespace(watchdog=0.05))


def test_the_recording_keeps_it(bench: Bench) -> None:
    short = replace(bench, trajectory=jid.Trajectory.thesis(0.1, cycle=0.5, duration=0.5))
    with open_drive(short, emulate=True) as drive:
        recording = Session(
            *(drive, short.controller, short.trajectory, short.limits), options=short.options
        ).run()
    assert recording is not None
    declared = {"time": 0.05, "fed_by": "heartbeat", "then": "off", "read_back": True}
    assert recording.metadata["watchdog"] == declared


def test_a_killed_host_leaves_no_longer_way_than_foretold(truthful: Bench) -> None:
    told = judged(truthful, 0.05).travel
    fastest = travel_after_death(truthful, 1.45)
    assert 0.8 * told < fastest <= 1.1 * told
    assert travel_after_death(truthful, 0.1) < told


@pytest.mark.slow
@pytest.mark.parametrize("time", TIMES)
def test_at_any_moment_and_time_it_is_no_longer(truthful: Bench, time: float) -> None:
    told = judged(truthful, time).travel
    moments = np.random.default_rng(round(1e3 * time)).uniform(0.0, 11.99, KILLS)
    ways = [
        travel_after_death(waiting(truthful, time), float(moment), seed)
        for seed, moment in enumerate(moments)
    ]
    assert max(ways) <= 1.1 * told
