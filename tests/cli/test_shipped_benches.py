"""Every bench file that is shipped passes every command that takes it, with the values that it states."""

from pathlib import Path
from typing import Any

import can
import pytest

from jointid.base.toml_file import read_toml
from jointid.cli.command_line import main

REPOSITORY = Path(__file__).resolve().parents[2]
BENCHES = [
    path
    for path in sorted((REPOSITORY / "examples").rglob("*.toml"))
    if "session" in read_toml(path)
]


def names(path: Path) -> str:
    return path.stem


def passes(words: list[str], path: Path) -> None:
    command, *options = words
    assert main([command, str(path), *options]) == 0


def test_there_is_one() -> None:
    assert REPOSITORY / "examples" / "hardware" / "joint.toml" in BENCHES


@pytest.mark.parametrize("path", BENCHES, ids=names)
@pytest.mark.parametrize("words", ["check --emulate", "run --emulate --dry-run"])
def test_it_is_checked(path: Path, words: str, capsys: Any) -> None:
    passes(words.split(), path)
    assert "PROBLEM" not in capsys.readouterr().out


@pytest.mark.parametrize("path", BENCHES, ids=names)
def test_it_is_simulated(path: Path, tmp_path: Path) -> None:
    passes(["simulate", "--output", str(tmp_path / "simulated.csv")], path)


@pytest.mark.parametrize("path", BENCHES, ids=names)
def test_it_is_emulated_on_a_bus(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        "jointid.hardware.can.bus.open_bus",
        lambda **_: can.Bus("shipped", interface="virtual"),
    )
    passes(["emulate", "--duration", "0.1"], path)


@pytest.mark.slow
@pytest.mark.parametrize("path", BENCHES, ids=names)
def test_it_is_moved(path: Path, tmp_path: Path) -> None:
    passes(["first-motion", "--emulate", "--watchdog", "--quiet"], path)
    passes(
        ["run", "--emulate", "--cycles", "1", "--quiet", "--output", str(tmp_path / "runs")], path
    )
