"""docs/design.md: its commands print what it shows, its Python runs, its motion by hand is a motion."""

import shlex
import shutil
from pathlib import Path

import pytest
from documents import ROOT, blocks, enter, read, run_console_blocks, run_python_blocks

import jointid as jid
from jointid.cli.parser import command_parser
from jointid.hardware.bench.bench import Bench
from jointid.hardware.session.limits import SessionLimits
from jointid.simulation.motion_file import load_motion
from jointid.simulation.peaks import Peaks

PAGE = read("docs/design.md")


def _section(title: str) -> str:
    return PAGE.partition(f"\n## {title}\n")[2].partition("\n## ")[0]


OWN, BENCH = _section("Design a motion"), _section("With a session of jointid")


def _bench(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    joint = folder / "joint.toml"
    shutil.copy(ROOT / "examples" / "hardware" / "joint.toml", joint)
    enter(folder, monkeypatch)
    return joint


@pytest.mark.slow
def test_an_own_joint_file_is_designed_for_and_rehearsed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    joint = tmp_path / "joint.toml"
    text, behind = OWN.partition("```toml\n")[2].split("```\n", 1)
    joint.write_text(text, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    commands = run_console_blocks(behind, joint, capsys, within=0.5)
    assert commands == ["design", "simulate", "identify"]
    names = run_python_blocks(OWN, tmp_path, monkeypatch)
    assert abs(names["position"]).max() < 1.05


def test_the_session_has_commands_that_there_are(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    joint = _bench(tmp_path, monkeypatch)
    run_console_blocks(BENCH, joint, capsys, whole=True, parsed=["design", "run", "identify"])
    assert jid.Joint.load(joint).parameters["ripple_sin_2"].max == 10.0


@pytest.mark.slow
def test_the_session_runs_and_prints_what_is_shown(
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
    first, second = _section("In Python"), _section("Record what is missing")
    names = run_python_blocks(first, tmp_path, monkeypatch)
    estimate, design = names["estimate"], names["design"]
    for name, expected in design.parameters.items():
        true = names["true"].parameters[name].value
        assert abs(estimate.parameters[name].value - true) < 4.0 * expected.stderr, name
    (block,) = blocks(second, "python")
    exec(compile(block, "document", "exec"), names)
    assert "designed by jid.design(estimate, " in str(names["estimate"].warnings[0])
    for name, true in names["true"].parameters.items():
        assert names["both"].parameters[name].value == pytest.approx(true.value, rel=0.02), name


def test_the_commands_for_the_next_motion_are_ones() -> None:
    (commands,) = blocks(_section("Record what is missing"), "sh")
    for line in commands.splitlines():
        assert command_parser().parse_args(shlex.split(line)[1:]).joint == Path("joint.toml")


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
