"""A servo without a torque signal is identified from duty and position, and what cannot be known is said."""

from dataclasses import replace

import numpy as np
import pytest
from simulated_servo import (
    ROW,
    Truth,
    bench_runs,
    changed,
    servo_joint,
    with_truth,
    without_free_runs,
)

import jointid as jid
from jointid.servo.findings import findings_of
from jointid.servo.layout import LAYOUTS
from jointid.servo.solving import Unknowns

TRUTH = Truth()
DIVIDED = Unknowns(
    layout=LAYOUTS["coulomb_viscous"],
    separable=True,
    load_friction=True,
    held=False,
    torque_constant=None,
    resistance=None,
    fixed={},
)


@pytest.fixture(scope="module")
def runs() -> list[jid.Recording]:
    return bench_runs(TRUTH, seed=1)


@pytest.fixture(scope="module")
def estimate(runs: list[jid.Recording]) -> jid.ServoEstimate:
    return jid.identify_servo(runs, servo_joint())


def codes(estimate: jid.ServoEstimate) -> dict[str, set[str]]:
    found: dict[str, set[str]] = {}
    for each in estimate.findings:
        found.setdefault(each.code, set()).update(each.parameters)
    return found


def test_the_truth_is_found_from_late_coarse_rows_that_are_not_simultaneous(
    estimate: jid.ServoEstimate,
) -> None:
    limits = {
        "torque_per_voltage": 0.02,
        "load_friction": 0.05,
        "inertia": 0.03,
        "torque_constant": 0.06,
        "resistance": 0.06,
        "coulomb": 0.1,
    }
    for name, limit in limits.items():
        assert estimate[name] == pytest.approx(TRUTH.values[name], rel=limit), name
    assert estimate.lead == pytest.approx(ROW, abs=4e-4)
    assert estimate.lead_found


def test_intervals_hold_the_truth_and_are_not_idle(estimate: jid.ServoEstimate) -> None:
    for name in ("torque_per_voltage", "load_friction", "coulomb", "torque_constant"):
        low, high = estimate.parameters[name].interval or (np.nan, np.nan)
        assert low <= TRUTH.values[name] <= high
    low, high = estimate.parameters["torque_per_voltage"].interval or (np.nan, np.nan)
    assert (high - low) / TRUTH.values["torque_per_voltage"] < 0.02


def test_the_logged_velocity_is_not_used(
    runs: list[jid.Recording], estimate: jid.ServoEstimate
) -> None:
    """It lags by 20 ms."""
    other = [changed(run, velocity=np.zeros(len(run.time))) for run in runs]
    assert (jid.identify_servo(other, servo_joint()).values == estimate.values).all()


def test_the_supply_may_be_one_number(runs: list[jid.Recording]) -> None:
    found = jid.identify_servo(runs, servo_joint(supply=7.2))
    assert found["torque_per_voltage"] == pytest.approx(
        TRUTH.values["torque_per_voltage"], rel=0.05
    )


def test_the_position_loop_gives_the_duty_that_is_not_logged(runs: list[jid.Recording]) -> None:
    bare = [changed(run, extra={k: v for k, v in run.extra.items() if k != "duty"}) for run in runs]
    found = jid.identify_servo(bare, servo_joint())
    for name, limit in (("torque_per_voltage", 0.03), ("load_friction", 0.08), ("inertia", 0.06)):
        assert found[name] == pytest.approx(TRUTH.values[name], rel=limit), name


def test_without_free_runs_the_motor_is_said_to_be_unknown(runs: list[jid.Recording]) -> None:
    found = jid.identify_servo(without_free_runs(runs), servo_joint())
    assert codes(found)["inseparable_back_emf"] == {
        "back_emf",
        "viscous",
        "torque_constant",
        "resistance",
    }
    assert found.parameters["torque_constant"].stderr == np.inf
    # Their sum, and k_t / R, are known all the same.
    total = TRUTH.values["back_emf"] + TRUTH.viscous
    assert found["back_emf"] + found["viscous"] == pytest.approx(total, rel=0.03)
    assert found["torque_per_voltage"] == pytest.approx(
        TRUTH.values["torque_per_voltage"], rel=0.02
    )
    assert "k_t" in found.report(verbose=True)


@pytest.mark.parametrize("given", ["resistance", "torque_constant", "both"])
def test_a_known_motor_divides_back_emf_from_friction(
    given: str, runs: list[jid.Recording]
) -> None:
    joint = servo_joint(resistance=None if given == "torque_constant" else TRUTH.resistance)
    if given != "resistance":
        joint = joint.replace(torque_constant=TRUTH.torque_constant)
    found = jid.identify_servo(without_free_runs(runs), joint)
    assert "inseparable_back_emf" not in codes(found)
    assert found["torque_constant"] == pytest.approx(TRUTH.torque_constant, rel=0.02)
    assert found["resistance"] == pytest.approx(TRUTH.resistance, rel=0.02)
    assert found["viscous"] == pytest.approx(TRUTH.viscous, rel=0.25)


def test_friction_that_is_not_there_ends_on_its_bound() -> None:
    runs = bench_runs(replace(TRUTH, coulomb=0.0, load_friction=0.2), seed=3)
    found = jid.identify_servo(runs, servo_joint())
    if found["coulomb"] == 0.0:
        assert "coulomb" in codes(found)["at_bound"]
    else:
        low, _ = found.parameters["coulomb"].interval or (np.nan, np.nan)
        assert low == 0.0
    plain = jid.identify_servo(
        bench_runs(replace(TRUTH, load_friction=0.0), seed=3),
        servo_joint(),
        model="coulomb_viscous",
    )
    assert plain["load_friction"] == pytest.approx(0.0, abs=0.01)


