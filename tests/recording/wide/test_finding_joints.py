"""The joints that headers name, and which column is which signal of which joint."""

from pathlib import Path
from typing import Any

import pytest

import jointid as jid
from jointid.recording.wide import finding_joints
from jointid.recording.wide.finding_joints import joint_headers


def meant(headers: list[str]) -> dict[str, dict[str, str]]:
    """Joint → header → signal."""
    return {
        joint: {headers[each.index]: each.meaning.signal for each in columns if each.meaning}
        for joint, columns in joint_headers(headers).items()
    }


@pytest.mark.parametrize(
    ("position", "torque", "joint"),
    [
        ("motor_position_3_rad", "motor_torque_3_Nm", "3"),
        ("joint3_pos", "joint3_effort", "3"),
        ("q3", "tau3", "3"),
        ("q[2]", "tau[2] [Nm]", "2"),
        ("actual_q_0", "actual_current_0", "0"),
        ("position.3", "effort.3", "3"),
        ("position(:,3)", "torque(:,3)", "3"),
        ("motor_encoder_pos_1_linkside_rad", "motor_torque_1_Nm", "1"),
        ("A1_pos", "A1_torque", "1"),
        ("ActPos1 [deg]", "ActTorque1 [Nm]", "1"),
        ("shoulder_pan.position [rad]", "shoulder_pan.effort [Nm]", "shoulder_pan"),
        ("shoulder_pan_position", "shoulder_pan_motor_torque_Nm", "shoulder_pan"),
        ("position.elbow", "torque.elbow", "elbow"),
        ("/joint_states/elbow/position", "/joint_states/elbow/effort", "elbow"),
        ("panda_joint1_position", "panda_joint1_effort", "panda_joint1"),
        ("panda_joint1.position [rad]", "panda_joint1.effort [Nm]", "panda_joint1"),
        ("joint_positions(:,3) [deg]", "joint_torques(:,3) [N*m]", "3"),
        ("joint_3.joint_positions [deg]", "joint_3.efforts", "joint_3"),
        ("positions_3", "motor_currents_3", "3"),
        ("qpos[2]", "qfrc_actuator[2]", "2"),
        ("angles.3", "torques.3", "3"),
        ("elbow_2_position_rad", "elbow_2_torque_Nm", "elbow_2"),
    ],
)
def test_a_joint_is_found_by_number_or_name(position: str, torque: str, joint: str) -> None:
    found = meant(["time", position, torque])
    assert list(found) == [joint]
    assert found[joint][position] == "position"
    assert torque in found[joint]


@pytest.mark.parametrize(
    "headers",
    [
        ["time_s", "position_rad", "velocity_rad_s", "torque_Nm", "sensor_raw"],
        ["time", "position", "motor_position", "link_position", "position_ref", "goal_position"],
        ["time", "position", "temperature_1", "temperature_2", "current_1"],
        ["time_s", "position_m", "acceleration_m_s2", "inertia_kgm2"],
        ["time", "position", "position_error", "torque_ff"],
    ],
)
def test_a_log_of_one_joint_names_none(headers: list[str]) -> None:
    assert joint_headers(headers) == {}


def test_what_a_model_or_a_tool_says_is_no_signal() -> None:
    computed = [
        "model_gravity_torque_1_Nm",
        "actual_TCP_speed_1",
        "inertia_1_kgm2",
    ]
    found = joint_headers(["time", "q1", *computed])
    assert [each.meaning for each in found["1"][1:]] == [None] * len(computed)
    commanded = joint_headers(["time", "q1", "target_moment_1"])["1"][1].meaning
    assert commanded is not None
    assert commanded.asked


@pytest.mark.parametrize(
    ("headers", "signals"),
    [
        (["positions_1", "velocities_1"], ["position", "velocity"]),
        (["qpos_1", "qvel_1", "qfrc_bias_1"], ["position", "velocity", None]),
        (
            ["q_1", "joint_temperatures_1", "torque_sensors_1"],
            ["position", "temperature", "sensor"],
        ),
    ],
)
def test_plural_words(headers: list[str], signals: list[str | None]) -> None:
    found = joint_headers(headers)["1"]
    assert [each.meaning and each.meaning.signal for each in found] == signals


def test_a_controllers_state() -> None:
    """What is commanded is the reference; error and output are not measured."""
    parts = ("reference", "feedback", "error", "output")
    found = joint_headers(
        [f"{part}.{signal}[0]" for part in parts for signal in ("positions", "effort")]
    )
    meant = [each.meaning and (each.meaning.signal, each.meaning.asked) for each in found["0"]]
    assert meant == [
        *[("reference", False), ("torque", True), ("position", False), ("torque", False)],
        *[None] * 4,
    ]


def test_side_and_pattern_of_a_column() -> None:
    found = joint_headers(["motor_position_3_rad", "motor_torque_3_Nm"])
    assert [each.pattern for each in found["3"]] == [
        "motor_position_{joint}_rad",
        "motor_torque_{joint}_Nm",
    ]
    assert [each.header for each in found["3"]] == ["motor_position_rad", "motor_torque_Nm"]
    assert [each.meaning.side for each in found["3"] if each.meaning] == ["motor", "motor"]


def test_a_robot_of_many_joints_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each joint looks through all headers; they are understood once."""
    names = [f"joint_{k}.{signal}" for k in range(257) for signal in ("position", "torque")]
    path = tmp_path / "a.csv"
    rows = "\n".join(",".join([f"{k / 1000}", *["0"] * len(names)]) for k in range(20))
    path.write_text(f"time,{','.join(names)}\n{rows}\n")
    with pytest.raises(jid.InputError, match="the robot has 257 joints; at most 256 are read"):
        jid.load_robot(path)
    asked: list[int] = []
    real = finding_joints._numbered

    def numbered(index: int, header: str) -> Any:
        asked.append(index)
        return real(index, header)

    monkeypatch.setattr(finding_joints, "_numbered", numbered)
    finding_joints._joints.cache_clear()
    assert len(jid.load_robot(path, joints=list(range(8))).names) == 8
    assert len(asked) == len(names) + 1
