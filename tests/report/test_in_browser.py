"""Pages in a real browser, at the widths of a phone, a tablet and a desk, on a light and a dark ground.

Debian's chromium (`apt install chromium`) or another Chromium; without one these tests are skipped.
"""

import html
import json
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest
from test_palette import LEAST, contrast

import jointid as jid
from jointid.cli.demo import data_folder
from jointid.report.html import html_report

BROWSER = next(filter(None, map(shutil.which, ("chromium", "chromium-browser"))), None)
WIDTHS = (390, 800, 1200)
SMALLEST = 9.0  # pixels of a text's line on a screen: about 8 px of type
PROBE = """<script>addEventListener("load", () => {
const seen = [...document.querySelectorAll("svg text")].map(each => each.getBoundingClientRect());
const curves = [...document.querySelectorAll("svg .line, svg .points, svg .dashed, svg .band")];
const root = document.documentElement;
parent.postMessage({width: innerWidth, room: root.clientWidth, wide: root.scrollWidth,
 outside: seen.filter(box => box.left < 0 || box.right > innerWidth).length,
 smallest: Math.min(...seen.map(box => box.height)), ground: getComputedStyle(document.body).backgroundColor,
 curves: [...new Set(curves.map(each => getComputedStyle(each).stroke))],
 fetched: performance.getEntriesByType("resource").length}, "*") })</script>"""
FRAME = """<body><script>const all = []; addEventListener("message", told => { all.push(told.data);
document.title = JSON.stringify(all) })</script>"""

pytestmark = pytest.mark.skipif(BROWSER is None, reason="no chromium is installed")


@pytest.fixture(scope="module")
def page() -> str:
    joint = jid.Joint.load(data_folder() / "kr300_joint1.toml")
    return html_report(jid.identify(jid.load(data_folder() / "kr300_joint1.csv.gz"), joint))


def told(folder: Path, page: str, scheme: str) -> list[dict[str, Any]]:
    """What a page says of itself in frames of each width."""
    (folder / "page.html").write_text(page.replace("</body>", f"{PROBE}</body>"), encoding="utf-8")
    frames = "".join(
        f'<iframe src="page.html" style="width:{width}px;height:900px;border:0"></iframe>'
        for width in WIDTHS
    )
    (folder / "frames.html").write_text(f"{FRAME}{frames}</body>", encoding="utf-8")
    assert BROWSER is not None
    command = [
        *(BROWSER, "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage"),
        *(f"--user-data-dir={folder / 'profile'}", "--virtual-time-budget=5000", "--dump-dom"),
        f"--blink-settings=preferredColorScheme={int(scheme == 'light')}",
        (folder / "frames.html").as_uri(),
    ]
    done = subprocess.run(command, capture_output=True, text=True, check=True, timeout=120)
    (title,) = re.findall("<title>(.*?)</title>", done.stdout)
    found: list[dict[str, Any]] = json.loads(html.unescape(title))
    return sorted(found, key=lambda each: int(each["width"]))


def colour(text: str) -> str:
    """A colour of a computed style as in the palette."""
    return "#" + "".join(f"{int(part):02x}" for part in re.findall(r"\d+", text)[:3])


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_a_page_fits_and_its_curves_stand_out(page: str, scheme: str, tmp_path: Path) -> None:
    found = told(tmp_path, page, scheme)
    assert [each["width"] for each in found] == [*WIDTHS]
    for each in found:
        assert each["wide"] <= each["room"]
        assert each["outside"] == 0
        assert each["smallest"] >= SMALLEST
        assert each["fetched"] == 0
        ground = colour(each["ground"])
        assert (ground == "#ffffff") == (scheme == "light")
        assert len(each["curves"]) >= 3
        assert all(contrast(colour(curve), ground) >= LEAST for curve in each["curves"])


def test_what_is_too_wide_would_be_seen(page: str, tmp_path: Path) -> None:
    broken = page.replace("<h1>", "<h1 style='width:2000px'>")
    assert all(each["wide"] > each["room"] for each in told(tmp_path, broken, "light"))
