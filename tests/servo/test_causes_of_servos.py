"""Causes of a servo's misfit: as those of a joint, and none where rows are only late and coarse."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from simulated_servo import Bench, Truth, bench_runs, servo_joint, without_free_runs

import jointid as jid
from jointid.estimate.causes import Cause, Causes
from jointid.identification.causes import causes
from jointid.identification.causes.families import BY_NAME

LOGS = Path(__file__).resolve().parents[1] / "data" / "xl330" / "bam_xl330.csv.gz"


def named(estimate: jid.ServoEstimate) -> list[str]:
    return [each.code for each in estimate.warnings if each.code in BY_NAME]


@pytest.fixture(scope="module")
def runs() -> list[jid.Recording]:
    return bench_runs(seed=1)


def test_friction_of_the_load_that_the_model_lacks_is_named_and_the_advice_runs(
    runs: list[jid.Recording],
) -> None:
    joint = servo_joint()
    plain = jid.Model("coulomb_viscous", load_friction=False)
    found = jid.identify_servo(runs, joint, model=plain, draws=20)
    (told,) = [each for each in found.warnings if each.code in BY_NAME]
    assert told.code == "load_friction"
    assert told.evidence["coefficient"].value == pytest.approx(Truth().load_friction, rel=0.1)
    right = jid.identify_servo(runs, joint, draws=20)
    for name in ("torque_per_voltage", "coulomb"):
        moved = 1.0 + told.evidence[f"{name}.shift"].value
        assert found[name] * moved == pytest.approx(right[name], rel=0.15)
    (advice,) = told.advice
    assert advice.function == "compare_servo_models"
    compared = jid.compare_servo_models(runs, joint, **advice.arguments)
    assert compared.best == "coulomb_viscous:load_friction"
    again = jid.ServoEstimate.from_json(found.to_json())
    assert again.findings == found.findings


@pytest.mark.parametrize(
    ("friction", "cause"),
    [
        (("gaussian", 0.03, 0.03, (1.0,)), "slow_motion"),
        (("linear", 0.006, 0.0, ()), "asymmetry"),
        (("constant", 0.01, 0.0, ()), "offset"),
    ],
)
def test_friction_that_the_model_lacks_is_named(
    friction: tuple[str, float, float, tuple[float, ...]], cause: str
) -> None:
    found = jid.identify_servo(
        bench_runs(seed=1, bench=Bench(friction=(friction,))), servo_joint(), draws=20
    )
    assert named(found) == [cause]
    assert found.verdict.level == "usable with care"


def test_a_run_with_another_load_is_named(runs: list[jid.Recording]) -> None:
    heavy = bench_runs(seed=1, bench=Bench(mass=0.8))[15]
    found = jid.identify_servo([*runs[:15], heavy], servo_joint(), draws=20)
    (told,) = [each for each in found.warnings if each.code in BY_NAME]
    assert told.code == "other_run"
    assert "run 15" in told.title


@pytest.mark.parametrize(("share", "named_so"), [(0.41, ["drift"]), (0.39, [])])
def test_a_small_share_depends_on_the_windows_that_are_kept(
    runs: list[jid.Recording], monkeypatch: pytest.MonkeyPatch, share: float, named_so: list[str]
) -> None:
    cause = Cause(name="drift", share=share, scale=0.1, relative={"viscous": 0.1})
    monkeypatch.setattr(causes, "causes_of", lambda *_: Causes(found=(cause,)))
    plain = jid.Model("coulomb_viscous", load_friction=False)
    assert named(jid.identify_servo(runs, servo_joint(), model=plain, draws=20)) == named_so


@pytest.mark.parametrize("seed", range(3))
def test_a_clean_servo_has_none(seed: int) -> None:
    every = bench_runs(seed=seed)
    for some in (every, without_free_runs(every), every[:4]):
        assert named(jid.identify_servo(some, servo_joint(), draws=20)) == []


def test_a_log_of_a_servo_has_none() -> None:
    """Over the angle, what resembles the known load would take its place."""
    extra = {"duty": "duty", "driven": "torque_enabled", "gain": "firmware_kp"}
    runs = list(jid.load_runs(LOGS, by="run_index", extra=extra))
    assert named(jid.identify_servo(runs, servo_joint(supply=7.3), draws=20)) == []


def test_a_late_duty_does_not_make_friction_negative() -> None:
    runs = [
        run.with_signals(extra={"duty": np.roll(run.extra["duty"], 2)})
        for run in bench_runs(seed=1)
    ]
    found = jid.identify_servo(runs, servo_joint(), draws=20)
    assert "slow_motion" not in {each.code for each in found.warnings}


def test_advice_against_a_constant_torque_is_a_look_at_the_load() -> None:
    bench = Bench(friction=(("constant", 0.01, 0.0, ()),))
    found = jid.identify_servo(bench_runs(seed=1, bench=bench), servo_joint(), draws=20)
    for each in found.findings:
        if each.code == "offset":
            assert [action.kind for action in each.advice] == ["inspect"]
