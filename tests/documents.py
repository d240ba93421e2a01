"""Reading the project's documents, and running what stands in them."""

import re
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[1]


def read(name: str) -> str:
    """The text of a document, named from the repository's root."""
    return (ROOT / name).read_text(encoding="utf-8")


def blocks(text: str, language: str) -> list[str]:
    """The fenced blocks of one language, in order."""
    return re.findall(rf"^```{language}\n(.*?)^```", text, re.DOTALL | re.MULTILINE)


def enter(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Make an empty folder look like the repository to a reader's code, which may write there."""
    (folder / "examples").symlink_to(ROOT / "examples")
    monkeypatch.chdir(folder)


def run_python_blocks(text: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """Run a document's Python blocks one after the other in one namespace, and return it."""
    pyplot = pytest.importorskip("matplotlib.pyplot")
    enter(folder, monkeypatch)
    found = blocks(text, "python")
    names: dict[str, Any] = {}
    assert found
    try:
        for block in found:
            exec(compile(block, "document", "exec"), names)
    finally:
        pyplot.close("all")
    return names
