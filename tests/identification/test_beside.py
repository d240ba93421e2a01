"""Work of the core that is begun by one call and fetched by another."""

from __future__ import annotations

import gc
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from example_recordings import WELL_EXCITED

import jointid as jid
from jointid import _core
from jointid.identification.prepared import prepare
from jointid.identification.warnings.inspection import inspect

MANY = 200_000  # samples from which on it is done at once, by all threads


@pytest.fixture(scope="module")
def well_excited() -> jid.Recording:
    return jid.load(WELL_EXCITED)


@pytest.fixture(scope="module")
def prepared(well_excited: jid.Recording) -> Any:
    return prepare(well_excited, jid.thesis_joint())


def shifts(prepared: Any, threads: int) -> Any:
    problem, domain = prepared.problem, prepared.domain
    found = _core.minimise_projected(prepared.penalty, domain.lower, domain.upper).found
    assert found is not None
    return _core.window_shifts(
        prepared.penalty,
        recordings=problem.in_core,
        terms=list(problem.choice.terms),
        mask_standstill=True,
        gear_ratio=problem.choice.gear_ratio,
        per_recording=[],
        lower=domain.lower,
        upper=domain.upper,
        best=found.best,
        threads=threads,
    )


def ripple(prepared: Any, windows: _core.WindowOptions, threads: int = 0) -> Any:
    problem = prepared.problem
    return _core.ripple(
        recordings=problem.in_core,
        terms=list(problem.choice.terms),
        windows=windows,
        residual=_core.Residual.torque,
        mask_standstill=True,
        gear_ratio=problem.choice.gear_ratio,
        per_recording=[],
        theta=np.ones(len(prepared.penalty.names)),
        halves=4,
        threads=threads,
    )


def test_a_thread_of_its_own_changes_no_bit(prepared: Any) -> None:
    alone, beside = shifts(prepared, 1).result(), shifts(prepared, 2).result()
    for one, other in zip(alone, beside, strict=True):
        np.testing.assert_array_equal(one, other)
    fine = _core.WindowOptions(duration=0.01)
    alone, beside = ripple(prepared, fine, 1).result(), ripple(prepared, fine, 2).result()
    assert alone[:2] == beside[:2]
    np.testing.assert_array_equal(alone[2], beside[2])


def test_what_was_found_is_handed_over_once(well_excited: jid.Recording) -> None:
    inspected = inspect(well_excited)
    assert inspected.found is inspected.found


@pytest.mark.parametrize("threads", [1, 2])
def test_what_it_met_is_raised_where_it_is_fetched(prepared: Any, threads: int) -> None:
    begun = ripple(prepared, _core.WindowOptions(duration=1e6), threads)
    for _ in range(2):
        with pytest.raises(jid.InputError, match="window"):
            begun.result()


def test_work_outlives_what_it_was_begun_with(well_excited: jid.Recording) -> None:
    """Its arrays, recordings and penalty are its own, and nobody has to fetch what it finds."""
    own = prepare(well_excited, jid.thesis_joint())
    expected = shifts(own, 1).result()
    begun = shifts(own, 2)
    copies = {n: np.array(getattr(well_excited, n)) for n in ("time", "position", "velocity")}
    other = _core.inspect(**copies, velocity_derived=False, period=1e-3, channels=[])
    del own, copies
    gc.collect()
    np.testing.assert_array_equal(begun.result()[0], expected[0])
    assert other.result().peak_speed == inspect(well_excited).found.peak_speed
    inspect(well_excited)


def test_long_work_is_done_at_once_and_says_at_once_what_it_met() -> None:
    time = np.arange(MANY) * 1e-3
    run = jid.Recording(
        time=time, position=np.sin(time), velocity=np.cos(time), torque=np.sin(time)
    )
    with pytest.raises(jid.InputError, match="window"):
        ripple(prepare(run, None, model="coulomb_viscous"), _core.WindowOptions(duration=1e6))


def test_several_recordings_are_looked_at_one_after_the_other(
    well_excited: jid.Recording, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Not by as many threads as there are recordings, whatever `threads` says."""
    begun, fetched = [], []

    def counted(run: jid.Recording, threads: int = 0) -> Any:
        begun.append(run)
        work = SimpleNamespace(result=lambda: fetched.append(len(begun)))
        return SimpleNamespace(work=work)

    monkeypatch.setattr("jointid.identification.warnings.inspection.inspect", counted)
    single = prepare(well_excited, jid.thesis_joint())
    single.inspected()
    assert (len(begun), fetched) == (1, [])
    halves = [well_excited.crop(stop=6.0), well_excited.crop(start=6.0)]
    prepare(halves, jid.thesis_joint()).inspected()
    assert (len(begun), fetched) == (3, [2, 3])
