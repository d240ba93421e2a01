"""On-line identification: what it finds, what it forgets, and what it refuses."""

import threading

import numpy as np
import pytest
from example_recordings import WELL_EXCITED
from online_feeding import blocks, fed, shifted
from simulated_joint import TRUTH, simulate

import jointid as jid
from jointid.online.settings import OnlineSettings
from jointid.online.sliding import Sliding
from jointid.problem.settings import USUAL


@pytest.fixture(scope="module")
def excited() -> jid.Recording:
    return jid.load(WELL_EXCITED)


def test_agrees_with_the_whole_recording(excited: jid.Recording) -> None:
    whole = jid.identify(excited, jid.thesis_joint(), search="separable")
    with jid.OnlineIdentifier(
        jid.thesis_joint(), window=12.0, windows=whole.residuals.window_duration
    ) as identifier:
        found = fed(identifier, excited)
    for name in whole.free:
        here, there = found.parameters[name], whole.parameters[name]
        assert there.stderr is not None
        # The last half second waits for what follows it; windows are cut anew in each stretch.
        assert abs(here.value - there.value) < 1.5 * there.stderr, name
        assert here.stderr is not None
        assert here.stderr == pytest.approx(there.stderr, rel=0.8)
    assert found.undetermined == ()
    assert found.at_bound == ()
    assert found.joint.parameters["coulomb"].value == found.parameters["coulomb"].value


def test_the_penalty_is_the_direct_sum_at_its_minimum(excited: jid.Recording) -> None:
    with jid.OnlineIdentifier(jid.thesis_joint(), window=6.0) as identifier:
        found = fed(identifier, excited)
    nearby = jid.identify(
        excited.crop(found.begin, found.end), jid.thesis_joint(), windows=0.01, residual="sensor"
    )
    assert found.penalty == pytest.approx(nearby.penalty, rel=0.1)
    assert found.end - found.begin == pytest.approx(6.0, abs=0.51)


def test_follows_a_joint_that_changes() -> None:
    before, after = simulate(2, duration=7.0, seed=3)
    change = 6.0  # [N·m] of Coulomb friction, as from a joint that has warmed up
    assert after.torque is not None
    later = shifted(after, 7.5, torque=after.torque + change * np.sign(after.velocity))
    with jid.OnlineIdentifier(jid.thesis_joint(), window=6.0) as identifier:
        first = fed(identifier, before)
        last = fed(identifier, later)
    assert first.parameters["coulomb"].value == pytest.approx(TRUTH["coulomb"], rel=0.01)
    assert last.parameters["coulomb"].value == pytest.approx(TRUTH["coulomb"] + change, rel=0.01)
    assert last.begin > 7.5


def test_holds_no_more_than_its_window(excited: jid.Recording) -> None:
    settings = OnlineSettings(
        joint=jid.thesis_joint(),
        window=3.0,
        update=0.5,
        posed=USUAL,
    )
    sliding = Sliding(settings, ("time", "position", "velocity", "torque", "sensor"))
    held = []
    for cycle in range(3):
        for block in blocks(shifted(excited, 12.0 * cycle), 500):
            sliding.append(block)
            sliding.estimate(0)
            assert sliding._plan is None or sliding._plan.penalty.stretches <= 7
            held.append(len(sliding._samples))
    assert max(held) < 1000 * (3.0 + 0.5 + 0.5 + 0.6)
    assert sliding._samples._rows.shape[1] < 4 * max(held)


def test_works_off_the_callers_thread_and_calls_back(excited: jid.Recording) -> None:
    seen: list[tuple[int, jid.OnlineEstimate]] = []
    with jid.OnlineIdentifier(
        jid.thesis_joint(), callback=lambda e: seen.append((threading.get_ident(), e))
    ) as identifier:
        last = fed(identifier, excited)
    assert {thread for thread, _ in seen} != {threading.get_ident()}
    assert len({thread for thread, _ in seen}) == 1
    assert [e.update for _, e in seen] == list(range(1, len(seen) + 1))
    assert seen[-1][1] is last
    assert not any(thread.name == "jointid on-line" for thread in threading.enumerate())


def test_single_samples_without_a_joint(excited: jid.Recording) -> None:
    part = excited.crop(0.0, 4.0)
    with jid.OnlineIdentifier(window=4.0, model="stribeck") as identifier:
        for block in blocks(part, 1):
            identifier.feed(**{name: float(values[0]) for name, values in block.items()})
        found = identifier.wait(30.0)
    assert found is not None
    assert found.parameters["inertia"].vary
    assert found.parameters["coulomb"].value == pytest.approx(TRUTH["coulomb"], rel=0.05)


def test_a_faster_joint_is_digested_anew(excited: jid.Recording) -> None:
    slow = excited.crop(0.0, 4.0)
    scale = 0.3
    assert slow.torque is not None
    crawling = jid.Recording(
        time=slow.time,
        position=slow.position * scale,
        velocity=slow.velocity * scale,
        torque=slow.torque,
        sensor=slow.sensor,
    )
    with jid.OnlineIdentifier(jid.thesis_joint(), window=8.0) as identifier:
        fed(identifier, crawling)
        found = fed(identifier, shifted(excited, 4.001))
    assert found.parameters["coulomb"].value == pytest.approx(TRUTH["coulomb"], rel=0.01)


