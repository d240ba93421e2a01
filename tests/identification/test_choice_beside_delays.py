"""The choice of a model where a delay leaves a misfit that a richer model fits in part."""

import re
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import jointid as jid
from jointid.identification.causes.families import against_delay
from jointid.identification.chosen_model import unfit_in
from jointid.identification.prepared import prepare
from jointid.problem.settings import Settings

SIDES = ("positive", "negative")


def simulated(index: int) -> jid.Recording:
    """Coulomb and viscous friction; the torque is held, but the log says linear: it seems half a sample early."""
    rng = np.random.default_rng(3)
    for _ in range(index + 1):
        rate = rng.uniform([0.15, 0.4, 0.8], [0.3, 0.7, 1.2])
        phase = rng.uniform(0, 6, 3)
    time = np.arange(0.0, 10.0001, 0.002)
    angle = np.array([0.5, 0.3, 0.1]) @ np.sin(2.0 * np.pi * np.outer(rate, time) + phase[:, None])
    joint = jid.Joint(inertia=1.0 + 0.3 * index, model=jid.Model("coulomb_viscous"))
    run = jid.simulate(
        joint.with_parameters({"coulomb": 4.0 + 3.0 * index, "viscous": 5.0 + 2.0 * index}),
        jid.Pd(stiffness=3000.0, damping=200.0),
        jid.Trajectory.from_samples(time, angle - angle[0]),
        sensors=jid.Sensors(torque_noise=0.1),
        control_period=0.002,
        seed=index,
    )
    return jid.Recording(
        time=run.time,
        position=run.position,
        velocity=run.velocity,
        torque=run.torque,
        torque_hold="linear",
    )


@pytest.fixture(scope="module")
def held() -> jid.Recording:
    return simulated(5)


@pytest.fixture(scope="module")
def found(held: jid.Recording) -> jid.Estimate:
    return jid.identify(held, search="separable")


def test_the_race_is_run_again_without_the_delay(found: jid.Estimate) -> None:
    assert found.delays["torque"].applied == pytest.approx(-1e-3, abs=1e-4)
    assert found.settings["model"] == found.joint.model.name == "coulomb_viscous"
    assert found.selection is not None
    assert found.selection.model == "coulomb_viscous"
    # Scores without the delay, ten times smaller than those with it.
    assert found.selection["coulomb_viscous"].score < 3e-4
    assert not {"model_too_rich", "undetermined", "at_bound"} & {f.code for f in found.findings}
    assert found.parameters["coulomb"].value == pytest.approx(19.0, rel=1e-3)
    assert found.parameters["viscous"].value == pytest.approx(15.0, rel=1e-3)


def test_a_model_that_its_fit_does_not_support_gives_way(held: jid.Recording) -> None:
    stribeck = prepare((held,), None, choose=True, unfit={"coulomb_viscous": "it is too simple"})
    assert stribeck.selection is not None
    assert stribeck.selection["coulomb_viscous"].refused == "it is too simple"
    assert stribeck.selection.model != "coulomb_viscous"


def test_the_fit_obeys_the_rule(
    held: jid.Recording, found: jid.Estimate, monkeypatch: pytest.MonkeyPatch
) -> None:
    rich = jid.identify(held, model="stribeck", search="separable")
    chosen = replace(rich, selection=found.selection)
    assert unfit_in(found) == unfit_in(rich) == ""  # it fits; it was not chosen
    assert "static is" in unfit_in(chosen)
    # The race itself is wrong: only the fit shows it.
    monkeypatch.setattr("jointid.identification.chosen_model._close", lambda _: False)
    plain = jid.identify(held, search="separable")
    assert plain.settings["model"] == "coulomb_viscous"
    assert plain.selection is not None
    assert plain.selection.model == "coulomb_viscous"
    assert "static is" in plain.selection["stribeck"].refused
    assert not any(finding.code == "model_too_rich" for finding in plain.findings)


def test_what_is_itself_uncertain_is_said_in_its_errors(held: jid.Recording) -> None:
    rich = jid.identify(held, model="stribeck", search="separable")
    static = rich.parameters["static"]
    assert static.stderr is not None
    assert static.stderr > abs(static.value)
    notes = [each.cause for each in rich.findings if "no parameter noticeably" in each.cause]
    assert any(
        re.search(r"static, itself uncertain, by 0\.\d+ of its standard error", n) for n in notes
    )
    assert not any(re.search(r"static by .\d", n) for n in notes)


def test_a_sum_that_is_known_says_where_its_width_is_from(held: jid.Recording) -> None:
    found = jid.identify(
        held, model=jid.Model.parse("coulomb_viscous:asymmetric"), search="separable"
    )
    both = found.derived["coulomb_sum"]
    lags = [found.parameters[f"coulomb_{side}"].systematic["lag"] for side in SIDES]
    assert both.largest_part == "lag"
    assert both.stderr is not None
    assert both.interval is not None
    # The parts of its parameters, not the most uncertain interval of the others.
    assert max(lags) / 2.0 < both.systematic_total < 1.01 * sum(lags)
    half = 0.5 * (both.interval[1] - both.interval[0])
    assert half == pytest.approx(2.0 * np.hypot(both.stderr, both.systematic_total), rel=0.1)
    assert both.interval[0] < 38.0 < both.interval[1]
    (line,) = [
        each for each in found.report(verbose=True).splitlines() if each.startswith("coulomb_sum")
    ]
    assert "(lag)" in line


@pytest.mark.parametrize(
    ("early", "torque_hold", "proposed"),
    [(0.55, None, True), (0.55, "zoh", False), (0.0, None, False), (1.0, None, False)],
)
def test_a_held_torque_is_proposed(
    early: float, torque_hold: str | None, proposed: bool, held: jid.Recording
) -> None:
    """A torque early by half a sample is a held one; by no time, or held already, it is not."""
    settings = Settings.of({"torque_hold": torque_hold, "model": "coulomb_viscous"})
    problem = prepare((held,), None, settings).problem
    late = -early * held.sample_period
    fit = SimpleNamespace(sample_period=held.sample_period, torque_held=problem.hold(0) == "zoh")
    cause = SimpleNamespace(
        candidate=SimpleNamespace(name="delay", detail="torque"), coefficients=np.array([late])
    )
    advice = against_delay(fit, cause)  # type: ignore[arg-type]
    calls = [dict(each.arguments) for each in advice if each.kind == "call"]
    assert calls == ([{"torque_hold": "zoh"}] if proposed else [])
    assert advice[-1].kind == "inspect"
