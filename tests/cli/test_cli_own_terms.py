"""Own terms on the command line: the columns they need are read by themselves."""

import json
from pathlib import Path

import numpy as np
import pytest

import jointid as jid
from jointid.cli import main

TIME = np.arange(3000) * 0.004
Q = 0.8 * np.sin(2.1 * TIME) + 0.3 * np.sin(5.3 * TIME + 1.0)
V = 0.8 * 2.1 * np.cos(2.1 * TIME) + 0.3 * 5.3 * np.cos(5.3 * TIME + 1.0)
A = -0.8 * 2.1**2 * np.sin(2.1 * TIME) - 0.3 * 5.3**2 * np.sin(5.3 * TIME + 1.0)
Q6 = 0.5 * np.sin(3.3 * TIME + 0.4) + 0.2 * np.cos(1.1 * TIME)
V6 = 0.5 * 3.3 * np.cos(3.3 * TIME + 0.4) - 0.22 * np.sin(1.1 * TIME)
MODEL = 20.0 * np.sin(0.9 * TIME + 0.2)


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    torque = 2.5 * A + 12.0 * np.sign(V) + 6.0 * V + 3.0 * V6 + MODEL
    torque += np.random.default_rng(1).normal(size=len(TIME))
    path = tmp_path_factory.mktemp("own") / "run.csv"
    columns = np.column_stack([TIME, Q, V, torque, 1e3 * Q6, MODEL])
    header = "time_s,position_rad,velocity_rad_s,torque_Nm,axis 6 [mrad],tau_model"
    np.savetxt(path, columns, delimiter=",", header=header, comments="")
    return path


def options(log: Path) -> list[str]:
    return [
        *(str(log), "--method", "separable", "--quiet"),
        *("--extra", "q6=axis 6 [mrad]", "--term", "q6=viscous@rate", "--term", "tau_model=known"),
    ]


def test_identify_reads_the_columns_of_its_terms(
    log: Path, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    joint = tmp_path / "joint.toml"
    command = ["identify", *options(log), "--model", "coulomb_viscous", "--json"]
    assert main([*command, "--save", str(joint)]) == 0
    found = json.loads(capsys.readouterr().out)["parameters"]
    assert found["viscous_of_q6_rate"]["value"] == pytest.approx(3.0, rel=0.05)
    assert found["viscous_of_q6_rate"]["unit"] == "N·m·s/rad"
    assert (
        found["known_of_tau_model"] | {"value": 1.0, "vary": False} == found["known_of_tau_model"]
    )
    assert 'tau_model = "known"' in joint.read_text(encoding="utf-8")
    # The joint file's terms need the same columns.
    again = ["identify", str(log), "--joint", str(joint), "--extra", "q6=axis 6 [mrad]", "--json"]
    assert main([*again, "--method", "separable", "--quiet"]) == 0
    assert "viscous_of_q6_rate" in json.loads(capsys.readouterr().out)["parameters"]


def test_the_text_of_a_model_has_terms_too(log: Path, capsys: pytest.CaptureFixture[str]) -> None:
    model = "coulomb_viscous:terms=tau_model=scaled"
    assert main(["identify", str(log), "--model", model, "--quiet", "--method", "separable"]) == 0
    assert "scale_of_tau_model" in capsys.readouterr().out


def test_models_are_compared_with_the_same_terms(
    log: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["compare", *options(log), "--folds", "2"]) == 0
    assert "q6=viscous@rate" in capsys.readouterr().out


def test_wrong_terms_are_refused_in_the_words_of_the_command(
    log: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for more, message in (
        (["--term", "tau_model=knwon"], "did you mean 'known'"),
        (["--term", "tau=known"], "no such header"),
        (["--term", "tau_model=known", "--term", "tau_model=scaled"], "given twice"),
    ):
        assert main(["identify", str(log), *more]) != 0
        assert message in capsys.readouterr().err


def test_info_shows_extra_signals(log: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["info", str(log), "--extra", "q6=axis 6 [mrad]", "--json"]) == 0
    assert "q6" in capsys.readouterr().out
    assert list(jid.load(log, extra=["tau_model"]).extra) == ["tau_model"]
