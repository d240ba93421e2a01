"""Friction that drifts: named, and taken away before the other values are estimated."""

import pickle
from dataclasses import replace

import numpy as np
import pytest
from plants import Bench, Law, Plant, simulate, thesis

import jointid as jid
from jointid.identification.drift import may_drift
from jointid.identification.follow_up import EstimateSource
from jointid.identification.gain import penalty_as_fitted

DRIFTS = np.array([-0.3, -0.2, 0.0])


@pytest.fixture(scope="module")
def runs() -> list[jid.Recording]:
    """Joints whose viscous friction drifts by so much, and one that another axis moves, too."""
    count = len(DRIFTS)
    plant = Plant(inertia=1.8, link_inertia=0.2, gravity=5.0, viscous_drift=DRIFTS)
    law = Law(inertia=1.8, stiffness=60.0, on_reference=1.0, coulomb=20.0, feedback=2.0)
    drifting = Bench(motion=thesis(np.full(count, np.radians(60.0))), plant=plant, law=law)
    coupled = Bench(
        motion=thesis(np.radians([60.0])),
        plant=Plant(viscous_drift=-0.3, coupling=1.5, coupling_rate=5.0),
        law=replace(law, inertia=2.5),
    )
    return simulate(Bench.stack([drifting, coupled]), duration=9.0, seed=1, finer=3)


@pytest.fixture(scope="module")
def found(runs: list[jid.Recording]) -> list[jid.Estimate]:
    """Estimates of those that drift."""
    joint = jid.Joint(inertia=1.8, sensor=True, model=jid.Model("stribeck"))
    return [jid.identify(run, joint, search="separable") for run in runs[: len(DRIFTS)]]


def test_a_drift_does_not_move_what_is_steady(found: list[jid.Estimate]) -> None:
    truth = Plant()
    for estimate, drift in zip(found[:2], DRIFTS, strict=False):
        (finding,) = estimate.warnings
        assert finding.code == "drift"
        assert finding.parameters == ("viscous",)
        assert finding.evidence["change"].value == pytest.approx(
            drift / (1.0 + 0.5 * drift), rel=0.05
        )
        assert estimate.settings["drift_removed"] == "viscous"
        values = {name: each.value for name, each in estimate.parameters.items()}
        assert values["sensor_gain"] == pytest.approx(2.4, rel=0.005)
        assert values["coulomb"] == pytest.approx(truth.coulomb, rel=0.003)
        assert values["viscous"] == pytest.approx(truth.viscous * (1.0 + 0.5 * drift), rel=0.005)


def test_steady_friction_is_left_as_it_is(found: list[jid.Estimate]) -> None:
    assert not found[2].warnings
    assert "drift_removed" not in found[2].settings


def test_models_are_compared_without_a_drift(found: list[jid.Estimate]) -> None:
    for estimate, removed in ((found[0], "viscous"), (found[2], None)):
        source = estimate.follow_up
        assert isinstance(source, EstimateSource)
        joint = jid.Joint(inertia=1.8, sensor=True)
        models = ("coulomb_viscous", "stribeck")
        compared = jid.compare_models(source.given, joint, models=models)
        assert compared.winner == "stribeck"
        for row in compared.rows:
            alone = jid.identify(source.given, joint, model=row.spec, search="separable")
            assert row.penalty == alone.penalty
        assert compared.estimate.findings == estimate.findings
        assert compared.estimate.settings.get("drift_removed") == removed


def test_drifts_alone_tell_whether_one_may_be_taken_away(found: list[jid.Estimate]) -> None:
    for estimate, may in ((found[0], True), (found[2], False)):
        source = estimate.follow_up
        assert isinstance(source, EstimateSource)
        problem = replace(source.problem, recordings=source.given)
        penalty = penalty_as_fitted(problem, source.windows, source.domain)
        fitted = jid.identify(source.given, problem.joint, search="separable")
        assert may_drift(problem, penalty, fitted.parameters) is may


def test_what_is_asked_later_knows_of_the_drift(found: list[jid.Estimate]) -> None:
    estimate = found[0]
    assert [each.name for each in estimate.causes().found] == ["drift"]
    assert "the values are valid in mid-recording" in estimate.causes().found[0].effect
    gain = estimate.bootstrap(n=50).parameters["sensor_gain"]
    assert gain.interval[0] == pytest.approx(2.4, rel=0.01)
    assert pickle.loads(pickle.dumps(estimate)).findings == estimate.findings


def test_causes_are_those_of_the_data_that_were_fitted(runs: list[jid.Recording]) -> None:
    run = runs[-1]
    joint = jid.Joint(inertia=2.5, sensor=True, model=jid.Model("stribeck"))
    estimate = jid.identify(run, joint, search="separable")
    assert estimate.settings["drift_removed"] == "viscous"
    other = np.sin(5.0 * run.time + run.metadata["plant"]["coupling_phase"])
    drift, coupling = estimate.causes({"other axis": other}).found
    assert (drift.name, drift.detail) == ("drift", "viscous")
    # Of the misfit that the fit left: beside the drift it would be a small part.
    assert (coupling.name, coupling.detail) == ("other_signal", "other axis")
    assert coupling.share > 0.8
