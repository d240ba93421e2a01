"""A torque that passed a low-pass filter is not taken for a late one: tried out of sample, named and undone."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import small_arm
from numpy.typing import NDArray

import jointid as jid

pytest.importorskip("pinocchio")

Array = NDArray[np.float64]


@pytest.fixture(name="path", scope="module")
def _path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return small_arm.urdf(tmp_path_factory.mktemp("filtered"))


def filtered(
    run: jid.RobotRecording, constants: tuple[float, float], noise: int = 7
) -> jid.RobotRecording:
    """The recording with each torque behind a low-pass filter [s], exact where the torque is even between samples."""
    fields = run.fields()
    torque = np.array(fields["torque"])
    step = float(np.median(np.diff(run.time)))
    for joint, constant in enumerate(constants):
        if constant:
            kept = np.exp(-step / constant)
            passed = torque[:, joint].copy()
            for k in range(1, len(passed)):
                mean = 0.5 * (torque[k - 1, joint] + torque[k, joint])
                passed[k] = kept * passed[k - 1] + (1.0 - kept) * mean
            torque[:, joint] = passed
    torque += np.random.default_rng(noise).normal(scale=0.02, size=torque.shape)
    return jid.RobotRecording(**{**fields, "torque": torque})


def late(run: jid.RobotRecording, delay: float) -> jid.RobotRecording:
    fields = run.fields()
    columns = [np.interp(run.time - delay, run.time, each) for each in fields["torque"].T]
    return jid.RobotRecording(**{**fields, "torque": np.column_stack(columns)})


def worst(found: jid.RobotEstimate) -> float:
    return max(
        abs(joint.parameters[name].value / float(truth[k]) - 1.0)
        for k, joint in enumerate(found.joints.values())
        for name, truth in (("coulomb", small_arm.COULOMB), ("viscous", small_arm.VISCOUS))
    )


@pytest.mark.parametrize("constants", [(0.005, 0.005), (0.012, 0.012), (0.004, 0.008)])
@pytest.mark.parametrize("seed", [0, 3])
def test_a_filter_is_named_and_undone(
    path: Path, constants: tuple[float, float], seed: int
) -> None:
    run, robot = (
        filtered(small_arm.recording(path, seed=seed), constants),
        jid.Robot.from_urdf(path),
    )
    found = jid.identify_robot(run, robot)
    (said,) = [each for each in found.findings if each.code == "torque_filtered"]
    values = [each.value for each in said.evidence.values()]
    assert values == pytest.approx(constants, rel=0.1)
    assert worst(found) < 0.03
    assert found.verdict.level == "usable", found.report(verbose=True)
    stated = jid.identify_robot(run, robot, shift=found.settings["shift"])
    assert stated.to_dict()["joints"] == found.to_dict()["joints"]
    assert found.predict(run).relative_residual < 1.1 * found.relative_residual


@pytest.mark.parametrize("delay", [0.003, 0.008])
@pytest.mark.parametrize("seed", [0, 3])
def test_a_delay_stays_one(path: Path, delay: float, seed: int) -> None:
    found = jid.identify_robot(
        late(small_arm.recording(path, seed=seed), delay), jid.Robot.from_urdf(path)
    )
    codes = {each.code for each in found.findings}
    assert "delay_removed" in codes
    assert "torque_filtered" not in codes
    assert worst(found) < 0.03


def test_a_filter_is_saved_and_compared(path: Path, tmp_path: Path) -> None:
    run, robot = filtered(small_arm.recording(path), (0.006, 0.006)), jid.Robot.from_urdf(path)
    found = jid.identify_robot(run, robot)
    again = jid.RobotEstimate.load(found.save(tmp_path / "arm.json"))
    assert again.to_json() == found.to_json()
    assert "low-pass filter undone" in found.report(verbose=True)
    compared = jid.compare_robot_models(run, robot, inertia="urdf", folds=3)
    assert "torque_filter" in compared.estimate.settings["shift"]


def test_a_time_constant_below_zero_is_refused(path: Path) -> None:
    run, robot = small_arm.recording(path, duration=1.0), jid.Robot.from_urdf(path)
    with pytest.raises(jid.InputError) as refused:
        jid.identify_robot(run, robot, shift={"torque_filter": -0.01})
    assert refused.value.argument == "shift.torque_filter"
