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
    assert "no evidence that the command is held" in found.report(verbose=True)
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


def sampled_runs(row: float, step: float = 1e-4) -> jid.Recording:
    """A motor without free runs, on a duty that jumps at each row and stands still until the next."""
    k_t, resistance, inertia, viscous, coulomb = 0.9, 3.0, 0.004, 0.02, 0.05
    mass, length, gain, supply = 0.3, 0.12, 6.0, 12.0
    position = velocity = duty = 0.0
    rows = []
    for k in range(round(15.0 / step)):
        t = k * step
        if k % round(row / step) == 0:
            wanted = 0.9 * np.sin(2.2 * t) + 0.5 * np.sin(5.3 * t) + 0.2 * np.sin(11.0 * t)
            duty = float(np.clip(gain * (wanted - position), -1.0, 1.0))
            rows.append((t, position, duty))
        torque = k_t / resistance * (supply * duty - k_t * velocity) - viscous * velocity
        torque -= mass * 9.80665 * length * np.sin(position)
        friction = coulomb * np.sign(velocity) if velocity else np.clip(torque, -coulomb, coulomb)
        after = velocity + step * (torque - friction) / (inertia + mass * length**2)
        velocity = 0.0 if velocity * after < 0.0 and abs(torque) < coulomb else after
        position += step * velocity
    time, positions, duties = np.array(rows).T
    return jid.Recording(time=time, position=positions, extra={"duty": duties})


def test_half_a_row_of_lead_describes_a_duty_that_is_held() -> None:
    link = jid.Link(mass=0.3, centre_of_mass=0.12, angle=-np.pi / 2)
    joint = jid.Joint(link=link, voltage=jid.VoltageDrive(supply=12.0, resistance=3.0))
    run = sampled_runs(0.01)
    found = jid.identify_servo(run, joint, lead=0.005, draws=0)
    for name, value in {"torque_constant": 0.9, "inertia": 0.004, "viscous": 0.02}.items():
        assert found[name] == pytest.approx(value, rel=0.04), name
    # Too large otherwise, as docs/servos.md says.
    assert jid.identify_servo(run, joint, draws=0)["inertia"] == pytest.approx(0.00537, rel=0.03)
