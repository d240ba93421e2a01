"""Both sides of the thresholds of findings about signals and about the fit as a whole."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from fake_evidence import RUN, TIME, evidence, found, inspected, parameter, signal

import jointid as jid
from jointid.estimate.causes import Cause, Causes
from jointid.estimate.delays import Delay

Make = Callable[[float], Any]
_N = len(RUN)


def _signals(**counts: Any) -> Any:
    """Counts of a recording whose torque and sensor return to ±1."""
    wave = np.clip(1.1 * np.sin(12.0 * TIME), -1.0, 1.0)
    run = jid.Recording(
        time=TIME, position=RUN.position, velocity=RUN.velocity, torque=wave, sensor=5.0 * wave
    )
    return evidence(inspections=(inspected(run, counts),), recordings=(run,))


def _inspection(recording: Any = RUN, **facts: Any) -> Any:
    return evidence(inspections=(inspected(recording, **facts),), recordings=(recording,))


def _clipped(samples: float) -> Any:
    edge = SimpleNamespace(there=int(samples), moving=int(samples), near=int(samples))
    return _signals(torque=signal(upper=edge))


def _few_levels(changes: float) -> Any:
    edge = SimpleNamespace(there=200, moving=200, near=200)
    return _signals(torque=signal(upper=edge, changes=int(changes)))


def _at_rest(near: float) -> Any:
    """A clean signal of coarse steps that stays at its largest value with the joint."""
    edge = SimpleNamespace(there=200, moving=200, near=200 + int(near))
    return _signals(torque=signal(upper=edge, fine=False))


def _agreement(scale: float) -> Any:
    return _inspection(agreement=SimpleNamespace(scale=scale))


def _power(correlation: float) -> Any:
    """Window torques and velocities with this correlation."""
    velocity = np.array([1.0, -1.0, 1.0, -1.0])
    across = np.array([1.0, 1.0, -1.0, -1.0])
    torque = correlation * velocity + np.sqrt(1.0 - correlation**2) * across
    table = SimpleNamespace(duration=np.full(4, 0.1), velocity=velocity)
    given = evidence(table=table)
    given.penalty.target = 0.1 * torque
    given.penalty.window_count = 0
    regressor = SimpleNamespace(names=(), norm=lambda _: 0.0, target=0.0)
    given.regressor = lambda _=None: regressor
    return given


def _moved(share: float) -> Any:
    viscous = parameter("viscous", 100.0)
    return evidence(viscous, velocity_effect=SimpleNamespace(size=np.array([100.0 * share])))


def _moved_offset(share: float) -> Any:
    """An offset of nearly zero is held against a share of the torque's level, 10."""
    offset = parameter("torque_offset", 0.001)
    return evidence(offset, velocity_effect=SimpleNamespace(size=np.array([0.02 * 10.0 * share])))


def _own(share: float) -> Any:
    term = parameter("spring", 100.0)
    noise = SimpleNamespace(effect=SimpleNamespace(size=np.array([100.0 * share])), noise=())
    given = evidence(term, own_noise=noise)
    terms = SimpleNamespace(each=())
    given.problem.choice.model = SimpleNamespace(resolved=SimpleNamespace(terms=terms))
    return given


def _of_causes(share: float) -> Any:
    cause = Cause(name="drift", share=share, scale=0.1, harmful=False)
    return evidence(causes=Causes(found=(), harmless=(cause,), tried=("drift",)))


def _ripple(share: float, windows: int = 100_000, others: float = 0.0) -> Any:
    """A peak at twice the motor's angle with this share of the residual's variance."""
    sums = np.full(16, np.sqrt(0.5 * others * windows))
    sums[3] = np.sqrt(0.5 * share * windows)
    given = evidence(joint=jid.thesis_joint(), best=np.zeros(0))
    given.problem.choice.gear_ratio = -100.0
    given.problem.ripple = lambda *_: (windows, 1.0, sums)
    return given


def _swing(swing: float) -> Any:
    return _inspection(swing=swing, agreement=None)


def _fast(speed: float) -> Any:
    """A motor's speed [rad/s] behind a gear of 100."""
    run = jid.Recording(
        time=TIME,
        position=np.cumsum(np.full(len(TIME), speed * 1e-5)),
        velocity=np.full(len(TIME), speed / 100.0),
        torque=np.sin(TIME),
    )
    given = _inspection(run, peak_speed=speed / 100.0)
    given.joint = jid.Joint(gear_ratio=100.0)
    return given


