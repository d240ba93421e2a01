"""A real arm of hobby servos: identified from one motion, and judged by rolling out another one."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import numpy as np
import pytest

PLACE = "JOINTID_SO101"


@pytest.mark.slow
def test_another_motion_is_rolled_out_better_than_with_published_values(
    repo: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("mujoco")
    if PLACE not in os.environ:
        pytest.skip(f"{PLACE} does not name a folder with the logs of an SO-101")
    monkeypatch.setattr(sys, "path", [str(repo / "benchmarks"), *sys.path])
    import so101_study as study

    folder = Path(os.environ[PLACE])
    gain, spread, (found, *_) = study.identified(folder, study.recording(folder, "frequency_sweep"))
    assert spread < 0.25 * gain
    judged, ours = study.recording(folder, "coupled_joints"), study.values_of(found)
    lift = study.NAMES.index("shoulder_lift")
    error = study.errors(judged, study.rolled_out(folder, judged, gain, ours))
    assert error.max() < 0.01
    for armature, dry in study.PUBLISHED:
        other = {key: np.array(value) for key, value in ours.items()}
        other["rotor_inertia"][lift], other["coulomb"][lift] = armature, dry
        assert (
            error[lift] < study.errors(judged, study.rolled_out(folder, judged, gain, other))[lift]
        )
