"""What cannot be identified is refused with the argument, its value and what to do about it."""

from typing import Any

import numpy as np
import pytest

import jointid as jid
from jointid.problem.recordings import listed

TIME = np.arange(0.0, 2.0, 0.002)
MOTION: dict[str, Any] = {"time": TIME, "position": np.sin(7.0 * TIME)}
RECORDING = jid.Recording(**MOTION, torque=np.cos(7.0 * TIME))


def refused(*arguments: Any, **keywords: Any) -> jid.InputError:
    with pytest.raises(jid.InputError) as caught:
        jid.identify(*arguments, **keywords)
    error = caught.value
    text = " ".join([error.reason, *(each for each in error.remedy if isinstance(each, str))])
    assert not any(syntax in text for syntax in ("={", "jid.", "jointid.", "--", "=True", "='"))
    return error


@pytest.mark.parametrize(
    ("windows", "reason"),
    [
        ("many", "a number of windows"),
        ([3], "a number of windows"),
        (True, "a number of windows"),
        (0, "above 0"),
        (-0.5, "above 0"),
        (1e15, "above 0 and below 1e\\+15"),
        (float("nan"), "a finite number"),
        (10**400, "a finite number"),
    ],
)
def test_windows_that_cannot_be_cut(windows: Any, reason: str) -> None:
    error = refused(RECORDING, windows=windows)
    assert error.argument == "windows"
    assert reason.replace("\\", "") in error.reason
    assert windows == 10**400 or error.value is windows or error.value != error.value


@pytest.mark.parametrize("hold", ["", "hold", 3, 0, ["x"]])
def test_a_torque_hold_that_does_not_exist(hold: Any) -> None:
    error = refused(RECORDING, torque_hold=hold)
    assert (error.argument, error.value) == ("torque_hold", hold)
    assert "zoh, linear" in error.reason


@pytest.mark.parametrize("recordings", [3, "run.csv", None, []])
def test_what_is_no_recording(recordings: Any) -> None:
    error = refused(recordings)
    assert (error.argument, error.value) == ("recordings", recordings)


def test_a_recording_is_not_counted_twice() -> None:
    copy = jid.Recording(**MOTION, torque=np.cos(7.0 * TIME), name="under another name")
    error = refused([RECORDING, copy])
    assert (error.place, error.reason[:38]) == (
        "recording 1",
        "this recording is the same as recording 0"[:38],
    )
    first, second = RECORDING[:1.0], RECORDING[1.0:]
    error = refused([first, second, RECORDING[1.0:]])
    assert (error.place, error.reason[:38]) == (
        "recording 2",
        "this recording is the same as recording 1"[:38],
    )
    for other in ({"torque_hold": "zoh"}, {"extra": {"q6_rate": np.cos(TIME)}}):
        listed([RECORDING, jid.Recording(**MOTION, torque=RECORDING.torque, **other)])


def test_one_of_several_is_no_recording() -> None:
    error = refused([RECORDING, "run.csv"])
    assert (error.argument, error.value, error.place) == ("recordings", "run.csv", "recording 1")


def test_kinds_are_not_mixed() -> None:
    sliding = jid.Recording(**MOTION, torque=np.cos(7.0 * TIME), kind="prismatic")
    error = refused([RECORDING, sliding])
    assert (error.argument, error.value, error.place) == ("kind", "prismatic", "recording 1")
    assert error.reason == "recording 0 is revolute"
    error = refused(sliding, jid.Joint(name="elbow"))
    assert (error.argument, error.value, error.place) == ("kind", "prismatic", "recording")
    assert error.reason == "joint 'elbow' is revolute"


def test_a_recording_with_many_gaps() -> None:
    bursts = np.cumsum(np.where(np.arange(TIME.size) % 5 == 0, 0.02, 0.002))
    torn = jid.Recording(time=bursts, position=np.sin(bursts), torque=np.cos(bursts))
    error = refused(torn)
    assert (error.argument, error.place) == ("time", "recording 0")
    assert error.reason.startswith("20 % of the sample intervals are gaps")


def test_a_motor_side_signal_needs_a_joint() -> None:
    error = refused(jid.Recording(**MOTION, current=np.cos(7.0 * TIME)))
    assert error.argument == "torque"
    joint = "set the joint with torque_constant=..., gear_ratio=... (facts of motor and gear)"
    assert [str(each) for each in error.remedy] == [joint]
    error = refused(jid.Recording(**MOTION, motor_torque=np.cos(7.0 * TIME)))
    ratio, joint = map(str, error.remedy)
    assert ratio == "load with gear_ratio=... (motor angle per joint angle)"
    assert (
        joint == "identify with joint=... (with the joint's gear_ratio, which converts the torque)"
    )
    commanded = {"commanded_torque": "target_moment_{joint}"}
    error = refused(jid.Recording(**MOTION, current=np.cos(7.0 * TIME), metadata=commanded))
    assert (
        str(error.remedy[0])
        == "load with columns={'torque': 'target_moment_{joint}'} (a commanded torque)"
    )


def test_a_missing_torque_names_the_call_that_maps_it() -> None:
    error = refused(jid.Recording(**MOTION))
    assert str(error.remedy[0]) == "load with columns={'torque': ...}"


def test_a_missing_sensor_names_the_call_that_maps_it() -> None:
    error = refused([RECORDING], jid.Joint(name="elbow", sensor=True))
    assert (error.argument, error.place) == ("sensor", "recording 0")
    assert str(error.remedy[0]) == "load with columns={'sensor': ...}"
    error = refused(RECORDING, residual="sensor")
    assert (error.argument, error.value) == ("residual", "sensor")
    assert str(error.remedy[0]) == "identify with residual='torque'"


def test_milliseconds_that_are_taken_for_seconds_are_no_standstill() -> None:
    motion = {"position": MOTION["position"], "velocity": 7.0 * np.cos(7.0 * TIME)}
    slow = jid.Recording(time=500.0 * TIME, torque=RECORDING.torque, **motion)
    error = refused(slow)
    assert "the time stamps are probably in milliseconds" in str(error)
    # At a usual rate the reason is the motion's.
    still = jid.Recording(
        time=TIME,
        position=1e-9 * TIME,
        velocity=np.full(len(TIME), 1e-12),
        torque=RECORDING.torque,
    )
    assert "milliseconds" not in str(refused(still))
