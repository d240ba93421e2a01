"""Desired motions: their formulas, their derivatives, their limits."""

import math
import pickle
import tracemalloc
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

import jointid as jid
from jointid.base.errors import InputError
from jointid.simulation import sums_of_sines

Trajectory = jid.Trajectory
TIMES = np.arange(0.0, 4.0, 1e-4)
ALL = {
    "thesis": Trajectory.thesis(0.7, cycle=2.0, duration=4.0),
    "sine": Trajectory.sine(0.5, 1.3, offset=0.2, duration=4.0),
    "multisine": Trajectory.multisine(0.4, lowest=0.5, highest=1.5, count=9, duration=4.0),
    "sigmoid": Trajectory.sigmoid(-0.8, rise=2.0, duration=4.0),
    "trapezoid": Trajectory.trapezoid(-1.2, velocity=0.6, acceleration=2.0, duration=4.0),
    "samples": Trajectory.from_samples(np.linspace(3.0, 8.0, 30), np.sin(np.linspace(0, 5, 30))),
}


@pytest.mark.parametrize("name", ALL)
def test_velocity_and_acceleration_are_the_derivatives(name: str) -> None:
    position, velocity, acceleration = ALL[name].sample(TIMES)
    step = TIMES[1]
    middle = (velocity[1:] + velocity[:-1]) / 2.0
    np.testing.assert_allclose(np.diff(position) / step, middle, atol=2e-4)
    # A jump of the acceleration lies inside one step at most.
    smooth = np.abs(np.diff(acceleration)) < 0.1
    assert smooth.mean() > 0.999
    slope = np.diff(velocity) / step
    mean = (acceleration[1:] + acceleration[:-1]) / 2.0
    np.testing.assert_allclose(slope[smooth], mean[smooth], atol=2e-3)


@pytest.mark.parametrize("name", ALL)
def test_a_trajectory_is_a_value(name: str) -> None:
    again = pickle.loads(pickle.dumps(ALL[name]))
    assert again == ALL[name]
    assert hash(again) == hash(ALL[name])
    assert again.sample(TIMES)[0].tobytes() == ALL[name].sample(TIMES)[0].tobytes()


def test_the_thesis_trajectory_is_6_1() -> None:
    w = 2.0 * math.pi / 6.0
    wanted = Trajectory.thesis(math.radians(20.0)).sample(TIMES)[0]
    formula = math.radians(20.0) / 1.3 * (np.sin(w * TIMES) - 0.5 * np.sin(2 * w * TIMES))
    np.testing.assert_allclose(wanted, formula, atol=1e-14)
    assert Trajectory.thesis().duration == 12.0


def test_a_multisine_keeps_to_its_size_and_band() -> None:
    duration = 20.0
    time = np.arange(0.0, duration, 1e-3)
    motion = Trajectory.multisine(
        0.4, lowest=0.5, highest=4.0, count=8, offset=0.1, duration=duration
    )
    position = motion.sample(time)[0]
    assert position[0] == pytest.approx(0.1)
    assert np.abs(position - 0.1).max() == pytest.approx(0.4, rel=0.01)
    power = np.abs(np.fft.rfft(position - position.mean())) ** 2
    frequency = np.fft.rfftfreq(len(time), 1e-3)
    assert power[(frequency > 0.45) & (frequency < 4.05)].sum() > 0.999 * power.sum()
    # Schroeder's phases: far below the eight-fold peak of sines in step.
    assert np.abs(position - position.mean()).max() < 2.1 * math.sqrt(2.0) * position.std()


def test_the_peak_is_found_in_parts(monkeypatch: pytest.MonkeyPatch) -> None:
    """A motion file of 100 bytes may ask for 50 million sines."""
    options: dict[str, Any] = {"lowest": 0.3, "highest": 4.0, "count": 3, "duration": 37.0}
    whole = Trajectory.multisine(0.4, **options)
    monkeypatch.setattr(sums_of_sines, "_AT_ONCE", 100)
    assert Trajectory.multisine(0.4, **options) == whole
    monkeypatch.undo()
    tracemalloc.start()
    Trajectory.multisine(0.4, lowest=1.0, highest=2.0, count=1, duration=1e5)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 50_000_000  # at once, they are 130 MB


@pytest.mark.parametrize(("distance", "peak"), [(1.2, 0.6), (-1.2, 0.6), (0.1, math.sqrt(0.2))])
def test_a_trapezoid_keeps_its_limits_and_arrives(distance: float, peak: float) -> None:
    motion = Trajectory.trapezoid(distance, velocity=0.6, acceleration=2.0, duration=4.0)
    position, velocity, acceleration = motion.sample(TIMES)
    assert position[0] == 0.0
    assert position[-1] == pytest.approx(distance)
    assert np.abs(velocity).max() == pytest.approx(peak, rel=1e-3)
    assert np.abs(acceleration).max() == 2.0
    assert velocity[-1] == 0.0


def test_samples_are_a_natural_spline_from_their_first_time() -> None:
    time = np.sort(np.random.default_rng(0).uniform(2.0, 6.0, 40))
    position = np.cos(3.0 * time)
    ours = Trajectory.from_samples(time, position)
    assert ours.duration == pytest.approx(time[-1] - time[0])
    spline = CubicSpline(time - time[0], position, bc_type="natural")
    inside = np.linspace(0.0, ours.duration * 0.999, 500)
    for order, values in enumerate(ours.sample(inside)):
        np.testing.assert_allclose(values, spline(inside, order), atol=1e-8)
    after = ours.sample([ours.duration + 1.0])
    assert [float(each[0]) for each in after] == [position[-1], 0.0, 0.0]


