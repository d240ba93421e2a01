"""What the duty does between rows: a command that is held from row to row, or one that moves evenly."""

from dataclasses import replace

import numpy as np
import pytest
from simulated_servo import LOOP_GAIN, SUPPLY, Truth, bench_runs, changed, servo_joint, with_truth

import jointid as jid

TRUTH = Truth()


def held_runs(row: float) -> list[jid.Recording]:
    """Runs whose command jumps at each row and stands still until the next; every second is let go."""
    joint = with_truth(TRUTH, servo_joint(supply=SUPPLY))
    time = np.arange(0.0, 6.0, row)
    runs = []
    for number in range(8):
        gain, free = 100.0 * 2 ** (number // 2), number % 2 == 1
        wanted = np.where(free, -1.6, np.sin(2.6 * time) + 0.5 * np.sin(7.1 * time))
        driven = np.where(free & (time > 1.5), 0.0, 1.0)
        extra = {"driven": driven, "gain": np.full(len(time), gain)}
        plan = jid.Recording(time=time, position=0.0 * time, reference=wanted, extra=extra)
        moved = jid.rollout(joint, plan).runs[0].position
        duty = np.clip(LOOP_GAIN * gain * (wanted - moved), -1.0, 1.0) * driven
        runs.append(changed(plan, position=moved, extra={**extra, "duty": duty}))
    return runs


@pytest.mark.parametrize("row", [0.002, 0.005])
def test_a_held_command_does_not_bias_the_motor(row: float) -> None:
    runs = held_runs(row)
    found = jid.identify_servo(runs, servo_joint(supply=SUPPLY))
    for name in ("torque_per_voltage", "back_emf", "torque_constant", "resistance", "inertia"):
        assert found[name] == pytest.approx(TRUTH.values[name], rel=0.01), name
    assert found.command_lag == pytest.approx(0.5 * row, rel=0.05)
    assert "held between rows" in found.report(verbose=True)


def test_a_duty_that_is_computed_is_held_too() -> None:
    runs = [
        changed(run, extra={k: v for k, v in run.extra.items() if k != "duty"})
        for run in held_runs(0.005)
    ]
    found = jid.identify_servo(runs, servo_joint(supply=SUPPLY), draws=0)
    assert found["torque_constant"] == pytest.approx(TRUTH.torque_constant, rel=0.01)


def test_a_command_that_moves_evenly_is_not_taken_as_held() -> None:
    found = jid.identify_servo(bench_runs(TRUTH, seed=1), servo_joint())
    assert found.command_lag == 0.0
    assert "nothing shows that it is held" in found.report(verbose=True)
    # What could not be told apart is in the errors.
    assert "command" in found.parameters["torque_constant"].systematic


def test_without_the_position_loop_nothing_is_said_of_the_command() -> None:
    joint = servo_joint(supply=SUPPLY)
    assert joint.voltage is not None
    joint = joint.replace(voltage=replace(joint.voltage, position_loop=None))
    found = jid.identify_servo(held_runs(0.005), joint, draws=0)
    assert found.command_lag is None
    # The bias that the loop takes away.
    assert found["torque_constant"] > 1.05 * TRUTH.torque_constant
