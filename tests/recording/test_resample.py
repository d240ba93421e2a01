"""Resampling and splitting: what a recording's parts and its uniform copy keep."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from jointid.base.errors import InputError
from jointid.recording.recording import Recording

N = 40
TIME = np.arange(N) * 0.01


def recording(time: Any = TIME, **changes: Any) -> Recording:
    time = np.asarray(time)
    fields: dict[str, Any] = {"time": time, "position": 3 * time + 1, "torque": 2 * time}
    return Recording(**(fields | changes))


def gapped() -> Recording:
    return recording(np.concatenate([TIME[:20], TIME[20:] + 0.5]), metadata={"a": 1})


def test_straight_lines_stay_straight() -> None:
    jittered = TIME + 0.002 * np.sin(np.arange(N) * 7.0)
    made = recording(jittered, sensor=-jittered, name="x", kind="prismatic")
    for uniform in (made.resample(period=0.004), made.resample(rate=250)):
        np.testing.assert_allclose(np.diff(uniform.time), 0.004, rtol=1e-9)
        assert uniform.time[0] == made.time[0]
        assert 0 <= made.time[-1] - uniform.time[-1] < 0.004
        np.testing.assert_allclose(uniform.position, 3 * uniform.time + 1, rtol=1e-12)
        np.testing.assert_allclose(uniform.velocity, 3.0, rtol=1e-9)
        assert uniform.velocity_derived
        assert (uniform.signals, uniform.name, uniform.kind) == (made.signals, "x", "prismatic")
        assert uniform.metadata == {"resampled_from": made.sample_period}


def test_the_same_period_changes_nothing_but_rounding() -> None:
    made = recording(torque_hold="zoh", velocity=np.sin(TIME))
    same = made.resample(period=0.01)
    assert len(same) == len(made)
    assert not same.velocity_derived
    for name in made.signals:
        np.testing.assert_allclose(getattr(same, name), getattr(made, name), atol=1e-12)


def test_a_held_torque_is_held() -> None:
    steps = np.floor(np.arange(N) / 4)
    made = recording(torque=steps, current=steps, sensor=steps, torque_hold="zoh")
    fine = made.resample(period=0.0025)
    assert fine.torque is not None
    assert fine.current is not None
    assert fine.sensor is not None
    expected = steps[np.floor((fine.time + 1e-9) / 0.01).astype(int)]
    assert fine.torque.tolist() == expected.tolist()
    assert fine.current.tolist() == expected.tolist()
    assert set(fine.sensor.tolist()) > set(steps.tolist())  # a reading is not held
    linear = recording(torque=steps, torque_hold="linear").resample(period=0.0025)
    assert linear.torque is not None
    assert set(linear.torque.tolist()) > set(steps.tolist())


@pytest.mark.parametrize("period", [0.003, 0.01, 0.025])
def test_gaps_are_kept_and_nothing_is_made_up_inside(period: float) -> None:
    made = gapped()
    uniform = made.resample(period=period)
    (gap,) = uniform.gaps
    assert uniform.time[gap.index + 1] == made.time[20]
    assert uniform.time[gap.index] <= made.time[19]
    assert uniform.metadata == {"a": 1, "resampled_from": made.sample_period}


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({}, r"period is None: either a period \[s\] or a rate \[Hz\] is"),
        ({"period": 0.1, "rate": 10}, "either a period"),
        ({"period": 0.0}, r"period is 0\.0: a positive number \[s\]"),
        ({"period": -0.1}, r"period is -0\.1: a positive number"),
        ({"period": np.nan}, "period is nan: a positive number"),
        ({"period": "fast"}, "period is 'fast': a positive number"),
        ({"rate": 0}, r"rate is 0: a positive number \[Hz\]"),
        ({"rate": np.inf}, r"rate is inf: a positive number \[Hz\]"),
        ({"rate": True}, "rate is True: a positive number"),
        ({"period": 1e-9}, "gives more than 50000000 samples; state the period in seconds"),
        ({"period": 0.5}, "a period of 0.5 s over 0.89 s gives only 2 samples; at least 8"),
    ],
)
def test_what_cannot_be_resampled(arguments: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        gapped().resample(**arguments)


def test_a_gap_must_not_vanish() -> None:
    time = np.concatenate([TIME, TIME + 0.5])
    with pytest.raises(
        InputError, match=r"the gap of 0\.11 s at 0\.39 s is no longer recognised as a gap"
    ):
        recording(time).resample(period=0.04)


def test_time_stamps_too_coarse_for_the_period() -> None:
    late = recording(1e9 + np.arange(N) * 1e-6)
    with pytest.raises(InputError, match="below the resolution of time stamps near 1e"):
        late.resample(period=3e-8)


@pytest.mark.parametrize("parts", [1, 2, 3, 5])
def test_equal_parts(parts: int) -> None:
    made = recording(name="run", torque_hold="zoh", metadata={"a": 1}, truth={"b": 2})
    split = made.split(parts)
    assert [part.name for part in split] == [f"run {k}/{parts}" for k in range(1, parts + 1)]
    lengths = [len(part) for part in split]
    assert sum(lengths) == N
    assert max(lengths) - min(lengths) <= 1
    for name in made.signals:
        together = np.concatenate([getattr(part, name) for part in split])
        assert together.tobytes() == getattr(made, name).tobytes()  # derived velocities, too
    for part in split:
        assert part.velocity_derived
        assert (part.torque_hold, part.metadata, part.truth) == ("zoh", {"a": 1}, {"b": 2})


def test_parts_at_times() -> None:
    made = recording()
    first, second, third = made.split(at=[TIME[10], 0.255])
    assert (len(first), second.time[0], third.time[0]) == (10, TIME[10], TIME[26])
    assert first.name == "1/3"
    assert made.split(at=[])[0] == recording(name="1/1")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({}, r"parts is None: either the number of parts or the times \[s\]"),
        ({"parts": 2, "at": [0.1]}, r"at is \[0\.1\]: either the number"),
        ({"parts": 0}, "parts is 0: an integer from 1 to 5"),
        ({"parts": 6}, "parts is 6: an integer from 1 to 5"),
        ({"parts": 2.0}, r"parts is 2\.0: an integer"),
        ({"parts": True}, "parts is True: an integer"),
        ({"at": 0.1}, r"at is 0\.1: a list of times"),
        ({"at": "0.1"}, r"at is '0\.1': a list of times"),
        ({"at": ["x"]}, r"at\[0\] is 'x': a time \[s\]"),
        ({"at": [np.nan]}, r"at\[0\] is nan: a time"),
        (
            {"at": [0.0]},
            r"at\[0\] is 0\.0: a time inside the recording is expected \(0\.0 s to 0\.39 s\)",
        ),
        ({"at": [0.4]}, r"at\[0\] is 0\.4: a time inside"),
        (
            {"at": [0.2, 0.1]},
            r"at\[1\] is 0\.1: the times must increase, but the previous time is 0\.2 s",
        ),
        ({"at": [0.05]}, "part 1 of 2 would have 5 of 40 samples; at least 8"),
        ({"at": [0.2, 0.21]}, "part 2 of 3 would have 1 of 40 samples"),
    ],
)
def test_what_cannot_be_split(arguments: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        recording().split(**arguments)


@given(
    steps=st.lists(st.floats(1e-3, 3e-3) | st.just(0.1), min_size=12, max_size=60),
    period=st.floats(5e-4, 2e-2),
)
@settings(deadline=None)
def test_any_clock_is_resampled_or_refused(steps: list[float], period: float) -> None:
    made = recording(np.cumsum(steps))
    refused = ""
    try:
        uniform = made.resample(period=period)
    except InputError as error:
        refused = str(error)
    else:
        assert len(uniform.gaps) == len(made.gaps)
        np.testing.assert_allclose(uniform.position, 3 * uniform.time + 1, rtol=1e-9)
        inside = np.ones(len(uniform) - 1, dtype=bool)
        inside[[gap.index for gap in uniform.gaps]] = False
        np.testing.assert_allclose(np.diff(uniform.time)[inside], period, rtol=1e-6)
    assert "\n" not in refused
