"""Both sides of the thresholds of findings about values: how certain, how well moved, in which balance."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from fake_evidence import TIME, evidence, found, inspected, parameter

import jointid as jid
from jointid.balance.covariance import Triangle
from jointid.estimate.causes import Causes
from jointid.estimate.findings import TITLE, Finding
from jointid.estimate.statistics import ParameterEstimate
from jointid.identification.warnings import torque_balance, unbounded
from jointid.identification.warnings.evidence import Regressor
from jointid.identification.warnings.excitation import Excitation
from jointid.identification.warnings.unbounded import Unbounded
from jointid.identification.warnings.undetermined import listed
from jointid.problem.terms import WEAK_READING

_BACK_AND_FORTH = np.where(np.arange(1000) // 100 % 2 == 0, 1.0, -1.0)


def _windows(velocity: Any) -> Any:
    velocity = np.asarray(velocity, dtype=float)
    return SimpleNamespace(
        velocity=velocity,
        duration=np.full(velocity.size, 0.01),
        recording=np.zeros(velocity.size, dtype=int),
    )


def _moved(*parameters: ParameterEstimate, velocity: Any = _BACK_AND_FORTH, **given: Any) -> Any:
    return evidence(*parameters, table=_windows(velocity), **given)


def _uncertain(*parameters: ParameterEstimate, **given: Any) -> list[Finding]:
    """What is said with a speed's range so small that something is missing for each parameter."""
    return found("undetermined", _moved(*parameters, **given))


# --- How certain ---


@pytest.mark.parametrize(
    ("name", "value", "limit"),
    [
        ("viscous", 2.0, 0.04 * 2.0),
        ("torque_offset", 0.0, 0.04 * 10.0),
        ("load_friction", 0.0, 0.04 * 0.05),
    ],
)
@pytest.mark.parametrize(("share", "named"), [(0.99, False), (1.01, True)])
def test_a_wide_interval_is_named(
    name: str, value: float, limit: float, share: float, named: bool
) -> None:
    velocity = np.ones(1000)  # one direction, one speed
    given = _moved(
        parameter(name, value, share * limit), parameter("sensor_gain", 1.0), velocity=velocity
    )
    given.recordings = given.problem.recordings = (_loaded(0.0),)
    assert [each.parameters for each in found("undetermined", given)] == (
        [(name,)] if named else []
    )


def _loaded(spread: float) -> jid.Recording:
    """A reading that varies by this standard deviation."""
    sensor = spread * math.sqrt(2.0) * np.sin(2.0 * np.pi * TIME)
    return jid.Recording(time=TIME, position=np.sin(TIME), torque=np.cos(TIME), sensor=sensor)


@pytest.mark.parametrize(("share", "named"), [(0.0099, False), (0.0101, True)])
def test_a_gain_is_held_to_a_hundredth(share: float, named: bool) -> None:
    given = _moved(parameter("sensor_gain", 1.0, share), recordings=(_loaded(0.01),))
    assert bool(found("undetermined", given)) == named


@pytest.mark.parametrize(
    ("shift", "chance", "named"),
    [
        (0.0303, 0.01, True),
        (0.0297, 0.01, False),  # below three errors by chance
        (0.0101, 0.001, True),
        (0.0099, 0.001, False),  # below a hundredth of the value
    ],
)
@pytest.mark.parametrize("side", ["shift_halved", "shift_doubled"])
def test_a_value_that_other_windows_move_is_named(
    shift: float, chance: float, named: bool, side: str
) -> None:
    moved = parameter("viscous", 1.0, 0.01, **{side: -shift})
    said = _uncertain(moved, chance={"viscous": chance})
    assert bool(said) == named


@pytest.mark.parametrize(("correlation", "told"), [(0.979, False), (0.981, True), (-0.981, True)])
@pytest.mark.parametrize(("half", "tied"), [(0.0199, False), (0.0201, True)])
def test_what_moves_with_an_uncertain_value_is_named(
    correlation: float, told: bool, half: float, tied: bool
) -> None:
    pair = (parameter("viscous", 1.0, 0.1), parameter("coulomb", 1.0, half))
    (said,) = _uncertain(*pair, correlations={("viscous", "coulomb"): correlation})
    assert ("indistinguishable" in said.message) == told
    assert ("coulomb" in said.parameters) == (told and tied)


