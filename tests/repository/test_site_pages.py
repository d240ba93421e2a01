"""The quickstart and the how-tos do what they say: their code and commands run in the order of the page."""

import re
import shlex
from pathlib import Path
from typing import Any

import pytest
from documents import ROOT, blocks, enter, read, same_text

from jointid.cli import main
from jointid.cli.parser import command_parser

PAGES = ["docs/findings.md", "docs/quickstart.md", "docs/safety.md"]
SLOW = {"docs/safety.md"}  # it runs a bench
# Elsewhere: the page, and the test that runs it.
RUN_BY = {
    "docs/app.md": "test_site_pages.py",
    "docs/command_line.md": "test_documents.py",
    "docs/contributors/measuring.md": "test_measured_page.py",
    "docs/design.md": "test_design_document.py",
    "docs/exports.md": "test_documents.py",
    "docs/guide.md": "test_documents.py",
    "docs/hardware.md": "test_first_motion_documents.py",
    "docs/index.md": "test_site_pages.py",
    "docs/logs.md": "test_logs_document.py",
    "docs/own_terms.md": "test_documents.py",
    "docs/reports.md": "test_documents.py",
    "docs/robot_reference.md": "test_robots_document.py",
    "docs/robots.md": "test_robots_document.py",
    "docs/servos.md": "test_servos_document.py",
    "docs/several_joints.md": "test_several_joints_document.py",
    "docs/thesis.md": "test_thesis_figures.py",
}


def run_page(text: str) -> dict[str, Any]:
    """Run a page in the working folder: Python, commands of ours, and files that begin with their name."""
    names: dict[str, Any] = {}
    shown = re.findall(r"^```(python|sh|toml)\n(.*?)^```", text, re.DOTALL | re.MULTILINE)
    assert shown
    for language, block in shown:
        if language == "python":
            exec(compile(block, "page", "exec"), names)
        elif language == "toml":
            name = re.match(r"# (\S+)\n", block)
            assert name, "a file of a page begins with its name"
            Path(name[1]).write_text(block, encoding="utf-8")
        else:
            for line in block.splitlines():
                program, *arguments = shlex.split(line, comments=True) or [""]
                assert program in ("jointid", "pip", "")
                if program == "jointid":
                    assert main(arguments) == 0, line
    return names


@pytest.mark.parametrize("page", PAGES)
def test_a_page_has_commands_that_there_are(page: str) -> None:
    for line in "".join(blocks(read(page), "sh")).splitlines():
        program, *arguments = shlex.split(line, comments=True) or [""]
        if program == "jointid":
            assert command_parser().parse_args(arguments).command == arguments[0]


@pytest.mark.parametrize(
    "page",
    [pytest.param(page, marks=[pytest.mark.slow] if page in SLOW else []) for page in PAGES],
)
def test_a_page_runs(
    page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    pyplot = pytest.importorskip("matplotlib.pyplot")
    enter(tmp_path, monkeypatch)
    try:
        names = run_page(read(page))
    finally:
        pyplot.close("all")
    if page == "docs/quickstart.md":
        assert names["estimate"].verdict.level == "usable"
        assert names["coulomb"].value == pytest.approx(25.0, rel=0.001)
        assert 'friction = "stribeck"' in Path("joint.toml").read_text(encoding="utf-8")
        assert "usable" in Path("report.html").read_text(encoding="utf-8")
    if page == "docs/findings.md":
        shown = capsys.readouterr().out
        assert shown == "".join(blocks(read(page), "text"))


def test_the_quickstart_shows_what_its_commands_print(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    enter(tmp_path, monkeypatch)
    page = read("docs/quickstart.md")
    shown = blocks(page, "text")
    run_page(page)
    assert main(["identify", "log.csv"]) == 2
    printed = "".join(capsys.readouterr())
    for block in shown:
        begin = printed.index(block.partition("\n")[0])
        assert same_text(block, printed[begin:], within=0.02), block
    assert len(shown) == 3


def test_the_front_page_shows_commands_that_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    enter(tmp_path, monkeypatch)
    (tmp_path / "run.csv").write_bytes(b"")
    (block,) = blocks(read("docs/index.md"), "sh")
    assert re.findall(r"^jointid (\w+)", block, re.MULTILINE) == ["demo", "identify"]
    assert main(["demo", "--output", "demo"]) == 0
    assert "demo --output demo" in block
    assert "identify run.csv --report report.html" in block  # as in the README, where it runs


def test_the_page_on_the_app_names_a_command() -> None:
    """It runs until it is stopped: only its arguments."""
    (block,) = blocks(read("docs/app.md"), "sh")
    (line,) = [line for line in block.splitlines() if line.startswith("jointid ")]
    assert command_parser().parse_args(shlex.split(line)[1:]).command == "app"


def test_the_code_of_every_page_is_run_by_a_test() -> None:
    """A page with code is run here, or by a test that names it."""
    for path in sorted((ROOT / "docs").rglob("*.md")):
        page = path.relative_to(ROOT).as_posix()
        if not re.search(r"^```(python|sh)$", path.read_text(encoding="utf-8"), re.MULTILINE):
            continue
        if page in PAGES:
            continue
        runner = Path(__file__).parent / RUN_BY.get(page, "")
        assert runner.is_file(), f"no test runs the code of {page}"
        assert page in runner.read_text(encoding="utf-8") or page == "docs/thesis.md"


def test_the_citation_is_that_of_the_repository() -> None:
    yaml: Any = pytest.importorskip("yaml")
    citation = yaml.safe_load(read("CITATION.cff"))
    package, thesis = blocks(read("docs/reports.md"), "bibtex")
    for text in (citation["title"], f"{{{citation['version']}}}", citation["license"]):
        assert text in package
    (source,) = citation["references"]
    for text in (source["title"], str(source["year"]), source["institution"]["name"]):
        assert text in thesis
