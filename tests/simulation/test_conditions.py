"""The study of many conditions: it names what it should, and counts what is off and unnamed."""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

BENCHMARKS = Path(__file__).resolve().parents[2] / "benchmarks"
sys.path.insert(0, str(BENCHMARKS))
import conditions_study as study  # noqa: E402
from conditions import CONDITIONS, Condition  # noqa: E402
from store import Store  # noqa: E402


def test_the_study_has_46_conditions_and_one_clean_one_of_each_kind() -> None:
    assert len(CONDITIONS) == len({condition.name for condition in CONDITIONS}) == 46
    clean = [condition for condition in CONDITIONS if condition.clean]
    assert {condition.sensor for condition in clean} == {True, False}
    assert {condition.motion for condition in clean} >= {"thesis", "sines", "trapezoids", "chirp"}


def test_joints_differ_and_do_not_depend_on_what_else_runs() -> None:
    rngs = (np.random.default_rng([0, 3]) for _ in range(2))
    first, second = (CONDITIONS[3].bench(4, rng) for rng in rngs)
    np.testing.assert_array_equal(first.plant.coulomb, second.plant.coulomb)
    assert np.unique(np.asarray(first.plant.coulomb)).size == 4


def test_a_clean_condition_and_a_mismatch_are_counted(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(study, "DURATION", 4.0)
    clean = Condition(name="clean", clean=True, duration=4.0)
    wrong = Condition(name="wrong", duration=4.0, plant={"torque_scale": 1.3})
    monkeypatch.setattr(study, "CONDITIONS", (clean, wrong))
    store = Store(tmp_path / "kept.jsonl", {"seed": 5})
    study.measure(store, (clean, wrong), 2, 5)
    # What is kept is not measured again.
    monkeypatch.setattr(study, "simulate", None)
    again = Store(tmp_path / "kept.jsonl", {"seed": 5})
    study.measure(again, (clean, wrong), 2, 5)
    found = {each.name: study.outcomes(again, each) for each in (clean, wrong)}
    assert [len(found[name]) for name in ("clean", "wrong")] == [2, 2]
    for each in found["clean"]:
        assert each.off == []
        assert max(map(abs, each.errors.values())) < 0.05
    for each in found["wrong"]:
        assert {"coulomb", "viscous"} <= set(each.off)
        assert "wrong_scale" in each.codes
        assert each.unnamed == []  # a blocking finding is about every value
    assert "2/2" in study.row(clean, found["clean"])
    assert "0/2" in study.row(wrong, found["wrong"])
    silent = replace(found["wrong"][0], named=frozenset())
    assert study.unnamed([(clean, found["clean"]), (wrong, found["wrong"])]) == "none"
    assert study.unnamed([(wrong, [silent])]) == f"**{len(silent.off)}** (wrong)"
