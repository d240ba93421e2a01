"""A search whose penalty is begun before delays are known finds what it finds without."""

from __future__ import annotations

import gc
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from example_recordings import WELL_EXCITED

import jointid as jid
from jointid import _core
from jointid.identification.prepared import Prepared, prepare
from jointid.identification.search.ahead import Ahead

JOINT = jid.thesis_joint()
STATED = {"stribeck": {"min": 1.0, "max": 400.0}, "viscous": 20.0}


@pytest.fixture(scope="module")
def clean() -> jid.Recording:
    return jid.load(WELL_EXCITED)


@pytest.fixture(scope="module")
def late(clean: jid.Recording) -> jid.Recording:
    """Its reading comes four samples late."""
    assert clean.sensor is not None
    return clean.with_signals(sensor=np.concatenate([clean.sensor[:4], clean.sensor[:-4]]))


def fading() -> jid.Recording:
    """Dry friction that loses a third over the recording, and a torque that is clipped."""
    time = np.arange(20_000) * 1e-3
    velocity = 2.0 * np.sin(2.0 * time) + 0.7 * np.sin(5.3 * time)
    position = -np.cos(2.0 * time) - 0.7 / 5.3 * np.cos(5.3 * time)
    acceleration = 4.0 * np.cos(2.0 * time) + 3.71 * np.cos(5.3 * time)
    dry = 10.0 * (1.0 - 0.3 * time / time[-1]) * np.sign(velocity)
    torque = 0.5 * acceleration + 3.0 * velocity + dry
    most = float(np.quantile(np.abs(torque), 0.975))
    clipped = np.clip(torque, -most, most)
    return jid.Recording(time=time, position=position, velocity=velocity, torque=clipped)


def values_of(estimate: jid.Estimate) -> dict[str, tuple[float, float | None]]:
    return {name: (each.value, each.stderr) for name, each in estimate.parameters.items()}


@pytest.fixture
def begun(monkeypatch: pytest.MonkeyPatch) -> list[Ahead | None]:
    """What each identification begins."""
    kept: list[Ahead | None] = []
    original: Callable[..., Ahead | None] = Ahead.begin

    def begin(*arguments: Any) -> Ahead | None:
        kept.append(original(*arguments))
        return kept[-1]

    monkeypatch.setattr(Ahead, "begin", begin)
    return kept


def prepared(run: jid.Recording, joint: jid.Joint | None = JOINT, **options: Any) -> Prepared:
    return prepare(run, joint, ahead=True, threads=2, **options)


CALLS: dict[str, dict[str, Any]] = {
    "as it is": {},
    "200 windows": {"windows": 200},
    "stated bounds": {"parameters": STATED},
    "reading": {"residual": "sensor"},
    "torque": {"residual": "torque"},
    "running integrals": {"windows": "cumulative"},
    "instruments of them": {"windows": "cumulative", "residual": "instruments"},
    "both directions": {"model": "stribeck:asymmetric"},
    "ripple": {"model": "stribeck:ripple=2"},
    "fixed gain": {"parameters": {"sensor_gain": 2.4}},
    "standing": {"mask_standstill": False},
    "no shape": {"model": "coulomb_viscous"},
    "fixed exponent": {
        "model": "stribeck_general",
        "parameters": {"stribeck_exponent": 1.5},
    },
    "random": {"search": "random"},
}


