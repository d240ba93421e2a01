"""The command line refuses bad input with exit code 2 and one helpful line."""

import json
from pathlib import Path

import pytest
from example_recordings import WELL_EXCITED

import jointid as jid
from jointid.cli.command_line import main
from jointid.cli.demonstration import data_folder

KR300 = str(data_folder() / "kr300_joint1.csv.gz")
KR300_JOINT = str(data_folder() / "kr300_joint1.toml")
WELL = str(WELL_EXCITED)

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
    "no generations": (["identify", WELL, "--generations", "0"], "generations"),
    "parameter that is no finite number": (["identify", WELL, "--set", "viscous=nan"], "viscous"),
    "model with an unknown option": (["identify", WELL, "--model", "stribeck:magic"], "magic"),
    "unknown signal": (["identify", WELL, "--column", "speed=velocity"], "speed"),
    "column beyond the last": (["identify", WELL, "--column", "torque=99"], "99"),
    "no such column to choose rows by": (["identify", WELL, "--where", "run=1"], "run"),
    "no such rows": (["identify", WELL, "--where", "torque_Nm=1e9"], "torque_Nm"),
    "a folder": (["identify", "folder.csv"], "folder"),
    "empty file": (["info", "empty.csv"], "empty.csv"),
    "nothing but a header": (["info", "header.csv"], "header.csv"),
    "not text": (["info", "binary.csv"], "binary.csv"),
    "not an archive": (["info", "binary.npz"], "binary.npz"),
    "not a MATLAB file": (["info", "binary.mat"], "binary.mat"),
    "not compressed": (["info", "plain.csv.gz"], "plain.csv.gz"),
    "a missing value": (["info", "nan.csv"], "nan.csv"),
    "a ragged row": (["info", "ragged.csv"], "ragged.csv"),
    "the second of several is missing": (["identify", WELL, "nothing.csv"], "nothing.csv"),
    "the second of several has no sensor": (
        ["identify", WELL, "good.csv", "--joint", "sensor.toml"],
        "recording 1",
    ),
    "revolute and prismatic": (["identify", "good.csv", "linear.csv"], "recording 1"),
    "prismatic recording of a revolute joint": (
        ["identify", "linear.csv", "--joint", "sensor.toml"],
        "kind",
    ),
    "comparison of an unknown model": (["compare", WELL, "--model", "magic"], "coulomb_viscous"),
    "comparison with an unknown option": (
        ["compare", WELL, "--model", "stribeck:asymetric"],
        "asymetric",
    ),
    "comparison with half an option": (["compare", WELL, "--model", "stribeck:ripple="], "ripple"),
    "the same model twice": (
        ["compare", WELL, "--model", "stribeck", "--model", "stribeck"],
        "twice",
    ),
    "one fold": (["compare", WELL, "--folds", "1"], "folds"),
    "too many folds": (["compare", WELL, "--folds", "100000"], "fewer folds"),
    "comparison saved as something else": (["compare", WELL, "--save", "winner.pdf"], "pdf"),
    "comparison saved into nowhere": (["compare", WELL, "--save", "no/where.json"], "no"),
    "report of nothing": (["report", "nothing.json"], "nothing.json"),
    "report of a folder": (["report", "folder.csv"], "folder.csv"),
    "report of a recording": (["report", WELL], "not text in UTF-8"),
    "report of other JSON": (["report", "other.json"], "other.json"),
    "report of a newer estimate": (["report", "newer.json"], "update jointid"),
    "report of half an estimate": (["report", "half.json"], "parameters: this is missing"),
    "report of deep JSON": (["report", "deep.json"], "nested too deeply"),
    "report of an estimate without settings": (
        ["report", "bare.json"],
        "settings.version: this is missing",
    ),
    "report of an estimate, into nowhere": (
        ["report", "estimate.json", "--output", "no/where/report.html"],
        "report.html",
    ),
}
assert len(BAD) >= 40


@pytest.fixture(scope="module")
def estimate_text() -> str:
    joint = jid.Joint.load(KR300_JOINT)
    return jid.identify(jid.load(KR300), joint, search="separable").to_json()


