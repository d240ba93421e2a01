"""Each result's page begins with its answer; pictures and tables have the result's numbers; nothing is unescaped."""

import html
import re
import tomllib
import xml.etree.ElementTree as ElementTree
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import report_pages
from designs import designed
from drawn_pictures import Picture
from report_pages import HOSTILE, PAGES, Shown, page

import jointid as jid
from jointid.report.saving import report_page, save_report


def pictures(text: str) -> list[Picture]:
    return [
        Picture(f"<svg {each.partition('</svg>')[0]}</svg>") for each in text.split("<svg ")[1:]
    ]


def top(text: str) -> str:
    """What stands before the first heading of a section."""
    return text[text.index("<h1>") : text.index("<h2")]


@pytest.mark.parametrize("make", PAGES, ids=lambda each: each.__name__)
def test_every_page_is_whole_and_begins_with_its_answer(make: Callable[[], Shown]) -> None:
    text = page(make)
    body = text[text.index("<body>") : text.index("</body>") + 7]
    ElementTree.fromstring(body.replace("<br>", "<br/>"))  # every element is closed
    strips = text.count('class="readout"')
    assert text.count("<title>") == text.count("<svg ") + strips + 1
    assert '<p class="verdict' in top(text)
    assert "<script" not in text
    assert "<img" not in text
    targets = set(re.findall(r'href="#([^"]+)"', text))
    assert targets <= set(re.findall(r'id="([^"]+)"', text))


def test_names_are_escaped_and_kept() -> None:
    kept = HOSTILE.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")
    kept = kept.replace('"', "&quot;").replace("'", "&#x27;")
    for make in (report_pages.of_a_named_comparison, report_pages.of_a_study_of_rows):
        assert kept in page(make)


def test_a_comparison_names_the_winner_and_draws_each_score() -> None:
    found = jid.compare_models(report_pages.good(), jid.thesis_joint(), folds=4)
    text = report_page(found)
    assert f'<p class="verdict usable"><b>Use {found.winner}: usable.</b></p>' in top(text)
    assert found.reason in top(text)
    drawn = pictures(text)[0]
    assert [row.model for row in found.rows] == [
        each for each in drawn.texts if each in {row.model for row in found.rows}
    ]
    axis = drawn.axis("across")
    single = np.array([piece[0, 0] for piece in drawn.points("points")])
    expected = [100.0 * score for row in found.rows for score in row.fold_scores]
    assert axis.value(single) == pytest.approx(expected, abs=0.01)
    others = [100.0 * row.score for row in found.rows if row.model != found.winner]
    strokes = [piece[0, 0] for piece in drawn.points("second", 1)]
    assert axis.value(np.array(strokes)) == pytest.approx(others, abs=0.01)
    assert "Usable." in text.partition(f"Identified with {found.winner}")[2]
    left = replace(found, settings={**found.settings, "left_out": {"stribeck": "it cannot be"}})
    assert "<li>stribeck: it cannot be</li>" in report_page(left)


def test_a_study_says_how_often_the_truth_was_found() -> None:
    study = report_pages.study()
    summary = study.summary()
    text = report_page(study)
    share = np.mean([cell.success or 0.0 for cell in summary.cells])
    said = f"Every parameter is within 5 % of the truth in {100.0 * share:.0f} % of the trials."
    assert f"<b>{said}</b>" in top(text)
    assert "and smallest with windows 50, model coulomb_viscous (0 %)" in top(text)
    lines = pictures(text)[0]
    assert {"model stribeck", "model coulomb_viscous", "largest error [%]"} <= set(lines.texts)
    assert '>search</th><td role="cell">separable, default</td>' in text


def test_a_study_without_a_truth_says_what_moves() -> None:
    study = replace(report_pages.study(), truth={})
    means = [cell.mean["coulomb"] for cell in study.summary().cells]
    moved = (max(means) - min(means)) / max(means)
    assert f"<b>coulomb differs most from cell to cell: by {100.0 * moved:.2g} %" in top(
        report_page(study)
    )
    unfinished = replace(study, rows=study.rows[:-2])
    assert "not finished: 2 trials are missing" in top(report_page(unfinished))
    nothing = replace(study, rows=())
    assert "<b>No trial has finished.</b>" in top(report_page(nothing))
    rows = pictures(page(report_pages.of_a_study_of_rows))[0]
    assert any(each.startswith("penalty") for each in rows.texts)
    assert "1 trial is refused" in page(report_pages.of_a_study_of_rows)