def test_a_sentence_names_a_few() -> None:
    assert listed("abcde") == "a, b, c and 2 others"
    assert listed("abcd", room=17) == "a, b and 2 others"
    many = [parameter(f"coulomb[{k}]", 1.0, 0.1 + 0.01 * k) for k in range(7)]
    pairs = {(f"coulomb[{k}]", f"coulomb[{k + 1}]"): 0.99 for k in range(6)}
    (said,) = _uncertain(*many, correlations=pairs)
    assert len(said.title) <= TITLE
    assert "and 5 others: " in said.title
    assert said.evidence["more_parameters"].value == 5
    assert said.cause.count(" ± ") == 6
    assert said.message.count("indistinguishable") == 5
    (said,) = _uncertain(*many[:4])
    assert "and 2 others: " in said.title
    assert "also coulomb[2] ± 6.1 %" in said.details
    (other,) = found("structured_residual", _moved(*many, causes=Causes(found=())))
    assert other.title.endswith("coulomb[2] and 4 others")
    assert "coulomb[3]" not in other.message


@pytest.mark.parametrize(("error", "excited"), [(9.9, True), (10.1, False)])
def test_an_error_ten_times_the_value_means_not_excited(error: float, excited: bool) -> None:
    (said,) = _uncertain(parameter("viscous", 1.0, 1.96 * error))
    assert ("viscous unknown" in said.title) != excited


# --- How well moved ---

_NEEDS: dict[str, tuple[str, Callable[[float], Any], float, float]] = {
    # Nine tenths of the windows at speed 1, the others slower.
    "viscous": (
        "viscous",
        lambda ratio: _moved(velocity=_BACK_AND_FORTH * _slow_part(1.0 / ratio)),
        *(3.01, 2.99),
    ),
    "coulomb": ("coulomb", lambda n: _moved(velocity=_turning(int(n))), 4, 3),
    "coulomb_positive": (
        "coulomb_positive",
        lambda share: _moved(velocity=_forward(share)),
        0.151,
        0.149,
    ),
    "static": (
        *("static", lambda share: _moved(parameter("stribeck", 400.0), velocity=_slow(share))),
        *(0.031, 0.029),
    ),
    "stribeck": (
        "stribeck",
        lambda speed: _moved(
            parameter("stribeck", 1.0), velocity=speed * _BACK_AND_FORTH * _slow_part(0.1)
        ),
        *(2.01, 1.99),
    ),
    "sensor_gain": (
        "sensor_gain",
        lambda spread: _moved(parameter("sensor_gain", 1.0), recordings=(_loaded(spread),)),
        *(0.303, 0.297),
    ),
    "gravity_sin": (
        "gravity_sin",
        lambda travel: _moved(recordings=(_travelled(travel),)),
        1.01,
        0.99,
    ),
    "position_cos_2": (
        "position_cos_2",
        lambda share: _moved(recordings=(_travelled(share * math.pi),)),
        *(0.76, 0.74),
    ),
    "ripple_cos_2": (
        "ripple_cos_2",
        lambda share: _moved(
            recordings=(_travelled(share * math.pi / 100.0),), joint=jid.Joint(gear_ratio=100.0)
        ),
        *(0.76, 0.74),
    ),
}


def _slow_part(speed: float) -> Any:
    slow = np.ones(1000)
    slow[::8] = speed
    return slow


def _turning(times: int) -> Any:
    edges = np.linspace(0, 1000, times + 2).astype(int)
    turned = np.concatenate(
        [np.full(b - a, (-1.0) ** k) for k, (a, b) in enumerate(pairwise(edges))]
    )
    return turned * _slow_part(0.1)


def _forward(share: float) -> Any:
    velocity = -np.ones(1000)
    velocity[: round(1000 * share)] = 1.0
    return velocity * _slow_part(0.1)