def _rich(share: float) -> Any:
    given = evidence(parameter("static", 1.0, 1.96 * share))
    given.at_best = SimpleNamespace(names=())
    given.residual = np.ones(10)
    given.penalty.residual = None
    return given


BOTH_SIDES: dict[str, tuple[str, str, Make, float, float]] = {
    "torque on its limit": ("clipped", "torque_saturated", _clipped, 19, 20),
    "a signal of few levels": ("clipped", "torque_saturated", _few_levels, 539, 541),
    "at rest on its limit": ("clipped", "torque_saturated", _at_rest, 68, 66),
    "frozen": ("constant", "constant_signal", lambda n: _signals(torque=signal(frozen=n)), 99, 100),
    "windows": (
        *("few_windows", "few_windows"),
        lambda n: evidence(parameter("viscous", 1.0), residuals={"windows": n}),
        *(8, 7),
    ),
    "explained": (
        *("poor_fit", "poor_fit"),
        lambda share: evidence(residuals={"r_squared": share}),
        *(0.95, 0.949),
    ),
    "explained beside noise": (
        *("poor_fit", "poor_fit"),
        lambda share: evidence(residuals={"r_squared": share}, white=True),
        *(0.05, 0.049),
    ),
    "standing": (
        *("standing", "standing"),
        lambda share: evidence(residuals={"standing": share}),
        *(0.35, 0.351),
    ),
    "autocorrelated": (
        *("structured_residual", "structured_residual"),
        lambda r: evidence(residuals={"autocorrelation": r}),
        *(0.5, 0.505),
    ),
    "repeated": (
        *("repeated", "repeated_samples"),
        lambda n: _signals(velocity=signal(stale=n)),
        *(30, 31),
    ),
    "jitter": (
        *("time_jitter", "time_jitter"),
        lambda share: _inspection(timing_errors=(share * RUN.sample_period, 0.0)),
        *(0.0199, 0.0201),
    ),
    "velocity too large": ("velocity", "velocity_mismatch", _agreement, 1.0299, 1.0301),
    "velocity too small": ("velocity", "velocity_mismatch", _agreement, 0.9701, 0.9699),
    "negative velocity": ("velocity", "reversed_sign", _agreement, 0.001, -0.001),
    "degrees, from below": ("velocity", "implausible_units", _agreement, 45.7, 46.0),
    "degrees, from above": ("velocity", "implausible_units", _agreement, 71.7, 71.5),
    "power from the joint": ("torque_balance", "reversed_sign", _power, -0.099, -0.101),
    "swing": ("speed", "implausible_units", _swing, 25.0, 25.1),
    "motor's speed": ("speed", "implausible_units", _fast, 1999.0, 2001.0),
    "noise of the velocity": ("noisy_velocity", "noisy_velocity", _moved, 0.0199, 0.0201),
    "noise moves an offset": ("noisy_velocity", "noisy_velocity", _moved_offset, 0.0499, 0.0501),
    "noise of an own signal": ("noisy_signal", "noisy_signal", _own, 0.0149, 0.0151),
    "harmless cause": ("causes", "drift", _of_causes, 0.3, 0.305),
    "ripple's share": ("ripple", "ripple", _ripple, 0.0499, 0.0501),
    "ripple by chance": ("ripple", "ripple", lambda share: _ripple(share, 200), 0.299, 0.301),
    "ripple among others": (
        *("ripple", "ripple"),
        lambda share: _ripple(share, others=0.01),
        *(0.0999, 0.1001),
    ),
    "windows that show ripple": (
        *("ripple", "ripple"),
        lambda windows: _ripple(3.0, int(windows)),
        *(49, 50),
    ),
    "static friction's error": ("model_too_rich", "model_too_rich", _rich, 0.499, 0.501),
}


@pytest.mark.parametrize("what", BOTH_SIDES)
def test_a_finding_begins_at_its_threshold(what: str) -> None:
    check, code, make, well, ill = BOTH_SIDES[what]
    assert code not in {each.code for each in found(check, make(well))}
    assert code in {each.code for each in found(check, make(ill))}


def test_every_row_has_a_finding_of_its_own() -> None:
    """Values on both sides are near each other: within 3 %, or one count."""
    for _, _, _, well, ill in BOTH_SIDES.values():
        assert abs(well - ill) <= max(0.03 * abs(well), 0.002 if abs(well) < 1.0 else 2.0)


@pytest.mark.parametrize(
    ("scale", "severity"),
    [(1.099, "warning"), (1.101, "blocking"), (0.91, "warning"), (0.908, "blocking")],
)
def test_a_velocity_off_by_a_tenth_blocks(scale: float, severity: str) -> None:
    (finding,) = found("velocity", _agreement(scale))
    assert finding.severity == severity


