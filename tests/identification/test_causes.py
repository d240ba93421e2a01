"""Causes of a misfit: each broken assumption is named, what it moves is moved to the truth, clean joints have none."""

from __future__ import annotations

import dataclasses
import pickle
from collections.abc import Mapping

import numpy as np
import pytest
from plants import Bench, Law, Log, Plant, simulate, sines, thesis

import jointid as jid
from jointid.estimate.delays import Delay
from jointid.identification.causes import causes, fitted
from jointid.identification.causes.attributed import Attributed
from jointid.identification.causes.candidates import Candidate
from jointid.identification.causes.families import BY_NAME, listed_candidates
from jointid.identification.causes.fitted import Fitted
from jointid.identification.causes.folds import Folds, first_windows, summed
from jointid.identification.causes.residual_test import suspicious
from jointid.identification.causes.whole_recording import WholeRecording
from jointid.identification.follow_up import EstimateSource
from jointid.identification.prepared import prepare

_SLOW = {"slow_motion", "smooth_friction", "presliding", "stribeck_exponent"}
_BROKEN: Mapping[str, tuple[dict[str, float], set[str]]] = {
    "clean": ({}, set()),
    "viscous drift": ({"viscous_drift": -0.3}, {"drift"}),
    "load friction": ({"load_friction": 0.15}, {"load_friction"}),
    "harmonic": ({"harmonic_torque": 1.5}, {"harmonic"}),
    "bump": ({"bump": 10.0, "bump_time": 4.0, "bump_width": 0.3}, {"disturbance"}),
    "bristles": ({"bristle_stiffness": 1e5, "bristle_damping": 200.0}, _SLOW),
    "exponent": ({"exponent": 1.0}, _SLOW),
    "weak bump": ({"bump": 2.0, "bump_time": 4.0, "bump_width": 0.3}, set()),
    "torque constant": ({"torque_scale": 1.03}, {"wrong_scale"}),
    "other axis": ({"coupling": 4.0}, {"other_signal"}),
    "harmonic and bump": (
        {"harmonic_torque": 1.5, "bump": 6.0, "bump_time": 4.0, "bump_width": 0.3},
        {"harmonic"},
    ),
}
_OF_THEIR_OWN = ("weak bump", "other axis", "harmonic and bump")
_LOGS = {"filtered velocity": Log(velocity_cutoff=50.0), "loud sensor": Log(sensor_noise=5.0)}


@pytest.fixture(scope="module")
def runs() -> dict[str, jid.Recording]:
    """One joint for each broken assumption and each log, moved alike: side by side they cost little more than one."""
    law = Law(inertia=2.5, stiffness=40.0, feedback=1.5, on_reference=1.0)
    plants = [(Plant(**changes), Log()) for changes, _ in _BROKEN.values()]
    plants += [(Plant(), log) for log in _LOGS.values()]
    motion = thesis(np.radians([60.0]))
    benches = [Bench(motion=motion, law=law, plant=plant, log=log) for plant, log in plants]
    found = simulate(Bench.stack(benches), duration=9.0, seed=3, finer=2)
    return dict(zip((*_BROKEN, *_LOGS), found, strict=True))


@pytest.fixture(scope="module")
def estimates(runs: dict[str, jid.Recording]) -> dict[str, jid.Estimate]:
    """One for each broken assumption."""
    return {
        name: jid.identify(runs[name], jid.thesis_joint(), search="separable") for name in _BROKEN
    }


def _named(estimate: jid.Estimate) -> list[str]:
    """Causes that a warning names; a note of a harmless one is none."""
    return [found.code for found in estimate.warnings if found.code in BY_NAME]


@pytest.mark.parametrize("name", [name for name in _BROKEN if name not in _OF_THEIR_OWN])
def test_a_broken_assumption_is_named(estimates: dict[str, jid.Estimate], name: str) -> None:
    wanted = _BROKEN[name][1]
    named = _named(estimates[name])
    assert set(named[:1]) <= wanted
    assert bool(named) == bool(wanted)
    codes = {found.code for found in estimates[name].findings}
    assert not {"structured_residual", "poor_fit"} & codes


