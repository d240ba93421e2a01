"""The documentation site: a newcomer's questions are two clicks away, nothing is dead, nothing comes from elsewhere."""

import importlib.util
import itertools
import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest
from documentation import defective, public_names, reference
from documentation.defective import Case
from documentation.findings_gallery import listed_sections
from documentation.findings_tables import in_place_of_the_table
from documentation.links import Page, broken, pages_of
from documentation.staging import Stage, stage_documents
from documentation.symptoms import SYMPTOMS
from documents import ROOT, read

import jointid as jid
from jointid.cli.command_table import HELP
from jointid.identification.warnings.registry import finding_types

WITHOUT_SPHINX = "Sphinx is not installed: `pip install --group docs`"
# What a newcomer asks: the clicks from the front page, and what the last page says.
QUESTIONS: Mapping[str, tuple[tuple[str, ...], str]] = {
    "my columns are counts and mA": (
        ("index.html", "quickstart.html"),
        "encoder counts of the motor",
    ),
    "what does this finding mean": (
        ("index.html", "findings.html"),
        "Flip the sign of the wrong column",
    ),
    "how do I move my joint": (("index.html", "design.html"), "jointid design"),
    "is it safe to run": (("index.html", "safety.html"), "was ever connected"),
    "cite this": (("index.html", "reports.html"), "@software{jointid"),
}


def _newest(*folders: str) -> float:
    files = [path for each in folders for path in (ROOT / each).rglob("*") if path.is_file()]
    return max(path.stat().st_mtime for path in files if "__pycache__" not in path.parts)


@pytest.fixture(scope="module")
def site() -> Path:
    """The site as it is; built anew where it is older than what it is made of."""
    built, complete = ROOT / "build/docs/site", ROOT / "build/docs/complete"
    made_of = _newest("docs", "notebooks", "tools/documentation")
    if not (complete.is_file() and complete.stat().st_mtime > made_of):
        if any(
            importlib.util.find_spec(name) is None for name in ("sphinx", "myst_parser", "furo")
        ):
            pytest.skip(WITHOUT_SPHINX)
        paths = os.pathsep.join([str(ROOT / "tools"), *sys.path])
        command = [sys.executable, "-m", "documentation"]
        environment = {**os.environ, "PYTHONPATH": paths}
        subprocess.run(command, cwd=ROOT, env=environment, check=True, timeout=240)
    return built


@pytest.fixture(scope="module")
def made() -> dict[str, Case]:
    with tempfile.TemporaryDirectory() as folder:
        return defective.cases(Path(folder))


@pytest.mark.slow
@pytest.mark.parametrize("question", QUESTIONS)
def test_a_newcomer_is_two_clicks_from_the_answer(site: Path, question: str) -> None:
    path, answer = QUESTIONS[question]
    assert len(path) <= 3
    for page, next_page in itertools.pairwise(path):
        links = _article(site / page).links
        there = {os.path.normpath(Path(page).parent / link.partition("#")[0]) for link in links}
        assert next_page in there, f"{page} does not lead to {next_page}"
    text = (site / path[-1]).read_text(encoding="utf-8")
    assert answer in "".join(_Text(text).parts)


class _Text(Page):
    """The words of a page."""

    def __init__(self, text: str) -> None:
        self.parts: list[str] = []
        super().__init__(text)

    def handle_data(self, data: str) -> None:
        self.parts.append(data)


def _article(path: Path) -> Page:
    """What stands on a page itself, not in the list of pages beside it."""
    text = path.read_text(encoding="utf-8")
    return Page(text[text.index("<article") : text.index("</article>")])


@pytest.mark.slow
def test_the_site_has_no_dead_link_and_loads_nothing_from_another_host(site: Path) -> None:
    assert list(broken(site)) == []
    assert len(pages_of(site)) > 40
    styles = "".join(path.read_text(encoding="utf-8") for path in site.rglob("*.css"))
    assert "url(http" not in styles
    assert "@import" not in styles


@pytest.mark.slow
def test_every_public_name_is_on_the_site(site: Path) -> None:
    pages = [
        page for path, page in pages_of(site).items() if path.parts[:2] == ("reference", "api")
    ]
    places = set().union(*(page.places for page in pages))
    assert public_names.public_names() <= places


def test_every_public_name_is_in_one_group(monkeypatch: pytest.MonkeyPatch) -> None:
    public_names.check_groups()
    monkeypatch.setattr(public_names, "GROUPS", public_names.GROUPS[1:])
    with pytest.raises(LookupError, match=r"jointid\.Recording"):
        public_names.check_groups()


def test_each_finding_has_a_symptom() -> None:
    assert SYMPTOMS.keys() == finding_types().keys()


@pytest.mark.slow
def test_each_finding_has_a_recording(made: dict[str, Case]) -> None:
    assert made.keys() == finding_types().keys()
    assert all(made[code].text for code, symptom in SYMPTOMS.items() if symptom.picture is None)


@pytest.mark.parametrize("code", ["reversed_sign", "spikes", "at_bound"])
def test_the_recording_in_a_picture_has_the_finding(code: str) -> None:
    _check(defective.damaged(jid.load(defective.GOOD))[code], code)


@pytest.mark.slow
@pytest.mark.parametrize("code", finding_types())
def test_each_recording_in_a_picture_has_its_finding(made: dict[str, Case], code: str) -> None:
    _check(made[code], code)


