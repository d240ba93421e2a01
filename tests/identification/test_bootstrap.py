"""The block bootstrap: the same bits for a seed, and errors like those reported."""

import time

import numpy as np
import pytest

import jointid as jid
from jointid.cli.demonstration import data_folder


@pytest.fixture(scope="module")
def estimate() -> jid.Estimate:
    run = jid.load(data_folder() / "kr300_joint1.csv.gz")
    joint = jid.Joint.load(data_folder() / "kr300_joint1.toml")
    return jid.identify(run, joint, search="separable")


def test_its_errors_are_like_those_reported(estimate: jid.Estimate) -> None:
    began = time.process_time()
    found = estimate.bootstrap()
    assert time.process_time() - began < 1.0
    assert found.samples.shape == (1000, 4)
    for p in found.parameters.values():
        assert p.ratio is not None
        assert 0.6 < p.ratio < 1.6
        assert p.interval[0] < p.value < p.interval[1]
    assert "1000 draws of 8 blocks" in found.report()


def test_the_same_seed_gives_the_same_bits(estimate: jid.Estimate) -> None:
    samples = estimate.bootstrap(200, seed=3).samples
    assert np.array_equal(samples, estimate.bootstrap(200, seed=3).samples)
    assert np.array_equal(samples[:50], estimate.bootstrap(50, seed=3).samples)
    assert not np.array_equal(samples, estimate.bootstrap(200, seed=4).samples)


def test_a_bound_holds_and_gives_percentiles() -> None:
    run = jid.load(data_folder() / "kr300_joint1.csv.gz")
    joint = jid.Joint.load(data_folder() / "kr300_joint1.toml")
    limits = {"viscous": {"min": 1800.0, "max": 1850.0}}
    found = jid.identify(run, joint, parameters=limits, search="separable").bootstrap(300)
    place = list(found.parameters).index("viscous")
    assert np.all((found.samples[:, place] >= 1800.0) & (found.samples[:, place] <= 1850.0))
    p = found.parameters["viscous"]
    assert p.near_bound
    assert (p.interval[0], p.interval[1]) == pytest.approx((1800.0, 1850.0))
    assert not found.parameters["inertia"].near_bound


def test_without_recordings_it_says_so(estimate: jid.Estimate) -> None:
    read = jid.Estimate.from_json(estimate.to_json())
    with pytest.raises(jid.InputError, match="does not contain the recordings; identify again"):
        read.bootstrap()
    with pytest.raises(jid.InputError, match="n is 3"):
        estimate.bootstrap(3)
