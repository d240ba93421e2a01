"""The page of a session is about the session: how it followed, limits, timing, stops, what is next."""

import re
import xml.etree.ElementTree as ElementTree
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from drawn_pictures import Picture

from jointid.cli import main
from jointid.cli.session import STOPPED
from jointid.commissioning import Commissioning, commission
from jointid.hardware.bench.bench import Bench
from jointid.report.saving import report_page, save_report
from jointid.report.sections.limit_margins import margin_rows
from jointid.report.sections.outcome import next_step

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "hardware" / "joint.toml"
BENCH = EXAMPLE.read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def ring() -> Commissioning:
    return commission(Bench.load(EXAMPLE), cycles=1, emulate=True, seed=1)


def pictures(page: str) -> list[Picture]:
    return [Picture(f"{part.split('</svg>')[0]}</svg>") for part in _svg(page)]


def _svg(page: str) -> list[str]:
    return [f"<svg {part}" for part in page.split("<svg ")[1:]]


def test_the_errors_of_the_runs_are_drawn(ring: Commissioning) -> None:
    page = report_page(ring)
    tracking = pictures(page)[0]
    first, last = ring.runs
    for number, run in enumerate((first, last)):
        recording = run.recording
        assert recording.reference is not None
        error = 1e3 * (recording.position - recording.reference)
        # The upper panel's numbers, of the axis that both runs share.
        heights = np.concatenate(tracking.points("line", number))[:, 1]
        upper = [
            (float(text.attrib["y"]) - 45.0, float((text.text or "").replace("−", "-")))
            for text in tracking.root.iter("text")
            if text.attrib.get("class") == "up"
        ][: _ticks(tracking)]
        places, values = zip(*upper, strict=True)
        slope, offset = np.polyfit(places, values, 1)
        assert slope * heights.min() + offset == pytest.approx(error.max(), abs=0.02)
        assert slope * heights.max() + offset == pytest.approx(error.min(), abs=0.02)
    assert f"initial, rms {1e3 * first.tracking_error:.3g} mrad" in tracking.texts
    assert any(text.startswith("true parameters, rms") for text in tracking.texts)


def _ticks(picture: Picture) -> int:
    """How many numbers stand at the first panel's axis: they come before the second title."""
    titles = [
        n for n, each in enumerate(picture.root) if (each.text or "") == "tracking error [mrad]"
    ]
    inside = list(picture.root)[titles[0] : titles[1]]
    return sum(each.attrib.get("class") == "up" for each in inside)


def test_the_page_says_what_a_session_is_asked(ring: Commissioning) -> None:
    page = report_page(ring)
    assert "An emulated joint on an emulated drive: no hardware moved." in page
    assert f"The tracking error fell by a factor of {ring.improvement:.1f}" in page
    for name in ("tracking", "limits", "timing", "drive", "identified", "of-1-friction-map"):
        assert f'id="{name}"' in page
    assert "No run was stopped by a limit." in page
    assert "The drive confirmed that the motor is off." in page
    assert "195911405" in page
    assert "http" not in page
    assert "<img" not in page
    body = page[page.index("<body>") : page.index("</body>") + 7]
    ElementTree.fromstring(body.replace("<br>", "<br/>"))  # every element is closed


def test_margins_are_shares_of_the_limits(ring: Commissioning) -> None:
    recording = ring.runs[0].recording
    rows = {row[0]: row[1:] for row in margin_rows([recording])[1:]}
    assert set(rows) == {"position", "velocity", "torque", "torque rate", "tracking error"}
    assert recording.velocity is not None
    peak = float(np.abs(recording.velocity).max())
    assert rows["velocity"] == [f"{peak:.4g} rad/s", "4 rad/s", f"{25.0 * peak:.0f} %"]
    low, high = float(recording.position.min()), float(recording.position.max())
    assert rows["position"][2] == f"{100.0 * max(-low, high) / 1.4:.0f} %"


def test_the_next_step_follows_from_the_outcome(ring: Commissioning) -> None:
    (found,) = ring.estimates[-1].warnings
    assert next_step(ring, lambda action: f"<{action.kind}>") == (
        f"Next: <{found.advice[0].kind}> (finding {found.code})."
    )
    assert f"Next: {found.advice[0]}" in report_page(ring)
    plain = replace(ring.estimates[-1], findings=())
    said = next_step(replace(ring, estimates=(plain,)))
    assert said == "Next: save these values to the joint file; no finding advises against this."
    worse = replace(ring, runs=ring.runs[::-1])
    assert "do not use these values" in next_step(worse)
    only = replace(ring, runs=ring.runs[:1], estimates=())
    assert "identify the joint" in next_step(only)
    assert 'id="timing"' in report_page(only)
    assert 'id="identified"' not in report_page(only)


def test_it_is_written_whole(ring: Commissioning, tmp_path: Path) -> None:
    path = save_report(ring, tmp_path / "session.html")
    assert path.read_text(encoding="utf-8") == report_page(ring)


def test_a_stopped_session_has_a_page_that_says_why(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text, limited = re.subn(r"(?m)^tracking_error = .*$", "tracking_error = 0.002", BENCH)
    assert limited == 1
    bench = tmp_path / "joint.toml"
    bench.write_text(text, encoding="utf-8")
    folder = tmp_path / "runs"
    assert main(["run", str(bench), "--emulate", "--quiet", "--output", str(folder)]) == STOPPED
    written = folder / "report.html"
    assert f"report: {written}" in capsys.readouterr().err
    page = written.read_text(encoding="utf-8")
    top = page[: page.index("<h2")]
    assert '<p class="verdict not-usable"><b>initial: stopped by tracking_error after' in top
    assert "Next: before the joint moves again, find out why the limit was reached" in top
    assert "The drive confirmed that the motor is off." in page
    limits = page.partition('id="limits"')[2].partition("</table>")[0]
    cells = re.findall(r"<td[^>]*>(.*?)</td>", limits.partition(">tracking error</th>")[2])
    assert cells[:3] == ["0.002006 rad", "0.002 rad", "100 %"]
    assert 'id="timing"' in page
