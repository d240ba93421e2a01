"""Tolerances of given facts: what they may be, and files that give them back."""

from pathlib import Path

import pytest

import jointid as jid
from jointid.joint.tolerances import Tolerances

FILE = """schema = 2
[drive]
torque_constant = 0.2
gear_ratio = 101   # exact

[tolerances]
torque_constant = "± 5%"   # the data sheet
rotor_inertia = 1e-5
"""


def test_a_file_gives_them_back(tmp_path: Path) -> None:
    path = tmp_path / "joint.toml"
    path.write_text(
        FILE.replace("gear_ratio", "rotor_inertia = 2e-4\ngear_ratio"), encoding="utf-8"
    )
    joint = jid.Joint.load(path)
    assert joint.tolerances == Tolerances(torque_constant="5 %", rotor_inertia=1e-5)
    joint.replace(tolerances={"torque_constant": "4 %"}).save(path)
    text = path.read_text(encoding="utf-8")
    assert 'torque_constant = "4 %"   # the data sheet' in text
    assert "rotor_inertia = 1e-5" not in text
    assert jid.Joint.load(path).tolerances.given == {"torque_constant": "4 %"}


@pytest.mark.parametrize(
    ("line", "reason"),
    [
        ('torque_constant = "5"', r'\[tolerances\]: torque_constant is .*"5 %"'),
        ('torque_constant = "100 %"', r"\[tolerances\]: torque_constant"),
        ("torque_constant = -1.0", r"\[tolerances\]: torque_constant .*0 or more"),
        ("torque_constant = true", r"\[tolerances\]: torque_constant"),
        ('torque_konstant = "5 %"', r"\[tolerances\]: .*did you mean 'torque_constant'"),
        ("inertia = 0.1", "inertia .*the joint does not state this fact"),
        ('mass = "5 %"', "mass .*there is no link"),
        ('mass_tolerance = "5 %"', r"\[tolerances\].*no such key"),
    ],
)
def test_what_cannot_be_is_refused_by_its_place(tmp_path: Path, line: str, reason: str) -> None:
    path = tmp_path / "joint.toml"
    path.write_text(FILE.split('torque_constant = "±')[0] + line + "\n", encoding="utf-8")
    with pytest.raises(jid.InputError, match=reason) as caught:
        jid.Joint.load(path)
    assert "joint.toml: [tolerances]" in str(caught.value)


def test_a_share_needs_no_fact() -> None:
    joint = jid.Joint(tolerances={"torque_constant": "0.5%", "inertia": "+-10 %"})  # type: ignore[arg-type]
    assert joint.tolerances.given == {"torque_constant": "0.5 %", "inertia": "10 %"}
    assert joint.tolerances.size("torque_constant", None) is None
    assert joint.tolerances.size("inertia", 2.0) == pytest.approx(0.2)
    with pytest.raises(jid.InputError, match="did you mean 'mass'"):
        jid.Joint(tolerances={"mas": "1 %"})  # type: ignore[arg-type]