def test_a_study_in_a_notebook_says_what_it_is_and_what_was_refused() -> None:
    study = report_pages.study()
    first = replace(study.rows[0], status="refused", message="it <cannot> be", values={})
    shown = replace(study, rows=(first, *study.rows[1:]))._repr_html_()
    assert "study over windows, model: 8 cells, 24 trials" in shown
    assert "it &lt;cannot&gt; be" in shown


def test_a_design_says_how_well_it_will_identify() -> None:
    design = designed()
    text = report_page(design)
    worst = max(each.worst for each in design.parameters.values())
    said = f"Usable: no parameter&#x27;s expected error is above {100.0 * worst:.2g} %, and all limits are kept."
    assert f'<p class="verdict usable"><b>{said}</b></p>' in top(text)
    motion = pictures(text)[0]
    time = np.linspace(0.0, design.duration, 6001)
    position, _, _ = design.trajectory.sample(time)
    assert {"position [rad]", "velocity [rad/s]", "time [s]", "limit"} <= set(motion.texts)
    line = np.concatenate(motion.points("line"))
    place = motion.axis("across").value(line[:, 0])
    assert place[0] == pytest.approx(0.0, abs=0.02)
    assert place[-1] == pytest.approx(design.duration, abs=0.02)
    highest = place[np.argmin(line[:, 1])]
    assert highest == pytest.approx(time[np.argmax(position)], abs=0.05)
    refused = report_page(designed(status="limits exceeded", reason="no motion keeps them"))
    assert '<p class="verdict not-usable"><b>Not usable: limits exceeded.</b></p>' in top(refused)
    assert "<p>no motion keeps them</p>" in top(refused)


def test_a_design_of_which_nothing_is_known_needs_care() -> None:
    design = designed()
    name = design.weakest
    vague = replace(design.parameters[name], worst=float("inf"))
    text = report_page(replace(design, parameters={**design.parameters, name: vague}))
    assert f"<b>Usable with care: {name} will not be determined.</b>" in top(text)


def test_a_robot_has_a_verdict_and_a_comparison_a_winner() -> None:
    text = page(report_pages.of_a_robot)
    assert '<p class="verdict usable"><b>Usable.</b></p>' in top(text)
    robot, recording = report_pages.arm()
    found = jid.compare_robot_models(recording, robot, folds=3)
    compared = page(report_pages.of_a_robot_comparison)
    assert f"<b>Use {found.winner.name}: usable.</b>" in top(compared)
    assert {row.name for row in found.rows} <= set(pictures(compared)[0].texts)


def test_several_joints_begin_with_their_verdicts() -> None:
    text = page(report_pages.of_several_joints)
    assert "usable with care" in top(text)
    assert top(text).index("usable with care") < text.index("<table")


def test_a_page_is_written_whole(tmp_path: Path) -> None:
    design = designed()
    written = jid.save_report(design, tmp_path / "page.html")
    assert written.read_text(encoding="utf-8") == report_page(design)
    assert jid.save_report is save_report
    with pytest.raises(jid.InputError, match="result is 'dict': this has no report"):
        save_report({}, tmp_path / "page.html")  # type: ignore[arg-type]


def test_a_page_is_no_pdf(tmp_path: Path) -> None:
    design = designed()
    with pytest.raises(
        jid.InputError, match=r"page\.pdf.: the file of a report ends in one of \.html, "
    ):
        save_report(design, tmp_path / "page.pdf")
    assert not list(tmp_path.iterdir())


def test_names_of_own_terms_are_keys_of_toml() -> None:
    estimate = jid.identify(report_pages.good(), jid.thesis_joint())
    named = dict(estimate.parameters)
    named["term[a b]"] = replace(named["coulomb"], name="term[a b]")
    text = report_page(replace(estimate, parameters=named, findings=()))
    code = re.findall("<pre[^>]*>(.*?)</pre>", text, re.DOTALL)[0]
    copied = tomllib.loads(html.unescape(code))
    assert copied["parameters"]["term[a b]"]["value"] == named["coulomb"].value
