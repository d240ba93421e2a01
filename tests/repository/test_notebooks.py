"""Every notebook runs from top to bottom, shows what is committed, and what its text says is true."""

import ast
import re
import sys
from pathlib import Path
from typing import Any

import matplotlib
import nbformat
import pytest

matplotlib.use("Agg")

FOLDER = Path(__file__).resolve().parents[2] / "notebooks"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))
# What a reader needs besides Python itself; of the package only what is public.
IMPORTED = {"jointid", "jointid.hardware", "matplotlib.pyplot", "numpy", "distributed"}
# What not every platform has.
NEEDED = {"03": "distributed", "04": "pinocchio"}
# What the text of each notebook says, as code that runs behind its last cell.
CLAIMS = {
    "01": """
assert all(abs(both[name].value / value - 1) < 0.005 for name, value in TRUTH.items())
assert both.verdict.level == "usable"
assert [jid.identify(each, joint).verdict.level for each in (recording, slow)] == ["usable with care"] * 2
wrong = jid.identify(recording, joint.replace(gear_ratio=GEAR_RATIO))
assert wrong.verdict.level == "not usable" and "wrong sign" in str(wrong.warnings[0])
fast, both_errors = estimate["stribeck"].stderr, both["stribeck"].stderr
assert both_errors < 0.3 * fast
for name, value in kuka.published.items():
    assert robot[name].interval[0] < value < robot[name].interval[1]
assert again.to_json() == both.to_json()
""",
    "02": """
assert all(abs(estimate[name].value / value - 1) < 0.01 for name, value in TRUTH.items())
success = {tuple(cell.labels.values()): cell.success for cell in grid.summary().cells}
assert {each for (size, _), each in success.items() if size <= 50} == {0.0}
assert success[100, 1000] <= 0.3 and success[200, 1500] == 1.0
worst = [max(abs(bias) for bias in cell.bias.values()) for cell in windows.summary().cells]
assert worst[0] > 0.05 and max(worst[3:]) < 0.01
assert small.verdict.level == "not usable"
gain = {size: each["sensor_gain"].stderr for size, each in zip(amplitudes, estimates)}
assert gain[2] > 10 * gain[90]
first, identified, true = batch.error
assert first > 10 * identified and abs(identified / true - 1) < 0.1
""",
    "03": """
assert study.complete and not half.complete and len(study) == 180
assert list(here.rows) == [row for row in study.rows if row.trial < 2]
cells = study.summary().cells
for cell in cells:
    if cell.labels["windows"] >= 300:
        assert all(0.6 < cell.spread[name] / cell.stderr[name] < 1.7 for name in ("viscous", "stribeck"))
quiet, loud = (
    next(each.spread["viscous"] for each in cells if each.labels == {"sensors.torque_noise": noise, "windows": 1000})
    for noise in (0.1, 2.0)
)
assert 12 < loud / quiet < 33
for name in ("inertia", "coulomb", "viscous"):
    values = log.column(name)
    assert values.max() - values.min() < log.column(name + "_stderr").max()
assert "± 0 " not in str(study.summary()) + str(log.summary())
""",
    "04": """
for column, estimate in enumerate(found.joints.values()):
    for name, values in TRUTH.items():
        if name in estimate.parameters:
            assert abs(estimate.parameters[name].value / values[column] - 1) < 0.005
assert found.verdict.level == "usable"
first = jid.identify(run, robot)
assert first.verdict.level == "usable with care" and first.joints["shoulder"].relative_residual > 0.03
assert rolled.median < np.deg2rad(0.1)
""",
    "05": """
assert ring.improvement > 15
assert stop.limit == "tracking_error" and stop.motor_off and first.metadata["motor_off"]
for name in ("coulomb", "static", "stribeck", "viscous", "sensor_gain", "sensor_offset"):
    assert abs(ring.estimates[-1][name].value / true.parameters[name].value - 1) < 0.03
""",
}


def _read(path: Path) -> Any:
    return nbformat.read(path, as_version=4)  # type: ignore[no-untyped-call]


def _pictures(notebook: Any) -> list[int]:
    """How many pictures each cell shows."""
    return [
        sum("image/png" in output.get("data", {}) for output in cell.get("outputs", []))
        for cell in notebook.cells
    ]


def _words(notebook: Any) -> list[str]:
    """What each cell prints, without its numbers, and the rules of tables, which are as long as numbers."""
    printed = [
        "".join(output.get("text", "") for output in cell.get("outputs", []))
        for cell in notebook.cells
    ]
    return [" ".join(re.sub(r"\S*\d\S*|-{3,}", "#", text).split()) for text in printed]


def test_there_are_five_numbered_notebooks() -> None:
    assert [path.name[:2] for path in NOTEBOOKS] == sorted(CLAIMS)


def test_the_first_notebook_runs_in_this_process(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    from matplotlib import pyplot

    monkeypatch.chdir(FOLDER)
    notebook = _read(NOTEBOOKS[0])
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
def test_a_notebook_runs_and_its_text_is_true(
    path: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    from nbclient import NotebookClient

    pytest.importorskip(NEEDED.get(path.name[:2], "nbclient"))
    monkeypatch.setenv("IPYTHONDIR", str(tmp_path / "ipython"))
    committed, again = _read(path), _read(path)
    for cell in again.cells:
        if cell.cell_type == "code":
            cell.outputs = []
    claims: Any = nbformat.v4.new_code_cell(CLAIMS[path.name[:2]])  # type: ignore[no-untyped-call]
    again.cells.append(claims)
    NotebookClient(
        again, timeout=120, kernel_name="python3", resources={"metadata": {"path": str(FOLDER)}}
    ).execute()
    again.cells.pop()
    assert _pictures(again) == _pictures(committed)
    assert sum(_pictures(again)) >= 1
    assert _words(again) == _words(committed)
    printed = [output for cell in again.cells for output in cell.get("outputs", [])]
    assert not [output for output in printed if output.get("name") == "stderr"]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebook_was_committed_whole(path: Path) -> None:
    code = [cell for cell in _read(path).cells if cell.cell_type == "code"]
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


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_uses_public_names_only(path: Path) -> None:
    cells = [cell.source for cell in _read(path).cells if cell.cell_type == "code"]
    nodes = [node for source in cells for node in ast.walk(ast.parse(source))]
    imported = {
        alias.name for node in nodes if isinstance(node, ast.Import) for alias in node.names
    }
    imported |= {str(node.module) for node in nodes if isinstance(node, ast.ImportFrom)}
    assert {
        name for name in imported if name.partition(".")[0] not in sys.stdlib_module_names
    } <= IMPORTED
    assert not [
        node for node in nodes if isinstance(node, ast.Attribute) and node.attr.startswith("_")
    ]
