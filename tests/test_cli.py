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

import jointid as jid
from jointid.cli import main
from jointid.demo import data_folder

KR300 = str(data_folder() / "kr300_joint1.csv.gz")
KR300_JOINT = str(data_folder() / "kr300_joint1.toml")
WELL = str(data_folder() / "well_excited.csv.gz")


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
    assert page.count("data:image/png;base64,") == 3
    assert "http" not in page.replace("http://www.w3.org", "")
    assert "viscous" in result.stdout
    estimate = jid.Estimate.from_json((tmp_path / "out" / "estimate.json").read_text())
    assert estimate.parameters["viscous"].value == pytest.approx(2050.0, rel=0.15)


def test_identify_prints_json_that_reads_back(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["identify", KR300, "--joint", KR300_JOINT, "--json", "--quiet"]) == 0
    text = capsys.readouterr().out
    assert json.loads(text)["schema"] == 1
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
    assert report.stat().st_size > 50_000


def test_info_tells_what_a_recording_holds(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["info", WELL, "--json"]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert facts["samples"] == 12000
    assert set(facts["signals"]) == {"time", "position", "velocity", "torque", "sensor"}
    assert main(["info", WELL]) == 0
    assert "sensor" in capsys.readouterr().out


@pytest.mark.parametrize("command", [[], ["demo"], ["identify"], ["info"]])
def test_help_has_an_example(command: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main([*command, "--help"])
    assert ended.value.code == 0
    assert "example" in capsys.readouterr().out


BAD = {
    "missing file": (["identify", "nothing.csv"], "nothing.csv"),
    "unknown extension": (["info", "log.xlsx"], "xlsx"),
    "not a number": (["identify", "text.csv"], "text.csv"),
    "missing torque": (["identify", "no_torque.csv"], "torque"),
    "time runs back": (["identify", "back.csv"], "time"),
    "unknown model": (
        ["identify", KR300, "--joint", KR300_JOINT, "--model", "magic"],
        "coulomb_viscous",
    ),
    "unknown method": (["identify", WELL, "--method", "magic"], "separable"),
    "unknown residual": (["identify", WELL, "--residual", "magic"], "sensor"),
    "sensor wanted, none there": (
        ["identify", KR300, "--joint", KR300_JOINT, "--residual", "sensor"],
        "sensor",
    ),
    "motor torque without a joint": (["identify", KR300], "gear_ratio"),
    "missing joint file": (["identify", WELL, "--joint", "nothing.toml"], "nothing.toml"),
    "joint file is not TOML": (["identify", WELL, "--joint", "text.csv"], "text.csv"),
    "joint file with a typo": (["identify", WELL, "--joint", "typo.toml"], "gear_ratio"),
    "unknown parameter": (["identify", WELL, "--set", "viscos=1"], "viscos"),
    "parameter without a number": (["identify", WELL, "--set", "viscous=much"], "much"),
    "all fixed": (
        [
            "identify",
            KR300,
            "--joint",
            KR300_JOINT,
            "--set",
            "inertia=1",
            "--set",
            "coulomb=1",
            "--set",
            "viscous=1",
            "--set",
            "torque_offset=0",
        ],
        "every parameter is fixed",
    ),
    "too many windows": (["identify", WELL, "--windows", "50000"], "windows"),
    "window longer than the recording": (
        ["identify", WELL, "--windows", "99s"],
        "longer than the recording",
    ),
    "no windows": (["identify", WELL, "--windows", "0"], "windows"),
    "population too small": (["identify", WELL, "--population", "1"], "population"),
    "no such column": (["identify", WELL, "--column", "torque=effort"], "effort"),
    "no such unit": (["identify", WELL, "--unit", "position=furlong"], "furlong"),
    "saved as something else": (["identify", WELL, "--save", "estimate.pdf"], "pdf"),
    "report into nowhere": (
        ["identify", WELL, "--method", "separable", "--report", "no/where/report.html"],
        "report.html",
    ),
    "standing still": (["identify", "still.csv"], "never moves"),
    "too many threads": (["identify", WELL, "--threads", "9999"], "threads"),
}


@pytest.fixture
def bad_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    rows = [f"{0.01 * k:.2f},{0.1 * k},{1.0}" for k in range(20)]
    (tmp_path / "text.csv").write_text(
        "time_s,position_rad,torque_Nm\n" + "\n".join([*rows, "oops,1,2"])
    )
    (tmp_path / "no_torque.csv").write_text(
        "time_s,position_rad\n" + "\n".join(row.rsplit(",", 1)[0] for row in rows)
    )
    (tmp_path / "back.csv").write_text(
        "time_s,position_rad,torque_Nm\n" + "\n".join([*rows, "0.05,1,2"])
    )
    (tmp_path / "still.csv").write_text(
        "time_s,position_rad,torque_Nm\n" + "\n".join(f"{0.01 * k:.2f},1,2" for k in range(200))
    )
    (tmp_path / "typo.toml").write_text("schema = 1\n[drive]\ngear_ration = 3.0\n")
    (tmp_path / "log.xlsx").write_bytes(b"PK")


@pytest.mark.parametrize(("arguments", "told"), BAD.values(), ids=BAD.keys())
def test_bad_input_ends_in_one_helpful_line(
    arguments: list[str], told: str, bad_files: None, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(arguments) == 2
    lines = capsys.readouterr().err.strip().splitlines()
    assert len(lines) == 1
    assert told in lines[0]


@pytest.mark.parametrize(
    "arguments",
    [["identfy"], ["identify"], ["identify", WELL, "--windows", "many"], ["demo", "--set"]],
)
def test_bad_usage_ends_in_one_line(
    arguments: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended:
        main(arguments)
    assert ended.value.code == 2
    assert len(capsys.readouterr().err.strip().splitlines()) == 1


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
        timer.join()
    assert code == 130
    assert capsys.readouterr().err.strip() == "jointid: interrupted"
    assert ended - sent[0] < 2.0  # 0.1 s on a machine that is not busy
