"""Every notebook runs from top to bottom, and is committed with what it showed."""

from pathlib import Path
from typing import Any

import matplotlib
import nbformat
import pytest

matplotlib.use("Agg")

FOLDER = Path(__file__).resolve().parents[2] / "notebooks"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))
# What takes long, and what the test runs instead: a notebook itself knows nothing of tests.
SHORTER = {
    "02": (("(2, 4, 7, 10, 15, 20, 30, 45, 60, 90)", "(5, 60)"),),
    "03": (
        ("[20, 50, 100, 500, 1000, 1500]", "[20, 50]"),
        ("[20, 50, 100, 200]", "[20, 50]"),
        ("        trials=10,", "        trials=2,"),
        ('["ga", "separable"]}, trials=10', '["ga", "separable"]}, trials=2'),
        ("generations=1000)", "generations=100)"),
    ),
    "04": (("range(5)", "range(2)"),),
    "05": (
        ("cycles=2, emulate", "cycles=1, emulate"),
        ("(0.25, 0.5, 0.75)", "(0.5,)"),
        ("0.05, duration=40.0", "0.05, duration=20.0"),
    ),
}


def _shorten(name: str, notebook: Any) -> None:
    """Put what is quick in the place of what takes long, each in the one place where it stands."""
    for long, short in SHORTER.get(name[:2], ()):
        (cell,) = (each for each in notebook.cells if long in each.source)
        assert cell.source.count(long) == 1, long
        cell.source = cell.source.replace(long, short)


def _pictures(notebook: Any) -> list[int]:
    """How many pictures each cell shows."""
    return [
        sum("image/png" in output.get("data", {}) for output in cell.get("outputs", []))
        for cell in notebook.cells
    ]


def test_notebooks_are_numbered_without_a_hole() -> None:
    assert [int(path.name[:2]) for path in NOTEBOOKS] == list(range(1, len(NOTEBOOKS) + 1))
    assert len(NOTEBOOKS) >= 4


def test_the_first_notebook_runs_in_this_process(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    from matplotlib import pyplot

    monkeypatch.chdir(FOLDER)
    notebook: Any = nbformat.read(NOTEBOOKS[0], as_version=4)  # type: ignore[no-untyped-call]
    names: dict[str, Any] = {}
    pyplot.close("all")  # of tests before it in this process
    try:
        for cell in notebook.cells:
            if cell.cell_type == "code":
                exec(compile(cell.source, NOTEBOOKS[0].name, "exec"), names)
        assert len(pyplot.get_fignums()) == sum(_pictures(notebook))
    finally:
        pyplot.close("all")
    assert capsys.readouterr().err == ""


@pytest.mark.slow
@pytest.mark.filterwarnings("default")  # the kernel's client warns of its own affairs
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebook_runs(path: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    from nbclient import NotebookClient

    monkeypatch.setenv("IPYTHONDIR", str(tmp_path / "ipython"))
    committed: Any = nbformat.read(path, as_version=4)  # type: ignore[no-untyped-call]
    again: Any = nbformat.read(path, as_version=4)  # type: ignore[no-untyped-call]
    for cell in again.cells:
        if cell.cell_type == "code":
            cell.outputs = []
    _shorten(path.stem, again)
    NotebookClient(
        again, timeout=120, kernel_name="python3", resources={"metadata": {"path": str(FOLDER)}}
    ).execute()
    assert _pictures(again) == _pictures(committed)
    assert sum(_pictures(again)) >= 2
    printed = [output for cell in again.cells for output in cell.get("outputs", [])]
    assert not [output for output in printed if output.get("name") == "stderr"]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebook_was_committed_whole(path: Path) -> None:
    notebook: Any = nbformat.read(path, as_version=4)  # type: ignore[no-untyped-call]
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert [cell.execution_count for cell in code] == list(range(1, len(code) + 1))
    kinds = {output.output_type for cell in code for output in cell.outputs}
    assert "error" not in kinds
    # Nothing of the machine that it ran on.
    assert not [
        word for word in ("/home/", "/tmp/", "/root/", "site-packages") if word in str(code)
    ]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_holds_no_code_for_tests(path: Path) -> None:
    assert not [word for word in ("QUICK", "environ", "pytest") if word in path.read_text("utf-8")]
