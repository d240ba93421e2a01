"""The code in docs/several_joints.md runs, and shows what the page says."""

from pathlib import Path

import numpy as np
import pytest
from documents import parsed_commands, read, run_python_blocks


def write_arm(path: Path) -> None:
    """A log of two joints at the motors; the friction of joint 2's drive acts on joint 1, too."""
    time = np.arange(0.0, 12.0, 0.002)
    rates, sizes = np.array([[1.1, 2.9, 5.3], [0.7, 3.7, 6.1]]), np.array([0.5, 0.3, 0.1])
    phases = rates[:, :, None] * time + np.arange(3)[:, None]
    q = np.einsum("k,jkn->nj", sizes, np.sin(phases))
    v = np.einsum("jk,jkn->nj", sizes * rates, np.cos(phases))
    a = -np.einsum("jk,jkn->nj", sizes * rates**2, np.sin(phases))
    torque = np.array([2.0, 0.8]) * a + np.array([8.0, 5.0]) * np.sign(v) + np.array([6.0, 3.0]) * v
    torque[:, 0] += 1.5 * np.sign(v[:, 1]) + 1.0 * v[:, 1]
    torque += np.random.default_rng(0).normal(scale=0.3, size=torque.shape)
    ratio = np.array([50.0, -30.0])
    columns = np.column_stack([time, q * ratio, torque / ratio])
    header = "time_s,motor_position_1_rad,motor_position_2_rad,motor_torque_1_Nm,motor_torque_2_Nm"
    np.savetxt(path, columns, delimiter=",", header=header, comments="")


def test_the_page_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    write_arm(tmp_path / "arm.csv")
    names = run_python_blocks(read("docs/several_joints.md"), tmp_path, monkeypatch)
    (share,) = (each for each in names["found"].results["1"].others if each.certain)
    assert (share.joint, share.by) == ("2", "speed")
    assert names["found"]["1"].parameters["coulomb"].value == pytest.approx(8.0, rel=0.1)
    text = read("docs/several_joints.md")
    (sentence,) = [line for line in text.splitlines() if line.startswith("joint 2's speed")]
    assert sentence in capsys.readouterr().out


def test_its_commands_exist() -> None:
    assert parsed_commands(read("docs/several_joints.md")) == ["identify", "info", "identify"]
