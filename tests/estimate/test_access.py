"""An estimate by names, and as a data frame."""

from pathlib import Path

import numpy as np
import pytest

import jointid as jid


@pytest.fixture(scope="module")
def estimate(repo: Path) -> jid.Estimate:
    run = jid.load(repo / "examples" / "data" / "well_excited.csv.gz")
    return jid.identify(run, jid.thesis_joint())


def test_names_give_parameters_and_derived_quantities(estimate: jid.Estimate) -> None:
    assert estimate["coulomb"] is estimate.parameters["coulomb"]
    assert estimate["breakaway"].value == estimate.derived["breakaway"].value
    assert "viscous" in estimate
    assert "breakaway" in estimate
    assert "nonsense" not in estimate


@pytest.mark.parametrize("name", ["coulmb", 3, None])
def test_other_names_are_refused(estimate: jid.Estimate, name: str) -> None:
    with pytest.raises(jid.InputError, match="no such parameter"):
        estimate[name]


def test_an_estimate_is_no_sequence(estimate: jid.Estimate) -> None:
    with pytest.raises(TypeError, match="not iterable"):
        iter(estimate)  # type: ignore[call-overload]


def test_a_data_frame_has_every_value_with_its_interval(estimate: jid.Estimate) -> None:
    frame = estimate.to_pandas()
    assert list(frame.index) == [*estimate.parameters, *estimate.derived]
    for name, p in estimate.parameters.items():
        row = frame.loc[name]
        assert row["value"] == p.value
        assert p.interval is None or (row["low"], row["high"]) == p.interval
        assert row["unit"] == p.unit
        assert row["vary"] == p.vary
    np.testing.assert_array_less(frame["low"].dropna(), frame["high"].dropna())