def _check(case: Case, code: str) -> None:
    estimate = case.estimate()
    assert code in {each.code for each in estimate.findings}
    picture = SYMPTOMS[code].picture
    if picture is not None:
        figure = str(picture(case.recording, estimate))
        assert figure.count("<svg ") == 1
        assert "no values" not in figure
        assert len(figure) < 60_000


def test_every_option_of_every_command_is_listed() -> None:
    page = reference.options_page()
    for command in HELP:
        assert f"## jointid {command}\n" in page
    for option in ("--drop-copies", "--bootstrap DRAWS", "--evaluations EVALUATIONS", "--dry-run"):
        assert f"`{option}`\n: " in page


def test_every_key_of_the_joint_file_is_described() -> None:
    page = reference.joint_file_page()
    joint = jid.thesis_joint().with_parameters({"coulomb": 1.0})
    with tempfile.TemporaryDirectory() as folder:
        joint.save(Path(folder) / "joint.toml")
        text = (Path(folder) / "joint.toml").read_text(encoding="utf-8")
    keys = {line.partition(" = ")[0] for line in text.splitlines() if " = " in line}
    assert {"gear_ratio", "friction", "mass", "value"} <= keys
    assert not [key for key in keys if f"`{key}` (" not in page]
    assert "See the guide." not in page


def test_links_are_led_to_where_their_targets_are(tmp_path: Path) -> None:
    stage = Stage(tmp_path)
    text = (
        "[a](guide.md#errors) [b](../README.md) [c](../examples/README.md) [`spikes`](findings.md) `[d](x.md)` "
        "[e](../examples/hardware/joint.toml) [f](pictures/thesis) [g](../notebooks/01_own_log.ipynb) "
        "[`h`](contributors/house.md#who) [i](../SECURITY.md)"
    )
    assert stage.relinked(text, "docs/page.md", "deep/page.md") == (
        "[a](../guide.md#errors) [b](../index.md) [c](../examples.md) [`spikes`](../findings.md#spikes) `[d](x.md)` "
        "[e](../repository/examples/hardware/joint.toml) f [g](../tutorials/01_own_log.ipynb) "
        "`h` i"
    )
    assert (tmp_path / "repository/examples/hardware/joint.toml").is_file()


def test_each_finding_is_listed_and_has_a_section() -> None:
    text = listed_sections({code: f"#### `{code}`\n" for code in finding_types()})
    page = in_place_of_the_table(read("docs/findings.md"), text)
    assert "| code |" not in page
    for code in finding_types():
        assert page.count(f"[`{code}`](#{code})") == page.count(f"#### `{code}`\n") == 1
    blocking, warning = (page.index(f"\n### {each}\n") for each in ("Blocking", "Warning"))
    assert blocking < page.index("#### `reversed_sign`") < warning < page.index("#### `spikes`")


def test_contributors_pages_are_not_on_the_site(tmp_path: Path) -> None:
    stage_documents(Stage(tmp_path))
    staged = {path.name for path in tmp_path.rglob("*.md")}
    assert staged.isdisjoint({"contributing.md", "CONTRIBUTING.md", "house.md"})


def test_what_is_staged_no_more_is_removed(tmp_path: Path) -> None:
    first, second = Stage(tmp_path), Stage(tmp_path)
    first.write("old.md", "old")
    first.write("kept.md", "kept")
    written = (tmp_path / "kept.md").stat().st_mtime_ns
    second.write("kept.md", "kept")
    second.finish()
    assert [path.name for path in tmp_path.iterdir()] == ["kept.md"]
    assert (tmp_path / "kept.md").stat().st_mtime_ns == written


@pytest.mark.parametrize(
    ("body", "complaint"),
    [
        ('<a href="gone.html">', "is not there"),
        ('<a href="/index.html">', "is not there"),
        ('<a href="#nowhere">', "a place that is not on that page"),
        ('<script src="https://example.org/a.js"></script>', "from another host"),
        ('<link rel="stylesheet" href="//example.org/a.css">', "from another host"),
    ],
)
def test_a_dead_link_is_found(tmp_path: Path, body: str, complaint: str) -> None:
    (tmp_path / "index.html").write_text(f"<p id='here'>{body}<a href='#here'>", encoding="utf-8")
    assert [complaint in each for each in broken(tmp_path)] == [True]


def test_a_notebook_is_shown_as_it_was_run(tmp_path: Path) -> None:
    pytest.importorskip("myst_parser", reason=WITHOUT_SPHINX)
    from documentation.notebooks import markdown_of

    path = ROOT / "notebooks" / "01_own_log.ipynb"
    notebook: Any = json.loads(path.read_text(encoding="utf-8"))
    text = markdown_of(notebook, tmp_path / "pictures", path.name)
    shown = [each for cell in notebook["cells"] for each in cell.get("outputs", [])]
    pictures = [each for each in shown if "image/png" in each.get("data", {})]
    assert len(list((tmp_path / "pictures").iterdir())) == len(pictures) >= 2
    assert text.count("](pictures/") == len(pictures)
    assert text.startswith("# ")


def test_a_formula_that_cannot_be_shown_is_refused() -> None:
    pytest.importorskip("sphinx", reason=WITHOUT_SPHINX)
    from documentation.mathml import mathml
    from sphinx.errors import ExtensionError

    assert "<mfrac>" in mathml(r"\frac{1}{2}")
    with pytest.raises(ExtensionError, match="no MathML"):
        mathml(r"\unknowncommand{x}")