@pytest.mark.parametrize("call", CALLS)
def test_it_finds_the_same_bits(
    call: str,
    clean: jid.Recording,
    begun: list[Ahead | None],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    options = {"search": "ga"} | CALLS[call]
    search = jid.Search(options.pop("search"), threads=2)
    found = jid.identify(clean, JOINT, search=search, **options)
    assert begun[0] is not None
    monkeypatch.setattr(Ahead, "begin", lambda *_: None)
    alone = jid.identify(clean, JOINT, search=search, **options)
    assert values_of(found) == values_of(alone)
    assert found.settings == alone.settings
    assert found.findings == alone.findings


def test_it_is_what_is_searched(clean: jid.Recording, monkeypatch: pytest.MonkeyPatch) -> None:
    """Neither the penalty nor its compressed form is made again."""

    def again(*_: Any, **__: Any) -> None:
        raise AssertionError("made again")

    search = jid.Search("ga", threads=2)
    jid.identify(clean, JOINT, search=search)
    monkeypatch.setattr(_core, "CompressedPenalty", again)
    monkeypatch.setattr(_core, "Penalty", again)
    jid.identify(clean, JOINT, search=search)


def test_it_is_let_go_of_where_a_delay_is_taken_away(
    late: jid.Recording, begun: list[Ahead | None], monkeypatch: pytest.MonkeyPatch
) -> None:
    search = jid.Search("ga", threads=2)
    found = jid.identify(late, JOINT, search=search)
    assert begun[0] is not None
    assert found.settings["shift"]["sensor"] == pytest.approx(4e-3, abs=1e-3)
    ready = prepared(late)
    assert ready.ahead is None
    assert begun[1] is not None
    assert begun[1].compressed(ready.penalty, ready.domain) is None
    monkeypatch.setattr(Ahead, "begin", lambda *_: None)
    assert values_of(jid.identify(late, JOINT, search=search)) == values_of(found)


def test_an_estimate_does_not_hold_it(clean: jid.Recording, late: jid.Recording) -> None:
    for run in (clean, late):
        estimate = jid.identify(run, JOINT, search=jid.Search("ga", threads=2))
        again: Any = estimate.follow_up
        held = again.again.func.__self__
        assert held.ahead is None
        assert held.looked == ()


def test_a_second_fit_looks_at_its_own_signals(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without the drift that was taken away, whose clipped torque is one no longer."""
    run = fading()
    search = jid.Search("ga", threads=2)
    found = jid.identify(run, None, model="coulomb_viscous", search=search)
    assert "drift" in {each.code for each in found.findings}
    monkeypatch.setattr(Ahead, "begin", lambda *_: None)
    alone = jid.identify(run, None, model="coulomb_viscous", search=search)
    assert found.findings == alone.findings


def test_a_compressed_form_is_of_its_shapes_bounds(clean: jid.Recording) -> None:
    ready, other = prepared(clean), prepared(clean, parameters=STATED)
    assert ready.ahead is not None
    assert ready.ahead.compressed(ready.penalty, other.domain) is None
    compressed = ready.ahead.compressed(ready.penalty, ready.domain)
    assert compressed is not None
    assert compressed.exact


def test_the_reading_is_projected_once(clean: jid.Recording) -> None:
    ready = prepared(clean)
    assert ready.ahead is not None
    alone = prepare(clean, JOINT, threads=2)
    assert ready.penalty is ready.ahead.work.result()
    assert ready.penalty.first_stage is not None
    at = ready.domain.lower
    assert ready.penalty(at) == alone.penalty(at)


@pytest.mark.parametrize(
    "options",
    [
        {"shift": {"sensor": 1e-3}},
        {"min_speed": 0.1},
        {"threads": 1},
        {"model": "stribeck_general"},
        {"model": {"name": "stribeck", "load_friction": "link"}},
        {"parameters": {"stribeck": {"min": -1.0, "max": -2.0}}},
        {"parameters": {"unheard_of": 1.0}},
        {"windows": -1.0},
    ],
    ids=lambda options: next(iter(options)),
)
def test_where_it_is_not_begun(
    options: dict[str, Any], clean: jid.Recording, begun: list[Ahead | None]
) -> None:
    """Where it would not be used, or would keep the call waiting, or cannot be: then the call says why."""

    def said(**more: Any) -> str:
        try:
            assert prepare(clean, JOINT, **(more | options)).ahead is None
        except jid.InputError as error:
            return str(error)
        return ""

    assert said(ahead=True, threads=2) == said()
    assert begun in ([], [None])


def test_several_recordings_begin_nothing(clean: jid.Recording) -> None:
    halves = [clean.crop(stop=6.0), clean.crop(start=6.0)]
    assert prepare(halves, JOINT, ahead=True, threads=2).ahead is None


def test_windows_that_cannot_be_cut_are_refused_alike(
    clean: jid.Recording, begun: list[Ahead | None]
) -> None:
    slow = jid.Recording(
        time=clean.time * 1e3,
        position=clean.position,
        velocity=clean.velocity * 1e-3,
        torque=clean.torque,
        sensor=clean.sensor,
    )
    for run, windows, why in ((clean, 1e6, "window"), (slow, 1e9, "seconds")):
        with pytest.raises(jid.InputError, match=why) as ours:
            prepared(run, windows=windows)
        with pytest.raises(jid.InputError) as alone:
            prepare(run, JOINT, windows=windows)
        assert str(ours.value) == str(alone.value)
    assert begun[0] is not None


def begin(ready: Prepared, lower: Any, upper: Any, windows: float = 200) -> Any:
    problem = ready.problem
    return _core.begin_search(
        recordings=problem.in_core,
        terms=list(problem.choice.terms),
        windows=problem.window_options(windows),
        residual=_core.Residual.torque,
        mask_standstill=True,
        gear_ratio=1.0,
        per_recording=[],
        free=[],
        lower=lower,
        upper=upper,
        threads=2,
    )


def test_a_penalty_outlives_a_compressed_form_that_fails(clean: jid.Recording) -> None:
    ready = prepare(clean, JOINT)
    size = len(ready.penalty.names)
    work = begin(ready, np.ones(size), np.zeros(size))
    penalty = work.result()
    assert penalty is work.result()
    for _ in range(2):
        with pytest.raises(ValueError, match="lower <= upper"):
            work.further()
    assert penalty.window_count > 100


def test_windows_that_only_a_shift_makes_possible_are_no_error(clean: jid.Recording) -> None:
    ready = prepared(clean)
    assert ready.ahead is not None
    failed = replace(ready.ahead, work=begin(ready, ready.domain.lower, ready.domain.upper, 1e6))
    assert failed.compressed(ready.penalty, ready.domain) is None


def test_what_is_begun_needs_nobody_to_wait_for_it(clean: jid.Recording) -> None:
    """Nor does its second step need anybody to keep what the first one found."""
    ready = prepare(clean, JOINT)
    expected = _core.CompressedPenalty(ready.penalty, ready.domain.lower, ready.domain.upper)
    work = begin(ready, ready.domain.lower, ready.domain.upper)
    work.result()
    gc.collect()
    assert work.further().passes == expected.passes
    begin(ready, ready.domain.lower, ready.domain.upper)


def test_work_of_one_step_has_no_further_one(clean: jid.Recording) -> None:
    assert prepared(clean).looked[0].work.further() is None