@pytest.mark.parametrize(("r_squared", "severity"), [(0.001, "warning"), (-0.001, "blocking")])
def test_a_fit_worse_than_the_mean_blocks(r_squared: float, severity: str) -> None:
    (finding,) = found("poor_fit", evidence(residuals={"r_squared": r_squared}))
    assert finding.severity == severity


@pytest.mark.parametrize(
    ("off", "names"), [(1.029, True), (1.031, False), (0.971, True), (0.969, False)]
)
def test_a_unit_is_named_where_the_factor_is_near(off: float, names: bool) -> None:
    run = jid.Recording(
        time=RUN.time,
        position=RUN.position,
        velocity=RUN.velocity,
        torque=RUN.torque,
        metadata={"assumed_units": ["time"]},
    )
    (finding,) = found("velocity", _inspection(run, agreement=SimpleNamespace(scale=1e-3 * off)))
    assert ("in ms" in finding.message) == names


@pytest.mark.parametrize(("r_squared", "advised"), [(0.95, True), (0.949, False)])
def test_a_wider_bound_is_advised_where_the_model_is_good(r_squared: float, advised: bool) -> None:
    held = parameter("viscous", 5.0, None, at_bound="max", max=5.0)
    (finding,) = found("at_bound", evidence(held, residuals={"r_squared": r_squared}))
    assert any(each.kind == "call" for each in finding.advice) == advised


def test_more_windows_are_advised_than_the_fewest() -> None:
    (finding,) = found("few_windows", evidence(parameter("viscous", 1.0), residuals={"windows": 7}))
    (call,) = (each for each in finding.advice if each.function == "identify")
    assert call.arguments == {"windows": 12}


@pytest.mark.parametrize(("columns", "more"), [(6, ""), (7, "and 1 more")])
def test_six_columns_are_named(columns: int, more: str) -> None:
    left_out = [{"column": f"c{k}", "reason": "text"} for k in range(columns)]
    run = SimpleNamespace(metadata={"left_out": left_out}, name="")
    (finding,) = found("left_out", evidence(recordings=(run,)))
    assert "c5 (text)" in finding.message
    assert "c6" not in finding.message
    assert finding.message.split(";")[0].endswith(more) or more in finding.message


def test_less_torque_is_advised_than_that_which_was_cut() -> None:
    (finding,) = found("clipped", _clipped(200))
    (motion,) = (each for each in finding.advice if each.function == "next_motion")
    peak = float(np.quantile(np.abs(RUN.torque), 0.999))  # type: ignore[arg-type]
    assert motion.arguments["limits"]["torque"] == pytest.approx(0.9 * peak, rel=0.006)
    speed = float(np.quantile(np.abs(RUN.velocity), 0.999))
    assert motion.arguments["limits"]["velocity"] == pytest.approx(speed, rel=0.01)


def test_a_clipped_sensor_is_to_stay_inside_its_range() -> None:
    edge = SimpleNamespace(there=200, moving=200, near=200)
    given = _signals(sensor=signal(upper=edge, lowest=-4.0, highest=5.0))
    given.parameters = {
        "sensor_gain": parameter("sensor_gain", 10.0),
        "sensor_offset": parameter("sensor_offset", 1.0),
    }
    (finding,) = found("clipped", given)
    (motion,) = (each for each in finding.advice if each.function == "next_motion")
    assert motion.arguments["limits"]["sensor_range"] == pytest.approx(0.9 * 39.0, rel=0.005)


def test_one_outlier_is_no_speed_to_stay_below() -> None:
    """One sample of a thousand is left out, not ten."""
    velocity = np.ones(len(TIME))
    velocity[:3] = 2.0, 2.0, 100.0
    run = jid.Recording(
        time=TIME,
        position=TIME.copy(),
        velocity=velocity,
        torque=np.clip(1.1 * np.sin(12.0 * TIME), -1.0, 1.0),
    )
    edge = SimpleNamespace(there=200, moving=200, near=200)
    clipped = inspected(run, counts={"torque": signal(upper=edge)})
    (finding,) = found("clipped", evidence(recordings=(run,), inspections=(clipped,)))
    (motion,) = (each for each in finding.advice if each.function == "next_motion")
    assert motion.arguments["limits"]["velocity"] == 2.0


