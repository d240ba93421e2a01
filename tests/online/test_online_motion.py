"""On-line identification of motions as they come: pauses, noise, gaps, encoders, a joint that changes."""

from typing import Any

import numpy as np
import pytest
from example_recordings import WELL_EXCITED
from numpy.typing import NDArray
from online_feeding import fed

import jointid as jid
from jointid.online import sliding
from jointid.online.plan import Plan, make_plan
from jointid.online.settings import OnlineSettings

Array = NDArray[np.float64]
COUNTS = 808_000  # of the encoder, a turn of the output


@pytest.fixture(scope="module")
def excited() -> jid.Recording:
    return jid.load(WELL_EXCITED)


def arrays(recording: jid.Recording) -> dict[str, Any]:
    names = ("time", "position", "velocity", "torque", "sensor")
    return {name: np.array(getattr(recording, name)) for name in names}


def agree(found: jid.OnlineEstimate, recording: jid.Recording) -> None:
    """With `identify` on the same samples, within the combined standard errors."""
    joint = jid.thesis_joint()
    whole = jid.identify(
        recording.crop(found.begin, found.end), joint, search="separable", residual="sensor"
    )
    assert found.at_bound == ()
    for name in whole.free:
        here, there = found.parameters[name], whole.parameters[name]
        assert here.stderr is not None, name
        assert there.stderr is not None, name
        assert abs(here.value - there.value) <= np.hypot(here.stderr, there.stderr), name


def with_pauses(recording: jid.Recording, kind: str) -> jid.Recording:
    """A pause of two seconds after every four of motion."""
    rng = np.random.default_rng(0)
    parts: dict[str, list[Array]] = {}
    for begin in (0, 4000, 8000):
        part = {name: values[begin : begin + 4000] for name, values in arrays(recording).items()}
        position: Any = np.zeros(2000)
        velocity: Any = np.zeros(2000)
        last = part["position"][-1]
        if kind == "noisy":
            position, velocity = 1e-6 * rng.normal(size=2000), 1e-3 * rng.normal(size=2000)
        if kind == "encoder":
            position = 2.0 * np.pi / COUNTS * rng.integers(0, 2, 2000)
            velocity = np.gradient(position, 1e-3)
        rest = {
            "position": last + position,
            "velocity": velocity,
            "torque": np.full(2000, 8.0),
            "sensor": part["sensor"][-1] + 0.02 * rng.normal(size=2000),
        }
        for name, values in rest.items():
            parts.setdefault(name, []).extend((part[name], values))
    signals: dict[str, Any] = {name: np.concatenate(values) for name, values in parts.items()}
    return jid.Recording(time=np.arange(18000) * 1e-3, **signals)


@pytest.mark.parametrize("kind", ["exact", "noisy", "encoder"])
def test_a_pause_does_not_count_as_motion(excited: jid.Recording, kind: str) -> None:
    recording = with_pauses(excited, kind)
    with jid.OnlineIdentifier(jid.thesis_joint(), window=15.0) as identifier:
        agree(fed(identifier, recording, 50), recording)


@pytest.mark.parametrize("noise", [0.001, 0.003, 0.005])
def test_windows_suit_the_noise_of_the_velocity(excited: jid.Recording, noise: float) -> None:
    signals = arrays(excited)
    signals["velocity"] += noise * np.random.default_rng(7).normal(size=len(excited))
    recording = jid.Recording(**signals)
    with jid.OnlineIdentifier(jid.thesis_joint(), window=10.0) as identifier:
        agree(fed(identifier, recording, 50), recording)


def test_a_velocity_derived_from_an_encoder(excited: jid.Recording) -> None:
    signals = arrays(excited)
    del signals["velocity"]
    quantum = 2.0 * np.pi / COUNTS
    signals["position"] = np.round(signals["position"] / quantum) * quantum
    recording = jid.Recording(**signals)
    with jid.OnlineIdentifier(jid.thesis_joint(), window=10.0) as identifier:
        agree(fed(identifier, recording, 50), recording)


def test_gaps(excited: jid.Recording) -> None:
    lost = np.ones(len(excited), dtype=bool)
    for begin, end in ((2500, 2505), (4000, 4900), (4903, 5500), (8000, 8004)):
        lost[begin:end] = False
    recording = jid.Recording(**{name: values[lost] for name, values in arrays(excited).items()})
    with jid.OnlineIdentifier(jid.thesis_joint(), window=10.0) as identifier:
        agree(fed(identifier, recording, 50), recording)


def test_what_is_older_than_the_window_does_not_hide_behind_a_gap(
    excited: jid.Recording,
) -> None:
    signals = {name: values[:4800] for name, values in arrays(excited).items()}
    signals["time"][2400:] += 3.0
    spans: list[float] = []
    with jid.OnlineIdentifier(
        jid.thesis_joint(), window=4.0, callback=lambda e: spans.append(e.end - e.begin)
    ) as identifier:
        found = fed(identifier, jid.Recording(**signals), 100)
    assert max(spans) < 4.51
    assert found.begin == pytest.approx(signals["time"][2400])


def test_few_samples_a_second_are_no_error(excited: jid.Recording) -> None:
    signals = {name: values[::125] for name, values in arrays(excited).items()}
    with jid.OnlineIdentifier(jid.thesis_joint(), window=12.0) as identifier:
        found = fed(identifier, jid.Recording(**signals), 1)
    assert found.windows > 14


