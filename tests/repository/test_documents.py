"""The code in docs/ runs, the links lead somewhere, and the citation names this version."""

import ast
import inspect
import os
import re
import shlex
import shutil
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeGuard

import pytest
from documents import ROOT, blocks, enter, parsed_commands, read, run_python_blocks
from example_recordings import WELL_EXCITED
from moving_joints import recorded, sines, torques

import jointid as jid
from jointid.cli import main
from jointid.cli.demonstration import data_folder
from jointid.cli.parser import command_parser

PAGES = ["README.md", "CONTRIBUTING.md", "SECURITY.md", "examples/README.md"]
PAGES += [path.relative_to(ROOT).as_posix() for path in sorted((ROOT / "docs").rglob("*.md"))]
# Pages that `make docs` writes; it follows the links to them.
WRITTEN = ("docs/reference/",)
COMMANDS = [
    line
    for page in ("README.md", "docs/command_line.md")
    for block in blocks(read(page), "sh")
    for line in block.splitlines()
    if line.startswith("jointid ")
]
DECISIONS = "docs/contributors/decisions.md"
SLOW = {"design", "run", "first-motion"}  # what design.md and hardware.md show is quick to try


@pytest.mark.parametrize("page", PAGES)
def test_python_on_a_page_names_what_there_is(page: str) -> None:
    """Also where running it is slow: what is called is public, and takes these keywords."""
    for block in blocks(read(page), "python"):
        for node in ast.walk(ast.parse(block)):
            if isinstance(node, ast.Call) and _is_ours(node.func):
                takes = _keywords(getattr(jid, node.func.attr))
                assert {word.arg for word in node.keywords} <= takes | {None}, ast.unparse(node)
            elif _is_ours(node):
                assert hasattr(jid, node.attr), node.attr


def _keywords(called: Callable[..., Any]) -> set[str]:
    try:
        return {*inspect.signature(called).parameters}
    except ValueError:  # options of the core, which are its fields
        return {*dir(called)}


def _is_ours(node: ast.AST) -> TypeGuard[ast.Attribute]:
    """Whether it is `jid.NAME`."""
    return (
        isinstance(node, ast.Attribute)
        and isinstance(node.value, ast.Name)
        and node.value.id == "jid"
    )


@pytest.mark.slow
def test_the_guide_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    names = run_python_blocks(read("docs/guide.md"), tmp_path, monkeypatch)
    assert (tmp_path / "grid.csv").is_file()
    assert names["comparison"].winner == "stribeck"
    assert names["together"].status == "converged"


def test_the_page_about_own_terms_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    names = run_python_blocks(read("docs/own_terms.md"), tmp_path, monkeypatch)
    assert "viscous_of_again" in str(names["caught"])
    assert parsed_commands(read("docs/own_terms.md")) == ["identify"]
    (text,) = blocks(read("docs/own_terms.md"), "toml")
    (tmp_path / "joint.toml").write_text(f"schema = 1\n{text}", encoding="utf-8")
    assert jid.Joint.load(tmp_path / "joint.toml").model == jid.Model(
        "stribeck", terms={"q6": "viscous@rate+coulomb@rate", "tau_model": "known"}
    )


def test_the_page_on_reports_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    run_python_blocks(read("docs/reports.md"), tmp_path, monkeypatch)
    assert capsys.readouterr().out.startswith("usable\n")
    assert "<b>Use stribeck: " in (tmp_path / "models.html").read_text(encoding="utf-8")
    for name in ("joint.html", "friction.pdf", "friction.csv"):
        assert (tmp_path / name).is_file()
    for name in re.findall(r"pictures/report_\w+\.png", read("docs/reports.md")):
        assert (ROOT / "docs" / name).stat().st_size < 150_000


def test_the_page_on_exports_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    run_python_blocks(read("docs/exports.md"), tmp_path, monkeypatch)
    assert 'frictionloss="' in (tmp_path / "arm.xml").read_text(encoding="utf-8")