@pytest.mark.parametrize(("travel", "wide"), [(14.9, True), (15.1, False)])
def test_turns_that_do_not_come_back_are_no_swing(travel: float, wide: bool) -> None:
    run = jid.Recording(time=TIME, position=travel * TIME / TIME[-1], torque=np.sin(TIME))
    assert bool(found("speed", _inspection(run, swing=30.0))) == wide


def test_one_outlier_is_no_speed() -> None:
    velocity = np.full(len(TIME), 1.0)
    velocity[1000] = 30.0
    run = jid.Recording(time=TIME, position=TIME.copy(), velocity=velocity, torque=np.sin(TIME))
    given = _inspection(run, peak_speed=30.0)
    given.joint = jid.Joint(gear_ratio=100.0)
    assert found("speed", given) == []


def _delay(value: float, stderr: float, signal: str = "sensor", fits: bool = True) -> Any:
    delay = Delay(signal=signal, value=value, stderr=stderr, certain=True, fits=fits, applied=0.0)
    return evidence(delays={signal: delay})


@pytest.mark.parametrize(("errors", "shifts"), [(2.99, False), (3.01, True)])
def test_a_delay_is_shifted_by_where_it_is_three_errors(errors: float, shifts: bool) -> None:
    (finding,) = found("delays", _delay(errors * 1e-4, 1e-4))
    (call,) = (each for each in finding.advice if each.kind == "call")
    assert ("sensor" in call.arguments["shift"]) == shifts


@pytest.mark.parametrize(("stderr", "told"), [(1.52e-4, False), (1.54e-4, True)])
def test_the_interval_of_a_delay_is_told_where_it_is_wide(stderr: float, told: bool) -> None:
    (finding,) = found("delays", _delay(5e-3, stderr))
    assert ("95 % interval" in finding.details) == told
    if told:
        assert "4.70 to 5.30 ms" in finding.details


@pytest.mark.parametrize(
    ("early", "held"), [(0.301, True), (0.299, False), (0.699, True), (0.701, False)]
)
def test_a_torque_half_a_sample_early_may_be_held(early: float, held: bool) -> None:
    delay = Delay(
        signal="torque",
        value=-early * 1e-3,
        stderr=1e-6,
        certain=True,
        fits=True,
        applied=-early * 1e-3,
    )
    (finding,) = found("delays", evidence(delays={"torque": delay}))
    assert any("torque_hold" in each.arguments for each in finding.advice) == held


@pytest.mark.parametrize(("uniform", "even"), [(0.29, True), (0.31, False)])
def test_stamps_are_called_uneven_where_the_samples_are_even(uniform: float, even: bool) -> None:
    scatter = 0.1 * RUN.sample_period
    (finding,) = found("time_jitter", _inspection(timing_errors=(scatter, uniform * scatter)))
    assert ("look evenly spaced" in finding.message) == even


@pytest.mark.parametrize(("jitter", "advised"), [(0.0199, True), (0.0201, False)])
@pytest.mark.parametrize(("noise", "quieter"), [(0.4999, True), (0.5001, False)])
def test_a_noisy_velocity_is_left_out_where_the_rate_is_quieter(
    jitter: float, advised: bool, noise: float, quieter: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    from jointid.identification.warnings import noisy_velocity

    monkeypatch.setattr(noisy_velocity, "noise_of_velocity", lambda _: 1.0)
    derived = SimpleNamespace(noise=np.full(3, noise), position_noise=SimpleNamespace(quantum=0.0))
    run = SimpleNamespace(velocity_derived=False, derived=derived, sample_period=1e-3)
    given = evidence(
        parameter("viscous", 1.0),
        recordings=(run,),
        inspections=(inspected(run, timing_errors=(jitter * 1e-3, 0.0)),),
        velocity_effect=SimpleNamespace(size=np.array([1.0])),
    )
    (finding,) = found("noisy_velocity", given)
    assert any(each.kind == "call" for each in finding.advice) == (advised and quieter)


def test_ripple_is_looked_for_in_windows_of_two_samples() -> None:
    given = _ripple(0.1)
    asked: list[float] = []
    spectrum = given.problem.ripple

    def ripple(best: Any, halves: int, period: float) -> Any:
        asked.append(period)
        return spectrum(best, halves, period)

    given.problem.ripple = ripple
    (finding,) = found("ripple", given)
    assert finding.evidence["multiple"].value == 2.0
    assert asked == [pytest.approx(2.2 * RUN.sample_period)]
    given.problem.choice.gear_ratio = -1.0  # the motor's angle is the joint's
    assert found("ripple", given) == []
    assert len(asked) == 1
