"""Every command at a terminal of 60, 80 and 120 columns: no word is split, no table broken; a pipe gets it whole."""

import fcntl
import os
import pty
import re
import shutil
import struct
import subprocess
import sys
import termios
from pathlib import Path

import pytest
from example_recordings import WELL_EXCITED

import jointid as jid
from jointid.cli.command_table import HELP
from jointid.cli.demonstration import data_folder
from jointid.cli.terminal import broken

WELL = str(WELL_EXCITED)
KR300 = str(data_folder() / "kr300_joint1.csv.gz")
BENCH = str(Path(__file__).resolve().parents[2] / "examples" / "hardware" / "joint.toml")
RULE = re.compile(r"-+(?:  -+)+")

DESIGN = "--position -1,1 --velocity 3 --torque 160 --duration 4 --evaluations 64 --joints 2 --rehearsals 10"

# A call of every command, in a folder with joint.toml and estimate.json.
CALLS: dict[str, list[str]] = {
    "demo": ["demo"],
    "new": ["new", "new.toml", KR300],
    "identify": ["identify", KR300, "--gear-ratio", "256.86", "--selftest", "--bootstrap", "50"],
    "identify with causes": ["identify", WELL, "--quiet", "--causes", "--save", "saved.json"],
    "an error": ["identify", KR300],
    "no such option": ["identify", KR300, "--gear", "3", "--unknown-option-of-no-command"],
    "compare": ["compare", WELL, "--folds", "2"],
    "simulate": ["simulate", "joint.toml"],
    "sweep": ["sweep", WELL, "--grid", "ga.population=10,20", "--grid", "windows=50,100", "--trials", "2"],
    "design": ["design", "joint.toml", *DESIGN.split()],
    "check": ["check", BENCH, "--emulate"],
    "first-motion": ["first-motion", BENCH, "--emulate", "--yes"],
    "run": ["run", BENCH, "--emulate", "--cycles", "1", "--output", "runs"],
    "emulate": ["emulate", BENCH, "--interface", "virtual"],
    "report": ["report", "estimate.json", "--output", "page.html"],
    "export": ["export", "estimate.json", "--to", "joint.h"],
    "info": ["info", WELL],
    "--help": ["--help"],
}  # fmt: skip
CALLS |= {f"{command} --help": [command, "--help"] for command in HELP}
LONG = {"run", "design", "first-motion", "demo"}
SLOW = {*LONG, *(name for name in CALLS if name.endswith(" --help") and name != "run --help")}
# Quickly at the narrowest; slow are other widths, what computes much, and what argparse alone writes.
CASES = [
    pytest.param(name, width, marks=[pytest.mark.slow] if name in SLOW or width > 60 else [])
    for name in CALLS
    for width in ([80] if name in LONG else [60, 80, 120])
]


def environment(**changes: str) -> dict[str, str]:
    return {k: v for k, v in os.environ.items() if k not in ("COLUMNS", "LINES")} | changes


def at_terminal(words: list[str], width: int, folder: Path, **changes: str) -> str:
    """What stands on a terminal of this width in the end, without its own breaking of lines."""
    leader, follower = pty.openpty()
    fcntl.ioctl(follower, termios.TIOCSWINSZ, struct.pack("HHHH", 50, width, 0, 0))
    command = [sys.executable, "-m", "jointid", *words]
    written = b""
    with subprocess.Popen(
        command,
        stdin=subprocess.DEVNULL,
        stdout=follower,
        stderr=follower,
        cwd=folder,
        env=environment(TERM="xterm", **changes),
    ):
        os.close(follower)
        while True:
            try:
                part = os.read(leader, 65536)
            except OSError:  # the last one has closed it
                break
            if not part:
                break
            written += part
    os.close(leader)
    return written.decode().replace("\r\n", "\n")


def in_pipe(words: list[str], folder: Path) -> str:
    done = subprocess.run(
        [sys.executable, "-m", "jointid", *words],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        cwd=folder,
        env=environment(),
        check=False,
    )
    return (done.stdout + done.stderr).decode()


def drawn(text: str) -> list[str]:
    """The lines that stay: a bar is drawn over."""
    return [line.rpartition("\r")[2].replace("\033[K", "") for line in text.split("\n")]