def test_a_recording_gives_its_reference_else_its_position() -> None:
    time = np.linspace(0.0, 1.0, 50)
    run = jid.Recording(time=time, position=np.sin(time), reference=np.cos(time))
    assert Trajectory.from_recording(run) == Trajectory.from_samples(time, np.cos(time))
    bare = jid.Recording(time=time, position=np.sin(time))
    assert Trajectory.from_recording(bare) == Trajectory.from_samples(time, np.sin(time))


@pytest.mark.parametrize(
    ("make", "complaint"),
    [
        (
            lambda: Trajectory.sine(1.0, 0.0, duration=1.0),
            "frequency is 0.0: a finite number above 0",
        ),
        (lambda: Trajectory.sine("big", 1.0, duration=1.0), "amplitude is 'big': a number"),  # type: ignore[arg-type]
        (lambda: Trajectory.sine(1.0, 1.0, duration=math.inf), "duration is inf: must be finite"),
        (
            lambda: Trajectory.sigmoid(1.0, rise=-1.0, duration=1.0),
            "rise is -1.0: must be finite and above 0",
        ),
        (
            lambda: Trajectory.multisine(1.0, lowest=2.0, highest=1.0, duration=1.0),
            "lowest is 2.0: above highest, 1.0",
        ),
        (
            lambda: Trajectory.multisine(1.0, lowest=1.0, highest=2.0, count=0, duration=1.0),
            "count is 0: a whole number",
        ),
        (
            lambda: Trajectory.from_samples([0.0, 0.0], [1.0, 2.0]),
            "time is 0.0: must be strictly increasing",
        ),
        (lambda: Trajectory.from_samples([0.0, 1.0], [1.0]), "the same number of samples"),
        (
            lambda: Trajectory.from_samples([0.0, 1.0], [1.0, math.nan]),
            "position is nan: must be finite",
        ),
        (
            lambda: Trajectory.sine(1e300, 1.0, duration=1.0),
            "amplitude is 1e+300: at most 1e+06 rad or m in magnitude",
        ),
        (
            lambda: Trajectory.multisine(-2e6, lowest=1.0, highest=2.0, duration=1.0),
            "amplitude is -2000000.0: at most 1e+06",
        ),
        (lambda: Trajectory.thesis(2e6), "amplitude is 2000000.0: at most 1e+06"),
        (
            lambda: Trajectory.sine(1.0, 1.0, offset=2e6, duration=1.0),
            "offset is 2000000.0: at most 1e+06",
        ),
        (lambda: Trajectory.step(2e6, duration=1.0), "distance is 2000000.0: at most 1e+06"),
        (
            lambda: Trajectory.from_samples([0.0, 1.0], [1.0, -2e6]),
            "position is -2000000.0: at most 1e+06",
        ),
        (
            lambda: Trajectory.multisine(1.0, lowest=1.0, highest=2.0, duration=1e12),
            "duration is 1000000000000.0: at most 1.56e+05 s is expected with 8 sines up to 2 Hz",
        ),
        (lambda: Trajectory.from_samples([[0.0]], [1.0]), "one dimension"),
    ],
)
def test_what_is_no_motion_is_refused(make: Callable[[], object], complaint: str) -> None:
    with pytest.raises(jid.InputError, match=r"^Trajectory[^\n]*$") as refusal:
        make()
    assert complaint in str(refusal.value)


def test_one_time_gives_numbers_and_several_give_arrays() -> None:
    motion = Trajectory.sine(0.5, 0.25, duration=8.0)
    one = motion.sample(1.0)
    many = motion.sample([1.0, 2.0])
    assert all(isinstance(value, float) for value in one)
    assert one == tuple(values[0] for values in many)


@pytest.mark.parametrize("time", ["a", [[1.0]], math.nan, None, [1.0, math.inf]])
def test_times_that_are_none_are_refused(time: Any) -> None:
    with pytest.raises(InputError, match=r"one time or an array of times \[s\] is expected"):
        Trajectory.sine(0.5, 0.25, duration=8.0).sample(time)


def test_a_trajectory_of_many_samples_shows_one_short_line() -> None:
    time = np.linspace(0.0, 2.0, 500)
    motion = Trajectory.from_samples(time, np.sin(time))
    assert len(repr(motion)) < 120
    assert "2 s" in repr(motion)
    assert "rad/s" in motion._repr_html_()


def test_sines_take_a_number_for_all() -> None:
    single = Trajectory.sines(amplitude=0.3, frequency=2.0, phase=0.0, duration=4.0)
    assert single == Trajectory.sines(amplitude=[0.3], frequency=[2.0], phase=[0.0], duration=4.0)
    two = Trajectory.sines(amplitude=0.3, frequency=[2.0, 5.0], phase=0.0, duration=4.0)
    assert two == Trajectory.sines(
        amplitude=[0.3, 0.3], frequency=[2.0, 5.0], phase=[0.0, 0.0], duration=4.0
    )
    with pytest.raises(InputError):
        Trajectory.sines(amplitude=[0.3, 0.1], frequency=[2.0] * 3, phase=0.0, duration=4.0)
