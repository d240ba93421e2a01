"""What README.md prints is what the program prints."""

import re
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

import jointid as jid
from jointid.cli.demo import data_folder

README = (Path(__file__).parents[2] / "README.md").read_text(encoding="utf-8")
NUMBER = re.compile(r"-?\d+(?:\.\d+)?")


@pytest.fixture(scope="module")
def well_excited() -> jid.Recording:
    return jid.load(data_folder() / "well_excited.csv.gz")


def test_the_first_table_is_what_identify_reports(well_excited: jid.Recording) -> None:
    printed = {
        line.split()[0]: line
        for line in jid.identify(well_excited, jid.thesis_joint()).report().splitlines()
        if line
    }
    start = README.index("parameter      value")
    table = README[start : README.index("```", start)].strip().splitlines()
    assert len(table) == 9
    for line in table[2:]:
        shown, found = (
            [float(number) for number in NUMBER.findall(text)]
            for text in (line, printed[line.split()[0]])
        )
        assert shown == pytest.approx(found, rel=0.02), line
        assert shown[0] == pytest.approx(found[0], rel=1e-5), line


def test_its_comparison_runs(well_excited: jid.Recording) -> None:
    models = re.search(r"compare_models\(recording, joint, models=\(([^)]*)\)", README)
    assert models is not None
    names = [name.strip().strip('"') for name in models[1].split(",")]
    comparison = jid.compare_models(well_excited, jid.thesis_joint(), models=names, folds=5)
    assert comparison.winner == "stribeck"


def test_its_blocks_run_one_after_the_other(
    well_excited: jid.Recording, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pyplot = pytest.importorskip("matplotlib.pyplot")
    (tmp_path / "examples").symlink_to(Path(__file__).parents[2] / "examples")
    monkeypatch.chdir(tmp_path)
    run = well_excited
    assert run.torque is not None
    assert run.sensor is not None
    columns = (run.time, run.position, run.velocity, run.torque, run.sensor)
    samples = [
        SimpleNamespace(t=t, q=q, v=v, tau=tau, raw=raw)
        for t, q, v, tau, raw in zip(*(column.tolist() for column in columns), strict=True)
    ]
    names: dict[str, Any] = {"samples": samples}
    blocks = re.findall(r"^```python\n(.*?)^```", README, re.DOTALL | re.MULTILINE)
    assert len(blocks) >= 7
    try:
        for block in blocks:
            exec(block, names)
    finally:
        pyplot.close("all")
    assert (tmp_path / "joint.toml").is_file()
    assert (tmp_path / "grid.csv").is_file()
    assert names["comparison"].winner == "stribeck"
