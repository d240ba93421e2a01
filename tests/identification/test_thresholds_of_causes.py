"""Both sides of the thresholds of findings that name a cause, and of what one finding leaves of another."""

from __future__ import annotations

import dataclasses
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from fake_evidence import evidence, found, parameter

import jointid as jid
from jointid.base.advice import Action
from jointid.estimate.causes import Cause, Causes
from jointid.estimate.delays import Delay
from jointid.estimate.findings import Finding, Measured
from jointid.identification.warnings import diagnosis, registry
from jointid.identification.warnings.check import Check


def _shifted(delay: float, period: float) -> Any:
    time = np.arange(200) * period
    run = jid.Recording(time=time, position=np.sin(time), torque=np.cos(time))
    given = evidence(recordings=(run,))
    given.problem.shift = {"sensor": delay}
    return given


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize(("period", "limit"), [(1e-3, 0.1), (0.01, 0.2)])
def test_a_delay_is_long_in_seconds_and_in_samples(
    period: float, limit: float, sign: float
) -> None:
    assert found("long_shift", _shifted(sign * 0.99 * limit, period)) == []
    (said,) = found("long_shift", _shifted(sign * 1.01 * limit, period))
    assert f"({1.01 * limit / period:.0f} samples)" in said.title
    assert said.advice[0].arguments == {"shift": {"sensor": pytest.approx(1.01e-3 * sign * limit)}}


def _cause(name: str = "drift", share: float = 0.5, **other: Any) -> Cause:
    return Cause(name=name, share=share, scale=0.1, harmful=True, **other)


def _named(*causes: Cause, free: Any = (), **given: Any) -> Any:
    return evidence(*free, causes=Causes(found=causes, tried=("drift",)), **given)


@pytest.mark.parametrize(
    ("name", "r_squared", "left", "severity"),
    [
        ("wrong_scale", -0.01, 0.101, "blocking"),
        ("wrong_scale", -0.01, 0.099, "warning"),  # nearly all of the torque is explained
        ("wrong_scale", 0.01, 0.101, "warning"),  # better than the mean
        ("drift", -0.01, 0.101, "warning"),
    ],
)
def test_a_scale_blocks_where_the_mean_explains_more(
    name: str, r_squared: float, left: float, severity: str
) -> None:
    residuals = {"r_squared": r_squared, "relative": left**0.5}
    cause = _cause(name, numbers={"ratio": Measured(1.1)})
    (said,) = found("causes", _named(cause, residuals=residuals))
    assert said.severity == severity


@pytest.mark.parametrize(
    ("ratio", "severity"),
    [
        *((1.49, "warning"), (1.51, "blocking"), (0.67, "warning"), (0.66, "blocking")),
        (-1.0, "blocking"),
    ],
)
def test_a_scale_that_is_grossly_wrong_blocks_whatever_is_explained(
    ratio: float, severity: str
) -> None:
    cause = _cause("wrong_scale", numbers={"ratio": Measured(ratio)})
    (said,) = found("causes", _named(cause, residuals={"r_squared": 0.9, "relative": 0.01}))
    assert said.severity == severity


@pytest.mark.parametrize("harmful", [True, False])
@pytest.mark.parametrize(("certain", "said"), [(True, False), (False, True)])
def test_a_delay_that_has_its_own_finding_is_no_cause_beside_it(
    harmful: bool, certain: bool, said: bool
) -> None:
    late = _cause("delay", detail="sensor")
    delay = Delay(signal="sensor", value=1e-3, stderr=1e-6, certain=certain, fits=True, applied=0.0)
    given = _named(late, delays={"sensor": delay}, residuals={"relative": 0.0})
    if not harmful:
        given.causes = Causes(found=(), harmless=(late,), tried=("delay",))
    assert bool(found("causes", given)) == said


def test_the_first_cause_alone_makes_wide_values_uncertain() -> None:
    wide = parameter("viscous", 1.0, 0.5)
    causes = (_cause("drift"), _cause("harmonic"))
    velocity = np.ones(1000)
    table = SimpleNamespace(
        velocity=velocity, duration=np.full(1000, 0.01), recording=np.zeros(1000, dtype=int)
    )
    given = _named(*causes, free=(wide,), residuals={"relative": 0.0}, table=table)
    first, second = found("causes", given)
    assert first.parameters == ("viscous",)
    assert second.parameters == ()


# --- What one finding leaves of another ---


def _said(code: str, severity: Any = "warning", **other: Any) -> Finding:
    return Finding(code=code, severity=severity, title=code, **other)


