"""A servo's estimate is read back as it was saved."""

import json
from pathlib import Path

import numpy as np
import pytest
from simulated_servo import Truth, bench_runs, servo_joint

import jointid as jid


@pytest.mark.parametrize(
    "model", ["coulomb_viscous:load_friction", "coulomb_viscous:load_friction=false"]
)
def test_all_but_the_draws_is_read_back(tmp_path: Path, model: str) -> None:
    runs = bench_runs(Truth(), seed=4, runs=8)
    found = jid.identify_servo(runs, servo_joint(), model=jid.Model.parse(model))
    again = jid.ServoEstimate.load(found.save(tmp_path / "servo.json"))
    assert again.report(verbose=True) == found.report(verbose=True)
    assert again.to_json() == found.to_json()
    assert np.array_equal(again.values, found.values)
    assert jid.rollout(again, runs).median == jid.rollout(found, runs).median


def test_a_file_from_before_there_were_models_is_read() -> None:
    found = jid.identify_servo(bench_runs(Truth(), seed=4, runs=8), servo_joint(), draws=0)
    document = json.loads(found.to_json())
    del document["settings"]["model"]
    again = jid.ServoEstimate.from_json(json.dumps(document))
    assert again.to_json() == found.to_json()


def test_what_does_not_fit_together_is_refused(tmp_path: Path) -> None:
    runs = bench_runs(Truth(), seed=4, runs=8)
    found = jid.identify_servo(runs, servo_joint())
    text = found.to_json()
    for old, new, message in (
        ('"jointid servo"', '"jointid robot"', "not a servo's estimate"),
        ('"name": "inertia"', '"name": "mass"', "differs from the key"),
        ('"run 0",', "", "one number for each of the runs"),
        ('"schema": 1,\n "kind"', '"schema": 2,\n "kind"', "schema"),
    ):
        assert old in text
        path = tmp_path / "servo.json"
        path.write_text(text.replace(old, new), encoding="utf-8")
        with pytest.raises(jid.InputError, match=message):
            jid.ServoEstimate.load(path)
