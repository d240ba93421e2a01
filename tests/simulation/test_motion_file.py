"""Motions in files: what is written is read, by hand or by a design, and what cannot be is named."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import jointid as jid
from jointid.base.errors import InputError
from jointid.base.toml_text import toml_of
from jointid.simulation.motion_file import COMMENTS, load_motion, motion_table

SINES: dict[str, Any] = {
    "amplitude": [0.5, 0.1],
    "frequency": [1.0, 2.5],
    "phase": [0.0, 0.7],
    "offset": 0.2,
    "fade": 1.0,
    "duration": 8.0,
}
TEXT = toml_of({"trajectory": {"form": "sines", **SINES}}, COMMENTS)
PEAKS = "\n[peaks]\nposition = [-0.4, 0.8]\nvelocity = 1.0\nacceleration = 2.0\ntorque = 90.0\n"


def written(folder: Path, text: str) -> Path:
    path = folder / "motion.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_what_is_written_is_read(tmp_path: Path) -> None:
    motion = jid.Trajectory.sines(**SINES)
    path = written(tmp_path, toml_of({"trajectory": motion_table(motion)}, COMMENTS))
    assert load_motion(path).trajectory == motion
    assert load_motion(path).peaks is None
    assert "frequency = [1.0, 2.5]  # rad/s" in path.read_text(encoding="utf-8")


def test_a_motion_by_hand_takes_angles_in_degrees(tmp_path: Path) -> None:
    path = written(
        tmp_path, '[trajectory]\nform = "thesis"\namplitude = "60deg"\ncycle = 3\nduration = 12.0\n'
    )
    assert load_motion(path).trajectory == jid.Trajectory.thesis(
        np.radians(60.0), cycle=3.0, duration=12.0
    )


def test_peaks_are_read_with_it(tmp_path: Path) -> None:
    peaks = load_motion(written(tmp_path, TEXT + PEAKS)).peaks
    assert peaks is not None
    assert (peaks.position, peaks.torque, peaks.sensor_torque) == ((-0.4, 0.8), 90.0, None)


def test_only_sums_of_sines_are_written() -> None:
    with pytest.raises(InputError, match=r"trajectory\.form is 'step': a sum of sines"):
        motion_table(jid.Trajectory.step(0.1, duration=1.0))


@pytest.mark.parametrize(
    ("before", "after", "says"),
    [
        ("[trajectory]", "[trajectori]", "trajectory: this is missing"),
        ('form = "sines"', "", r"trajectory\.form: this is missing"),
        (
            'form = "sines"',
            'form = "cosines"',
            r"trajectory\.form: this is 'cosines': choose one of",
        ),
        (
            "amplitude = [0.5, 0.1]",
            "amplitude = 0.5",
            r"trajectory\.amplitude: .*a list is expected",
        ),
        ("amplitude = [0.5, 0.1]", "amplitude = []", r"trajectory\.amplitude: 1 to 10000 items"),
        ("[0.5, 0.1]", '[0.5, "60 dge"]', r"trajectory\.amplitude\[1\]: .*a number is expected"),
        ("[0.5, 0.1]", "[0.5, nan]", r"trajectory\.amplitude\[1\]: .*a finite number"),
        ("frequency = [1.0, 2.5]", "frequency = [1.0]", "trajectory"),
        ("phase =", "phases =", r"trajectory\.phase: this is missing"),
        ("offset = 0.2", "ofset = 0.2", r"trajectory\.ofset: unknown key; choose one of"),
        ("duration = 8.0", "duration = 0.0", "trajectory.*0"),
        ("duration = 8.0", "duration = ", "not TOML"),
        ("duration = 8.0", f"duration = {'[' * 50}{']' * 50}", "nested too deeply"),
        ("position = [-0.4, 0.8]", "position = [0.4]", r"peaks\.position: 2 to 2 items"),
        ("torque = 90.0", "torque = -1.0", r"peaks\.torque: .*a number from 0"),
        ("position = [-0.4, 0.8]", "position = [0.8, -0.4]", "the first value must not be above"),
    ],
)
def test_a_file_that_cannot_be_used_is_named_with_its_key(
    tmp_path: Path, before: str, after: str, says: str
) -> None:
    assert before in TEXT + PEAKS
    path = written(tmp_path, (TEXT + PEAKS).replace(before, after, 1))
    with pytest.raises(InputError, match=rf"motion\.toml: .*{says}") as error:
        load_motion(path)
    assert str(error.value).count("motion.toml") == 1


def test_a_file_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"nowhere\.toml: there is no such file"):
        load_motion(tmp_path / "nowhere.toml")