@dataclasses.dataclass(frozen=True)
class _Given:
    causes: Any = None


def _diagnosed(monkeypatch: pytest.MonkeyPatch, *said: Finding, causes: Any = None) -> list[str]:
    monkeypatch.setattr(registry, "CHECKS", (Check(lambda _: iter(said), ()),))
    return [each.code for each in diagnosis.diagnose(_Given(causes))]  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("causes", "told"),
    [
        ((), True),
        ((_cause(share=0.499),), True),
        ((_cause(share=0.501),), False),
        ((_cause(share=0.501), _cause("ripple", 0.1)), True),
    ],
)
def test_ripple_is_not_told_beside_what_explains_most(
    causes: tuple[Cause, ...], told: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    said = _diagnosed(monkeypatch, _said("ripple"), causes=SimpleNamespace(found=causes))
    assert ("ripple" in said) == told


def test_a_wrong_unit_is_told_once_and_hides_ripple(monkeypatch: pytest.MonkeyPatch) -> None:
    unit = _said("implausible_units", "blocking")
    other = dataclasses.replace(unit, title="another")
    assert _diagnosed(monkeypatch, unit, _said("ripple"), other) == ["implausible_units"]


def test_the_most_severe_stands_first(monkeypatch: pytest.MonkeyPatch) -> None:
    said = (_said("gaps", "info"), _said("standing"), _said("velocity", "blocking"))
    assert _diagnosed(monkeypatch, *said) == ["velocity", "standing", "gaps"]


def test_without_motion_values_are_not_spoken_of(monkeypatch: pytest.MonkeyPatch) -> None:
    said = (_said("hardly_moves"), _said("gaps"), _said("undetermined"))
    assert _diagnosed(monkeypatch, *said) == ["hardly_moves", "gaps"]


def test_what_its_own_check_has_raised_is_not_told_again(monkeypatch: pytest.MonkeyPatch) -> None:
    again = _said("ripple", evidence={"share": Measured(0.2)})
    assert _diagnosed(monkeypatch, _said("ripple"), again) == ["ripple"]
    assert _diagnosed(monkeypatch, again, _said("standing")) == ["ripple", "standing"]
    # One code for two parameters: neither rests on the share that a cause explains.
    assert _diagnosed(monkeypatch, _said("at_bound"), _said("at_bound")) == ["at_bound"] * 2


@pytest.mark.parametrize(("severity", "told"), [("blocking", False), ("warning", True)])
def test_a_signal_that_cannot_be_right_is_the_cause(
    severity: str, told: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    signal = Check(lambda _: iter([_said("reversed_sign", severity)]), ())
    cause = Check(lambda given: iter([_said("drift")] if given.causes else []), ())
    monkeypatch.setattr(registry, "CHECKS", (signal, cause))
    causes = SimpleNamespace(found=(_cause(),))
    said = diagnosis.diagnose(_Given(causes))  # type: ignore[arg-type]
    assert ("drift" in {each.code for each in said}) == told


@pytest.mark.parametrize(("severity", "kept"), [("blocking", 2), ("warning", 3)])
def test_values_that_cannot_be_used_are_not_fitted_again(
    severity: str, kept: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A blocking finding itself may say how: with the other sign, the fit is of use."""
    advice = (
        Action("call", {"windows": 12}, function="identify"),
        Action("call", {"columns": {"velocity": None}}, function="load"),
        Action("inspect", text="the wiring"),
    )
    said = (_said("reversed_sign", severity, advice=advice), _said("few_windows", advice=advice))
    monkeypatch.setattr(registry, "CHECKS", (Check(lambda _: iter(said), ()),))
    first, second = diagnosis.diagnose(_Given())  # type: ignore[arg-type]
    assert first.advice == advice
    assert len(second.advice) == kept


@pytest.mark.parametrize(
    ("ratio", "signal", "said"),
    [
        *((1.0, "current", True), (1.0, "motor_torque", True), (1.0, "torque", False)),
        *((50.0, "current", False), (-1.0, "motor_torque", False), (None, "current", False)),
    ],
)
def test_a_torque_of_the_motor_without_a_gear_is_told(
    ratio: float | None, signal: str, said: bool
) -> None:
    time = np.arange(200) * 1e-3
    run = jid.Recording(time=time, position=np.sin(time), **{signal: np.cos(time)})
    joint = None if ratio is None else jid.Joint(gear_ratio=ratio, torque_constant=0.1)
    findings = found("motor_side", evidence(recordings=(run,), joint=joint))
    assert [each.severity for each in findings] == ["info"] * said
