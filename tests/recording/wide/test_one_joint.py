"""One joint of a file with several: `load(path, joint=...)`."""

from pathlib import Path

import numpy as np
import pytest

import jointid as jid
from jointid.recording.wide.joint_names import joint_named


def written(folder: Path, headers: list[str], seed: int = 0) -> tuple[Path, dict[str, np.ndarray]]:
    """A file with these headers, time first, and its columns."""
    random = np.random.default_rng(seed)
    columns = {header: random.uniform(-1.0, 1.0, 40) for header in headers}
    columns[headers[0]] = np.asarray(np.arange(40) * 0.01, dtype=np.float64)
    path = folder / "arm.csv"
    rows = zip(*(values.tolist() for values in columns.values()), strict=True)
    text = "\n".join([",".join(headers), *(",".join(map(repr, row)) for row in rows), ""])
    path.write_text(text)
    return path, columns


MOTORS = [
    "time_s",
    "motor_position_1_rad",
    "motor_position_2_rad",
    "motor_torque_1_Nm",
    "motor_torque_2_Nm",
]


def test_one_joint_of_several(tmp_path: Path) -> None:
    path, columns = written(tmp_path, ["t", "q1", "q2", "tau1", "tau2", "temperature"])
    loaded = jid.load(path, joint=2)
    assert loaded.name == "arm joint 2"
    assert loaded.metadata["joint"] == "2"
    np.testing.assert_array_equal(loaded.position, columns["q2"])
    np.testing.assert_array_equal(loaded.torque, columns["tau2"])
    np.testing.assert_array_equal(loaded.temperature, columns["temperature"])
    assert jid.load(path, joint="2") == loaded


def test_several_joints_and_none_named(tmp_path: Path) -> None:
    path, _ = written(tmp_path, ["t", "q1", "q2", "tau1", "tau2"])
    with pytest.raises(jid.InputError, match=r"2 joints \(1, 2\).*load with joint=1"):
        jid.load(path)


def test_the_only_joint_needs_no_name(tmp_path: Path) -> None:
    path, columns = written(tmp_path, ["t", "elbow_angle_rad", "elbow_torque_Nm"])
    np.testing.assert_array_equal(jid.load(path).position, columns["elbow_angle_rad"])


def test_a_joint_that_is_not_there(tmp_path: Path) -> None:
    path, _ = written(tmp_path, ["t", "elbow.position [rad]", "wrist.position [rad]"])
    with pytest.raises(jid.InputError, match=r"there are elbow, wrist; did you mean 'elbow'"):
        jid.load(path, joint="elbo")


def test_a_number_finds_the_name_with_it(tmp_path: Path) -> None:
    path, columns = written(tmp_path, ["t", "joint_1.position [rad]", "joint_2.position [rad]"])
    np.testing.assert_array_equal(
        jid.load(path, joint=2).position, columns["joint_2.position [rad]"]
    )


UR = ["shoulder_lift_joint", "elbow_joint", "wrist_1_joint", "wrist_2_joint", "wrist_3_joint"]


def test_a_number_in_a_name_is_not_the_joints_number(tmp_path: Path) -> None:
    """Joint 3 of this robot is the elbow, which no number names."""
    path, columns = written(tmp_path, ["t", *(f"{name}.position [rad]" for name in UR)])
    expected = (
        r"there are shoulder_lift_joint, elbow_joint, .*load with joint='shoulder_lift_joint'"
    )
    with pytest.raises(jid.InputError, match=expected) as caught:
        jid.load(path, joint=3)
    pasted = caught.value.remedy[0].arguments["joint"]  # type: ignore[union-attr]
    loaded = jid.load(path, joint=pasted)
    np.testing.assert_array_equal(loaded.position, columns["shoulder_lift_joint.position [rad]"])
    with pytest.raises(jid.InputError, match=r"load with joints=\['shoulder_lift_joint'\]"):
        jid.load_robot(path, [3])
    robot = jid.load_robot(path)
    with pytest.raises(KeyError, match="there are shoulder_lift_joint"):
        robot[3]
    with pytest.raises(jid.InputError, match="the only one is wrist_3_joint"):
        robot.select(["wrist_3_joint"]).joint(3)


def test_a_misspelt_word_of_a_name(tmp_path: Path) -> None:
    path, _ = written(tmp_path, ["t", *(f"{name}.position [rad]" for name in UR)])
    with pytest.raises(jid.InputError, match="did you mean 'elbow_joint'"):
        jid.load(path, joint="elbw")
    with pytest.raises(KeyError, match="did you mean 'elbow_joint'"):
        jid.load_robot(path)["elbw"]
    with pytest.raises(jid.InputError) as caught:  # one of three
        jid.load(path, joint="wrst")
    assert caught.value.remedy == ()


@pytest.mark.parametrize(
    ("names", "third"),
    [
        (["panda_joint1", "panda_joint2", "panda_joint3"], "panda_joint3"),
        (["iiwa14_joint_a1", "iiwa14_joint_a3"], "iiwa14_joint_a3"),
        (["left_joint_1", "left_joint_03"], "left_joint_03"),
        (["panda_joint3"], "panda_joint3"),
        (["left_joint_3", "right_joint_3"], None),
        (["joint_1_left", "joint_3_right"], None),
        (["base", "joint_3"], None),
        (["joint_3", "joint_03"], None),
        (["wrist_3_joint"], None),
        (["elbow"], None),
    ],
)
def test_a_number_stands_for_a_name_where_all_are_numbered_alike(
    names: list[str], third: str | None
) -> None:
    if third is not None:
        assert joint_named(3, names, "here") == third
        return
    with pytest.raises(jid.InputError, match="there is no such joint"):
        joint_named(3, names, "here")


