"""Sides of the gear in a file: each column is converted by its own side."""

from pathlib import Path

import numpy as np
import pytest

import jointid as jid
from jointid.recording.wide.words import meaning_of

RATIO = 100.0


def columns_of(folder: Path, *headers: str) -> tuple[Path, dict[str, np.ndarray]]:
    """A file with these columns of joint 1, and one of joint 2."""
    random = np.random.default_rng(0)
    names = ["time", *(f"{each}_1" for each in headers), "motor_position_2"]
    columns: dict[str, np.ndarray] = {name: random.uniform(-1.0, 1.0, 40) for name in names}
    columns["time"] = np.arange(40, dtype=np.float64) * 0.01
    path = folder / "arm.csv"
    rows = np.column_stack(list(columns.values())).tolist()
    path.write_text("\n".join([",".join(names), *(",".join(map(repr, row)) for row in rows), ""]))
    return path, columns


def remedies(error: jid.InputError) -> list[dict[str, object]]:
    """What to paste: the columns of each advice."""
    return [dict(each.arguments["columns"]) for each in error.remedy if not isinstance(each, str)]


@pytest.mark.parametrize("torque", ["joint_torque", "output_torque", "torque_loadside"])
def test_a_torque_at_the_joint_beside_a_motors_position(torque: str, tmp_path: Path) -> None:
    path, columns = columns_of(tmp_path, "motor_position", torque)
    robot = jid.load_robot(path, gear_ratio=[RATIO, RATIO])
    for loaded in (robot["1"], jid.load(path, joint=1, gear_ratio=RATIO)):
        np.testing.assert_array_equal(loaded.torque, columns[f"{torque}_1"])
        np.testing.assert_array_equal(loaded.position, columns["motor_position_1"] / RATIO)
        assert "side" not in loaded.metadata
    assert robot.side == "joint"
    np.testing.assert_array_equal(robot["2"].position, columns["motor_position_2"] / RATIO)


def test_signals_of_both_sides_need_the_ratio(tmp_path: Path) -> None:
    path, _ = columns_of(tmp_path, "motor_position", "joint_torque")
    for load in (lambda: jid.load(path, joint=1), lambda: jid.load_robot(path)):
        with pytest.raises(
            jid.InputError,
            match=r"position on the motor side, torque on the j.*gear_ratio=\.\.\.",
        ):
            load()


def test_the_motors_torque_comes_first_beside_its_position(tmp_path: Path) -> None:
    path, columns = columns_of(tmp_path, "motor_position", "joint_torque", "motor_torque")
    robot = jid.load_robot(path, gear_ratio=[RATIO, RATIO])
    for loaded in (robot["1"], jid.load(path, joint=1, gear_ratio=RATIO)):
        np.testing.assert_array_equal(loaded.torque, columns["motor_torque_1"] * RATIO)


def test_a_torque_of_no_side_is_asked_about(tmp_path: Path) -> None:
    path, columns = columns_of(tmp_path, "motor_position", "torque")
    with pytest.raises(jid.InputError, match="does not show its side of the gear") as caught:
        jid.load(path, joint=1, gear_ratio=RATIO)
    at_motor, at_joint = remedies(caught.value)
    assert (at_motor, at_joint) == (
        {"motor_torque": "torque_{joint}"},
        {"torque": "torque_{joint}"},
    )
    for named, factor in ((at_motor, RATIO), (at_joint, 1.0)):
        loaded = jid.load(path, joint=1, gear_ratio=RATIO, columns=named)  # type: ignore[arg-type]
        np.testing.assert_array_equal(loaded.torque, columns["torque_1"] * factor)


def test_a_velocity_that_the_user_names_has_its_own_side(tmp_path: Path) -> None:
    path, columns = columns_of(tmp_path, "motor_position", "motor_torque", "joint_velocity")
    named = {"velocity": "joint_velocity_{joint}"}
    loaded = jid.load(path, joint=1, gear_ratio=RATIO, columns=named)
    np.testing.assert_array_equal(loaded.velocity, columns["joint_velocity_1"])


@pytest.mark.parametrize(
    ("headers", "measured"),
    [
        (("q", "motor_torque", "target_torque"), "motor_torque"),
        (("q", "motor_torque", "target_motor_torque"), "motor_torque"),
        (("q", "motor_torque", "link_torque"), "motor_torque"),
        (("q", "motor_torque", "load_torque"), "motor_torque"),
        (("q", "torque", "torque_target"), "torque"),
        (("q", "torque", "torque_filtered"), "torque"),
        (("q", "actual_current", "target_torque"), "current"),
    ],
)
def test_only_what_was_measured_at_the_drive(
    headers: tuple[str, ...], measured: str, tmp_path: Path
) -> None:
    path, _ = columns_of(tmp_path, *headers)
    assert jid.load(path, joint=1).signals == ("time", "position", "velocity", measured)


@pytest.mark.parametrize("torque", ["target_torque", "torque_filtered", "commanded_effort"])
def test_no_measured_torque_is_asked_about(torque: str, tmp_path: Path) -> None:
    path, columns = columns_of(tmp_path, "q", torque)
    with pytest.raises(jid.InputError, match="no measured torque") as caught:
        jid.load(path, joint=1)
    named, without = remedies(caught.value)
    assert named == {"torque": f"{torque}_{{joint}}"}
    loaded = jid.load(path, joint=1, columns=named)  # type: ignore[arg-type]
    np.testing.assert_array_equal(loaded.torque, columns[f"{torque}_1"])
    assert jid.load(path, joint=1, columns=without).torque is None  # type: ignore[arg-type]


def test_a_commanded_torque_of_the_motor_stays_the_motors(tmp_path: Path) -> None:
    path, columns = columns_of(tmp_path, "q", "target_motor_torque")
    with pytest.raises(jid.InputError, match="no measured torque") as caught:
        jid.load(path, joint=1)
    named = remedies(caught.value)[0]
    loaded = jid.load(path, joint=1, gear_ratio=RATIO, columns=named)  # type: ignore[arg-type]
    np.testing.assert_array_equal(loaded.torque, columns["target_motor_torque_1"] * RATIO)


def test_what_acts_on_the_link_is_no_torque_of_the_drive(tmp_path: Path) -> None:
    path, _ = columns_of(tmp_path, "q", "link_torque")
    assert jid.load(path, joint=1).signals == ("time", "position", "velocity")
    assert meaning_of(("target", "load", "torque")) is None
