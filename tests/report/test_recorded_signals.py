"""The recordings in the page of an estimate: their signals, what was left out, the residual over the position."""

import ast
import re
from pathlib import Path

import defects
import numpy as np
import pytest
import report_pages
from drawn_pictures import Picture, corners

import jointid as jid
from jointid.panels.recorded import left_out
from jointid.report.saving import report_page, save_report
from jointid.report.sections.values_to_copy import program


@pytest.fixture(scope="module")
def pieces() -> list[jid.Recording]:
    whole = report_pages.good()
    return [whole[:5.0], whole[6.0:]]


@pytest.fixture(scope="module")
def estimate(pieces: list[jid.Recording]) -> jid.Estimate:
    return jid.identify(pieces, jid.thesis_joint())


def test_what_no_window_uses_is_left_out(
    pieces: list[jid.Recording], estimate: jid.Estimate
) -> None:
    shares = []
    for number, piece in enumerate(pieces):
        begins, ends = left_out(estimate.windows, number, piece.time)
        assert (begins < ends).all()
        assert (ends[:-1] <= begins[1:]).all()
        assert begins.min() >= piece.time[0]
        assert ends.max() <= piece.time[-1]
        same = estimate.windows.recording == number
        middle = 0.5 * (estimate.windows.start + estimate.windows.stop)[same]
        used = estimate.windows.duration[same] >= 0.5 * np.ptp(
            np.array([estimate.windows.start[same], estimate.windows.stop[same]]), axis=0
        )
        for begin, end in zip(begins, ends, strict=True):
            assert not (used & (middle > begin) & (middle < end)).any()
        shares.append((ends - begins).sum() / piece.duration)
    assert np.mean(shares) == pytest.approx(estimate.residuals.left_out, abs=0.03)


def test_each_signal_of_each_recording_is_drawn_as_recorded(
    pieces: list[jid.Recording], estimate: jid.Estimate
) -> None:
    page = report_page(estimate, recordings=pieces)
    section = page.partition('id="signals"')[2].partition("</details>")[0]
    drawn = [
        Picture(f"<svg {each.partition('</svg>')[0]}</svg>") for each in section.split("<svg ")[1:]
    ]
    assert len(drawn) == len(pieces) + 1  # the residual over the position
    for piece, seen in zip(pieces, drawn, strict=False):
        for name in ("position [rad]", "velocity [rad/s]", "torque [N·m]", "sensor [raw]"):
            assert name in seen.texts
        axis = seen.axis("across")
        line = seen.points("line")[0]
        assert axis.value(line[[0, -1], 0]) == pytest.approx(piece.time[[0, -1]], abs=0.02)
        shades = corners(seen.path("shade"))
        assert shades
        assert all(len(each) >= 4 for each in shades)
    assert "left out" in drawn[0].texts


def test_a_page_without_them_has_no_such_section(estimate: jid.Estimate) -> None:
    page = report_page(estimate)
    assert 'id="signals"' not in page


def test_others_are_refused(
    pieces: list[jid.Recording], estimate: jid.Estimate, tmp_path: Path
) -> None:
    with pytest.raises(jid.InputError, match="the estimate was made from"):
        save_report(estimate, tmp_path / "page.html", recordings=pieces[::-1])
    assert not (tmp_path / "page.html").exists()
    with pytest.raises(jid.InputError, match="only the report of one joint's estimate"):
        report_page(report_pages.study(), recordings=pieces)


def test_the_copied_program_finds_the_same_values(
    pieces: list[jid.Recording], estimate: jid.Estimate
) -> None:
    joint = jid.thesis_joint()
    for found, names in (
        (estimate, {"recordings": pieces, "joint": joint}),
        (jid.identify(pieces[0]), {"recording": pieces[0], "joint": None}),
        (
            jid.identify(
                pieces[0], joint, search=jid.Search(ga=jid.GaOptions(generations=30), seed=3)
            ),
            {"recording": pieces[0], "joint": joint},
        ),
    ):
        page = report_page(found)
        program = re.findall("<pre[^>]*>(.*?)</pre>", page, re.DOTALL)[-1]
        program = program.replace("&#x27;", "'").replace("&lt;", "<")
        scope: dict[str, object] = dict(names)
        exec(program, scope)
        again = scope["estimate"]
        assert isinstance(again, jid.Estimate)
        for name, parameter in found.parameters.items():
            assert again[name].value == pytest.approx(parameter.value, rel=1e-9)
        assert again.settings["seed"] == found.settings["seed"]
        assert again.settings["ga"] == found.settings["ga"]


def test_no_name_becomes_a_line_of_the_program() -> None:
    named = defects.changed(report_pages.good(), name="x\nimport os\n# y")
    lines = program(jid.identify(named, jid.thesis_joint())).splitlines()
    assert [line for line in lines if line.startswith("import")] == ["import jointid as jid"]
    assert len(ast.parse("\n".join(lines)).body) == 2


def test_values_are_a_table_for_spreadsheets(estimate: jid.Estimate) -> None:
    page = report_page(estimate)
    table = re.findall("<pre[^>]*>(.*?)</pre>", page, re.DOTALL)[-2].splitlines()
    assert table[0] == "name,value,stderr,lower,upper,unit"
    rows = {line.split(",")[0]: line.split(",")[1:] for line in table[1:]}
    assert set(rows) == set(estimate.parameters)
    for name, parameter in estimate.parameters.items():
        assert float(rows[name][0]) == parameter.value
        shown = tuple(float(each) for each in rows[name][2:4] if each)
        assert shown == (parameter.interval or ())
    assert any(parameter.interval for parameter in estimate.parameters.values())