def test_a_cause_says_what_it_moves(estimates: dict[str, jid.Estimate]) -> None:
    estimate = estimates["load friction"]
    (cause, *_) = estimate.causes().found
    assert cause.name == "load_friction"
    assert cause.share > 0.8
    assert cause.numbers["coefficient"].value == pytest.approx(0.15, abs=0.03)
    moved = estimate.parameters["coulomb"].value + cause.shifts["coulomb"]
    assert moved == pytest.approx(25.0, rel=0.01)
    assert pickle.loads(pickle.dumps(cause)) == cause


def test_a_cause_that_moves_no_value_is_a_note(estimates: dict[str, jid.Estimate]) -> None:
    sound, weak = estimates["clean"], estimates["weak bump"]
    (note,) = [found for found in weak.findings if found.code == "disturbance"]
    assert note.severity == "info"
    assert "moves no parameter noticeably" in note.cause
    assert _named(weak) == []
    # It makes values uncertain nevertheless, which is a warning.
    (wide,) = [found for found in weak.warnings if found.code == "structured_residual"]
    assert "disturbance" in wide.cause
    (cause,) = weak.causes().harmless
    assert not weak.causes().found
    for name, share in cause.shares.items():
        moved = weak.parameters[name].value - sound.parameters[name].value
        assert note.evidence[f"{name}.shift"].value == share
        assert cause.shifts[name] == pytest.approx(-moved, rel=0.1, abs=0.01 * abs(moved / share))
    strong = estimates["bump"].causes().found[0]
    assert strong.harmful
    assert max(map(abs, strong.relative.values())) > 0.05


def test_a_torque_constant_is_told_from_a_known_inertia(
    estimates: dict[str, jid.Estimate],
) -> None:
    (found,) = [f for f in estimates["torque constant"].findings if f.code == "wrong_scale"]
    assert found.severity == "warning"
    # The drive gives 3 % more than the log says.
    assert found.evidence["ratio"].value == pytest.approx(1.0 / 1.03, abs=0.005)
    assert found.evidence["coulomb.shift"].value == pytest.approx(0.03, abs=0.005)


