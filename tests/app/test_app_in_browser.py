"""The page in a real browser: from a log in counts and milliamperes to a joint file, in few clicks."""

from __future__ import annotations

import json
import math
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from browser import browser, require
from example_recordings import WELL_EXCITED
from served import LARGEST, Served, require_nicegui, served

import jointid as jid

COUNTS, RATIO, CONSTANT = 1_048_576, 100.0, 0.05
pytestmark = pytest.mark.slow
PATIENCE = 60.0  # [s]: a loaded machine


class Hand:
    """What a person does with a page; counts the clicks."""

    def __init__(self, driver: Any) -> None:
        self.driver = driver
        self.clicks = 0

    def wait(self, what: str, until: Callable[[], Any]) -> Any:
        """Wait until something is true."""
        from selenium.common.exceptions import WebDriverException

        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            try:
                found = until()
            except WebDriverException:  # it was drawn anew in between
                found = None
            if found:
                return found
            time.sleep(0.05)
        pytest.fail(f"not seen within {PATIENCE:.0f} s: {what}")

    def element(self, name: str) -> Any:
        """The element with an id, once it is there."""
        return self.wait(name, lambda: self.driver.find_element("id", name))

    def click(self, name: str) -> None:
        """Click on an element that can be clicked."""

        def clicked() -> bool:
            element = self.driver.find_element("id", name)
            self.driver.execute_script("arguments[0].scrollIntoView({block: 'center'})", element)
            if not element.is_enabled() or element.get_attribute("disabled"):
                return False
            element.click()
            return True

        self.wait(f"{name} can be clicked", clicked)
        self.clicks += 1

    def choose(self, name: str, option: str) -> None:
        """Choose an option of a menu: two clicks."""
        found = f"//div[contains(@class, 'q-menu')]//*[normalize-space(text())='{option}']"
        field = f"//*[@id='{name}']/ancestor-or-self::label[contains(@class, 'q-field')]"

        def opened() -> bool:
            element = self.driver.find_element("xpath", field)
            self.driver.execute_script("arguments[0].scrollIntoView({block: 'center'})", element)
            element.click()
            return True

        self.wait(name, opened)
        self.wait(option, lambda: self.driver.find_element("xpath", found).click() or True)
        self.clicks += 2

    def text(self) -> str:
        """Everything that is shown."""
        shown: str = self.driver.find_element("tag name", "body").text
        return shown


@pytest.fixture(scope="module")
def server() -> Iterator[Served]:
    require()
    require_nicegui()
    with served() as running:
        yield running


