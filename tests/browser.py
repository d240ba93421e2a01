"""A Chromium without a window that shows pages: Debian's chromium and chromium-driver, by selenium."""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest

REQUIRED = "JOINTID_REQUIRE_BROWSER"
"""Environment variable that makes a missing browser a failure; otherwise the tests are skipped."""

PROGRAMS = ("chromium", "chromedriver")

_SEEN = """
const root = document.documentElement, mine = getComputedStyle(document.body);
const texts = [...document.querySelectorAll("svg text")].map(each => each.getBoundingClientRect());
const strokes = [...document.querySelectorAll("svg .line, svg .points, svg .dashed, svg .band")];
const fills = [...document.querySelectorAll("svg .bars")];
const words = [...document.querySelectorAll("h1, h2, p, li, td, th, a, b, figcaption, footer")];
return {
  width: innerWidth, room: root.clientWidth, wide: root.scrollWidth,
  outside: texts.filter(box => box.left < 0 || box.right > root.clientWidth).map(box => [box.left, box.right]),
  smallest: Math.min(...texts.map(box => box.height)),
  ground: mine.backgroundColor,
  curves: [...new Set([...strokes.map(each => getComputedStyle(each).stroke),
                       ...fills.map(each => getComputedStyle(each).fill)])],
  words: [...new Set(words.map(each => getComputedStyle(each).color))],
  active: document.querySelectorAll("script, img, iframe, object, embed, link, form, [onload], [onerror]").length,
  title: document.title,
}
"""


def missing() -> str:
    """Return what this machine lacks; empty when a browser can be started."""
    for program in PROGRAMS:
        if shutil.which(program) is None:
            return f"{program} is not installed: apt-get install chromium chromium-driver"
    if find_spec("selenium") is None:
        return "the package selenium is not installed"
    return ""


class Browser:
    """One browser for all pages; a page is opened anew for each width and colour scheme.

    Parameters
    ----------
    driver : selenium.webdriver.Chrome
    folder : Path
        For the pages.
    """

    def __init__(self, driver: Any, folder: Path) -> None:
        self._driver = driver
        self._folder = folder

    @property
    def driver(self) -> Any:
        """Selenium's driver, for pages that are used and not only looked at."""
        return self._driver

    def open(self, page: str, width: int, scheme: str, height: int = 900) -> list[str]:
        """Show a page at a width, in "light" or "dark"; returns what it requested, itself first."""
        path = self._folder / "page.html"
        path.write_text(page, encoding="utf-8")
        size = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
        wanted = [{"name": "prefers-color-scheme", "value": scheme}]
        self._driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
        self._driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": wanted})
        self._driver.get_log("performance")  # what came before this page
        self._driver.get(path.as_uri())
        told = [
            json.loads(each["message"])["message"] for each in self._driver.get_log("performance")
        ]
        return [
            each["params"]["request"]["url"].rpartition("/")[2]
            for each in told
            if each["method"] == "Network.requestWillBeSent"
        ]

    def seen(self) -> dict[str, Any]:
        """What the page that is shown says of itself."""
        found: dict[str, Any] = self._driver.execute_script(_SEEN)
        return found

    def picture(self, path: Path) -> None:
        """Write what is shown as a .png file."""
        self._driver.save_screenshot(str(path))


@contextmanager
def browser(folder: Path) -> Iterator[Browser]:
    """Start a browser, and end it."""
    from selenium.webdriver import Chrome, ChromeOptions
    from selenium.webdriver.chrome.service import Service

    options = ChromeOptions()
    options.binary_location = shutil.which(PROGRAMS[0]) or ""
    for argument in (
        *("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage"),
        *("--hide-scrollbars", f"--user-data-dir={folder / 'profile'}"),
    ):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"performance": "ALL"})
    log = (folder / "chromedriver.log").open("wb")
    # By its path: without one, selenium looks for a driver on the network.
    service = Service(executable_path=shutil.which(PROGRAMS[1]), log_output=log)
    with log:
        driver = Chrome(options=options, service=service)
        try:
            yield Browser(driver, folder)
        finally:
            driver.quit()


def require() -> None:
    """Skip the test on a machine without a browser, or fail where one is required."""
    lacking = missing()
    if lacking and os.environ.get(REQUIRED):
        pytest.fail(f"{REQUIRED} is set, but {lacking}")
    if lacking:
        pytest.skip(lacking)