@pytest.mark.parametrize("name", ["viscous drift", "load friction", "harmonic"])
def test_stretches_of_a_long_recording_say_what_all_of_it_says(
    estimates: dict[str, jid.Estimate], monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    estimate, looked_at = estimates[name], _counted(monkeypatch)
    (every, *_) = estimate.causes().found
    _in_stretches(monkeypatch)
    (cause, *_) = estimate.causes().found
    assert looked_at[0] > 800
    assert looked_at[1] == 256
    assert cause.name == every.name
    assert cause.share == pytest.approx(every.share, abs=0.1)
    for key, value in every.numbers.items():
        assert cause.numbers[key].value == pytest.approx(value.value, rel=0.1)
    for key, shift in every.shifts.items():
        error = estimate.parameters[key].uncertainty
        assert cause.shifts[key] == pytest.approx(shift, abs=2.0 * error + 0.1 * abs(shift))


def test_a_cause_that_stretches_show_is_sized_by_all_of_the_recording(
    runs: dict[str, jid.Recording], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(fitted, "_STRETCH", 16)
    problem = prepare((runs["harmonic"],), jid.thesis_joint()).problem
    penalty = problem.penalty(None)
    best = np.array([2.5, 25.0, 20.0, 100.0, 20.0, 2.4, 15.0])
    whole = Fitted.of(problem, penalty, best, (1, 2, 4), most=256)
    some = Fitted.of(problem, penalty, best, (1, 2, 4), most=256, beside=whole)
    third = next(each for each in listed_candidates(some, "harmonic") if "3" in each.detail)
    asked = Attributed(
        candidate=third, share=0.9, factor=4, coefficients=np.ones(2), shifts=np.full(3, 9.0)
    )
    found = WholeRecording(whole, some).attributed(asked)
    (columns,) = (
        each.columns for each in listed_candidates(whole, "harmonic") if each.detail == third.detail
    )
    expected = whole.solve(np.column_stack([whole.jacobian, columns]), whole.residual)
    np.testing.assert_array_equal(found.shifts, expected[:3])
    np.testing.assert_array_equal(found.coefficients, -expected[3:])
    assert (found.share, found.factor) == (0.9, 4)
    # Sums of windows show no ripple: of its shifts, what the stretches say by chance is no part.
    ripple = dataclasses.replace(asked, candidate=Candidate(name="ripple", columns=third.columns))
    chance = some.solve(some.jacobian, some.residual) - whole.solve(whole.jacobian, whole.residual)
    assert np.abs(chance).min() > 0.0
    found = WholeRecording(whole, some).attributed(ripple)
    np.testing.assert_allclose(found.shifts, 9.0 - chance)
    np.testing.assert_array_equal(found.coefficients, 1.0)


@pytest.mark.parametrize("cut", [0.0, 3.3])
def test_sums_of_windows_end_with_their_stretch(
    monkeypatch: pytest.MonkeyPatch, runs: dict[str, jid.Recording], cut: float
) -> None:
    whole = runs["clean"]
    recordings = [whole] if cut == 0.0 else [whole.crop(0.0, cut), whole.crop(cut + 0.1, 9.0)]
    monkeypatch.setattr(fitted, "_STRETCH", 64)
    problem = prepare(tuple(recordings), jid.thesis_joint()).problem
    penalty = problem.penalty(None)
    best = np.array([2.5, 25.0, 20.0, 100.0, 20.0, 2.4, 15.0])[: len(penalty.names)]
    every = Fitted.of(problem, penalty, best, (1, 2))
    fit = Fitted.of(problem, penalty, best, (1, 2), most=256, beside=every)
    assert fit.chosen is not None
    assert len(fit.residual) == len(fit.spans) == len(fit.run) == 256
    windows = np.arange(penalty.window_count)[fit.chosen]
    for factor in (4, 16, 64):
        first = first_windows(fit.neighbours, factor)
        last = np.append(first[1:], 256) - 1
        assert (windows[last] - windows[first] < factor).all()
        assert (fit.run[last] == fit.run[first]).all()
    np.testing.assert_array_equal(fit.spans, every.spans[fit.chosen])
    np.testing.assert_array_equal(fit.residual, every.residual[fit.chosen])
    square = every.integral_of_each(lambda _, run: run.velocity**2)
    found = fit.integral_of_each(lambda _, run: run.velocity**2)
    np.testing.assert_array_equal(found, square[fit.chosen])


def test_an_event_between_the_stretches_of_a_long_recording_is_found(
    estimates: dict[str, jid.Estimate], monkeypatch: pytest.MonkeyPatch
) -> None:
    estimate, looked_at = estimates["bump"], _counted(monkeypatch)
    _in_stretches(monkeypatch, 128)  # the first and the last second: the event is at 4 s
    (cause, *_) = estimate.causes().found
    assert looked_at == [256, looked_at[1]]
    assert looked_at[1] < 256  # sums of neighbours, of all of it
    assert cause.name == "disturbance"
    assert "and" not in cause.detail
    begin, _, end = cause.detail.removesuffix(" s").partition(" to ")
    assert 3.5 < float(begin) < 4.15 < float(end) < 5.0


@pytest.mark.parametrize("stretch", [64, 128])
def test_an_event_beside_a_cause_of_a_long_recording_is_found(
    estimates: dict[str, jid.Estimate], monkeypatch: pytest.MonkeyPatch, stretch: int
) -> None:
    estimate = estimates["harmonic and bump"]
    every = estimate.causes()
    _in_stretches(monkeypatch, stretch)
    some = estimate.causes()
    names = [cause.name for cause in every.found + every.harmless]
    assert names == ["harmonic", "disturbance"]
    assert [cause.name for cause in some.found + some.harmless] == names


def _in_stretches(monkeypatch: pytest.MonkeyPatch, length: int = 16) -> None:
    """Look for causes as in a recording of many windows: in 256 of them, all over the motion."""
    monkeypatch.setattr(causes, "_MOST", 256)
    monkeypatch.setattr(fitted, "_STRETCH", length)


def _counted(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """How many windows each look for causes takes."""
    counts: list[int] = []

    def listed(fit: Fitted, only: str = "") -> list[Candidate]:
        counts.append(len(fit.residual))
        return listed_candidates(fit, only)

    monkeypatch.setattr(causes, "listed_candidates", listed)
    return counts


def test_a_signal_of_the_log_is_named_only_if_given(estimates: dict[str, jid.Estimate]) -> None:
    estimate = estimates["other axis"]
    assert "other_signal" not in {cause.name for cause in estimate.causes().found}
    source = estimate.follow_up
    assert source is not None
    time = source.given[0].time  # type: ignore[attr-defined]
    axis = np.sin(5.3 * time + 0.7)
    found = estimate.causes({"axis 2": axis})
    assert found.found[0].detail == "axis 2"
    assert "axis 2" in found.report()
    with pytest.raises(jid.InputError, match="samples"):
        estimate.causes({"axis 2": axis[1:]})
    axis[7] = np.nan
    with pytest.raises(jid.InputError, match=r"must be finite; 1 of .*, the first at sample 7"):
        estimate.causes({"axis 2": axis})


def test_a_signal_has_the_samples_of_the_log_where_a_delay_is_taken_away(
    estimates: dict[str, jid.Estimate],
) -> None:
    source = estimates["other axis"].follow_up
    assert isinstance(source, EstimateSource)
    recording = source.given[0]
    late = jid.identify(recording, jid.thesis_joint(), search="separable", shift={"torque": -0.004})
    inner = late.follow_up
    assert isinstance(inner, EstimateSource)
    assert len(inner.problem.recordings[0]) < len(recording)
    axis = np.sin(5.3 * recording.time + 0.7)
    axis[:4] = 1e6  # left out, as the samples are
    (found, *_) = [each for each in late.causes({"axis 2": axis}).found if each.detail == "axis 2"]
    assert found.name == "other_signal"


@pytest.mark.parametrize("late", [-1.0, 1.0])
@pytest.mark.parametrize("signal", ["torque", "velocity"])
def test_a_delay_has_a_side_and_is_no_cause_where_the_signal_excludes_it(
    estimates: dict[str, jid.Estimate], signal: str, late: float
) -> None:
    source = estimates["clean"].follow_up
    assert isinstance(source, EstimateSource)
    (run,) = source.problem.recordings
    fields = {name: getattr(run, name) for name in run.signals}
    fields[signal] = np.interp(run.time - late * 2e-3, run.time, fields[signal])
    moved = jid.Recording(**fields, torque_hold=run.torque_hold)
    estimate = jid.identify(moved, jid.thesis_joint(), search="separable", shift={}, min_speed=0)
    again = estimate.follow_up
    assert isinstance(again, EstimateSource)
    unknown = again.causes(dataclasses.replace(estimate, delays={}), {})
    every = [*unknown.found, *unknown.harmless]
    (cause,) = [each for each in every if (each.name, each.detail) == ("delay", signal)]
    assert cause.numbers["delay"].value == pytest.approx(late * 2e-3, rel=0.5)
    assert ("late by" if late > 0.0 else "early by") in cause.size
    nothing = Delay(signal=signal, value=0.0, stderr=1e-5, certain=False, fits=False, applied=0.0)
    excluded = dataclasses.replace(estimate, delays={signal: nothing})
    known = again.causes(excluded, {})
    assert signal not in {each.detail for each in (*known.found, *known.harmless)}


def test_signals_have_names(estimates: dict[str, jid.Estimate]) -> None:
    with pytest.raises(
        jid.InputError, match="signals is 'int': a mapping from names to signals is expected"
    ):
        estimates["clean"].causes(5)  # type: ignore[arg-type]


def test_a_read_estimate_has_no_recordings(estimates: dict[str, jid.Estimate]) -> None:
    read = jid.Estimate.from_json(estimates["clean"].to_json())
    with pytest.raises(jid.InputError, match="recordings"):
        read.causes()


def test_a_column_is_judged_where_it_was_not_fitted() -> None:
    rng = np.random.default_rng(0)
    known = np.sin(np.linspace(0.0, 60.0, 400))
    residual = known + rng.normal(0.0, 0.5, 400)
    noise = rng.normal(size=(400, 30))
    folds = Folds.of(np.column_stack([known, noise]), residual)
    assert folds is not None
    nothing, right = folds.misfit([]).sum(), folds.misfit([0]).sum()
    assert right < 0.5 * nothing
    assert (
        folds.misfit(list(range(1, 31))).sum() > nothing
    )  # 30 columns of noise fit, and predict nothing
    one = np.zeros(400, dtype=np.int64)
    rows, run = summed(residual[:, None], one, 4)
    assert (len(rows), len(run)) == (100, 100)
    assert rows[0, 0] == pytest.approx(residual[:4].sum())


def test_noise_is_not_suspicious_and_slow_structure_is() -> None:
    rng = np.random.default_rng(1)
    run, ones = np.zeros(1200, dtype=np.int64), np.ones(1200)
    velocity = np.sin(np.linspace(0.0, 40.0, 1200))
    alarms = sum(suspicious(rng.normal(size=1200), run, ones, velocity) for _ in range(200))
    assert alarms <= 2
    # Silent from one window to the next, loud over sixteen.
    slow = rng.normal(size=1200) + 0.5 * np.sin(np.linspace(0.0, 30.0, 1200))
    assert suspicious(slow, run, ones, velocity)


def test_a_filtered_velocity_is_no_friction_at_low_speed(runs: dict[str, jid.Recording]) -> None:
    estimate = jid.identify(runs["filtered velocity"], jid.thesis_joint(), search="separable")
    assert estimate.delays["velocity"].certain
    every = estimate.causes()
    first = (*every.found, *every.harmless)[0]
    assert first.name == "delay"
    assert first.detail.startswith("velocity")
    assert dict(first.advice[0].arguments) == {"columns": {"velocity": None}}
    assert not _SLOW & set(_named(estimate))


def test_a_velocity_that_is_measured_as_prompt_is_no_cause(
    estimates: dict[str, jid.Estimate],
) -> None:
    estimate = estimates["bristles"]
    assert not estimate.delays["velocity"].certain
    assert "delay" not in estimate.causes().tried or all(
        cause.detail != "velocity" for cause in estimate.causes().found
    )


def test_noise_of_a_sensor_is_no_structure(runs: dict[str, jid.Recording]) -> None:
    estimate = jid.identify(runs["loud sensor"], jid.thesis_joint(), search="separable")
    assert not {"structured_residual", *BY_NAME} & {found.code for found in estimate.findings}


def test_a_clipped_torque_is_its_own_cause(runs: dict[str, jid.Recording]) -> None:
    run = runs["clean"]
    torque = run.torque
    assert torque is not None
    limit = 0.7 * float(torque.max())
    run = jid.Recording(
        time=run.time,
        position=run.position,
        velocity=run.velocity,
        torque=np.minimum(torque, limit),
        sensor=run.sensor,
    )
    estimate = jid.identify(run, jid.thesis_joint(), search="separable")
    assert "torque_saturated" in {found.code for found in estimate.findings}
    assert _named(estimate) == []


def test_a_misfit_without_a_name_is_said_in_one_line(runs: dict[str, jid.Recording]) -> None:
    rng = np.random.default_rng(2)
    run = runs["clean"]
    wander = np.convolve(rng.normal(0.0, 0.15, len(run) + 99), np.ones(100), "valid")
    run = jid.Recording(
        time=run.time,
        position=run.position,
        velocity=run.velocity,
        torque=np.asarray(run.torque) + wander,
        sensor=run.sensor,
    )
    estimate = jid.identify(run, jid.thesis_joint(), search="separable")
    said = [f for f in estimate.findings if f.code in ("structured_residual", "poor_fit")]
    assert said
    count = len(estimate.causes().excluded)
    for found in said:
        assert f"none of {count} known causes" in found.message
        assert found.evidence["causes_excluded"].value == count
        assert len(found.message) <= 220


def test_a_load_of_gravity_and_a_part_of_the_inertia_is_named() -> None:
    # At this pace the link's inertia takes most of gravity's part away.
    motion = sines(np.radians([[25.0, 25.0, 20.0]]), np.array([[1.2, 2.3, 4.0]]))
    law = Law(inertia=3.0, stiffness=40.0, on_reference=1.0, gravity=7.0)
    plant = Plant(inertia=3.0, link_inertia=0.45, gravity=6.0, load_friction=0.15)
    log = Log(sensor=0.0, torque_noise=0.2)
    bench = Bench(motion=motion, law=law, plant=plant, log=log)
    (run,) = simulate(bench, duration=12.0, seed=2, finer=2)
    joint = jid.Joint(gear_ratio=101.0, model=jid.Model.parse("stribeck:gravity=free"))
    estimate = jid.identify(run, joint, search="separable")
    assert _named(estimate)[:1] == ["load_friction"]
    cause = estimate.causes().found[0]
    assert cause.share > 0.6
    assert cause.numbers["coefficient"].value == pytest.approx(0.15, abs=0.04)