def plain(word: str) -> str:
    """A word whose numbers, which time and chance change, are all alike."""
    return re.sub(r"\d+(?:\.\d+)?(?:e[+-]?\d+)?", "0", word)


@pytest.fixture(scope="module")
def prepared(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("terminal")
    values = {"coulomb": 25.0, "static": 20.0, "stribeck": 100.0, "viscous": 20.0}
    joint = jid.thesis_joint().with_parameters(
        {**values, "sensor_gain": 2.4, "sensor_offset": 15.0}
    )
    joint.save(folder / "joint.toml")
    jid.identify(jid.load(WELL), jid.thesis_joint()).save(folder / "estimate.json")
    return folder


@pytest.fixture(scope="module")
def piped(prepared: Path) -> dict[str, set[str]]:
    """By call: its words in a pipe."""
    return {}


def check_tables(lines: list[str], name: str) -> None:
    """Below each rule the columns stand where the rule has them."""
    for index, line in enumerate(lines):
        if not RULE.fullmatch(line):
            continue
        gaps = [found.start() for found in re.finditer("  ", line)]
        for row in lines[index - 1 : index + 2]:
            assert not "".join(row[gap : gap + 2] for gap in gaps).strip(), (name, row)


@pytest.mark.parametrize(("name", "width"), CASES)
def test_nothing_is_broken(
    name: str, width: int, prepared: Path, piped: dict[str, set[str]], tmp_path: Path
) -> None:
    shutil.copytree(prepared, tmp_path / "terminal")
    is_help = "--help" in name  # argparse itself breaks it at hyphens: its words are not compared
    if name not in piped and not is_help:
        shutil.copytree(prepared, tmp_path / "pipe")
        piped[name] = {plain(word) for word in in_pipe(CALLS[name], tmp_path / "pipe").split()}
    lines = drawn(at_terminal(CALLS[name], width, tmp_path / "terminal"))
    assert any(lines)
    for line in lines:
        # A word that is wider than the terminal, such as a path, is all that may stand out.
        assert len(line) <= width or len(line.split()) <= 2, (len(line), line)
    if not is_help:
        words = {plain(word) for line in lines for word in line.split()} - {"\\"}
        strange = {word for word in words - piped[name] if not set(word) <= {"-"}}
        assert not strange, strange
    check_tables(lines, name)


def test_a_pipe_gets_whole_lines(prepared: Path) -> None:
    assert max(len(line) for line in in_pipe(CALLS["identify"], prepared).split("\n")) > 200


def test_no_colour_is_kept(prepared: Path) -> None:
    """Nothing is coloured where NO_COLOR is set; the bar's own erasing is no colour."""
    for changes in ({"NO_COLOR": "1"}, {}):
        text = at_terminal(CALLS["identify with causes"], 80, prepared, **changes)
        assert "\033[" not in text.replace("\033[K", "")


def test_a_bar_stays_on_its_line(prepared: Path) -> None:
    """A bar that is wider than the terminal could not be drawn over."""
    text = at_terminal(["compare", WELL, "--folds", "2"], 30, prepared)
    bars = [part for part in re.split("[\r\n]", text) if "█" in part or "·····" in part]
    assert bars
    assert max(len(bar.replace("\033[K", "")) for bar in bars) < 30


@pytest.mark.parametrize(
    ("line", "parts"),
    [
        ("a bb ccc" + " word" * 8, None),
        ("jointid identify: the file holds 6 joints, but a recording has only one", None),
        ("next: jointid identify a.csv --column position='my enc' --quiet", "\\"),
    ],
)
def test_a_line_is_joined_again(line: str, parts: str | None) -> None:
    found = [*broken(line, 40)]
    assert len(found) > 1
    assert max(map(len, found)) <= 40
    assert " ".join(part.strip().removesuffix(" \\") for part in found) == line
    assert all(part.endswith(" \\") for part in found[:-1]) == (parts is not None)


def test_numbers_keep_their_units() -> None:
    for width in range(40, 90):
        text = "\n".join(
            broken("torque " * 6 + "-10.19 ± 7.6 ms, by ±27 % and +4.21 %, 2.4 N·m", width)
        )
        assert "± 7.6 ms," in text
        assert "±27 %" in text
        assert "+4.21 %," in text
