"""The page of an estimate: sections, pictures inside, and findings that link to the picture that shows them."""

import html
import re
import tomllib
from pathlib import Path

import pytest
from example_recordings import WELL_EXCITED

import jointid as jid
from jointid.cli.demonstration import data_folder
from jointid.identification.warnings.registry import finding_types
from jointid.report.saving import report_page, save_report


def code(page: str) -> list[str]:
    """What a page offers to copy."""
    return [html.unescape(each) for each in re.findall("<pre[^>]*>(.*?)</pre>", page, re.DOTALL)]


@pytest.fixture(scope="module")
def robot() -> jid.Estimate:
    recording = jid.load(data_folder() / "kr300_joint1.csv.gz")
    joint = jid.Joint.load(data_folder() / "kr300_joint1.toml")
    return jid.identify(recording, joint)


def test_every_picture_named_by_a_check_is_in_the_page() -> None:
    page = report_page(jid.identify(jid.load(WELL_EXCITED), jid.thesis_joint(), search="ga"))
    pictures = {each.picture for each in finding_types().values() if each.picture}
    assert pictures == {"windows", "friction-map", "convergence"}
    for name in pictures:
        assert f' id="{name}">' in page
    assert page.count("<svg ") == len(pictures) + 1  # the residual over velocity


def test_a_reason_has_its_advice_and_its_picture(robot: jid.Estimate) -> None:
    page = report_page(robot, lambda action: f"<{action.kind}>")
    reason = page[: page.index('id="parameters"')]
    assert "<b> do: </b>&lt;record&gt;." in reason
    assert '<a href="#findings">All findings</a>' in reason
    findings = page.partition('id="findings"')[2]
    assert '<a href="#windows">picture</a>' in findings


def test_values_are_written_as_exactly_as_they_are_known(robot: jid.Estimate) -> None:
    page = report_page(robot)
    assert robot["inertia"].value == pytest.approx(2027.5, abs=0.1)
    cell = '<td role="cell" data-label="value ± std. error">2030 ± 160 kg·m²</td>'
    assert f'<th scope="row" role="rowheader">inertia</th>{cell}' in page
    copied = tomllib.loads(code(page)[0])["parameters"]
    values = {name: p.value for name, p in robot.parameters.items()}
    assert {name: each["value"] for name, each in copied.items()} == values


def test_the_page_says_what_was_recorded(robot: jid.Estimate) -> None:
    section = report_page(robot).partition('id="recording"')[2].partition("</details>")[0]
    run = robot.settings["recordings"][0]
    assert f"kr300_joint1 ({run['fingerprint']})" in section
    assert '>samples</th><td role="cell">2501</td>' in section
    low, high = robot.windows.velocity.min(), robot.windows.velocity.max()
    assert f"{low:.3g} to {high:.3g} rad/s" in section


def test_a_finding_links_to_its_picture(robot: jid.Estimate) -> None:
    assert {"inertia_varies"} <= {found.code for found in robot.findings}
    page = report_page(robot)
    assert re.search(
        r'<li class="warning"><b>warning:</b> inertia that varies[^<]*\(inertia_varies\)', page
    )
    assert '<a href="#windows">picture</a>' in page


def test_no_link_leads_to_a_picture_that_is_not_there() -> None:
    recording = jid.load(WELL_EXCITED)
    rough = jid.GaOptions(population=20, generations=3, polish=False)
    stopped = jid.identify(recording, jid.thesis_joint(), search=jid.Search(ga=rough))
    assert "stopped" in {found.code for found in stopped.findings}
    assert 'href="#convergence"' in report_page(stopped)
    plain = jid.identify(recording, jid.thesis_joint())
    page = report_page(plain)
    assert "convergence" not in page.lower()
    assert "<p>No warnings.</p>" in page


def test_another_interface_words_the_advice(robot: jid.Estimate) -> None:
    page = report_page(robot, lambda action: f"<{action.kind}>")
    assert "<b>do: </b>&lt;record&gt;; or &lt;inspect&gt;" in page


def test_the_page_is_written_whole(robot: jid.Estimate, tmp_path: Path) -> None:
    path = save_report(robot, tmp_path / "page.html")
    text = path.read_text(encoding="utf-8")
    assert text == report_page(robot)
    assert text.startswith("<!doctype html>")
    assert text.endswith("</body></html>")
