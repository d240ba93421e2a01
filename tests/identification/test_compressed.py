"""The compressed penalty against the direct sum, as `identify` uses them."""

from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from example_recordings import WELL_EXCITED
from numpy.typing import NDArray

import jointid as jid
from jointid import _core
from jointid.identification.search.domain import SearchDomain, domain_for
from jointid.identification.search.run import Engine, Outcome
from jointid.problem.problem import Problem
from jointid.problem.terms import Request, choose_terms

CANDIDATES = 10_000


@dataclass(frozen=True)
class Case:
    model: Any
    residual: str
    asymmetric: bool = False
    ripple: tuple[float, ...] = ()
    joint: bool = True


CASES = [
    Case(model, residual)
    for model in ("coulomb_viscous", "stribeck")
    for residual in ("sensor", "torque")
] + [
    Case("stribeck", "torque", asymmetric=True, joint=False),
    Case("stribeck", "sensor", ripple=(2.0,)),
]


@pytest.fixture(scope="module")
def excited() -> jid.Recording:
    return jid.load(WELL_EXCITED)


def made(recording: jid.Recording, case: Case) -> tuple[_core.Penalty, SearchDomain]:
    joint = jid.thesis_joint() if case.joint else None
    if not case.joint:  # both directions' Coulomb friction and a sensor's offset are one
        recording = jid.Recording(
            time=recording.time,
            position=recording.position,
            velocity=recording.velocity,
            torque=recording.torque,
        )
    model = jid.Model(case.model, asymmetric=case.asymmetric, ripple=case.ripple or None)
    request = Request(model=model, residual=case.residual)
    choice = choose_terms((recording,), joint, request)
    problem = Problem(
        recordings=(recording,),
        joint=joint,
        choice=choice,
    )
    penalty = problem.penalty(None)
    return penalty, domain_for(penalty, joint, None, problem.peak_speed)


def allowed(
    penalty: _core.Penalty, theta: NDArray[np.float64], value: NDArray[np.float64]
) -> NDArray[np.float64]:
    gain: NDArray[np.float64] | float = 1.0
    if penalty.residual == _core.Residual.sensor:
        gain = theta[penalty.names.index("sensor_gain")]
    return np.asarray(1e-10 * value + 1e-14 * float(penalty.target @ penalty.target) / gain**2)


@pytest.mark.parametrize("case", CASES, ids=str)
def test_equals_the_direct_sum(excited: jid.Recording, case: Case) -> None:
    penalty, domain = made(excited, case)
    low, high = domain.lower, domain.upper
    compressed = _core.CompressedPenalty(penalty, low, high)
    assert compressed.exact, compressed.reason
    rng = np.random.default_rng(11)
    share = rng.random((len(low), CANDIDATES))
    theta = low[:, None] + share * (high - low)[:, None]
    best = _core.polish(
        penalty, low, high, _core.minimise_separable(compressed, low, high).best
    ).best
    # A quarter gathers about the optimum, which is the first.
    near = CANDIDATES // 4
    reach = 10.0 ** rng.uniform(-8.0, 0.0, near)
    theta[:, :near] = best[:, None] + reach * (theta[:, :near] - best[:, None])
    theta[:, 0] = best
    theta = np.clip(theta, low[:, None], high[:, None])
    expected = penalty.evaluate(theta)
    found = compressed.evaluate(theta)
    assert (found >= 0.0).all()
    assert np.max(np.abs(found - expected) / allowed(penalty, theta, expected)) <= 1.0


def test_a_candidate_with_a_shape_out_of_bounds_is_refused(excited: jid.Recording) -> None:
    penalty, domain = made(excited, Case("stribeck", "sensor"))
    compressed = _core.CompressedPenalty(penalty, domain.lower, domain.upper)
    theta = np.column_stack([domain.upper, domain.upper])
    theta[-1, 1] *= 1.5
    with pytest.raises(ValueError, match="stribeck must lie within"):
        compressed.evaluate(theta)
    with pytest.raises(ValueError, match="one row per parameter"):
        compressed.evaluate(theta[:3])


def test_falls_back_to_the_direct_sum_and_says_so(excited: jid.Recording) -> None:
    # Shapes below 0 grow with the speed: the even scale of the table does not reach there.
    wide = {"stribeck": {"min": -2.0, "max": 200.0}}
    estimate = jid.identify(excited, jid.thesis_joint(), parameters=wide, search="ga")
    assert "by the direct sum because the bounds of stribeck reach too far below 0" in (
        estimate.message
    )
    usual = jid.identify(excited, jid.thesis_joint(), search="ga")
    assert "direct sum" not in usual.message
    for name in usual.free:
        stderr = usual.parameters[name].stderr
        assert stderr is not None
        assert estimate.parameters[name].value == pytest.approx(
            usual.parameters[name].value, abs=1e-3 * stderr
        )


def test_an_exponent_is_searched_by_the_direct_sum(excited: jid.Recording) -> None:
    search = jid.Search(ga=jid.GaOptions(population=10, generations=2))
    estimate = jid.identify(excited, jid.thesis_joint(), model="stribeck_general", search=search)
    assert "by the direct sum because stribeck_exponent is searched" in estimate.message
    separable = jid.identify(excited, jid.thesis_joint(), model="stribeck_general")
    assert estimate.penalty == pytest.approx(separable.penalty, rel=1e-9)


@pytest.mark.parametrize("corner", ["lower", "upper"])
def test_two_shapes_are_polished_over_their_whole_range(
    excited: jid.Recording, corner: str
) -> None:
    penalty, domain = made(excited, Case("stribeck_general", "sensor"))
    engine = Engine.of(penalty, domain, 0)
    least = _core.minimise_separable(penalty, domain.lower, domain.upper).penalty
    best, _, settled = engine.polished(domain, getattr(domain, corner))
    assert settled
    assert penalty(best) == pytest.approx(least, rel=1e-6)


@pytest.mark.parametrize("found", [None, "worse"])
def test_two_shapes_are_polished_by_the_direct_sum_where_projection_is_no_help(
    excited: jid.Recording, monkeypatch: pytest.MonkeyPatch, found: str | None
) -> None:
    penalty, domain = made(excited, Case("stribeck_general", "sensor"))
    engine = Engine.of(penalty, domain, 0)
    least, steps, _ = engine.polished(domain, domain.lower)  # by projection
    worse = SimpleNamespace(best=domain.lower, penalty=np.inf, evaluations=1)
    result = SimpleNamespace(found=worse if found else None)
    monkeypatch.setattr(_core, "minimise_projected", lambda *_, **__: result)
    best, direct_steps, settled = engine.polished(domain, domain.lower)
    assert settled
    assert direct_steps > steps
    assert penalty(best) == pytest.approx(penalty(least), rel=1e-9)


def test_the_direct_sum_verifies_the_result(excited: jid.Recording) -> None:
    penalty, domain = made(excited, Case("stribeck", "sensor"))
    other, _ = made(excited.crop(0.0, 6.0), Case("stribeck", "sensor"))
    engine = Engine.of(penalty, domain, 1)
    best, _, settled = engine.polished(domain, 0.5 * (domain.lower + domain.upper))
    assert settled
    outcome = Outcome(best=best, convergence=None, status="converged", message="found")
    verified = engine.verified(outcome, domain)
    assert verified == outcome  # not polished again
    assert verified.balance is not None
    assert verified.balance[0] == penalty(best)
    wrong = Engine(direct=other, form=engine.form, reason="")
    polished = wrong.verified(outcome, domain)
    assert "gave another penalty" in polished.message
    assert other(polished.best) <= other(best)
