"""What the command line says names its own options, not Python's arguments."""

import re
from pathlib import Path

import numpy as np
import pytest

import jointid as jid
from jointid.cli.command_line import main
from jointid.cli.demo import data_folder
from jointid.cli.words import spoken

WELL = str(data_folder() / "well_excited.csv.gz")
PYTHON = re.compile(
    r"\w=[{(]|=True|=False|=None|\b(?:columns|units|parameters|output)=|jointid\.[A-Z]|Options|with_parameters|positional|\w\("
)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    run = jid.load(WELL)
    jid.thesis_joint().save(tmp_path / "joint.toml")
    (tmp_path / "study.jsonl").write_text("{}\n", encoding="utf-8")
    columns = (run.time, np.degrees(run.position), run.velocity, run.torque, run.sensor)
    table = np.column_stack(columns)  # type: ignore[arg-type]
    header = "time_s,enc1,velocity_rad_s,torque_Nm,sensor_raw"
    np.savetxt(tmp_path / "log.csv", table, delimiter=",", header=header, comments="")
    return tmp_path


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (f"identify {WELL} --column torque=foo", "--column torque=foo, no such header"),
        ("identify LOG", "candidates are 'enc1'; choose one with --column position=enc1"),
        ("info LOG --column position=enc1 --unit position=V", "--scale position=FACTOR"),
        ("identify LOG --column position=enc1 --column sensor=enc1", "--column gives 'enc1'"),
        (f"identify {WELL} --unit temperature=K", "--unit names 'temperature'"),
        (f"identify {WELL} --model stribeck:asymmetric", "with --set sensor_offset=VALUE, or"),
        (f"identify {WELL} --column sensor=none --residual sensor", "use --residual torque"),
        (f"identify {WELL} --population 1", "population is 1: must be 4"),
        (f"sweep {WELL} --grid windows=50 --resume", "give it as --output"),
        (f"sweep {WELL} --grid windows=50 --output STUDY", "--output"),
        (f"sweep {WELL} --grid ga=foo", "ga must be one of default, thesis"),
        (f"sweep {WELL} --tracking", "--tracking simulates; give --simulate JOINT"),
        ("simulate JOINT --trajectory sine", "sine needs amplitude and frequency"),
        ("simulate JOINT --trajectory sine:foo=3", "sine has no option 'foo'"),
        ("simulate JOINT --trajectory thesis:amplitude=1", "parameters.coulomb: has no value"),
    ],
)
def test_refusals_name_options(
    words: str, told: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    files = {"LOG": "log.csv", "JOINT": "joint.toml", "STUDY": "study.jsonl"}
    asked = [str(folder / files[word]) if word in files else word for word in words.split()]
    assert main(asked) == 2
    said = capsys.readouterr().err
    assert told in said
    assert PYTHON.search(said) is None, said


def test_warnings_name_options(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["identify", str(folder / "log.csv"), "--column", "position=enc1"]) == 0
    assert "load with --unit position=deg" in capsys.readouterr().out


def test_a_column_may_be_left_out(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["info", WELL, "--column", "velocity=none"]) == 0
    assert "velocity: derived from the position" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("sentence", "said"),
    [
        (
            "load with units={'position': 'deg', 'velocity': 'deg/s'}",
            "load with --unit position=deg --unit velocity=deg/s",
        ),
        (
            "leave the column out (columns={'velocity': None})",
            "leave the column out (--column velocity=none)",
        ),
        (
            "or free the inertia with parameters={'inertia': {'vary': True}}",
            "or free the inertia by vary = true under [parameters.inertia] in the joint file",
        ),
        ("add ripple=(2,) to the model", "add :ripple=2 to the name given to --model"),
        ("use model='coulomb_viscous', or", "use --model coulomb_viscous, or"),
        (
            "x exists; go on with it by resume=True, or give another output=",
            "x exists; go on with it by --resume, or give another --output",
        ),
        ("inertia = 2.5 and R² = 0.99", "inertia = 2.5 and R² = 0.99"),
    ],
)
def test_each_rule(sentence: str, said: str) -> None:
    assert spoken(sentence) == said