def test_standing_still_gives_no_estimate_and_no_error() -> None:
    time = np.arange(0.0, 3.0, 0.001)
    rest = np.zeros(time.size)
    with jid.OnlineIdentifier(jid.thesis_joint(), window=6.0) as identifier:
        identifier.feed(time=time, position=rest, velocity=rest, torque=rest, sensor=rest)
        assert identifier.wait(30.0) is None


@pytest.mark.parametrize(
    ("changes", "wording"),
    [
        ({"window": 0.0}, "window is 0.0: a finite duration above 0"),
        ({"update": float("nan")}, "update is nan: a finite duration above 0"),
        ({"window": 1.0}, "window is 1.0: at least four times `update` \\("),
        ({"model": "stribeck_general"}, "two shape parameters"),
        ({"joint": "joint.toml"}, "a Joint is expected"),
        ({"callback": 3}, "callback is 3: a function"),
    ],
)
def test_refuses_settings(changes: dict[str, object], wording: str) -> None:
    with pytest.raises(jid.InputError, match=wording):
        jid.OnlineIdentifier(**changes)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("sample", "wording"),
    [
        (
            {"time": 0.0, "position": 0.0, "torque": 1.0},
            "samples: velocity: this signal is missing",
        ),
        (
            {"time": 0.0, "position": 0.0, "velocity": 0.0, "torque": 1.0, "sensor": 2.0},
            "time is 0.0: .* the previous time is 1.0 s",
        ),
        (
            {"time": 9.0, "position": np.nan, "velocity": 0.0, "torque": 1.0, "sensor": 2.0},
            "samples, number 0: position is nan",
        ),
        (
            {"time": [9.0, 9.1], "position": 0.0, "velocity": 0.0, "torque": 1.0, "sensor": 2.0},
            "position: its shape is .* time has 2 samples",
        ),
        (
            {"time": 9.0, "position": "x", "velocity": 0.0, "torque": 1.0, "sensor": 2.0},
            "position is 'x': a number",
        ),
        (
            {
                name: [2.0, 3.0, 3.0]
                for name in ("time", "position", "velocity", "torque", "sensor")
            },
            "time is 3.0: .* the previous time is 3.0 s",
        ),
        ({"time": 9.0, "speed": 1.0}, "samples: speed: there is no such signal"),
    ],
)
def test_refuses_samples(sample: dict[str, object], wording: str) -> None:
    with jid.OnlineIdentifier(jid.thesis_joint()) as identifier:
        identifier.feed(time=1.0, position=0.0, velocity=0.0, torque=0.0, sensor=0.0)
        with pytest.raises(jid.InputError, match=wording):
            identifier.feed(**sample)  # type: ignore[arg-type]
        identifier.feed(time=1.1, position=0.0, velocity=0.0, torque=0.0, sensor=0.0)


def test_an_error_in_the_thread_is_reported_by_the_next_call(excited: jid.Recording) -> None:
    def broken(_: jid.OnlineEstimate) -> None:
        raise RuntimeError("the user's own")

    with jid.OnlineIdentifier(jid.thesis_joint(), callback=broken) as identifier:
        identifier.feed(**next(blocks(excited, 3000)))
        with pytest.raises(RuntimeError, match="the user's own"):
            identifier.wait(30.0)


def test_goes_on_after_an_error_in_the_callback(excited: jid.Recording) -> None:
    calls: list[int] = []

    def broken_once(estimate: jid.OnlineEstimate) -> None:
        calls.append(estimate.update)
        if len(calls) == 1:
            raise RuntimeError("the user's own")

    with jid.OnlineIdentifier(jid.thesis_joint(), callback=broken_once) as identifier:
        for block in blocks(excited.crop(0.0, 4.0), 500):
            try:
                identifier.feed(**block)
                identifier.wait(30.0)
            except RuntimeError:
                continue
    assert calls == list(range(1, len(calls) + 1))
    assert len(calls) > 2


def test_closes_from_its_own_callback(excited: jid.Recording) -> None:
    identifier = jid.OnlineIdentifier(jid.thesis_joint(), callback=lambda _: identifier.close())
    identifier.feed(**next(blocks(excited.crop(0.0, 3.0), 3000)))
    thread = identifier._worker.thread
    assert thread is not None
    thread.join(30.0)
    assert not thread.is_alive()
    assert identifier.estimate is not None


def test_a_refused_first_sample_decides_nothing(excited: jid.Recording) -> None:
    with jid.OnlineIdentifier(jid.thesis_joint()) as identifier:
        with pytest.raises(jid.InputError, match="position: this signal is missing"):
            identifier.feed(time=0.0, torque=1.0)
        with pytest.raises(jid.InputError, match="torque is nan: a finite number"):
            identifier.feed(time=0.0, position=0.0, torque=np.nan)
        for block in blocks(excited.crop(0.0, 3.0), 3000):
            identifier.feed(**block)
        assert identifier.wait(30.0) is not None


def test_closed_is_closed() -> None:
    identifier = jid.OnlineIdentifier(jid.thesis_joint())
    identifier.close()
    with pytest.raises(jid.InputError, match="closed"):
        identifier.feed(time=0.0, position=0.0, velocity=0.0, torque=0.0, sensor=0.0)