def test_the_joint_file_in_the_guide_loads(tmp_path: Path) -> None:
    (text,) = blocks(read("docs/guide.md"), "toml")
    path = tmp_path / "joint.toml"
    path.write_text(text, encoding="utf-8")
    joint = jid.Joint.load(path)
    assert joint.parameters["coulomb"].max == 50.0
    assert joint.torque_hold == "zoh"


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What the commands read: recordings, a joint with values, and a saved estimate."""
    folder = tmp_path_factory.mktemp("files")
    recording = jid.load(WELL_EXCITED)
    estimate = jid.identify(recording, jid.thesis_joint())
    estimate.save(folder / "joint.toml")
    estimate.save(folder / "estimate.json")
    robot = data_folder() / "kr300_joint1.toml"
    shipped = jid.identify(jid.load(robot.with_suffix(".csv.gz")), jid.Joint.load(robot))
    shipped.save(folder / "kr300.toml")
    for name, part in {"run": recording, "monday": recording, "tuesday": recording[2.0:]}.items():
        part.save(folder / f"{name}.csv")
    motion = sines(2, 1, duration=8.0)
    ratios = [50.0, -30.0]
    torque = torques(motion, 1) / ratios
    recorded(motion, torque).save(folder / "arm.csv")
    text = (folder / "run.csv").read_text(encoding="utf-8")
    (folder / "enc1.csv").write_text(text.replace("position_rad", "enc1", 1), encoding="utf-8")
    current = text.replace("torque_Nm", "current_A", 1)
    (folder / "log.csv").write_text(current, encoding="utf-8")
    return folder


def test_each_command_is_one() -> None:
    for line in COMMANDS:
        command, *arguments = shlex.split(line, comments=True)[1:]
        assert command_parser().parse_args([command, *arguments]).command == command


@pytest.mark.parametrize(
    "line",
    [
        pytest.param(line, marks=[pytest.mark.slow] if line.split()[1] in SLOW else [])
        for line in COMMANDS
        if line.split()[1] != "emulate"  # until Ctrl-C, on an interface of the machine
    ],
)
def test_a_command_runs(
    line: str, files: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    command, *arguments = shlex.split(line, comments=True)[1:]
    for path in files.iterdir():
        shutil.copy(path, tmp_path)
    enter(tmp_path, monkeypatch)
    if command == "sweep":
        arguments += ["--trials", "1"]
    assert main([command, *arguments]) == 0


@pytest.mark.parametrize("page", PAGES)
def test_links_lead_somewhere(page: str) -> None:
    for link in re.findall(r"\]\(([^)\s]+)\)", read(page)):
        if re.match(r"https?://", link):
            continue
        path, _, anchor = link.partition("#")
        target = ((ROOT / page).parent / path) if path else ROOT / page
        if os.path.relpath(target, ROOT).startswith(WRITTEN):
            continue
        assert target.exists(), f"{page}: {link}"
        if anchor:
            assert anchor in _anchors(target.read_text(encoding="utf-8")), f"{page}: {link}"


def _anchors(text: str) -> set[str]:
    """The names that GitHub gives a page's headings."""
    headings = re.findall(r"^#+ (.*)$", text, re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", each.lower()).replace(" ", "-") for each in headings}


def test_every_page_can_be_found_from_the_readme() -> None:
    """In three clicks; pages for contributors by CONTRIBUTING.md."""
    found = {"README.md"}
    for _ in range(3):
        found |= {
            os.path.normpath(Path(page).parent / link.partition("#")[0])
            for page in found.intersection(PAGES)
            for link in re.findall(r"\]\(([^)\s]+)\)", read(page))
        }
    assert set(PAGES) - found == set()


def test_the_citation_names_this_version_and_the_thesis() -> None:
    yaml: Any = pytest.importorskip("yaml")
    citation = yaml.safe_load(read("CITATION.cff"))
    project = tomllib.loads(read("pyproject.toml"))["project"]
    assert citation["cff-version"] == "1.2.0"
    assert citation["version"] == project["version"]
    assert citation["license"] == project["license"]
    (thesis,) = citation["references"]
    assert thesis["type"] == "thesis"
    assert thesis["year"] == 2007
    cited = " ".join(read("README.md").split())
    assert f"*{thesis['title']}*" in cited


def test_the_thesis_is_cited_in_full_once_beside_the_page_for_that() -> None:
    pages = [page for page in PAGES if page != "docs/reports.md"]
    whole = " ".join("\n".join(read(page) for page in pages).split())
    assert whole.count("Ryerson University") == 1


CONTRIBUTORS = [page for page in PAGES if page.startswith(("CONTRIBUTING", "docs/contributors"))]


@pytest.mark.parametrize("page", CONTRIBUTORS)
def test_a_file_that_contributors_are_sent_to_is_there(page: str) -> None:
    for name in re.findall(r"`((?:cpp|docs|python|tests|tools)/[\w./-]+)`", read(page)):
        if "NAME" not in name and not name.startswith(WRITTEN):
            assert (ROOT / name).exists(), f"{page}: {name}"


def test_each_decision_has_a_reason_and_a_guard() -> None:
    decisions = re.findall(r"^\*\*.*?(?=\n\n|\Z)", read(DECISIONS), re.MULTILINE | re.DOTALL)
    assert len(decisions) >= 50
    for decision in decisions:
        assert re.fullmatch(
            r"\*\*[^*]+\.\*\*\n.+\nGuard: `[^`]+`(,\s`[^`]+`)*\n?", decision, re.DOTALL
        ), decision


def test_every_example_is_listed() -> None:
    listed = re.findall(r"^\| `(\w+\.py)` \|", read("examples/README.md"), re.MULTILINE)
    assert listed == sorted(path.name for path in (ROOT / "examples").glob("*.py"))
