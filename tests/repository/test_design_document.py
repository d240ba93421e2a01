"""docs/design.md: its commands print what it shows, its Python runs, its motion by hand is a motion."""

import shutil
from pathlib import Path

import pytest
from documents import ROOT, blocks, enter, read, run_console_blocks, run_python_blocks

import jointid as jid
from jointid.hardware.bench.bench import Bench
from jointid.hardware.session.limits import SessionLimits
from jointid.simulation.motion_file import load_motion
from jointid.simulation.peaks import Peaks

PAGE = read("docs/design.md")
BENCH = PAGE.partition("\n## Through the bench")[2].partition("\n## ")[0]


def _bench(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    joint = folder / "joint.toml"
    shutil.copy(ROOT / "examples" / "hardware" / "joint.toml", joint)
    enter(folder, monkeypatch)
    return joint


def test_the_way_through_the_bench_has_commands_that_there_are(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    joint = _bench(tmp_path, monkeypatch)
    run_console_blocks(BENCH, joint, capsys, whole=True, parsed=["design", "run", "identify"])
    assert jid.Joint.load(joint).parameters["ripple_sin_2"].max == 10.0


@pytest.mark.slow
def test_the_way_through_the_bench_runs_and_prints_what_is_shown(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    joint = _bench(tmp_path, monkeypatch)
    commands = run_console_blocks(BENCH, joint, capsys, whole=True, within=0.5)
    assert commands == ["edit", "design", "edit", "run", "identify"]
    # The session moved what was designed.
    design = jid.load_design("motion.toml")
    recording = jid.load("runs/initial.csv")
    assert Bench.load(joint).trajectory == design.trajectory
    assert recording.reference is not None
    wanted = design.trajectory.sample(recording.time - recording.time[0])[0]
    assert abs(recording.reference - wanted).max() < 0.02
    # And the errors are of the size that was expected.
    estimate = jid.identify(recording, jid.Joint.load(joint))
    truth = Bench.load(joint).emulation
    assert truth is not None
    for name, true in truth.truth.items():
        expected = design.parameters[name].worst * abs(true)
        assert abs(estimate.parameters[name].value - true) < 3.0 * expected, name
    assert recording.duration == pytest.approx(design.duration, abs=0.01)


def test_the_python_of_the_page_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    names = run_python_blocks(PAGE, tmp_path, monkeypatch)
    estimate, design = names["estimate"], names["design"]
    for name, expected in design.parameters.items():
        true = names["true"].parameters[name].value
        assert abs(estimate.parameters[name].value - true) < 4.0 * expected.stderr, name


def test_the_motion_by_hand_is_a_motion(tmp_path: Path) -> None:
    (text,) = (block for block in blocks(PAGE, "toml") if "[trajectory]" in block)
    path = tmp_path / "motion.toml"
    path.write_text(text, encoding="utf-8")
    assert load_motion(path).trajectory.duration == 12.0


def test_the_refusal_on_the_page_is_the_programs() -> None:
    refusal = PAGE.partition("\njointid run: joint.toml: ")[2].partition("\n```")[0]
    shown = " ".join(refusal.split())
    peaks = Peaks(position=(-1.0102, 1.0083), velocity=1.0, acceleration=1.0, torque=1.0)
    assert shown.endswith(f"joints go {SessionLimits(position=(-0.8, 0.8)).passed_by(peaks)}")
