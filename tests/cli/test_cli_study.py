"""The commands `simulate` and `sweep`."""

import json
import os
import select
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from example_recordings import WELL_EXCITED

import jointid as jid
from jointid.cli.command_line import main
from jointid.cli.progress import StudyProgress
from jointid.study.sweeping import StudyStep

WELL = str(WELL_EXCITED)
TRUTH = {
    "coulomb": 25.0,
    "static": 20.0,
    "stribeck": 100.0,
    "viscous": 20.0,
    "sensor_gain": 2.4,
    "sensor_offset": 15.0,
}
WIDE = "thesis:amplitude=60deg,cycle=3,duration=6"

Printed = pytest.CaptureFixture[str]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("joints")
    joint = jid.thesis_joint()
    joint.save(path / "unknown.toml")
    joint.with_parameters(TRUTH).save(path / "true.toml")
    joint.with_parameters(TRUTH | {"coulomb": 10.0, "sensor_gain": 1.0}).save(path / "guess.toml")
    return path


@pytest.mark.parametrize("kept", [True, False])
def test_an_interrupted_sweep_says_how_much_is_done_and_how_to_go_on(
    kept: bool, tmp_path: Path, capsys: Printed, monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupted(_: StudyProgress, step: StudyStep) -> None:
        raise KeyboardInterrupt

    path = tmp_path / "study.jsonl"
    words = ["sweep", WELL, "--grid", "windows=100,200", "--trials", "3"]
    words += ["--output", str(path)] if kept else []
    with monkeypatch.context() as patch:
        patch.setattr(StudyProgress, "__call__", interrupted)
        assert main(words) == 130
    text = capsys.readouterr().err
    assert text.startswith("jointid: interrupted: ")
    assert "of 6 trials were done" in text
    assert text.count("\n") == 1
    if not kept:
        assert "lost; --output study.jsonl keeps each trial" in text
        return
    assert f"in {path}; the same command with --resume continues" in text
    assert main([*words, "--resume"]) == 0
    assert len(jid.Study.load(path).rows) == 6


def test_simulate_identify_simulate_closes_the_ring(
    folder: Path, tmp_path: Path, capsys: Printed
) -> None:
    run, found = str(tmp_path / "run.csv"), str(tmp_path / "found.toml")
    true, guess = str(folder / "true.toml"), str(folder / "guess.toml")
    common = ["simulate", true, "--trajectory", WIDE, "--sensor", "torque_noise=0.5", "--json"]
    assert main([*common, "--believe", guess, "--output", run]) == 0
    before = json.loads(capsys.readouterr().out)
    assert before["truth"]["coulomb"] == 25.0
    known = str(folder / "unknown.toml")
    assert main(["identify", run, "--joint", known, "--save", found, "--quiet"]) == 0
    capsys.readouterr()
    assert main([*common, "--believe", found]) == 0
    after = json.loads(capsys.readouterr().out)
    assert after["tracking_error"] < before["tracking_error"] / 3.0


def test_the_recording_is_that_of_the_library(
    folder: Path, tmp_path: Path, capsys: Printed
) -> None:
    path = tmp_path / "run.npz"
    words = ["simulate", str(folder / "true.toml"), "--controller", "pd", "--output", str(path)]
    words += ["--gain", "stiffness=8000", "--gain", "damping=400", "--control-period", "0.002"]
    words += ["--trajectory", "sine:amplitude=30deg,frequency=0.5,duration=2", "--seed", "7"]
    assert main([*words, "--sensor", "torque_noise=0.1"]) == 0
    assert "tracking error" in capsys.readouterr().out
    wanted = jid.simulate(
        jid.thesis_joint().with_parameters(TRUTH),
        jid.Pd(stiffness=8000.0, damping=400.0),
        jid.Trajectory.sine(0.5235987755982988, 0.5, duration=2.0),
        control_period=0.002,
        sensors=jid.Sensors(torque_noise=0.1),
        seed=7,
    )
    assert jid.load(path).fingerprint == wanted.fingerprint
    again = ["simulate", str(folder / "true.toml"), "--trajectory", str(path), "--json"]
    assert main(again) == 0
    assert json.loads(capsys.readouterr().out)["samples"] == 1998  # to the last of its samples


@pytest.mark.parametrize(
    ("words", "text"),
    [
        (["--trajectory", "helix"], "neither a file nor one of"),
        (["--trajectory", "sine:amplitude"], "not of the form NAME=VALUE"),
        (["--trajectory", "sine:amplitude=1,hertz=1,duration=1"], "there is no hertz"),
        (["--controller", "pdd"], "did you mean 'pd'"),
        (["--controller", "pd"], "add --gain stiffness=VALUE"),
        (
            ["--controller", "pd", "--gain", "stiffness=1", "--believe", "x"],
            "does not compensate friction",
        ),
        (["--gain", "bandwith=3"], "did you mean 'bandwidth'"),
        (["--gain", "bandwidth=3", "--gain", "bandwidth=4"], "given twice"),
        (["--sensor", "torque_noise=-1"], "torque_noise"),
        (["--control-period", "0"], "more than 0"),
        (["--output", "nowhere/run.csv"], "does not exist"),
        (["--output", "run.xyz"], "--output"),
        (["--believe", "nowhere.toml"], "nowhere.toml"),
    ],
)
def test_simulate_refuses_in_a_line(
    folder: Path, words: list[str], text: str, capsys: Printed
) -> None:
    assert main(["simulate", str(folder / "true.toml"), *words]) == 2
    error = capsys.readouterr().err
    assert text in error
    assert error.count("\n") == 1


def test_simulate_names_the_missing_values(folder: Path, capsys: Printed) -> None:
    assert main(["simulate", str(folder / "unknown.toml")]) == 2
    assert "a simulation needs a value" in capsys.readouterr().err


def test_sweep_prints_writes_draws_and_goes_on(
    folder: Path, tmp_path: Path, capsys: Printed
) -> None:
    joint = str(folder / "unknown.toml")
    words = ["sweep", WELL, "--joint", joint, "--grid", "ga.population=8,12", "--windows", "100"]
    words += ["--grid", "method=ga,random", "--quiet"]
    output, table, plot = (tmp_path / name for name in ("s.jsonl", "s.csv", "s.png"))
    files = ["--output", str(output), "--table", str(table), "--plot", str(plot)]
    assert main([*words, *files, "--trials", "2"]) == 0
    shown = capsys.readouterr().out
    assert shown.splitlines()[0].split()[:2] == ["ga.population", "method"]
    assert shown.splitlines()[-2:] == [f"table: {table}", f"plot: {plot}"]
    assert len(table.read_text().splitlines()) == 9
    assert plot.read_bytes().startswith(b"\x89PNG")
    assert main([*words, "--output", str(output), "--trials", "3"]) == 2
    assert "exists" in capsys.readouterr().err
    resumed = [*words, "--output", str(output), "--trials", "3", "--resume", "--json"]
    assert main([*resumed, "--workers", "2"]) == 0
    cells = json.loads(capsys.readouterr().out)["cells"]
    assert [cell["trials"] for cell in cells] == [3] * 4
    assert len(jid.Study.load(output)) == 12


@pytest.mark.skipif(sys.platform != "linux", reason="children are read from /proc")
def test_workers_end_with_a_command_that_is_killed(tmp_path: Path) -> None:
    output = tmp_path / "study.jsonl"
    words = ["sweep", WELL, "--grid", "windows=100,200", "--trials", "500", "--workers", "2"]
    command = subprocess.Popen(
        [sys.executable, "-m", "jointid", *words, "--output", str(output), "--quiet"]
    )
    try:
        while not output.exists() or output.read_text().count("\n") < 4:  # work has begun
            assert command.poll() is None
            select.select([], [], [], 0.05)
        children = Path(f"/proc/{command.pid}/task/{command.pid}/children").read_text().split()
        assert len(children) >= 2
        ends = [os.pidfd_open(int(child)) for child in children]
    finally:
        command.kill()
        command.wait()
    for end in ends:
        assert select.select([end], [], [], 30.0)[0], "a worker outlives its command"
        os.close(end)


def test_sweep_simulates(folder: Path, capsys: Printed) -> None:
    words = ["sweep", "--simulate", str(folder / "true.toml"), "--trajectory", WIDE, "--tracking"]
    words += ["--believe", str(folder / "guess.toml"), "--grid", "sensors.torque_noise=0.1,1"]
    assert main([*words, "--trials", "2", "--json", "--quiet"]) == 0
    for cell in json.loads(capsys.readouterr().out)["cells"]:
        assert cell["tracking_after"] < cell["tracking_before"] / 3.0
        assert cell["success"] == 1.0


@pytest.mark.parametrize(
    ("words", "text"),
    [
        ([], "give recordings or --simulate"),
        ([WELL, "--simulate", "true.toml"], "recordings or a simulation"),
        ([WELL, "--grid", "windows=10", "--grid", "windows=20"], "given twice"),
        ([WELL, "--grid", "windos=10"], "did you mean"),
        ([WELL, "--grid", "windows"], "not of the form NAME=VALUE"),
        ([WELL, "--table", "x.xlsx"], "written as .csv or .parquet"),
        ([WELL, "--workers", "0"], "--workers 0: 1 to 1024"),
        ([WELL, "--resume"], "--resume"),
        ([WELL, "--ga", "best"], "thesis_code"),
        ([WELL, "--trials", "0"], "trials"),
        (["--simulate", "examples.toml", "--term", "q6=viscous"], "has no extra signals"),
    ],
)
def test_sweep_refuses_in_a_line(words: list[str], text: str, capsys: Printed) -> None:
    try:
        code = main(["sweep", *words])
    except SystemExit as ended:  # the grammar's own refusals
        code = int(str(ended.code))
    assert code == 2
    error = capsys.readouterr().err
    assert text in error
    assert error.count("\n") == 1


def test_sweep_knows_own_terms(tmp_path: Path, capsys: Printed) -> None:
    recording = jid.load(WELL)
    other = 3.0 * np.sin(2.7 * recording.time)
    assert recording.torque is not None
    path = tmp_path / "other.csv"
    recording.with_signals(torque=recording.torque + 0.5 * other, extra={"other": other}).save(path)
    words = ["sweep", str(path), "--term", "other=scaled", "--method", "separable"]
    words += ["--extra", "other=extra_other", "--output", str(tmp_path / "study.jsonl")]
    assert main([*words, "--trials", "1", "--json", "--quiet"]) == 0
    (cell,) = json.loads(capsys.readouterr().out)["cells"]
    assert "scale_of_other" in json.dumps(cell)


def test_a_sweep_whose_model_nobody_named_says_which_it_has(
    capsys: pytest.CaptureFixture[str],
) -> None:
    call = ["sweep", str(WELL_EXCITED), "--grid", "windows=50,100"]
    call += ["--trials", "1", "--method", "separable", "--quiet"]
    assert main(call) == 0
    assert "model: coulomb_viscous, because no model is named" in capsys.readouterr().out
    assert main([*call, "--model", "stribeck"]) == 0
    assert "because no model is named" not in capsys.readouterr().out