def test_a_joint_in_a_file_without_joints(tmp_path: Path) -> None:
    path, _ = written(tmp_path, ["time_s", "position_rad"])
    with pytest.raises(jid.InputError, match="no header names the position of a joint"):
        jid.load(path, joint=1)


@pytest.mark.parametrize("ratio", [48.0, -48.0])
def test_columns_of_the_motor_are_converted(tmp_path: Path, ratio: float) -> None:
    path, columns = written(tmp_path, MOTORS)
    loaded = jid.load(path, joint=2, gear_ratio=ratio)
    np.testing.assert_array_equal(loaded.position, columns["motor_position_2_rad"] / ratio)
    np.testing.assert_array_equal(loaded.torque, columns["motor_torque_2_Nm"] * ratio)
    assert "side" not in loaded.metadata


def test_without_a_ratio_the_motors_side_is_named(tmp_path: Path) -> None:
    path, columns = written(tmp_path, MOTORS)
    loaded = jid.load(path, joint=1)
    assert loaded.metadata["side"] == "motor"
    np.testing.assert_array_equal(loaded.position, columns["motor_position_1_rad"])
    np.testing.assert_array_equal(loaded.torque, columns["motor_torque_1_Nm"])
    assert loaded.motor_torque is None


def test_positions_of_the_joint_come_before_those_of_the_motor(tmp_path: Path) -> None:
    path, columns = written(
        tmp_path, ["t", "motor_position_1_rad", "position_1_rad", "motor_velocity_1_rad_s"]
    )
    loaded = jid.load(path, joint=1)
    np.testing.assert_array_equal(loaded.position, columns["position_1_rad"])
    assert loaded.velocity_derived  # the motor's velocity is on the other side of the gear


def test_two_positions_are_refused_with_a_line_to_paste(tmp_path: Path) -> None:
    path, columns = written(tmp_path, ["t", "position_1_rad", "encoder_pos_1_rad", "tau_1"])
    with pytest.raises(jid.InputError) as caught:
        jid.load(path, joint=1)
    columns_to_paste = caught.value.remedy[1].arguments["columns"]  # type: ignore[union-attr]
    assert columns_to_paste == {"position": "encoder_pos_{joint}_rad"}
    loaded = jid.load(path, joint=1, columns=columns_to_paste)
    np.testing.assert_array_equal(loaded.position, columns["encoder_pos_1_rad"])


def test_joints_where_only_a_pattern_names_them(tmp_path: Path) -> None:
    headers = ["t", "Foo<1>", "Foo<2>", "Bar<1>", "Bar<2>"]
    path, columns = written(tmp_path, headers)
    given = {"position": "Foo<{joint}>", "torque": "bar<{joint}>"}
    loaded = jid.load(path, joint=2, columns=given)
    np.testing.assert_array_equal(loaded.position, columns["Foo<2>"])
    np.testing.assert_array_equal(loaded.torque, columns["Bar<2>"])
    assert jid.load_robot(path, columns=given).names == ("1", "2")
    with pytest.raises(jid.InputError, match=r"2 joints \(1, 2\)"):
        jid.load(path, columns=given)
    with pytest.raises(jid.InputError, match=r"joints is 'all': no header names the"):
        jid.load_robot(path)


def test_a_column_number_is_that_of_the_file(tmp_path: Path) -> None:
    path, columns = written(tmp_path, ["t", "q1", "q2", "tau1", "tau2", "spare"])
    loaded = jid.load(path, joint=2, columns={"torque": 5})
    np.testing.assert_array_equal(loaded.torque, columns["spare"])


def test_a_current_in_counts_blocks_nothing(tmp_path: Path) -> None:
    path, _ = written(tmp_path, ["t", "q1", "tau1", "current_1 [counts]"])
    assert jid.load(path, joint=1).current is None


def test_a_wrong_cell_is_named_in_the_file(tmp_path: Path) -> None:
    path, _ = written(tmp_path, ["t", "q1", "q2"])
    text = path.read_text().splitlines()
    text[5] = "0.04,0.1,broken"
    path.write_text("\n".join(text))
    with pytest.raises(jid.InputError, match="line 6, column 'q2'"):
        jid.load(path, joint=2)


def test_kr300(shared_data: Path) -> None:
    loaded = jid.load(shared_data / "kr300" / "kr300_A.csv.gz", joint=1)
    assert loaded.signals == ("time", "position", "velocity", "link_position", "motor_torque")
    alone = jid.load(
        shared_data / "kr300" / "kr300_A.csv.gz",
        columns={
            "position": "motor_encoder_pos_1_linkside_rad",
            "velocity": "motor_encoder_vel_1_linkside_rad_s",
            "motor_torque": "motor_torque_1_Nm",
        },
    )
    np.testing.assert_array_equal(loaded.position, alone.position)
    np.testing.assert_array_equal(loaded.velocity, alone.velocity)
