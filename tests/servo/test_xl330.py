"""Rhoban BAM's logs of an XL330 (Apache-2.0): held-out closed loops, the motor, and what is said of it."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from simulated_servo import servo_joint, without_free_runs

import jointid as jid

LOGS = Path(__file__).resolve().parents[1] / "data" / "xl330" / "bam_xl330.csv.gz"


@pytest.fixture(scope="module")
def runs() -> list[jid.Recording]:
    extra = {"duty": "duty", "driven": "torque_enabled", "gain": "firmware_kp"}
    return list(jid.load_runs(LOGS, by="run_index", extra=extra))


def test_held_out_by_gain_and_by_trajectory(runs: list[jid.Recording]) -> None:
    joint = servo_joint(supply=7.3)
    by_gain = jid.compare_servo_models(runs, joint)
    by_motion = jid.compare_servo_models(runs, joint, groups=[k % 4 for k in range(len(runs))])
    assert len(set(by_gain.groups)) == len(set(by_motion.groups)) == 4
    for found, most in ((by_gain, 2.3), (by_motion, 2.5)):
        plain, load = np.degrees(found.medians)
        assert load <= most
        assert plain > 3.0  # the simpler model is worse
        assert found.best == "coulomb_viscous:load_friction"
        assert found.estimate.load_friction
        assert "best: coulomb_viscous:load_friction" in found.report()


def test_compare_models_scores_by_rollouts(runs: list[jid.Recording]) -> None:
    joint = servo_joint(supply=7.3)
    found = jid.compare_models(runs, joint, score="rollout", models="coulomb_viscous:load_friction")
    assert np.degrees(found.medians[0]) <= 2.3
    assert found.models == ("coulomb_viscous:load_friction",)
    with pytest.raises(jid.InputError, match="only the option models"):
        jid.compare_models(runs, joint, score="rollout", folds=3)  # type: ignore[call-overload]
    with pytest.raises(jid.InputError, match="voltage"):
        jid.compare_models(runs, joint.replace(voltage=None), score="rollout")
    with pytest.raises(jid.InputError, match="windows or rollout"):
        jid.compare_models(runs, joint, score="torque")  # type: ignore[call-overload]


def test_what_cannot_be_compared_is_refused(runs: list[jid.Recording]) -> None:
    joint = servo_joint(supply=7.3)
    with pytest.raises(jid.InputError, match="groups"):
        jid.compare_servo_models(runs, joint, groups=[1] * len(runs))
    with pytest.raises(jid.InputError, match="one label"):
        jid.compare_servo_models(runs, joint, groups=[1, 2])
    with pytest.raises(jid.InputError, match="at least one model"):
        jid.compare_servo_models(runs, joint, models=[])


def test_the_motor_and_what_is_said_of_it(runs: list[jid.Recording]) -> None:
    found = jid.identify_servo(runs, servo_joint(supply=7.3))
    # BAM's own fits: k_t .387, R 4.02, armature .0018.
    assert found["torque_constant"] == pytest.approx(0.387, rel=0.1)
    assert found["resistance"] == pytest.approx(4.02, rel=0.15)
    assert found["inertia"] == pytest.approx(0.0018, rel=0.15)
    assert found.lead == pytest.approx(0.0025, abs=5e-4)
    assert any(f.code == "at_bound" and "coulomb" in f.parameters for f in found.findings)
    driven = jid.identify_servo(without_free_runs(runs), servo_joint(supply=7.3))
    assert any(f.code == "inseparable_back_emf" for f in driven.findings)


def test_the_position_loop_gives_the_duty(runs: list[jid.Recording]) -> None:
    joint = servo_joint(supply=7.3)
    assert joint.voltage is not None
    assert joint.voltage.position_loop is not None
    logged = jid.identify_servo(runs, joint, draws=0)
    bare = [
        jid.Recording(
            time=run.time,
            position=run.position,
            reference=run.reference,
            extra={k: v for k, v in run.extra.items() if k != "duty"},
        )
        for run in runs
    ]
    drive = replace(joint.voltage, signals={})
    computed = jid.identify_servo(bare, joint.replace(voltage=drive), draws=0)
    assert computed["torque_per_voltage"] == pytest.approx(logged["torque_per_voltage"], rel=0.05)
