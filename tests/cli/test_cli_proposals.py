"""What is proposed for a foreign log has evidence: a header's unit or words, or numbers; else it is asked for."""

import re
import shlex
from pathlib import Path

import numpy as np
import pytest
from command_line_answers import answer

import jointid as jid
from jointid.cli.command_line import main

N = 400
TIME = 0.005 * np.arange(N)
ANGLE = np.sin(4.0 * TIME) + 0.3 * np.sin(11.0 * TIME)
SPEED = np.gradient(ANGLE, TIME)
EFFORT = 3.0 * np.tanh(20.0 * SPEED) + SPEED
REST = np.random.default_rng(3).normal(-1.57, 1e-4, (3, N))


def log(path: Path, header: str, *columns: np.ndarray) -> str:
    rows = [",".join(f"{value:.7f}" for value in row) for row in zip(*columns, strict=True)]
    path.write_text("\n".join([header] * bool(header) + [*rows, ""]))
    return str(path)


HEADERLESS = {  # columns, and what is right for time, position and velocity
    "an arm of which one joint moves": ((TIME, ANGLE, REST[0], SPEED, REST[1], EFFORT), (0, 1, 3)),
    "a resting joint first": ((TIME, REST[0], REST[1], ANGLE, EFFORT, SPEED), (0, 3, 5)),
    "the motion before the time": ((EFFORT, ANGLE, SPEED, TIME + 1.2), (3, 1, 2)),
    "no velocity": ((TIME, EFFORT, ANGLE, REST[0]), (0, 2, None)),
}


@pytest.mark.parametrize("name", HEADERLESS)
@pytest.mark.parametrize("command", ["info", "identify"])
def test_bare_numbers_show_no_torque(
    name: str, command: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    columns, right = HEADERLESS[name]
    code, said = answer([command, log(tmp_path / "a.csv", "", *columns)], capsys)
    assert code == 2
    for signal, column in zip(("time", "position", "velocity"), right, strict=True):
        assert (f"{signal}='column {column}'" in said) == (column is not None)
    assert "which column is the torque or current?" in said
    example = "e.g. position=1:6, torque=7:12"  # of blocks, of another file
    assert "torque=" not in said.replace("torque=HEADER", "").replace(example, "")


@pytest.mark.parametrize("header", ["i_A", "motor_amps [A]", "Phasenstrom (A)"])
def test_amperes_are_a_current(
    header: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = log(tmp_path / "a.csv", f"time_s,position_rad,{header}", TIME, ANGLE, EFFORT)
    for more in ([], ["--column", f"torque={header}"]):
        code, said = answer(["identify", path, *more], capsys)
        assert code == 2
        assert "--torque-constant VALUE" in said
        assert "--unit torque" not in said
        assert "--scale torque" not in said
    with pytest.raises(jid.InputError, match="is in A") as caught:
        jid.load(path, columns={"torque": header})
    assert "'Nm'" not in str(caught.value)


@pytest.mark.parametrize(
    ("header", "quantity"), [("torque_current", "current"), ("current_torque", "torque")]
)
def test_the_last_word_says_what_a_column_is(
    header: str, quantity: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = log(tmp_path / "a.csv", f"time_s,position_rad,{header}", TIME, ANGLE, EFFORT)
    assert f"--column {quantity}={header}" in answer(["identify", path], capsys)[1]


@pytest.mark.parametrize("header", ["", "sample"])
def test_rows_that_are_counted_are_no_time(
    header: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    head = f"{header},position_rad,torque_Nm"
    _, said = answer(["info", log(tmp_path / "a.csv", head, np.arange(N), ANGLE, EFFORT)], capsys)
    assert "load with --rate HZ" in said
    assert "time=" not in said


def test_a_wrong_rate_is_named_and_cured_by_what_is_pasted(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    head = "position_rad,velocity_rad_s,torque_Nm"
    path = log(tmp_path / "a.csv", head, ANGLE, SPEED, EFFORT)
    line = ["identify", path, "--model", "coulomb_viscous", "--rate"]
    assert main([*line, "230"]) == 0
    said = capsys.readouterr().out
    found = re.search(r"do: jointid identify .* --rate ([\d.]+)", said)
    assert found is not None
    assert float(found[1]) == pytest.approx(200.0, rel=0.01)
    assert main([*line, found[1]]) == 0
    assert "velocity_mismatch" not in capsys.readouterr().out


@pytest.mark.parametrize("header", ["sample_count", "lamp", "extra"])
def test_a_column_without_evidence_is_no_torque(
    header: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = log(tmp_path / "a.csv", f"time_s,position_rad,{header}", TIME, ANGLE, EFFORT)
    _, said = answer(["identify", path], capsys)
    assert said.endswith(
        "load with --column torque=HEADER; or load with --column current=HEADER (if the column is in amperes)\n"
    )


def test_counts_of_an_encoder_are_a_position_whose_factor_is_asked(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = log(tmp_path / "a.csv", "time_s,encoder_counts,torque_Nm", TIME, 500.0 * ANGLE, EFFORT)
    _, said = answer(["identify", path], capsys)
    assert "load with --column position=encoder_counts --scale position=FACTOR" in said


@pytest.mark.parametrize(
    ("header", "column"),
    [("stuff,position_rad,torque_Nm", ANGLE + TIME), ("q_0,q_1,tau_0", 9.0 * TIME)],
)
def test_a_position_or_counter_is_no_time(
    header: str, column: np.ndarray, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    _, said = answer(["info", log(tmp_path / "a.csv", header, column, ANGLE, EFFORT)], capsys)
    assert "--rate HZ" in said
    assert "time=" not in said
    counted = log(
        tmp_path / "b.csv", "frame_index,position_rad,torque_Nm", np.arange(N), ANGLE, EFFORT
    )
    _, said = answer(["info", counted], capsys)
    assert "time=" not in said


def test_volts_need_a_factor(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = log(tmp_path / "a.csv", "time_s,position_rad,torque_monitor [V]", TIME, ANGLE, EFFORT)
    _, said = answer(["identify", path], capsys)
    assert "--scale torque=FACTOR" in said
    assert "--unit" not in said


INFO = {
    "a joint with brackets": (
        "OSL:timestamp,knee[Pack]:output_position,knee[Pack]:output_torque,knee[Pack]:state",
        ["--column", "time=OSL:timestamp", "--joints", "knee[Pack]:output"],
    ),
    "by numbers and a factor": (
        "clock,encoder [counts],torque_Nm,knee[Pack]:state",
        ["--column", "time=0", "--column", "position=1", "--scale", "position=0.001"],
    ),
    "a joint and an extra signal": (
        "time_s,axis2_enc,axis2_torque,knee[Pack]:state",
        ["--column", "position=axis2_enc", "--extra", "torque_2=axis2_torque"],
    ),
}


@pytest.mark.parametrize("name", INFO)
def test_info_names_as_unknown_only_what_it_did_not_read(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    header, options = INFO[name]
    path = log(tmp_path / "a.csv", header, TIME, ANGLE, EFFORT, np.ones(N))
    assert main(["info", path, *options]) == 0
    assert "columns not recognised: knee[Pack]:state\n" in capsys.readouterr().out


@pytest.mark.parametrize("header", ["par_mNm", "couple_moteur [Nm]"])
def test_a_unit_alone_shows_a_torque(
    header: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = log(tmp_path / "a.csv", f"tiempo_s,angulo_rad,{header}", TIME, ANGLE, EFFORT)
    code, said = answer(["identify", path], capsys)
    assert code == 2
    assert main(["identify", path, *shlex.split(said.partition("load with ")[2])]) == 0