@pytest.fixture(scope="module")
def driver(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    require()
    folder = tmp_path_factory.mktemp("browser")
    with browser(folder) as one:
        size = {"width": 1200, "height": 1000, "deviceScaleFactor": 1, "mobile": False}
        one.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
        behaviour = {"behavior": "allow", "downloadPath": str(folder)}
        one.driver.execute_cdp_cmd("Browser.setDownloadBehavior", behaviour)
        one.driver.downloads = folder
        yield one.driver


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A recording as a drive's tool writes it: encoder counts and milliamperes, units nowhere."""
    recording = jid.load(WELL_EXCITED)
    assert recording.torque is not None
    path = tmp_path_factory.mktemp("log") / "drive.csv"
    rows = ["time,position,motor_current"]
    for when, position, torque in zip(
        recording.time, recording.position, recording.torque, strict=True
    ):
        counts = round(position / (2.0 * math.pi) * COUNTS)
        rows.append(f"{when:.4f},{counts},{1e3 * torque / RATIO / CONSTANT:.2f}")
    path.write_text("\n".join(rows), encoding="utf-8")
    return path


def opened(driver: Any, server: Served, path: Path) -> Hand:
    hand = Hand(driver)
    driver.get(server.address)
    hand.wait("the page", lambda: driver.find_element("css selector", "input[type=file]"))
    driver.find_element("css selector", "input[type=file]").send_keys(str(path))
    hand.clicks += 1
    return hand


def test_from_counts_and_milliamperes_to_a_joint_file(
    driver: Any, server: Served, log: Path
) -> None:
    driver.get_log("performance")
    hand = opened(driver, server, log)
    assert "turns" in hand.wait("a range", lambda: hand.element("seen-position").text)
    hand.choose("unit-position", "counts")
    hand.element("counts").send_keys(f"{COUNTS}\t")
    hand.choose("unit-current", "mA")
    hand.wait("milliamperes", lambda: "-19." in hand.element("seen-current").text)
    hand.click("fact-gear_ratio")  # the next field is one Tab away
    driver.switch_to.active_element.send_keys(f"{RATIO:.0f}\t")
    driver.switch_to.active_element.send_keys(f"{CONSTANT}\t")
    hand.click("identify")
    hand.wait("an estimate", lambda: "coulomb" in hand.element("estimate").text)
    hand.click("compare")
    hand.wait("a comparison", lambda: "stribeck" in hand.element("comparison").text)

    chart = hand.element("signals")
    driver.execute_script("arguments[0].scrollIntoView({block: 'center'})", chart)
    from selenium.webdriver import ActionChains

    time.sleep(0.5)  # the page scrolls
    actions = ActionChains(driver).move_to_element_with_offset(chart, -200, 0)
    actions.click_and_hold().move_by_offset(60, 0).move_by_offset(60, 0).release().perform()
    hand.clicks += 1
    hand.click("leave-out")
    left = hand.element("left-out").text
    hand.click("identify")
    hand.wait("the second estimate", lambda: "coulomb" in hand.element("estimate").text)
    hand.wait("the end of it", lambda: not hand.driver.find_element("id", "cancel").is_displayed())
    hand.click("export-toml")
    target = driver.downloads / "joint.toml"
    hand.wait("the joint file", target.exists)
    joint = jid.Joint.load(target)

    assert hand.clicks <= 12
    assert left.startswith("left out: ")
    assert joint.parameters["coulomb"].value == pytest.approx(25.0, rel=0.02)
    assert joint.parameters["viscous"].value == pytest.approx(20.0, rel=0.02)
    told = [json.loads(each["message"])["message"] for each in driver.get_log("performance")]
    asked = [
        each["params"]["request"]["url"]
        for each in told
        if each["method"] == "Network.requestWillBeSent"
    ]
    here = (f"http://127.0.0.1:{server.port}/", "data:", "blob:")
    assert [url for url in asked if not url.startswith(here)] == []


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        ("log.exe", b"MZ", "a file name that ends in .csv"),
        ("log.npz", b"PK\x03\x04 no archive", "log.npz"),
        ("<img src=x onerror=alert(1)>.csv", b"a,b\n<script>alert(1)</script>,2\n", "no column"),
    ],
)
def test_a_file_that_is_none_is_refused_in_a_sentence(
    driver: Any, server: Served, tmp_path: Path, name: str, content: bytes, said: str
) -> None:
    path = tmp_path / name
    path.write_bytes(content)
    hand = opened(driver, server, path)
    assert hand.wait(said, lambda: said in hand.text())
    assert driver.find_elements("css selector", "img[src=x]") == []


def test_too_large_a_file_is_refused(driver: Any, server: Served, tmp_path: Path) -> None:
    path = tmp_path / "long.csv"
    path.write_bytes(b"t,q\n" + b"0,0\n" * (LARGEST // 4))
    hand = opened(driver, server, path)
    hand.wait("a refusal", lambda: "one file of at most 3 MB is accepted" in hand.text())


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="processes are listed in /proc")
def test_closing_the_page_ends_its_work(driver: Any, server: Served, log: Path) -> None:
    hand = opened(driver, server, log)
    hand.wait("a reading process", lambda: workers(server.process.pid))
    driver.get("about:blank")
    hand.wait("no process of any page", lambda: not workers(server.process.pid))


def workers(parent: int) -> list[int]:
    """The living processes that a server started to compute."""
    found = []
    for each in Path("/proc").glob("[0-9]*"):
        try:
            state, of = (each / "stat").read_text().rpartition(")")[2].split()[:2]
            command = (each / "cmdline").read_bytes()
        except OSError:  # it has just ended
            continue
        if int(of) == parent and state != "Z" and b"spawn_main" in command:
            found.append(int(each.name))
    return found
