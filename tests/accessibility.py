"""What axe-core finds on the page that a browser shows: contrast, names of controls, landmarks, order of headings."""

from __future__ import annotations

import os
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest
from browser import REQUIRED

# What a sentence of axe-core contains → why it is no fault.
IGNORED = {
    "ARIA attribute is not allowed: aria-readonly=": "ARIA 1.2 allows it on a combobox; this axe-core knows ARIA 1.1",
    "role combobox is not allowed for given element": "ARIA in HTML allows it on a text input; this axe-core does not",
    'Invalid ARIA attribute value: aria-controls="': "a menu's list exists while it is open; ARIA 1.2 allows that",
}

_RUN = """
const done = arguments[arguments.length - 1];
axe.run(document, {resultTypes: ["violations"]}).then(
  found => done(found.violations.flatMap(each => each.nodes.map(node =>
    `${each.id} (${each.impact}) at ${node.target.join(" ")}: ${node.failureSummary.replace(/\\s+/g, " ")}`))),
  error => done(["axe failed: " + error]));
"""


def violations(driver: Any) -> list[str]:
    """Return a sentence for each element of the shown page that breaks a rule."""
    package = find_spec("axe_selenium_python")
    if package is None or package.origin is None:
        lacking = "the package axe-selenium-python is not installed"
        if os.environ.get(REQUIRED):
            pytest.fail(f"{REQUIRED} is set, but {lacking}")
        pytest.skip(lacking)
    script = Path(package.origin).parent / "node_modules" / "axe-core" / "axe.min.js"
    # It is injected as text: the page requests nothing.
    driver.execute_script(script.read_text(encoding="utf-8"))
    driver.set_script_timeout(60)
    found: list[str] = driver.execute_async_script(_RUN)
    return [each for each in found if not any(text in each for text in IGNORED)]
