"""`--report` of `compare`, `sweep` and `design`: each its own page, named at the end, and refused before the work."""

from pathlib import Path

import pytest
from designs import bench_text
from example_recordings import WELL_EXCITED

import jointid as jid
from jointid.cli.command_line import main

WELL = str(WELL_EXCITED)
QUICK = ("--duration", "4", "--evaluations", "100", "--joints", "2", "--rehearsals", "10")
COMMANDS = {
    "compare": ("compare", WELL, "--joint", "thesis.toml", "--folds", "3"),
    "sweep": (
        *("sweep", WELL, "--joint", "thesis.toml", "--method", "separable"),
        *("--grid", "windows=50,100,200", "--trials", "1"),
    ),
    "design": ("design", "bench.toml", "--position", "-60deg,60deg", "--velocity", "3.4", *QUICK),
}
FIRST = {
    "compare": "<b>Use stribeck: ",
    "sweep": "differs most from cell to cell",
    "design": '<p class="verdict usable"><b>Usable: no parameter',
}


@pytest.fixture(autouse=True)
def _folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    jid.thesis_joint().save("thesis.toml")
    Path("bench.toml").write_text(bench_text(), encoding="utf-8")


@pytest.mark.parametrize("command", COMMANDS)
def test_it_writes_its_page(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([*COMMANDS[command], "--quiet", "--report", "page.html"]) == 0
    last = capsys.readouterr().out.splitlines()[-1]
    assert last.startswith("report: page.html")
    page = Path("page.html").read_text(encoding="utf-8")
    assert FIRST[command] in page[: page.index("<h2")]
    assert "<svg " in page


@pytest.mark.parametrize("command", COMMANDS)
def test_what_is_no_page_is_refused_before_the_work(
    command: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([*COMMANDS[command], "--report", "page.pdf"]) == 2
    assert (
        "--report page.pdf: the file of a report ends in one of .html, " in capsys.readouterr().err
    )
    assert not Path("page.pdf").exists()
