"""Columns that nobody maps: they never block a file whose needed ones are understood."""

import math
from pathlib import Path

import pytest
from recording_files import ROWS, column, headed, lines, refusal, written

from jointid.recording.header_words import meaning_of
from jointid.recording.headers import understood
from jointid.recording.readers.loading import load
from jointid.recording.recording import Recording


def left_out(recording: Recording) -> dict[str, str]:
    return {each["column"]: each["reason"] for each in recording.metadata.get("left_out", [])}


@pytest.mark.parametrize(
    ("header", "reason"),
    [
        ("motor_current_raw", "current is a raw reading"),
        ("current [raw]", "current is a raw reading"),
        ("velocity [counts/100ms]", "velocity has the unknown unit 'counts/100ms'"),
        ("sensor [degC]", "sensor is in degC (temperature)"),
        ("temperature [V]", "temperature is in V (voltage)"),
    ],
)
def test_a_foreign_unit_of_what_is_not_needed_blocks_nothing(
    header: str, reason: str, tmp_path: Path
) -> None:
    path = written(tmp_path / "a.csv", lines(f"t_s,q_rad,tau_Nm,{header}"))
    loaded = load(path)
    assert set(loaded.signals) == {"time", "position", "velocity", "torque"}
    assert left_out(loaded) == {header: reason}


@pytest.mark.parametrize(
    ("headers", "signal", "read", "said"),
    [
        ("vel,speed", "velocity", None, {"vel", "speed"}),
        ("velocity,omega", "velocity", 2, {"omega"}),
        ("omega,velocity", "velocity", 3, {"omega"}),
        ("dq,qd", "velocity", None, {"dq", "qd"}),
        ("temp_motor,temperature", "temperature", 3, {"temp_motor"}),
    ],
)
def test_two_columns_of_one_signal(
    headers: str, signal: str, read: int | None, said: set[str], tmp_path: Path
) -> None:
    loaded = load(written(tmp_path / "a.csv", lines(f"t_s,q_rad,{headers}")))
    assert set(left_out(loaded)) == said
    if read is None:
        assert loaded.velocity_derived
    else:
        assert getattr(loaded, signal).tolist() == column(read)


def test_a_torque_that_may_be_either_of_two_is_asked_for(tmp_path: Path) -> None:
    message = refusal(written(tmp_path / "a.csv", lines("t_s,q_rad,current_A,motor_current_A")))
    assert "are both recognised as current" in message


def test_text_and_empty_cells_beside_the_signals(tmp_path: Path) -> None:
    states = ["OK", "", "nan", "RUN; fast", "-"] * 2
    rows = [
        ",".join([*map(repr, row[:2]), f'"{state}"', "", repr(row[3])])
        for row, state in zip(ROWS, states, strict=True)
    ]
    path = written(
        tmp_path / "a.csv", ["t_s,q_rad,drive state,setpoint_nobody_knows,tau_Nm", *rows]
    )
    loaded = load(path)
    assert loaded.torque is not None
    assert loaded.torque.tolist() == column(3)
    assert left_out(loaded) == {}


