"""Breakaway torque and Stribeck velocity: values, errors by the delta method, and every table shows them."""

import dataclasses
import json
import math

import numpy as np
import pytest
from example_recordings import WELL_EXCITED
from simulated_joint import TRUTH, simulate

import jointid as jid
from jointid.cli.demonstration import data_folder
from jointid.estimate.derived import DerivedValue
from jointid.estimate.wording import number, rounded
from jointid.report.saving import report_page


@pytest.fixture(scope="module")
def estimate() -> jid.Estimate:
    run = jid.load(WELL_EXCITED)
    return jid.identify(run, jid.thesis_joint(), search="separable")


def values(estimate: jid.Estimate) -> dict[str, float]:
    return {name: p.value for name, p in estimate.parameters.items()}


def test_they_follow_from_the_parameters(estimate: jid.Estimate) -> None:
    found, value = estimate.derived, values(estimate)
    assert list(found) == ["breakaway", "stribeck_velocity"]
    assert found["breakaway"].value == value["coulomb"] + value["static"]
    assert found["breakaway"].unit == "N·m"
    assert found["stribeck_velocity"].value == 1.0 / math.sqrt(value["stribeck"])
    assert found["stribeck_velocity"].unit == "rad/s"


def test_errors_are_those_of_a_monte_carlo(estimate: jid.Estimate) -> None:
    mean = [estimate.parameters[name].value for name in estimate.free]
    rng = np.random.default_rng(5)
    # The errors ten times as large, so that a wrong slope could not hide in rounding, and two of them correlated.
    covariance = 100.0 * estimate.covariance
    pair = [estimate.free.index(name) for name in ("coulomb", "static")]
    covariance[pair, :] = covariance[:, pair] = 0.0
    covariance[np.ix_(pair, pair)] = [[0.01, -0.018], [-0.018, 0.04]]
    wide = dataclasses.replace(estimate, covariance=covariance)
    drawn = dict(
        zip(estimate.free, rng.multivariate_normal(mean, covariance, 400_000).T, strict=True)
    )
    samples = {
        "breakaway": drawn["coulomb"] + drawn["static"],
        "stribeck_velocity": 1.0 / np.sqrt(drawn["stribeck"]),
    }
    for name, sample in samples.items():
        assert wide.derived[name].stderr == pytest.approx(float(np.std(sample)), rel=0.01), name
    # Correlation counts: without it the error would be another one.
    assert wide.derived["breakaway"].stderr == pytest.approx(math.sqrt(0.05 - 0.036))


def test_intervals_hold_the_truth_of_simulated_runs() -> None:
    found = [
        jid.identify(run, jid.thesis_joint(), search="separable").derived
        for run in simulate(16, duration=6.0, seed=21)
    ]
    truths = {
        "breakaway": TRUTH["coulomb"] + TRUTH["static"],
        "stribeck_velocity": TRUTH["stribeck"] ** -0.5,
    }
    for name, truth in truths.items():
        intervals = [each[name].interval for each in found]
        inside = sum(each is not None and each[0] <= truth <= each[1] for each in intervals)
        assert inside >= 12, name
        spread = float(np.std([each[name].value for each in found], ddof=1))
        errors = float(np.mean([each[name].stderr or np.nan for each in found]))
        assert 0.5 * spread < errors < 2.0 * spread, name


def one(estimate: jid.Estimate, name: str) -> DerivedValue:
    return estimate.derived[name]


def test_the_interval_has_the_factor_of_its_parameter(estimate: jid.Estimate) -> None:
    # Quantile and systematic parts are in it, not in the error of chance.
    p, found = estimate.parameters["stribeck"], one(estimate, "stribeck_velocity")
    assert p.interval is not None
    assert found.interval is not None
    assert (found.interval[1] - found.value) / (found.stderr or 1.0) == pytest.approx(
        (p.interval[1] - p.value) / (p.stderr or 1.0)
    )


def test_each_direction_has_its_own() -> None:
    run = jid.load(data_folder() / "kr300_joint1.csv.gz")
    joint = jid.Joint(torque_offset=False)
    estimate = jid.identify(
        run, joint, model=jid.Model.parse("stribeck:asymmetric"), search="separable"
    )
    found, value = estimate.derived, values(estimate)
    breakaway = ["breakaway_positive", "breakaway_negative"]
    assert list(found) == [*breakaway, "coulomb_sum", "stribeck_velocity"]
    for side in ("positive", "negative"):
        expected = value[f"coulomb_{side}"] + value[f"static_{side}"]
        assert found[f"breakaway_{side}"].value == expected
    assert "breakaway friction, positive" in estimate.report(verbose=True)
    assert "static_positive (above Coulomb)" in estimate.report(verbose=True)


def test_what_a_model_lacks_is_not_derived() -> None:
    run = jid.load(WELL_EXCITED)
    plain = jid.identify(run, jid.thesis_joint(), model="coulomb_viscous", search="separable")
    assert plain.derived == {}
    general = jid.identify(run, jid.thesis_joint(), model="stribeck_general", search="separable")
    assert list(general.derived) == ["breakaway"]
    assert "stribeck_velocity" in general.parameters


def test_a_parameter_at_a_bound_leaves_no_error(estimate: jid.Estimate) -> None:
    run = jid.load(WELL_EXCITED)
    fixed = {"static": 20.0, "stribeck": 100.0}
    found = jid.identify(run, jid.thesis_joint(), parameters=fixed, search="separable")
    assert one(found, "breakaway").stderr == found.parameters["coulomb"].stderr  # static is known
    assert one(found, "stribeck_velocity").stderr is None  # and so is this
    bound = {"static": {"min": 5.0, "max": 15.0}}
    held = jid.identify(run, jid.thesis_joint(), parameters=bound, search="separable")
    assert held.parameters["static"].at_bound == "max"
    assert one(held, "breakaway").stderr is None
    assert one(held, "breakaway").interval is None
    unknown = dataclasses.replace(estimate, covariance=np.full_like(estimate.covariance, np.inf))
    assert one(unknown, "breakaway").stderr is None


def test_every_table_shows_them(estimate: jid.Estimate) -> None:
    found = estimate.derived
    shown = {"breakaway": "= coulomb + static", "Stribeck velocity": "= 1/√stribeck"}
    for text in (estimate.report(verbose=True), estimate._repr_html_(), report_page(estimate)):
        assert "static (above Coulomb)" in text
        for name, formula in shown.items():
            assert name in text
            assert formula in text
        value, stderr = found["breakaway"].value, found["breakaway"].stderr
        assert stderr is not None
        assert f">{rounded(value, stderr)} ± " in text or number(value) in text
    saved = json.loads(estimate.to_json())["derived"]["breakaway"]
    assert saved["value"] == found["breakaway"].value
    assert saved["stderr"] == found["breakaway"].stderr
    assert jid.Estimate.from_json(estimate.to_json()).derived == found