@pytest.fixture
def bad_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, estimate_text: str) -> None:
    monkeypatch.chdir(tmp_path)
    rows = [f"{0.01 * k:.2f},{0.1 * k},{1.0}" for k in range(20)]
    (tmp_path / "text.csv").write_text(
        "time_s,position_rad,torque_Nm\n" + "\n".join([*rows, "oops,1,2"])
    )
    (tmp_path / "no_torque.csv").write_text(
        "time_s,position_rad\n" + "\n".join(row.rsplit(",", 1)[0] for row in rows)
    )
    (tmp_path / "back.csv").write_text(
        "time_s,position_rad,torque_Nm\n" + "\n".join([*rows, "0.05,1,2", ""])
    )
    (tmp_path / "still.csv").write_text(
        "time_s,position_rad,torque_Nm\n" + "\n".join(f"{0.01 * k:.2f},1,2" for k in range(200))
    )
    (tmp_path / "typo.toml").write_text("schema = 1\n[drive]\ngear_ration = 3.0\n")
    (tmp_path / "log.xlsx").write_bytes(b"PK")
    (tmp_path / "folder.csv").mkdir()
    (tmp_path / "empty.csv").touch()
    (tmp_path / "header.csv").write_text("time_s,position_rad,torque_Nm\n")
    for name in ("binary.csv", "binary.npz", "binary.mat"):
        (tmp_path / name).write_bytes(bytes(range(256)))
    header = "time_s,position_rad,torque_Nm\n"
    (tmp_path / "plain.csv.gz").write_text(header + "\n".join(rows))
    (tmp_path / "good.csv").write_text(header + "\n".join(rows))
    (tmp_path / "nan.csv").write_text(header + "\n".join([*rows, "0.2,nan,1", ""]))
    (tmp_path / "ragged.csv").write_text(header + "\n".join([*rows, "0.2,1", "0.21,2.1,1.0"]))
    (tmp_path / "linear.csv").write_text("time_s,position_m,force_N\n" + "\n".join(rows))
    (tmp_path / "sensor.toml").write_text("schema = 1\n[sensor]\npresent = true\n")
    estimate = json.loads(estimate_text)
    (tmp_path / "estimate.json").write_text(estimate_text)
    (tmp_path / "other.json").write_text('{"schema": 1}')
    (tmp_path / "newer.json").write_text(json.dumps(estimate | {"schema": 99}))
    (tmp_path / "half.json").write_text(
        json.dumps({key: estimate[key] for key in ("schema", "kind")})
    )
    (tmp_path / "bare.json").write_text(json.dumps(estimate | {"settings": {}}))
    (tmp_path / "deep.json").write_text("[" * 100_000)


@pytest.mark.parametrize(("arguments", "text"), BAD.values(), ids=BAD.keys())
def test_bad_input_ends_in_one_helpful_line(
    arguments: list[str], text: str, bad_files: None, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(arguments) == 2
    lines = capsys.readouterr().err.strip().splitlines()
    assert len(lines) == 1
    assert text in lines[0]
    assert len(lines[0]) < 400, "a sentence, not a dump"


@pytest.mark.parametrize(
    "field", ["parameters", "free", "correlation", "residuals", "windows", "joint", "settings"]
)
@pytest.mark.parametrize("junk", [None, 3, "text", [1], {"recording": -1e308}], ids=repr)
def test_a_tampered_estimate_is_refused(
    field: str,
    junk: object,
    estimate_text: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    path = tmp_path / "estimate.json"
    path.write_text(json.dumps(json.loads(estimate_text) | {field: junk}))
    assert main(["report", str(path), "--output", str(tmp_path / "report.html")]) == 2
    (line,) = capsys.readouterr().err.strip().splitlines()
    assert str(path) in line
    assert not (tmp_path / "report.html").exists()


@pytest.mark.parametrize(
    "arguments",
    [
        ["identfy"],
        ["identify"],
        ["identify", WELL, "--windows", "many"],
        ["identify", WELL, "--column", "torque"],
        ["identify", WELL, "--seed", "one"],
        ["identify", WELL, "--seed", "-1"],
        ["identify", WELL, "--windows", "99999999999999999999"],
        ["demo", "--set"],
        ["compare"],
        ["compare", WELL, "--folds", "few"],
        ["report"],
        ["report", "a.json", "b.json"],
        ["info", WELL, WELL],
    ],
)
def test_bad_usage_ends_in_one_line(
    arguments: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended:
        main(arguments)
    assert ended.value.code == 2
    assert len(capsys.readouterr().err.strip().splitlines()) == 1


@pytest.mark.parametrize(
    "words",
    [
        ["identify", "RUN", "--report", "RUN"],
        ["identify", "RUN", "--checkpoint", "RUN"],
        ["identify", "RUN", "--joint", "JOINT", "--report", "JOINT"],
        ["compare", "RUN", "--report", "RUN"],
        ["report", "ESTIMATE", "--output", "ESTIMATE"],
        ["simulate", "JOINT", "--trajectory", "RUN", "--output", "RUN"],
        ["sweep", "RUN", "--table", "RUN", "--grid", "windows=50"],
        ["sweep", "RUN", "--joint", "JOINT", "--output", "JOINT", "--grid", "windows=50"],
        ["sweep", "--simulate", "JOINT", "--plot", "JOINT", "--grid", "windows=50"],
    ],
)
def test_no_output_is_written_over_an_input(
    words: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    files = {"RUN": "run.csv", "JOINT": "joint.toml", "ESTIMATE": "estimate.html"}
    for name in files.values():
        (tmp_path / name).write_text(f"{name}: to be kept", encoding="utf-8")
    asked = [str(tmp_path / files[word]) if word in files else word for word in words]
    assert main(asked) == 2
    text = capsys.readouterr().err
    assert "cannot overwrite it" in text
    assert text.count("\n") == 1
    for name in files.values():
        assert (tmp_path / name).read_text(encoding="utf-8") == f"{name}: to be kept"


def test_a_report_is_a_page(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["identify", "run.csv", "--report", str(tmp_path / "report.pdf")]) == 2
    assert "report.pdf: the file of a report ends in one of .html, " in capsys.readouterr().err