def _slow(share: float) -> Any:
    velocity = _BACK_AND_FORTH.copy()
    velocity[: round(1000 * share)] = 0.09
    return velocity


def _travelled(travel: float) -> jid.Recording:
    position = 0.5 * travel * np.cos(20.0 * TIME)
    return jid.Recording(
        time=TIME,
        position=position * travel / np.ptp(position),
        velocity=np.cos(TIME),
        torque=np.cos(TIME),
    )


@pytest.mark.parametrize("name", _NEEDS)
def test_a_lack_of_motion_begins_at_its_threshold(name: str) -> None:
    of, make, enough, too_little = _NEEDS[name]
    # Viscous friction carries most of the torque: its speeds alone decide.
    value = parameter(of, 10.0)
    assert Excitation(make(enough)).lack(value) is None
    assert Excitation(make(too_little)).lack(value) is not None


@pytest.mark.parametrize(("share", "enough"), [(0.101, True), (0.099, False)])
def test_friction_and_acceleration_take_a_tenth_of_the_torque(share: float, enough: bool) -> None:
    velocity = _BACK_AND_FORTH * _slow_part(0.1)
    viscous = Excitation(_moved(velocity=velocity)).lack(parameter("viscous", share * 10.0))
    assert (viscous is None) == enough
    at_best = SimpleNamespace(norm=lambda _: 1.0, target=1.0)
    inertia = Excitation(_moved(at_best=at_best)).lack(parameter("inertia", share))
    assert (inertia is None) == enough


@pytest.mark.parametrize(("windows", "few"), [(6, True), (7, False)])
def test_hardly_more_windows_than_parameters(windows: int, few: bool) -> None:
    given = _moved(
        parameter("viscous", 1.0), parameter("coulomb", 1.0), residuals={"windows": windows}
    )
    lack = Excitation(given).lack(parameter("other", 1.0))
    assert (lack is not None) == few


@pytest.mark.parametrize(
    ("times", "said"), [(3.1, "about 96 s are needed"), (3.2, "times this duration")]
)
def test_nobody_records_ten_times_as_long(times: float, said: str) -> None:
    lack = Excitation(_moved()).longer("viscous", times, 1.0)
    assert said in lack.text
    assert lack.wanted == pytest.approx(10.0 * times**2)


def test_a_weak_reading_lacks_load_however_much_it_varies() -> None:
    given = _moved(parameter("sensor_gain", 1.0), recordings=(_loaded(5.0),))
    assert Excitation(given).lack(parameter("sensor_gain", 1.0)) is None
    given.problem.choice.residual_reason = WEAK_READING
    assert Excitation(given).lack(parameter("sensor_gain", 1.0)) is not None


def test_noise_of_the_reading_is_no_load() -> None:
    rng = np.random.default_rng(0)
    run = _loaded(0.0)
    noisy = jid.Recording(
        time=TIME,
        position=run.position,
        torque=np.cos(TIME),
        sensor=rng.normal(0.0, 0.5, len(TIME)),
    )
    given = _moved(parameter("sensor_gain", 1.0), recordings=(noisy,))
    assert Excitation(given).lack(parameter("sensor_gain", 1.0)) is not None


def test_standstill_is_no_reversal() -> None:
    velocity = _turning(3)
    velocity[::10] = 0.019 * np.where(np.arange(100) % 2 == 0, 1.0, -1.0)
    assert Excitation(_moved(velocity=velocity)).reversals == 3
    velocity[::10] *= 0.021 / 0.019
    assert Excitation(_moved(velocity=velocity)).reversals > 3


# --- In which balance ---


def _free(values: dict[str, float], relative: float = 0.0, reverse: Any = None) -> Any:
    return SimpleNamespace(
        values=values,
        relative=relative,
        with_noisy_sensor=lambda: reverse,
        sure=lambda *_: True,
    )


def _contradicted(monkeypatch: pytest.MonkeyPatch, free: Any) -> list[Finding]:
    given = evidence(parameter("inertia", 1.0, None, vary=False))
    monkeypatch.setattr(torque_balance, "without_bounds", lambda _: free)
    monkeypatch.setattr(torque_balance, "_torque_with_velocity", lambda _: None)
    return found("torque_balance", given)


