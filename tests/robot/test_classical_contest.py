"""TX40's held-out blocks: our prediction beside filtered inverse dynamics; and that the latter is done well."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("pinocchio")

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "benchmarks"))
from arms import classical, tx40, tx40_tables

JOINTS = range(1, tx40.JOINTS + 1)


@pytest.fixture(scope="module")
def log(shared_data: Path) -> tx40_tables.Log:
    return tx40_tables.Log.read(shared_data / "tx40")


def test_the_classical_way_gives_the_published_friction(log: tx40_tables.Log) -> None:
    """Or the comparison would be with a straw man."""
    signals = classical.filtered(log.time, log.position, log.torque, 20.0)
    rows = classical.rows_of(tx40.urdf(log.folder), tx40.sources(), signals, 50)
    values = tx40.as_published(classical.fit(rows, log.moving[::50]).value)
    for joint in JOINTS:
        viscous = tx40.VISCOUS[str(joint)]
        assert values[f"viscous {joint}"] == pytest.approx(viscous, rel=0.03)
        if joint < 6:
            coulomb = tx40.COULOMB[str(joint)]
            assert values[f"coulomb {joint}"] == pytest.approx(coulomb, rel=0.03)
    assert values["viscous motor 6"] == pytest.approx(tx40.VISCOUS[tx40.MOTOR_6], rel=0.02)
    assert values["coulomb motor 6"] == pytest.approx(tx40.COULOMB[tx40.MOTOR_6], rel=0.02)


@pytest.mark.slow
def test_ours_predicts_held_out_blocks_as_well(log: tx40_tables.Log) -> None:
    theirs = tx40_tables.held_out_of_classical(log, tx40_tables.MOTION, 25)
    mine = tx40_tables.held_out_of_ours(log, tx40_tables.MOTION, inertia="free")
    for length in tx40_tables.LENGTHS:
        ours, other = mine[length], theirs[length]
        below = np.sum(ours.joints <= other.joints)
        assert below >= 5, (length, ours.joints.round(4), other.joints.round(4))
        assert ours.total <= other.total
