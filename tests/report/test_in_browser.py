"""Pages in a real browser, at the widths of a phone, a tablet and a desk, on a light and a dark ground."""

import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from accessibility import violations
from browser import REQUIRED, Browser, browser, require
from report_pages import PAGES, Shown, of_a_joint, page
from test_palette import LEAST, TEXT, contrast

pytestmark = pytest.mark.slow
WIDTHS = (390, 800, 1200)
SMALLEST = 9.0  # pixels of a text's line on a screen: about 8 px of type


@pytest.fixture(scope="module")
def shown(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    require()
    with browser(tmp_path_factory.mktemp("browser")) as each:
        yield each


def colour(text: str) -> str:
    """A colour of a computed style as in the palette."""
    return "#" + "".join(f"{int(part):02x}" for part in re.findall(r"\d+", text)[:3])


def faults(seen: dict[str, Any], width: int, scheme: str) -> list[str]:
    """What is wrong with a page that was looked at."""
    ground = colour(seen["ground"])
    found = []
    if seen["width"] != width or (ground == "#ffffff") != (scheme == "light"):
        found.append(f"shown {seen['width']} px wide on {ground}")
    if seen["wide"] > seen["room"]:
        found.append(f"{seen['wide']} px wide, {seen['room']} px of room")
    if seen["outside"]:
        found.append(f"texts outside at {seen['outside']}")
    if seen["smallest"] is not None and seen["smallest"] < SMALLEST:  # None: no picture
        found.append(f"a text of {seen['smallest']} px")
    if seen["active"]:
        found.append(f"{seen['active']} elements that run or load something")
    found += [
        f"{what} {each} on {ground}"
        for what, least in (("curves", LEAST), ("words", TEXT))
        for each in seen[what]
        if contrast(colour(each), ground) < least
    ]
    return found


@pytest.mark.parametrize("make", PAGES, ids=lambda each: each.__name__)
def test_a_page_fits_stands_out_and_asks_for_nothing(
    shown: Browser, make: Callable[[], Shown]
) -> None:
    found = []
    for scheme in ("light", "dark"):
        for width in WIDTHS:
            requests = shown.open(page(make), width, scheme)
            seen = shown.seen()
            assert bool(seen["curves"]) == ("<svg " in page(make))
            assert seen["title"] != "run"  # nothing that a page is given runs
            assert requests == ["page.html"]
            found += [f"{width} {scheme}: {each}" for each in faults(seen, width, scheme)]
    assert found == []


_UNFOLD = "document.querySelectorAll('details').forEach(each => { each.open = true })"


def broken_rules(shown: Browser, markup: str, width: int, scheme: str) -> list[str]:
    """What axe-core finds on a page, with all of its parts unfolded."""
    shown.open(markup, width, scheme)
    shown.driver.execute_script(_UNFOLD)
    return [f"{width} {scheme}: {each}" for each in violations(shown.driver)]


@pytest.mark.parametrize("make", PAGES, ids=lambda each: each.__name__)
def test_a_page_breaks_no_rule_of_accessibility(shown: Browser, make: Callable[[], Shown]) -> None:
    markup = page(make)
    assert [
        each
        for width in (390, 1280)
        for scheme in ("light", "dark")
        for each in broken_rules(shown, markup, width, scheme)
    ] == []


@pytest.mark.parametrize(
    ("defect", "rule"),
    [
        (("p.verdict {", "p.verdict b { color: #ccc } p.verdict {"), "color-contrast"),
        (("</h1>", "</h1><button></button>"), "button-name"),
        (("<main>", "<div>"), "landmark-one-main"),
        (("</h1>", "</h1><h5>Deep</h5>"), "heading-order"),
        (("</main>", "<input></main>"), "label"),
    ],
)
def test_a_broken_rule_would_be_seen(shown: Browser, defect: tuple[str, str], rule: str) -> None:
    assert defect[0] in page(of_a_joint)
    found = broken_rules(shown, page(of_a_joint).replace(*defect), 390, "light")
    assert any(each.startswith(f"390 light: {rule} (") for each in found)


@pytest.mark.parametrize(
    ("defect", "said"),
    [
        (("<h1>", "<h1 style='width:2000px'>"), "px of room"),
        (("svg .fitted { stroke: var(--fitted)", "svg .fitted { stroke: #eeeeee"), "curves"),
        (("p.verdict {", "p.verdict b { color: #ccc } p.verdict {"), "words"),
        (("svg text { font-size: 170px", "svg text { font-size: 10px"), "a text of"),
        (("</body>", "<script>1</script></body>"), "elements that run"),
    ],
)
def test_a_fault_would_be_seen(shown: Browser, defect: tuple[str, str], said: str) -> None:
    assert defect[0] in page(of_a_joint)
    shown.open(page(of_a_joint).replace(*defect), 390, "light")
    assert any(said in each for each in faults(shown.seen(), 390, "light"))


def test_a_request_would_be_seen(shown: Browser) -> None:
    broken = page(of_a_joint).replace("<h1>", "<img src='other.png'><h1>")
    assert shown.open(broken, 800, "dark") == ["page.html", "other.png"]


def test_a_missing_browser_is_a_failure_only_where_it_is_required(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv(REQUIRED, raising=False)
    with pytest.raises(pytest.skip.Exception, match="apt-get install chromium chromium-driver"):
        require()
    monkeypatch.setenv(REQUIRED, "1")
    with pytest.raises(pytest.fail.Exception, match=f"{REQUIRED} is set, but chromium is not"):
        require()
