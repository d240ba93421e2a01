"""When a coarsely sampled torque sensor is read, against the steps of a held torque."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from plants import Bench, Law, Log, Plant, simulate, thesis

import jointid as jid
from jointid.identification.prepared import prepare
from jointid.identification.refinements.instant_by_samples import by_samples
from jointid.identification.refinements.sensor_instant import SensorInstant

JOINT = jid.Joint(inertia=1.8, sensor=True, model=jid.Model("stribeck"))
JOINTS = 8
HALF = 0.5 * 0.31 / 2.11 / 3.0  # of a step of 1 N·m, in the reading


@pytest.fixture(scope="module")
def runs() -> list[jid.Recording]:
    """Joints at 4 ms whose controller feeds the reading and its noise back, in front of light links."""
    rng = np.random.default_rng(4)
    bench = Bench(
        motion=thesis(np.radians(rng.uniform(50.0, 70.0, JOINTS)), rng.uniform(2.5, 4.0, JOINTS)),
        plant=Plant(inertia=1.8, link_inertia=0.31, gravity=2.5, coulomb=12.0, static=9.0),
        law=Law(
            every=4.0, inertia=1.8, stiffness=60.0, on_reference=1.0, coulomb=9.0, feedback=2.0
        ),
        log=Log(every=4.0, gain=3.0, offset=10.0, sensor_noise=0.2),
    )
    return simulate(bench, duration=12.0, seed=11, finer=3)


def instants(recordings: Sequence[jid.Recording]) -> list[SensorInstant]:
    """What is found out about the instant of each reading."""
    found = [prepare((run,), JOINT).refinements.sensor_instant for run in recordings]
    return [each for each in found if each is not None]


def moved(run: jid.Recording, share: float) -> jid.Recording:
    """The recording as if its reading had so much of the step that its sample ends with."""
    assert run.torque is not None
    assert run.sensor is not None
    step = share * 0.31 / 2.11 / 3.0 * np.diff(run.torque, prepend=run.torque[0])
    signals = {name: getattr(run, name) for name in run.signals}
    return jid.Recording(**signals | {"sensor": run.sensor + step}, torque_hold="zoh")


def test_a_coarse_reading_before_the_command_is_known_as_such(runs: list[jid.Recording]) -> None:
    found = instants(runs)
    assert len(found) == JOINTS
    assert sum(each.applied == 1.0 for each in found) >= JOINTS - 1
    errors = np.array([(each.share - 1.0) / each.stderr for each in found])
    assert np.sqrt(np.mean(errors**2)) < 1.6  # its standard errors say how far off it is


def test_the_gain_of_a_coarse_reading_is_not_biased(runs: list[jid.Recording]) -> None:
    gains = [jid.identify(run, JOINT, search="separable").parameters["sensor_gain"] for run in runs]
    assert np.mean([each.value for each in gains]) == pytest.approx(3.0, rel=0.004)
    intervals = [each.interval for each in gains if each.interval is not None]
    assert len(intervals) == JOINTS
    assert sum(low < 3.0 < high for low, high in intervals) >= JOINTS - 1


def test_a_coarse_reading_in_the_middle_of_the_step_is_left_there(
    runs: list[jid.Recording],
) -> None:
    found = instants([moved(run, 0.5) for run in runs])
    assert not any(each.applied for each in found)


def test_a_reading_that_remembers_is_not_taken_for_an_early_one(runs: list[jid.Recording]) -> None:
    """Behind a filter the samples before tell more of the reading than the equation allows."""
    for run in runs[:3]:
        problem = prepare((run,), JOINT).problem
        assert by_samples(problem, HALF) is not None
        slow = np.array(run.sensor)
        for k in range(1, len(slow)):
            slow[k] = 0.9 * slow[k - 1] + 0.1 * slow[k]
        filtered = replace(problem, recordings=(run.with_signals(sensor=slow),))
        assert by_samples(filtered, HALF) is None


def test_finer_samples_are_left_to_the_windows(runs: list[jid.Recording]) -> None:
    problem = prepare((runs[0],), JOINT).problem
    assert by_samples(problem, HALF) is not None
    time = problem.recordings[0].time
    run = problem.recordings[0].with_signals(time=0.25 * time)
    assert by_samples(replace(problem, recordings=(run,)), HALF) is None
