"""Units in camel case (mNm, kNm, mA) in the headers of a log with several joints."""

from pathlib import Path

import numpy as np
import pytest

import jointid as jid

TIME = 0.01 * np.arange(100)


def log(path: Path, torque: str) -> Path:
    header = (
        f"time_s,motor_position_1_rad,motor_position_2_rad,{torque.format(1)},{torque.format(2)}"
    )
    columns = [TIME, np.sin(TIME), np.cos(TIME), 3.0 + TIME, 5.0 + TIME]
    np.savetxt(path, np.column_stack(columns), delimiter=",", header=header, comments="")
    return path


@pytest.mark.parametrize(
    ("header", "factor"),
    [("motor_torque_{}_mNm", 1e-3), ("motor_torque_{}_Nm", 1.0), ("motorTorque_{} [kNm]", 1e3)],
)
def test_a_motors_torque_is_read_and_turned_alike_in_every_unit(
    header: str, factor: float, tmp_path: Path
) -> None:
    path = log(tmp_path / "a.csv", header)
    read = jid.load_robot(path)
    assert read.torque is not None
    np.testing.assert_allclose(read.torque[0], [3.0 * factor, 5.0 * factor])
    turned = jid.load_robot(path, scale={"torque": -factor})
    assert turned.torque is not None
    np.testing.assert_allclose(turned.torque, -read.torque)


def test_a_torque_of_no_side_is_asked_about_in_every_unit(tmp_path: Path) -> None:
    with pytest.raises(jid.InputError, match="does not show its side of the gear"):
        jid.load_robot(log(tmp_path / "a.csv", "torque_{}_mNm"))


def test_a_factor_of_a_signal_that_no_joint_has_is_refused(tmp_path: Path) -> None:
    path = log(tmp_path / "a.csv", "motor_torque_{}_Nm")
    with pytest.raises(jid.InputError, match="no column is recognised as current"):
        jid.load_robot(path, scale={"current": 0.001})