def test_a_fixed_parameter_stays(runs: list[jid.Recording]) -> None:
    joint = servo_joint().replace(
        inertia=TRUTH.inertia,
        parameters={"coulomb": jid.Parameter(name="coulomb", value=0.01, vary=False)},
    )
    found = jid.identify_servo(runs, joint)
    assert (found["inertia"], found["coulomb"]) == (TRUTH.inertia, 0.01)
    assert found.parameters["coulomb"].stderr is None
    assert found["torque_per_voltage"] == pytest.approx(
        TRUTH.values["torque_per_voltage"], rel=0.02
    )


def test_the_same_seed_gives_the_same_bits(
    runs: list[jid.Recording], estimate: jid.ServoEstimate
) -> None:
    again = jid.identify_servo(runs, servo_joint())
    assert np.array_equal(again.draws, estimate.draws)
    other = jid.identify_servo(runs, servo_joint(), seed=1)
    assert not np.array_equal(other.draws, estimate.draws)


def test_one_run_is_resampled_by_its_stretches(runs: list[jid.Recording]) -> None:
    found = jid.identify_servo(runs[4], servo_joint())
    assert 0.0 < (found.parameters["torque_per_voltage"].stderr or 0.0) < 0.05


def test_what_is_missing_is_named(runs: list[jid.Recording]) -> None:
    joint = servo_joint()
    assert joint.voltage is not None
    no_supply = [
        changed(run, extra={k: v for k, v in run.extra.items() if k != "supply"}) for run in runs
    ]
    with pytest.raises(jid.InputError, match="supply"):
        jid.identify_servo(no_supply, joint)
    bare = joint.replace(voltage=replace(joint.voltage, position_loop=None, supply=7.4))
    no_duty = [changed(run, extra={}) for run in runs]
    with pytest.raises(jid.InputError, match="duty"):
        jid.identify_servo(no_duty, bare)
    with pytest.raises(jid.InputError, match="voltage"):
        jid.identify_servo(runs, joint.replace(voltage=None))
    with pytest.raises(jid.InputError, match="stribeck"):
        jid.identify_servo(runs, joint, model="stribeck")
    with pytest.raises(jid.InputError, match="more motion"):
        jid.identify_servo(runs, joint, slowest=1e3)
    changing = changed(
        runs[0], extra={**runs[0].extra, "gain": np.linspace(1.0, 2.0, len(runs[0].time))}
    )
    with pytest.raises(jid.InputError, match="changes within a run"):
        jid.identify_servo(changing, joint)


def test_a_duty_in_percent_is_refused(runs: list[jid.Recording]) -> None:
    percent = [changed(r, extra={**r.extra, "duty": 100.0 * r.extra["duty"]}) for r in runs]
    with pytest.raises(
        jid.InputError, match=r"duty: the duty reaches .*, but 1 is .* duty_scale = 0\.01"
    ):
        jid.identify_servo(percent, servo_joint(), draws=0)
    joint = servo_joint()
    assert joint.voltage is not None
    scaled = joint.replace(voltage=replace(joint.voltage, duty_scale=0.01))
    found = jid.identify_servo(percent, scaled, draws=0)
    assert found["torque_per_voltage"] == pytest.approx(
        TRUTH.values["torque_per_voltage"], rel=0.02
    )


def test_the_cause_comes_before_its_effects(runs: list[jid.Recording]) -> None:
    degrees = [changed(r, position=np.degrees(r.position)) for r in runs]
    first = jid.identify_servo(degrees, servo_joint()).warnings[0]
    assert first.code == "poor_fit"
    assert "the position's unit" in str(first.advice[0])


def test_a_servo_is_refused_where_a_torque_is_needed(runs: list[jid.Recording]) -> None:
    with pytest.raises(jid.InputError, match="identify the recordings of this joint separately"):
        jid.sweep(runs, servo_joint(), grid={"windows": [100]}, trials=1)


def test_without_a_load_the_scale_is_unknown(runs: list[jid.Recording]) -> None:
    found = jid.identify_servo(runs, servo_joint().replace(link=None))
    assert any(each.code == "no_known_load" for each in found.warnings)


def test_the_identified_joint_has_the_values(estimate: jid.ServoEstimate) -> None:
    joint = estimate.identified
    assert joint.voltage is not None
    assert joint.torque_constant == estimate["torque_constant"]
    assert joint.voltage.resistance == estimate["resistance"]
    assert joint.inertia == estimate["inertia"]
    assert joint.parameters["load_friction"].value == estimate["load_friction"]
    again = jid.identify_servo(bench_runs(TRUTH, seed=1), with_truth(TRUTH, servo_joint()))
    assert again["torque_constant"] == TRUTH.torque_constant


def test_the_verdict_minds_wide_intervals_and_missing_errors(
    runs: list[jid.Recording], estimate: jid.ServoEstimate
) -> None:
    assert estimate.verdict.level == "usable"
    wide = dict(estimate.parameters)
    value = wide["inertia"].value
    wide["inertia"] = replace(wide["inertia"], interval=(0.7 * value, 1.3 * value))
    vague = replace(estimate, parameters=wide)
    found = [each for each in findings_of(vague, DIVIDED) if each.code == "undetermined"]
    assert [each.parameters for each in found] == [("inertia",)]
    bare = jid.identify_servo(runs, servo_joint(), draws=0)
    assert bare.verdict.level == "usable with care"
    assert "errors were not requested" in bare.verdict.reasons[0]


def test_without_a_link_no_swing_is_claimed(runs: list[jid.Recording]) -> None:
    found = jid.identify_servo(without_free_runs(runs), replace(servo_joint(), link=None))
    (said,) = (each for each in found.findings if each.code == "inseparable_back_emf")
    assert "free swing from other shares" not in said.cause
    assert "because no load swings freely" in said.cause
