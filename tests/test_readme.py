"""What README.md prints is what the program prints."""

import re
from pathlib import Path

import pytest

import jointid as jid
from jointid.demo import data_folder

README = (Path(__file__).parent.parent / "README.md").read_text(encoding="utf-8")
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
