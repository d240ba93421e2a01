"""A robot's recording: made, taken apart, saved and loaded again."""

import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import jointid as jid

TIME = np.arange(50) * 0.01
ARRAY = np.random.default_rng(0).uniform(-1.0, 1.0, (50, 3))


def robot(**changes: Any) -> jid.RobotRecording:
    fields = {
        "time": TIME,
        "position": ARRAY,
        "torque": 2.0 * ARRAY,
        "names": ["a", "b", "joint_3"],
    }
    return jid.RobotRecording(**{**fields, **changes})


def test_a_mapping_of_recordings() -> None:
    whole = robot()
    assert (len(whole), list(whole), whole.samples) == (3, ["a", "b", "joint_3"], 50)
    assert whole["b"] == whole.joint("b") == whole.to_recordings()[1]
    with pytest.raises(
        jid.InputError, match="there are a, b, joint_3; the joints have no common numbering"
    ):
        whole.joint(3)
    numbered = robot(names=["joint_1", "joint_2", "joint_3"])
    assert numbered.joint(3).name == "joint_3"
    np.testing.assert_array_equal(whole["b"].position, ARRAY[:, 1])
    assert whole["b"].velocity_derived
    with pytest.raises(KeyError):
        whole["c"]
    with pytest.raises(jid.InputError, match="there are a, b, joint_3"):
        whole.joint("c")


def test_it_is_read_only() -> None:
    whole = robot()
    with pytest.raises(AttributeError):
        whole.position = ARRAY
    with pytest.raises(ValueError, match="read-only"):
        whole.position[0, 0] = 1.0


def test_motors_become_joints_with_their_ratios() -> None:
    whole = robot(side="motor", gear_ratio=[10.0, -20.0, 1.0], velocity=ARRAY)
    second = whole["b"]
    np.testing.assert_array_equal(second.position, ARRAY[:, 1] / -20.0)
    np.testing.assert_array_equal(second.velocity, ARRAY[:, 1] / -20.0)
    np.testing.assert_array_equal(second.torque, 2.0 * ARRAY[:, 1] * -20.0)
    assert "side" not in second.metadata
    assert robot(side="motor")["b"].metadata["side"] == "motor"


def test_a_joint_without_a_signal() -> None:
    current = np.full_like(ARRAY, np.nan)
    current[:, 0] = 1.0
    whole = robot(current=current)
    assert whole["a"].current is not None
    assert whole["b"].current is None
    current[3, 0] = np.nan
    with pytest.raises(jid.InputError, match=r"current\[:, 0\].*index 3|index 3.*current\[:, 0\]"):
        robot(current=current)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"position": ARRAY.T}, "swapped"),
        ({"position": ARRAY[:, 0]}, "one row per sample"),
        ({"torque": ARRAY[:, :2]}, "torque"),
        ({"names": ["a", "a", "b"]}, "two joints"),
        ({"names": ["a", "b"]}, "one name"),
        ({"names": ["a", "b", "c,d"]}, "without brackets"),
        ({"side": "left"}, "joint or motor"),
        ({"gear_ratio": [1.0, 0.0, 2.0]}, "gear_ratio"),
        ({"gear_ratio": [1.0, 2.0]}, "one gear ratio for each"),
        ({"gear_ratio": 2.0}, "one gear ratio is given for 3 joints"),
        ({"extra": {"load": ARRAY[:5, 0]}}, "extra.load"),
        ({"time": TIME[::-1]}, "increase"),
    ],
)
def test_what_is_refused(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(jid.InputError, match=message):
        robot(**changes)


def test_parts() -> None:
    whole = robot(extra={"load": ARRAY[:, 0], "model": ARRAY}, gear_ratio=[1.0, 2.0, 3.0])
    some = whole.select(["joint_3", "a"])
    assert some.names == ("joint_3", "a")
    assert some.gear_ratio == (3.0, 1.0)
    np.testing.assert_array_equal(some["a"].extra["model"], ARRAY[:, 0])
    np.testing.assert_array_equal(some["joint_3"].extra["load"], ARRAY[:, 0])
    assert whole.crop(0.1, 0.3).samples == 21


@pytest.mark.parametrize("ending", [".csv", ".csv.gz", ".npz"])
def test_saved_and_loaded(ending: str, tmp_path: Path) -> None:
    current = np.full_like(ARRAY, np.nan)
    current[:, 2] = 1.0
    whole = robot(
        side="motor",
        gear_ratio=[10.0, -20.0, 1.0],
        current=current,
        extra={"load": ARRAY[:, 0], "model": ARRAY},
        torque_hold="zoh",
        name="arm",
        metadata={"note": "x"},
    )
    path = tmp_path / f"arm{ending}"
    whole.save(path)
    assert jid.load_robot(path) == whole
    assert jid.load_robot(path, ["joint_3", "b"]) == whole.select(["joint_3", "b"])
    for name in whole:
        loaded = jid.load(path, joint=name)
        np.testing.assert_array_equal(loaded.position, whole[name].position)
        np.testing.assert_array_equal(loaded.torque, whole[name].torque)
    with pytest.raises(jid.InputError, match="3 joints"):
        jid.load(path)


def test_a_damaged_description_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "arm.csv"
    robot().save(path)
    path.write_text(path.read_text().replace('"torque"', '"tongue"'))
    with pytest.raises(jid.InputError, match="does not fit"):
        jid.load_robot(path)


def test_pickled_and_shown() -> None:
    whole = robot(name="arm")
    assert pickle.loads(pickle.dumps(whole)) == whole
    assert hash(whole) == hash(robot(name="arm"))
    assert whole != robot(name="leg")
    assert "3 joints (a, b, joint_3)" in repr(whole)


def test_wide_file_to_robot(tmp_path: Path) -> None:
    path = tmp_path / "arm.csv"
    headers = "t,motor_position_1_deg,motor_position_2_deg,motor_torque_1_Nm,motor_torque_2_Nm,model_1,model_2"
    rows = [f"{k / 100},{k},{2 * k},{3 * k},{4 * k},{5 * k},{6 * k}" for k in range(20)]
    path.write_text("\n".join([headers, *rows, ""]))
    whole = jid.load_robot(path, gear_ratio=[10, -20], extra={"model": "model_{joint}"})
    assert (whole.names, whole.side, whole.name) == (("1", "2"), "motor", "arm")
    np.testing.assert_allclose(whole["2"].position, -np.deg2rad(2.0 * np.arange(20)) / 20.0)
    torque = whole["2"].torque
    assert torque is not None
    np.testing.assert_allclose(torque, -80.0 * np.arange(20))
    np.testing.assert_allclose(whole["2"].extra["model"], 6.0 * np.arange(20))
    assert jid.load_robot(path, [2]).names == ("2",)
    assert jid.load_robot(path, "all").names == ("1", "2")
    with pytest.raises(jid.InputError, match="twice"):
        jid.load_robot(path, [2, "2"])


def test_rows_of_a_saved_recording_keep_its_side(tmp_path: Path) -> None:
    path = tmp_path / "arm.csv"
    whole = robot(side="motor", gear_ratio=[10.0, -20.0, 1.0], extra={"run": ARRAY[:, 0] * 0 + 1})
    whole.save(path)
    kept = jid.load_robot(path, ["b", "a"], where={"extra_run": 1})
    assert (kept.side, kept.gear_ratio) == ("motor", (-20.0, 10.0))
    np.testing.assert_array_equal(kept["b"].position, whole["b"].position)
