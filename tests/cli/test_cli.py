"""The command line: exit codes, one helpful line for bad input, Ctrl-C."""

import json
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest
from example_recordings import WELL_EXCITED

import jointid as jid
from jointid.cli.command_line import main
from jointid.cli.demonstration import data_folder

KR300 = str(data_folder() / "kr300_joint1.csv.gz")
KR300_JOINT = str(data_folder() / "kr300_joint1.toml")
WELL = str(WELL_EXCITED)


@pytest.fixture(scope="module")
def thesis_file(tmp_path_factory: pytest.TempPathFactory) -> str:
    path = tmp_path_factory.mktemp("joint") / "thesis.toml"
    jid.thesis_joint().save(path)
    return str(path)


def _run(*arguments: str, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "jointid", *arguments],
        capture_output=True,
        text=True,
        timeout=120,
        cwd=cwd,
        check=False,
    )


def test_demo_writes_a_report_with_its_pictures(tmp_path: Path) -> None:
    result = _run("demo", "--output", "out", cwd=tmp_path)
    assert result.returncode == 0, result.stderr
    page = (tmp_path / "out" / "report.html").read_text()
    assert page.count("<svg ") == 5
    assert "http" not in page.replace("http://www.w3.org", "")
    assert "viscous" in result.stdout
    estimate = jid.Estimate.from_json((tmp_path / "out" / "estimate.json").read_text())
    assert estimate.parameters["viscous"].value == pytest.approx(2050.0, rel=0.15)


def test_identify_prints_json_that_reads_back(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["identify", KR300, "--joint", KR300_JOINT, "--json", "--quiet"]) == 0
    text = capsys.readouterr().out
    assert json.loads(text)["schema"] == 3
    assert jid.Estimate.from_json(text).parameters["coulomb"].value == pytest.approx(
        355.0, rel=0.15
    )


def test_identify_saves_into_the_joint_file(tmp_path: Path) -> None:
    joint = tmp_path / "joint.toml"
    joint.write_text(Path(KR300_JOINT).read_text())
    report = tmp_path / "report.html"
    arguments = [
        "--joint",
        str(joint),
        "--save",
        str(joint),
        "--report",
        str(report),
        "--set",
        "torque_offset=49",
    ]
    assert main(["identify", KR300, *arguments, "--method", "separable"]) == 0
    kept = jid.Joint.load(joint)
    assert kept.parameters["viscous"].value == pytest.approx(2050.0, rel=0.15)
    assert "vertical axis" in joint.read_text()
    assert report.read_text().count("<svg ") == 5


