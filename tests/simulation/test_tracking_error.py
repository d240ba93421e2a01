"""The tracking error that a simulation tells, and the motions that it refuses to go on with."""

import numpy as np
import pytest
from closed_loop import TRUTH, thesis_joint

import jointid as jid
from jointid import _core


@pytest.fixture(scope="module")
def joint() -> jid.Joint:
    return thesis_joint().with_parameters(TRUTH)


@pytest.mark.parametrize("step", [1.0, -1.0])
@pytest.mark.parametrize("settling", [0.0, 0.05])
def test_the_error_is_that_of_the_true_position(
    joint: jid.Joint, step: float, settling: float
) -> None:
    """Not of what a coarse encoder shows; the largest counts to either side."""
    batch = jid.simulate_batch(
        joint,
        jid.Pd(stiffness=500.0, damping=100.0),
        jid.Trajectory.step(step, duration=0.3),
        sensors=_core.Sensors(encoder_counts=50),
        position=0.0,
        settling=settling,
        recordings=True,
    )
    recording = batch.recordings[0]
    error = recording.truth.signals["position"] - np.asarray(recording.reference)
    settled = error[np.asarray(recording.time) >= settling - 1e-9]
    assert batch.peak_error[0] == np.abs(settled).max()
    assert batch.error[0] == pytest.approx(np.sqrt(np.mean(settled**2)), rel=1e-12)


@pytest.mark.parametrize("start", [{"position": 2e12}, {"velocity": 2e12}])
def test_a_motion_beyond_all_bounds_is_refused(joint: jid.Joint, start: dict[str, float]) -> None:
    """Of the position or of the velocity alone."""
    push = jid.Trajectory.step(0.0, duration=0.1)
    with pytest.raises(jid.InputError, match=r"the simulation diverges 0\.0+ s after its start"):
        jid.simulate(joint, jid.OpenLoop(), push, **start)  # type: ignore[call-overload]
