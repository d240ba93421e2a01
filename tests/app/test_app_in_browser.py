"""The page in a real browser: from a log to a joint file in few clicks, by keyboard, and for a screen reader."""

from __future__ import annotations

import json
import math
import os
import re
import signal
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from accessibility import violations
from browser import browser, require
from example_recordings import WELL_EXCITED
from served import LARGEST, Served, require_nicegui, served

import jointid as jid

COUNTS, RATIO, CONSTANT = 1_048_576, 100.0, 0.05
pytestmark = pytest.mark.slow
PATIENCE = 60.0  # [s]: a loaded machine
IN_PROC = pytest.mark.skipif(
    not Path("/proc/self/stat").exists(), reason="processes are listed in /proc"
)
LOOKS = [(width, scheme) for width in (390, 1280) for scheme in ("light", "dark")]


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

    def fill(self, name: str, text: str) -> None:
        """Replace what a field holds, and leave it by Tab."""
        from selenium.webdriver import Keys

        self.element(name).send_keys(f"{Keys.CONTROL}a{Keys.NULL}{text}\t")

    def look(self, width: int, scheme: str) -> None:
        """Show the page at a width, in "light" or "dark"."""
        size = {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": False}
        wanted = [{"name": "prefers-color-scheme", "value": scheme}]
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": wanted})
        query = f"(prefers-color-scheme: {scheme})"
        self.wait("Quasar's scheme", lambda: self.driver.execute_script(_SETTLED, query, width))

    def idle(self) -> None:
        """Wait until nothing is computed."""
        self.wait("the end", lambda: not self.driver.find_element("id", "cancel").is_displayed())

    def text(self) -> str:
        """Everything that is shown."""
        shown: str = self.driver.find_element("tag name", "body").text
        return shown


# Whether the page has followed the scheme and the width, and what fades in has done so.
_SETTLED = """
const dark = matchMedia(arguments[0]).matches && arguments[0].includes("dark");
return innerWidth === arguments[1] && document.body.classList.contains("body--dark") === dark
  && document.getAnimations().length === 0
"""


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


@IN_PROC
def test_closing_the_page_ends_its_work(driver: Any, server: Served, log: Path) -> None:
    hand = opened(driver, server, log)
    hand.wait("a reading process", lambda: workers(server.process.pid))
    driver.get("about:blank")
    hand.wait("no process of any page", lambda: not workers(server.process.pid))


def visited(driver: Any, server: Served) -> Hand:
    """The page before anything is loaded."""
    hand = Hand(driver)
    driver.get(server.address)
    hand.element("example")
    return hand


def broken_rules(hand: Hand, state: str) -> list[str]:
    """What is wrong with a state of the page at each width and in each scheme."""
    found = []
    for width, scheme in LOOKS:
        hand.look(width, scheme)
        where = f"{state}, {width} px, {scheme}"
        found += [f"{where}: {each}" for each in violations(hand.driver)]
        wide, cut = hand.driver.execute_script(_FITS)
        found += [f"{where}: {wide} px wide"] * (wide > width)
        found += [f"{where}: {text!r} is cut" for text in cut]
    return found


_FITS = """
const shown = [...document.querySelectorAll(".q-field__native > span, .q-btn, .hint")];
return [document.documentElement.scrollWidth,
        shown.filter(each => each.scrollWidth > each.clientWidth + 1 && each.clientWidth).map(each => each.innerText)]
"""


def test_states_break_no_rule_and_fit(driver: Any, server: Served, log: Path) -> None:
    hand = visited(driver, server)
    found = broken_rules(hand, "empty")
    hand.click("example")
    coulomb = round(jid.identify(*demonstration())["coulomb"].value)
    hand.wait("the example's result", lambda: f"{coulomb} ±" in hand.element("estimate").text)
    hand.idle()
    found += broken_rules(hand, "result")
    hand.click("compare")
    hand.element("comparison")
    hand.idle()
    found += broken_rules(hand, "comparison")
    hand.fill("fact-gear_ratio", "0")
    hand.click("identify")
    hand.wait("a refusal", lambda: "gear ratio is 0" in hand.element("failure").text)
    hand.idle()
    assert "gear_ratio" not in hand.text()
    found += broken_rules(hand, "error")
    hand = opened(driver, server, log)
    hand.element("signals")
    hand.idle()
    found += broken_rules(hand, "loaded")
    assert found == []


def demonstration() -> tuple[jid.Recording, jid.Joint]:
    kuka = jid.demo()
    return kuka.recording, kuka.joint


@IN_PROC
def test_work_shows_its_duration_is_announced_once_and_can_be_cancelled(
    driver: Any, server: Served, tmp_path: Path
) -> None:
    recording, times = jid.load(WELL_EXCITED), 8
    assert recording.torque is not None
    step = float(recording.time[1] - recording.time[0])
    spans = [recording.time + k * (recording.time[-1] + step) for k in range(times)]
    path = tmp_path / "long.npz"
    np.savez_compressed(
        path,
        time_s=np.concatenate(spans),
        position_rad=np.tile(recording.position, times),
        torque_Nm=np.tile(recording.torque, times),
    )
    hand = opened(driver, server, path)
    hand.element("signals")
    hand.idle()
    hand.click("compare")
    shown = hand.element("progress")
    hand.wait("the comparison runs", lambda: shown.text.startswith("comparing"))
    for each in workers(server.process.pid):
        os.kill(each, signal.SIGSTOP)  # it stays as it is
    announced = driver.find_element("id", "status").get_attribute("textContent")
    first = shown.text
    hand.wait("time passes", lambda: shown.text != first and "s of about" in first)
    assert re.match(r"comparing(, fit \d+ of \d+: \S+)?: \d+ s", shown.text)
    assert announced.startswith("comparing")
    assert driver.find_element("id", "status").get_attribute("textContent") == announced
    assert broken_rules(hand, "at work") == []
    hand.click("cancel")
    hand.wait("it is cancelled", lambda: "comparing was cancelled" in hand.text())
    assert not workers(server.process.pid)


def test_a_log_of_the_motor_is_identified_at_the_joint(
    driver: Any, server: Served, tmp_path: Path
) -> None:
    recording = jid.load(WELL_EXCITED)
    assert recording.torque is not None
    rows = ["t_s,motor_position,motor_current_A"]
    for when, position, torque in zip(
        recording.time, recording.position, recording.torque, strict=True
    ):
        rows.append(f"{when:.4f},{RATIO * position:.6f},{torque / RATIO / CONSTANT:.5f}")
    path = tmp_path / "motor.csv"
    path.write_text("\n".join(rows), encoding="utf-8")
    hand = opened(driver, server, path)
    hand.wait("the side", lambda: hand.element("side-position").get_attribute("value") == "motor")
    hand.fill("fact-gear_ratio", f"{RATIO:g}")
    hand.fill("fact-torque_constant", f"{CONSTANT:g}")
    hand.click("identify")
    hand.element("estimate")
    hand.idle()
    target = driver.downloads / "joint.toml"
    target.unlink(missing_ok=True)
    hand.click("export-toml")
    hand.wait("the joint file", target.exists)
    joint = jid.Joint.load(target)
    assert joint.parameters["coulomb"].value == pytest.approx(25.0, rel=0.02)
    assert joint.parameters["viscous"].value == pytest.approx(20.0, rel=0.02)


def test_a_keyboard_reaches_every_control_in_order_and_sees_where_it_is(
    driver: Any, server: Served, log: Path
) -> None:
    from selenium.webdriver import ActionChains, Keys

    hand = opened(driver, server, log)
    hand.element("signals")
    hand.idle()
    driver.execute_script("document.activeElement.blur(); scrollTo(0, 0)")
    reached: list[str] = []
    for _ in range(60):
        ActionChains(driver).send_keys(Keys.TAB).perform()
        name, outlined = driver.execute_script(_FOCUSED)
        if not name:  # the end of the page
            break
        assert outlined, f"nothing shows that {name} has the focus"
        reached.append(name)
    wanted = [
        *("choose", "example", "column-time", "column-position", "unit-position", "side-position"),
        *("fact-gear_ratio", "fact-torque_constant", "model", "stretch-from", "stretch-to"),
        *("identify", "compare"),
    ]
    assert [each for each in reached if each in wanted] == wanted

    driver.execute_cdp_cmd("Page.setInterceptFileChooserDialog", {"enabled": True})
    driver.get_log("performance")
    hand.element("choose").send_keys(Keys.ENTER)
    hand.wait(
        "the dialogue for files",
        lambda: any(
            "fileChooserOpened" in each["message"] for each in driver.get_log("performance")
        ),
    )
    driver.execute_cdp_cmd("Page.setInterceptFileChooserDialog", {"enabled": False})

    hand.fill("stretch-from", "2")
    hand.fill("stretch-to", "3.5")
    hand.wait("a stretch", lambda: hand.element("leave-out").is_enabled())
    hand.element("leave-out").send_keys(Keys.ENTER)
    assert hand.element("left-out").text == "left out: 2.00 to 3.50 s"
    hand.wait("focus", lambda: driver.switch_to.active_element.get_attribute("id") == "keep-all")


_FOCUSED = """
const at = document.activeElement, shows = each => each && getComputedStyle(each).outlineStyle !== "none";
return [at.id, shows(at) || shows(at.closest(".q-field__control"))]
"""


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
