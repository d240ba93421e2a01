"""Signals of impossible magnitude, and joints without a name, are refused in one sentence."""

import warnings

import pytest
from example_recordings import WELL_EXCITED as PATH

import jointid as jid


@pytest.mark.parametrize("factor", [1e300, -1e150, 1e-300])
def test_a_magnitude_without_a_square_is_refused(factor: float) -> None:
    recorded = jid.load(PATH)
    assert recorded.torque is not None
    run = recorded.with_signals(torque=factor * recorded.torque)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(jid.InputError, match=r"check unit and scale$") as refused:
            jid.identify(run, jid.thesis_joint())
    assert refused.value.argument == "torque"
    assert run.torque is not None
    assert refused.value.value == abs(run.torque).max()


def test_a_joint_without_a_name_is_the_joint() -> None:
    run = jid.load(PATH)
    with pytest.raises(jid.InputError, match=r": joint is prismatic;"):
        jid.identify(run, jid.Joint(kind="prismatic", inertia=1.0))
