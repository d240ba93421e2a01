"""A cause is one row: joint, robot and servo name it; and a new row of friction in the core's table is such a cause."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import plain_joint
import pytest
import small_arm
from simulated_servo import Bench, bench_runs, servo_joint

import jointid as jid
from jointid import _core
from jointid.identification.causes import candidates, families
from jointid.identification.causes.candidates import other_laws
from jointid.identification.causes.families import BY_NAME, FAMILIES, OTHER_LAW
from jointid.identification.warnings import causes as warned

_QUADRATIC = SimpleNamespace(
    **dict.fromkeys(("needs_load", "side", "at_rest", "settles"), 0),
    friction=True,
    key="quadratic",
    name="quadratic",
    basis="quadratic",
    shapes=(),
    meaning="quadratic friction",
    unit="N·m·s²/rad²",
    unit_prismatic="N·s²/m²",
)


@pytest.fixture(name="row")
def _row(monkeypatch: pytest.MonkeyPatch) -> SimpleNamespace:
    """The core with a term in its table that no model has yet."""

    def basis(key: str, velocity: np.ndarray, shapes: np.ndarray) -> np.ndarray:
        if key == _QUADRATIC.key:
            return np.asarray(velocity * np.abs(velocity))
        return _core.friction_basis(key, velocity, shapes)

    core = SimpleNamespace(
        terms=lambda: [*_core.terms(), _QUADRATIC],
        friction_basis=basis,
        shape=_core.shape,
        circle=_core.circle,
    )
    monkeypatch.setattr(candidates, "_core", core)
    monkeypatch.setattr(families, "FAMILIES", (*FAMILIES, OTHER_LAW))
    monkeypatch.setitem(BY_NAME, OTHER_LAW.name, OTHER_LAW)
    monkeypatch.setitem(warned.TYPES, OTHER_LAW.name, OTHER_LAW.finding_type)
    return core


def test_other_causes_stand_for_todays_friction() -> None:
    """So there is no such cause; a term for which none stands brings it."""
    known = {"constant", "linear", "gaussian", "general", "rising", "load"}
    others = {term.basis for term in _core.terms() if term.friction} - known
    assert {term.basis for term in other_laws()} == others
    assert (OTHER_LAW in FAMILIES) == bool(others)


@pytest.mark.usefixtures("row")
def test_a_joint_names_it() -> None:
    time, position, velocity, acceleration = plain_joint.motion()
    torque = plain_joint.torque(velocity, acceleration) + velocity * np.abs(velocity)
    torque += np.random.default_rng(0).normal(0.0, 0.02, len(time))
    found = jid.identify(
        jid.Recording(time=time, position=position, torque=torque), model="coulomb_viscous"
    )
    (told,) = [each for each in found.warnings if each.code in BY_NAME]
    assert told.code == "other_law"
    assert told.title.startswith("friction of another model (quadratic friction, 1.01 N·m·s²/rad²)")
    moved = 1.0 + told.evidence["viscous.shift"].value
    viscous = found.parameters["viscous"].value
    assert viscous * moved == pytest.approx(plain_joint.VISCOUS, rel=0.02)


@pytest.mark.usefixtures("row")
def test_a_robots_joint_names_it(tmp_path: Path) -> None:
    pytest.importorskip("pinocchio")
    path = small_arm.urdf(tmp_path)

    def friction(speed: np.ndarray) -> np.ndarray:
        plain = small_arm.COULOMB * np.sign(speed) + small_arm.VISCOUS * speed
        return np.asarray(plain + [0.0, 1.0] * speed * np.abs(speed))

    found = jid.identify_robot(
        small_arm.recording(path, friction=friction), jid.Robot.from_urdf(path)
    )
    told = [each for each in found.warnings if each.code in BY_NAME]
    assert [each.code for each in told] == ["other_law"]
    assert told[0].title.startswith("elbow: friction of another model (quadratic friction, 0.99")


def test_a_servo_names_it(row: SimpleNamespace) -> None:
    """Of the bases that the bench's core has, one of which no other cause has the shape stands for the row."""
    row.friction_basis = lambda _, speed, __: np.sign(speed) * np.exp(-((np.abs(speed) / 3.0) ** 4))
    bench = Bench(friction=(("general", 0.03, 0.03, (3.0, 4.0)),))
    found = jid.identify_servo(bench_runs(seed=1, bench=bench), servo_joint(), draws=20)
    told = [each for each in found.warnings if each.code in BY_NAME]
    assert [each.code for each in told] == ["other_law"]
    assert told[0].evidence["coefficient"].value == pytest.approx(0.03, rel=0.1)