def test_an_update_shorter_than_a_sample_is_one_sample(excited: jid.Recording) -> None:
    signals = {name: values[:2000:20] for name, values in arrays(excited).items()}
    with jid.OnlineIdentifier(
        jid.thesis_joint(), window=2.0, update=1e-3, windows=1e-3
    ) as identifier:
        found = fed(identifier, jid.Recording(**signals), 10)
    assert found.windows > 50


def test_noise_of_a_derived_velocity_ends_the_search_for_a_plan() -> None:
    rng = np.random.default_rng(1)
    time = np.arange(0.0, 8.0, 1e-3)
    position = 0.05 * np.sin(np.pi * time) + 2e-4 * rng.normal(size=time.size)
    speed = np.gradient(0.05 * np.sin(np.pi * time), time)
    torque = 5.0 * np.sign(speed) + 20.0 * speed + 0.1 * rng.normal(size=time.size)
    with jid.OnlineIdentifier(window=6.0) as identifier:
        found = fed(identifier, jid.Recording(time=time, position=position, torque=torque))
    assert found.end > 7.0


@pytest.mark.parametrize("duration", [0.1, 0.3])
def test_windows_are_as_long_as_asked(excited: jid.Recording, duration: float) -> None:
    with jid.OnlineIdentifier(jid.thesis_joint(), window=11.0, windows=duration) as identifier:
        found = fed(identifier, excited)
    assert (found.end - found.begin) / found.windows == pytest.approx(duration, rel=0.02)


def test_rest_is_looked_at_once_an_update(monkeypatch: pytest.MonkeyPatch) -> None:
    planned: list[float] = []

    def counted(settings: OnlineSettings, recording: jid.Recording, fastest: float) -> Plan | None:
        planned.append(recording.time[-1])
        return make_plan(settings, recording, fastest)

    monkeypatch.setattr(sliding, "make_plan", counted)
    with jid.OnlineIdentifier(jid.thesis_joint(), window=6.0) as identifier:
        for time in np.arange(0.0, 3.0, 0.005):
            identifier.feed(time=time, position=0.0, velocity=0.0, torque=0.0, sensor=0.0)
            identifier.wait(30.0)
    assert 0 < len(planned) <= 5  # from the second second on, twice a second


def test_a_rest_longer_than_the_window_keeps_what_was_planned(excited: jid.Recording) -> None:
    rng = np.random.default_rng(2)
    signals = arrays(excited.crop(0.0, 6.0))
    rest = 14000
    moving: dict[str, Any] = {name: values.copy() for name, values in signals.items()}
    for name, noise in (("position", 1e-5), ("velocity", 1e-3), ("torque", 0.5), ("sensor", 0.1)):
        still = (0.0 if name == "velocity" else moving[name][-1]) + noise * rng.normal(size=rest)
        signals[name] = np.concatenate([moving[name], still, moving[name]])
    signals["time"] = np.arange(len(signals["position"])) * 1e-3
    recording = jid.Recording(**signals)
    counts = []
    with jid.OnlineIdentifier(
        jid.thesis_joint(), window=5.0, callback=lambda e: counts.append((e.end, e.windows))
    ) as identifier:
        found = fed(identifier, recording, 100)
    assert not [windows for end, windows in counts if 11.5 < end < 20.0]
    agree(found, recording)


def driven(coulomb: float, offset: float, begin: float, duration: float) -> jid.Recording:
    """The thesis's joint in closed loop, with these values."""
    joint = jid.thesis_joint().with_parameters(
        {
            "coulomb": coulomb,
            "static": 20.0,
            "stribeck": 100.0,
            "viscous": 20.0,
            "sensor_gain": 2.4,
            "sensor_offset": offset,
        }
    )
    trajectory = jid.Trajectory.thesis(1.0, cycle=3.0, duration=duration)
    controller = jid.AdaptiveRobust(**jid.control_estimates(joint))
    sensors = jid.Sensors(torque_noise=0.2, encoder_counts=COUNTS)
    run = jid.simulate(joint, controller, trajectory, sensors=sensors, seed=5)
    signals = {name: getattr(run, name) for name in run.signals if name != "reference"}
    return jid.Recording(**{**signals, "time": run.time + begin}, torque_hold=run.torque_hold)


def holds(found: jid.OnlineEstimate, coulomb: float, offset: float) -> None:
    for name, truth in (("coulomb", coulomb), ("sensor_offset", offset)):
        parameter = found.parameters[name]
        assert parameter.stderr is not None, name
        assert abs(parameter.value - truth) <= max(4.0 * parameter.stderr, 0.03 * truth), name


def test_follows_a_simulated_joint_that_changes_half_way() -> None:
    with jid.OnlineIdentifier(jid.thesis_joint(), window=6.0) as identifier:
        holds(fed(identifier, driven(25.0, 15.0, 0.0, 9.0), 50), 25.0, 15.0)
        last = fed(identifier, driven(32.0, 11.0, 9.1, 9.0), 50)
    assert last.begin > 9.1
    holds(last, 32.0, 11.0)


def test_follows_a_simulated_joint_that_drifts() -> None:
    with jid.OnlineIdentifier(jid.thesis_joint(), window=6.0) as identifier:
        for number in range(4):
            coulomb, offset = 25.0 + 0.5 * number, 15.0 - 0.2 * number
            found = fed(identifier, driven(coulomb, offset, 6.1 * number, 6.0), 50)
            holds(found, coulomb, offset)