def test_it_is_said_where_values_are_shown(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    from jointid.cli.command_line import main

    path = tmp_path / "a.csv"
    written(path, lines("t_s,q,tau_Nm,motor_current_raw"))
    assert main(["info", str(path)]) == 0
    shown = capsys.readouterr().out
    assert "not read: motor_current_raw (current is a raw reading)" in shown
    assert "SI units assumed: position" in shown


@pytest.mark.parametrize(
    ("header", "signal"),
    [
        *(
            (name, "time")
            for name in ("timestamp", "time_stamp", "stamp", "secs", "%time", "Time(s)")
        ),
        *((name, "time") for name in ("header.stamp.secs", "field.header.stamp", "robot_time")),
        *((name, "position") for name in ("q_meas", "actual_position", "position_actual", "theta")),
        *((name, "position") for name in ("joint1_pos", "Axis 1.ActPos", "actual_q_0", "q1")),
        *((name, "position") for name in ("actual.positions[0]", "/joint_states/elbow/position")),
        *((name, "position") for name in ("current_position", "feedback.position", "q[3]")),
        *((name, "velocity") for name in ("omega", "dq", "qd", "q_dot", "actual_qd_0", "ActVelo")),
        *((name, "torque") for name in ("effort", "tau_J", "torque_measured", "ActTorque")),
        *((name, "motor_torque") for name in ("tau_m", "motor torque [Nm]", "motor_torque_actual")),
        *((name, "current") for name in ("actual_current_0", "i_q_A", "Iq", "motor current")),
        *((name, "current") for name in ("i_A", "i_mA", "I [A]", "i_motor [A]", "joint_2_i_A")),
        *((name, "reference") for name in ("target_q_0", "q_d", "q_des", "desired.positions[0]")),
    ],
)
def test_names_of_other_programs(header: str, signal: str) -> None:
    meaning = understood(header).meaning
    assert meaning is not None
    assert meaning.signal == signal


@pytest.mark.parametrize(
    "header",
    [
        *(
            "target_moment_0",
            "tau_J_d",
            "tau_cmd",
            "commanded_torque",
            "target_qd_0",
            "velocity_setpoint",
        ),
        *("torque_limit", "position_error", "error.positions[0]", "max_torque", "torque_enabled"),
        *(
            "motor_position",
            "encoder_counts",
            "time_to_target",
            "time_offset",
            "tau_ext_hat_filtered",
        ),
        *("i", "i [s]", "i_d_A", "i_cmd_A", "i_max [A]", "i_bus_A"),
        *("link_velocity", "q_std", "gravity_torque", "axis_angle", "drive state", "column 0", ""),
    ],
)
def test_what_is_no_measured_signal(header: str) -> None:
    meaning = understood(header).meaning
    assert meaning is None
    assert meaning_of(header) is None


def test_one_numbered_joint_loads_as_it_is(tmp_path: Path) -> None:
    loaded = load(
        written(tmp_path / "a.csv", headed("timestamp,joint1_pos,joint1_vel,joint1_effort"))
    )
    assert loaded.position.tolist() == column(1)
    assert loaded.velocity.tolist() == column(2)
    assert loaded.torque is not None


def test_several_joints_are_nobodys(tmp_path: Path) -> None:
    path = written(tmp_path / "a.csv", headed("timestamp,joint1_pos,joint2_pos,joint2_effort"))
    message = refusal(path)
    assert "2 joints (1, 2)" in message
    loaded = load(path, columns={"position": "joint2_pos"})
    assert loaded.position.tolist() == column(2)


@pytest.mark.parametrize("header", ["torque_MNm", "torque [MNm]"])
def test_mega_asks_whether_milli_is_meant(header: str, tmp_path: Path) -> None:
    path = written(tmp_path / "a.csv", lines(f"t_s,q_rad,{header}"))
    message = refusal(path)
    assert "torque of a revolute joint is in MNm, where M means mega (milli is mNm)" in message
    assert "load with units={'torque': 'mNm'} (if milli is meant)" in message
    loaded = load(path, units={"torque": "mNm"})
    assert loaded.torque is not None
    assert loaded.torque[1] == column(2)[1] / 1000


def test_what_nothing_shows_to_be_a_position_is_asked_for(tmp_path: Path) -> None:
    rows = [f"{0.002 * k:.3f},24.1,{1700000000 + k},{k % 7}" for k in range(20)]
    text = "\n".join(["time_s,data,header.stamp_other,state", *rows])
    message = refusal(written(tmp_path / "a.csv", text))
    assert "no column is recognised as position; columns are 'time_s', 'data'" in message
    assert "load with columns={'position': ...}" in message


def test_a_position_is_proposed_where_its_rate_is_the_velocity(tmp_path: Path) -> None:
    time = [0.002 * k for k in range(200)]
    rows = [
        f"{t:.3f},{k % 7},{math.sin(9.0 * t)},{9.0 * math.cos(9.0 * t)}" for k, t in enumerate(time)
    ]
    text = "\n".join(["time_s,state,data,velocity_rad_s", *rows])
    message = refusal(written(tmp_path / "a.csv", text))
    assert "load with columns={'position': 'data'}" in message


def test_german_words(tmp_path: Path) -> None:
    text = lines("Zeit [s],Winkel [rad],Drehmoment [Nm],Geschwindigkeit [rad/s]")
    loaded = load(written(tmp_path / "a.csv", text))
    assert not loaded.velocity_derived
    assert loaded.velocity.tolist() == column(3)


def test_the_proposed_units_make_unknown_columns_plausible(tmp_path: Path) -> None:
    """A pasted remedy must not read degrees as radians, or milliamperes as amperes."""
    rows = [f"{k / 100},{60.0 * math.sin(k / 20)},{4000.0 * math.cos(k / 20)}" for k in range(200)]
    message = refusal(written(tmp_path / "a.csv", ["clk,ang_meas,mot_curr", *rows]))
    assert "units={'time': 's', 'position': 'deg', 'current': 'mA'}" in message