def test_info_shows_the_contents_of_a_recording(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["info", WELL, "--json"]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert facts["samples"] == 12000
    assert set(facts["signals"]) == {"time", "position", "velocity", "torque", "sensor"}
    assert main(["info", WELL]) == 0
    assert "sensor" in capsys.readouterr().out


def test_info_says_that_stamps_may_be_milliseconds(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "run.csv"
    rows = "".join(f"{2 * k},{(k % 7) / 7},{k % 5}\n" for k in range(50))
    path.write_text(f"time_s,position_rad,torque_Nm\n{rows}")
    assert main(["info", str(path)]) == 0
    said = capsys.readouterr().out
    assert "the samples are 2 s apart: the time stamps may be in milliseconds" in said
    assert "load with --unit time=ms" in said
    assert main(["info", str(path), "--unit", "time=msec"]) == 0
    said = capsys.readouterr().out
    assert "warning" not in said
    assert "over 0.098 s" in said


def test_info_lists_columns_that_are_not_recognised(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "run.csv"
    tags = [f"tag_{k}" for k in range(15)]
    rows = "".join(f"{k / 500},{k % 7},{k % 5}{',0' * 15}\n" for k in range(50))
    path.write_text(f"time_s,position_rad,torque_Nm,{','.join(tags)}\n{rows}")
    assert main(["info", str(path)]) == 0
    shown = ", ".join(tags[:12])
    assert f"columns not recognised: {shown} and 3 more" in capsys.readouterr().out


def test_identify_takes_several_recordings(
    tmp_path: Path, thesis_file: str, capsys: pytest.CaptureFixture[str]
) -> None:
    whole = jid.load(WELL)
    halves = [str(tmp_path / name) for name in ("first.csv", "second.csv")]
    whole.crop(0.0, 6.0).save(halves[0])
    whole.crop(6.0, 12.0).save(halves[1])
    arguments = ["--joint", thesis_file, "--method", "separable", "--json"]
    assert main(["identify", *halves, *arguments, "--column", "sensor=sensor_raw"]) == 0
    estimate = jid.Estimate.from_json(capsys.readouterr().out)
    assert [run["fingerprint"] for run in estimate.settings["recordings"]] == [
        jid.load(half).fingerprint for half in halves
    ]
    assert estimate.parameters["static"].value == pytest.approx(20.0, rel=0.01)


def test_report_draws_a_saved_estimate(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    saved, page = tmp_path / "estimate.json", tmp_path / "page.html"
    arguments = ["--joint", KR300_JOINT, "--method", "separable", "--save", str(saved)]
    assert main(["identify", KR300, *arguments]) == 0
    capsys.readouterr()
    assert main(["report", str(saved), "--output", str(page)]) == 0
    assert str(page) in capsys.readouterr().out
    assert page.read_text().count("<svg ") == 3
    assert main(["report", str(saved), "--output", str(page), "--json"]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert printed["report"] == str(page)
    assert "inertia_varies" in printed["warnings"]


def test_report_is_written_beside_by_default(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    arguments = ["--joint", KR300_JOINT, "--method", "separable", "--save", "estimate.json"]
    assert main(["identify", KR300, *arguments]) == 0
    assert main(["report", "estimate.json"]) == 0
    assert (tmp_path / "report.html").read_text().count("<svg ") == 3


def test_compare_prints_the_winner_and_saves_it(
    tmp_path: Path, thesis_file: str, capsys: pytest.CaptureFixture[str]
) -> None:
    saved = tmp_path / "winner.json"
    models = ["--model", "coulomb_viscous", "--model", "stribeck", "--folds", "4"]
    arguments = ["compare", WELL, "--joint", thesis_file, *models]
    assert main([*arguments, "--save", str(saved)]) == 0
    assert "stribeck predicts held-out motion best" in capsys.readouterr().out
    assert jid.Estimate.from_json(saved.read_text()).settings["model"] == "stribeck"
    assert main([*arguments, "--json"]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert printed["kind"] == "jointid comparison"
    assert printed["winner"] == "stribeck"
    assert [len(entry["fold_scores"]) for entry in printed["rows"]] == [4, 4]


def test_compare_holds_out_whole_recordings(
    tmp_path: Path, thesis_file: str, capsys: pytest.CaptureFixture[str]
) -> None:
    whole = jid.load(WELL)
    parts = [str(tmp_path / f"part{k}.csv") for k in range(3)]
    for k, part in enumerate(parts):
        whole.crop(4.0 * k, 4.0 * k + 4.0).save(part)
    assert main(["compare", *parts, "--joint", thesis_file, "--model", "stribeck", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["settings"]["held_out"] == "recording"


COMMANDS = ("demo", "identify", "compare", "report", "info")


@pytest.mark.parametrize("command", [[], *([name] for name in COMMANDS)])
def test_help_has_an_example(command: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main([*command, "--help"])
    assert ended.value.code == 0
    assert "example" in capsys.readouterr().out


def test_interrupt_ends_one_long_generation_with_130(
    thesis_file: str, capsys: pytest.CaptureFixture[str]
) -> None:
    # One generation of so many individuals takes tens of seconds: only the poll inside it can end it.
    sent: list[float] = []

    def interrupt() -> None:
        sent.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)

    timer = threading.Timer(0.7, interrupt)
    timer.start()
    try:
        code = main(
            ["identify", WELL, "--joint", thesis_file, "--population", "1000000", "--quiet"]
        )
        ended = time.monotonic()
    finally:
        timer.cancel()  # had the command ended early, the signal would hit whoever runs next
        timer.join()
    assert code == 130
    assert capsys.readouterr().err.strip() == "jointid: interrupted"
    assert ended - sent[0] < 2.0  # 0.1 s on a machine that is not busy


def test_interrupt_ends_a_comparison_with_130(
    thesis_file: str, capsys: pytest.CaptureFixture[str]
) -> None:
    sent: list[float] = []

    def interrupt() -> None:
        sent.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)

    timer = threading.Timer(0.7, interrupt)
    timer.start()
    try:
        code = main(["compare", WELL, "--joint", thesis_file, "--folds", "250", "--quiet"])
        ended = time.monotonic()
    finally:
        timer.cancel()  # had the command ended early, the signal would hit whoever runs next
        timer.join()
    assert code == 130
    assert capsys.readouterr().err.strip() == "jointid: interrupted"
    assert ended - sent[0] < 2.0


def test_scale_and_checkpoint_from_the_shell(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    state = tmp_path / "search.state"
    arguments = [
        "identify",
        WELL,
        "--scale",
        "torque=2",
        "--torque-hold",
        "zoh",
        "--json",
        "--quiet",
    ]
    assert main([*arguments, "--checkpoint", str(state), "--generations", "60"]) == 0
    doubled = jid.Estimate.from_json(capsys.readouterr().out)
    assert state.stat().st_size > 100
    assert main([*arguments, "--resume", str(state), "--generations", "60"]) == 0
    again = jid.Estimate.from_json(capsys.readouterr().out)
    assert again.parameters == doubled.parameters
    assert doubled.parameters["viscous"].value == pytest.approx(40.0, rel=0.1)
