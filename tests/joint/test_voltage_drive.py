"""A drive whose input is a voltage: its values, and its tables in a joint file."""

import pickle
from pathlib import Path

import pytest

import jointid as jid

TEXT = """schema = 2
name = "servo"

[drive]
input = "voltage"  # the duty divides it
supply = 7.3
resistance = 4.0
torque_constant = 0.36

[drive.position_loop]
gain = 0.0028774  # per unit of the firmware's gain
saturation = 0.9
delay = 0.002

[drive.signals]
duty = "pwm"
gain = "firmware_kp"

[link]
mass = 0.49
centre_of_mass = 0.1
angle = "-90deg"
"""


def written(folder: Path, text: str = TEXT) -> Path:
    path = folder / "servo.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_a_joint_file_describes_it_and_keeps_its_comments(tmp_path: Path) -> None:
    path = written(tmp_path)
    joint = jid.Joint.load(path)
    assert joint.voltage == jid.VoltageDrive(
        resistance=4.0,
        supply=7.3,
        position_loop=jid.PositionLoop(gain=0.0028774, saturation=0.9, delay=0.002),
        signals={"duty": "pwm", "gain": "firmware_kp"},
    )
    joint.replace(torque_constant=0.4).save(path)
    assert "# per unit of the firmware's gain" in path.read_text()
    assert "# the duty divides it" in path.read_text()
    assert jid.Joint.load(path) == joint.replace(torque_constant=0.4)
    new = tmp_path / "new.toml"
    joint.save(new)
    assert jid.Joint.load(new) == joint
    assert pickle.loads(pickle.dumps(joint)) == joint


def test_a_torque_is_the_usual_input(tmp_path: Path) -> None:
    text = 'schema = 2\n[drive]\ninput = "torque"\n'
    assert jid.Joint.load(written(tmp_path, text)).voltage is None


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('input = "voltage"', 'input = "voltge"', r"\[drive\].*voltge"),
        ('input = "voltage"', 'input = "torque"', r"\[drive\].*voltage"),
        ("supply = 7.3", "supply = -7.3", r"\[drive\].*supply"),
        ("gain = 0.0028774", "gains = 0.0028774", r"\[drive.position_loop\].*gains"),
        ("saturation = 0.9", "saturation = 0", r"\[drive.position_loop\].*saturation"),
        ('duty = "pwm"', 'dutty = "pwm"', r"\[drive.signals\].*dutty"),
        ('duty = "pwm"', "duty = 3", r"\[drive.signals\].*duty"),
        ("supply = 7.3", "supply = 7.3\nduty_scale = 0", "duty_scale"),
    ],
)
def test_what_cannot_be_is_refused_with_its_place(
    tmp_path: Path, old: str, new: str, message: str
) -> None:
    assert old in TEXT
    with pytest.raises(jid.InputError, match=message):
        jid.Joint.load(written(tmp_path, TEXT.replace(old, new, 1)))


def test_a_loop_without_a_gain_is_refused() -> None:
    with pytest.raises(jid.InputError, match="gain"):
        jid.VoltageDrive(position_loop={"saturation": 1.0})  # type: ignore[arg-type]
    with pytest.raises(jid.InputError, match="VoltageDrive"):
        jid.Joint(voltage="7 V")  # type: ignore[arg-type]