@pytest.mark.parametrize(
    ("ratio", "wrong"), [(1.0499, False), (1.0501, True), (0.9501, False), (0.9499, True)]
)
def test_a_known_inertia_is_contradicted_by_a_twentieth(
    ratio: float, wrong: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert bool(_contradicted(monkeypatch, _free({"inertia": ratio}))) == wrong


@pytest.mark.parametrize(("relative", "said"), [(0.0299, True), (0.0301, False)])
def test_a_balance_that_nothing_explains_contradicts_no_inertia(
    relative: float, said: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert bool(_contradicted(monkeypatch, _free({"inertia": 2.0}, relative))) == said


@pytest.mark.parametrize(
    ("ratio", "left", "wrong"),
    [
        (1.49, 0.49, False),  # noise hides the gain, and the link's inertia goes to the joint
        (1.51, 0.49, True),
        (1.0 / 1.49, 0.49, False),
        (1.0 / 1.51, 0.49, True),
        (1.49, 0.51, True),
    ],
)
def test_noise_that_hides_a_gain_excuses_an_inertia(
    ratio: float, left: float, wrong: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    reverse = {"inertia": ratio, "sensor_gain": 1.0}
    free = _free({"inertia": ratio, "sensor_gain": left}, reverse=reverse)
    assert bool(_contradicted(monkeypatch, free)) == wrong


def test_an_inertia_between_the_two_regressions_is_not_contradicted(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    reverse = {"inertia": 0.5, "sensor_gain": 1.0}
    free = _free({"inertia": 1.4, "sensor_gain": 1.0}, reverse=reverse)
    assert _contradicted(monkeypatch, free) == []


@pytest.mark.parametrize(
    ("ratio", "code"),
    [(57.3 * 1.24, "implausible_units"), (57.3 * 1.26, "wrong_scale"), (3.0, "wrong_scale")],
)
def test_an_inertia_off_by_57_is_in_degrees(
    ratio: float, code: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    ratio = 1.0 / ratio
    (said,) = _contradicted(monkeypatch, _free({"inertia": ratio}))
    assert said.code == code


@pytest.mark.parametrize(("ratio", "named"), [(101.0 * 1.24, True), (101.0 * 1.26, False)])
def test_a_gear_ratio_too_many_is_named(
    ratio: float, named: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    given = evidence(parameter("inertia", 1.0, None, vary=False), joint=jid.Joint(gear_ratio=101.0))
    monkeypatch.setattr(torque_balance, "without_bounds", lambda _: _free({"inertia": ratio}))
    monkeypatch.setattr(torque_balance, "_torque_with_velocity", lambda _: None)
    (said,) = found("torque_balance", given)
    assert ("multiplied by the gear ratio" in said.message) == named


def _regressed(scatter: float) -> tuple[Any, Unbounded]:
    """One coefficient of 1 with a standard error of `scatter` by chance."""
    rng = np.random.default_rng(1)
    column = np.ones((4000, 1))
    noise = rng.normal(0.0, 1.0, 4000)
    noise = (noise - noise.mean()) / noise.std()
    target = 1.0 * column[:, 0] + scatter * math.sqrt(4000) * noise
    given = evidence(parameter("inertia", 1.0))
    given.penalty = SimpleNamespace(
        coefficients=1, columns=lambda _: column, target=target, window_count=4000
    )
    given.best = np.zeros(1)
    regressor = Regressor(names=("inertia",), triangle=Triangle(np.column_stack([column, target])))
    return given, Unbounded(
        evidence=given, regressor=regressor, best=None, values={"inertia": 1.0}, relative=0.0
    )


def test_ten_errors_are_sure() -> None:
    _, free = _regressed(0.01)
    assert not free.sure("inertia", 1.0 + 0.098)
    assert free.sure("inertia", 1.0 + 0.102)
    assert free.sure("inertia", 1.0 - 0.102)


def test_the_reverse_regression_finds_what_noise_of_the_sensor_hides() -> None:
    """torque = 3 inertia + 2 reading, and the reading is noisy: regressed on it, both come out wrong."""
    rng = np.random.default_rng(2)
    inertia, load = rng.normal(size=4000), rng.normal(size=4000)
    reading = load + rng.normal(size=4000)
    triangle = Triangle(np.column_stack([inertia, reading, 3.0 * inertia + 2.0 * load]))
    regressor = Regressor(names=("inertia", "sensor_gain"), triangle=triangle)
    values = {"inertia": 3.0, "sensor_gain": 1.0}
    free = Unbounded(
        evidence=evidence(), regressor=regressor, best=None, values=values, relative=0.0
    )
    reverse = free.with_noisy_sensor()
    assert reverse is not None
    assert reverse["inertia"] == pytest.approx(3.0, rel=0.03)
    assert reverse["sensor_gain"] == pytest.approx(2.0, rel=0.03)
    free = Unbounded(
        evidence=evidence(), regressor=regressor, best=None, values={"inertia": 3.0}, relative=0.0
    )
    assert free.with_noisy_sensor() is None


def test_other_shapes_are_tried_where_much_is_left(monkeypatch: pytest.MonkeyPatch) -> None:
    tried: list[float | None] = []

    def at(_: Any, best: Any) -> Any:
        tried.append(None if best is None else float(best[0]))
        left = 0.0299 if best is None and good else 0.0301 if best is None else 0.02
        return SimpleNamespace(relative=left)

    monkeypatch.setattr(unbounded, "_at", at)
    given = evidence(parameter("stribeck", 1.0), best=np.ones(1))
    good = True
    assert unbounded.without_bounds(given).relative == 0.0299  # type: ignore[union-attr]
    assert tried == [None]
    good = False
    assert unbounded.without_bounds(given).relative == 0.02  # type: ignore[union-attr]
    assert tried[2:] == [pytest.approx(share**-2) for share in (0.02, 0.05, 0.1, 0.2, 0.4)]


# --- Too rich a model, and kicks of the link ---


@pytest.mark.parametrize(("errors", "plain"), [(3.9, False), (4.1, True)])
@pytest.mark.parametrize("correlation", [0.0, 0.6])
def test_a_plain_excess_keeps_the_model(errors: float, plain: bool, correlation: float) -> None:
    residual = np.tile([1.0, -1.0], 50)
    static = np.zeros((100, 3))
    static[0, 1], static[1, 0], static[2, 2] = 1.0, 1.0, 1.0
    scatter = math.sqrt((1.0 + correlation) / (1.0 - correlation))
    given = evidence(
        parameter("static", errors * scatter, 1.96 * 0.6 * errors * scatter),
        parameter("viscous", 1.0),
        residuals={"autocorrelation": correlation},
        residual=residual,
        at_best=Regressor(names=("viscous", "static"), triangle=Triangle(static)),
    )
    given.penalty.residual = None
    (said,) = found("model_too_rich", given)
    assert any(each.kind == "call" for each in said.advice) != plain


@pytest.mark.parametrize(("kick", "spared"), [(9.9, False), (10.1, True)])
@pytest.mark.parametrize(("beside", "near"), [(0, True), (1, True), (2, False)])
def test_a_sensor_feels_jumps_of_the_velocity(
    kick: float, spared: bool, beside: int, near: bool
) -> None:
    velocity = np.cumsum(np.full(len(TIME), 1e-3))
    velocity[1000:] += (kick - 1.0) * 1e-3
    sensor = np.sin(TIME)
    sensor[1000 + beside] += 5.0
    run = jid.Recording(
        time=TIME,
        position=np.cumsum(velocity) * 1e-3,
        velocity=velocity,
        torque=TIME,
        sensor=sensor,
    )
    spike = SimpleNamespace(count=1, index=1000 + beside, height=5.0)
    seen = inspected(run)
    seen.channels, seen.spike = ("sensor",), lambda _: spike
    said = found("spikes", evidence(recordings=(run,), inspections=(seen,)))
    assert (said == []) == (spared and near)
