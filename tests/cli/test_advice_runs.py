"""What a finding says to do is done, on a recording that raises it: its command runs as printed."""

import shlex
import sys
from pathlib import Path

import pytest

from jointid.cli.command_line import main
from jointid.cli.wording import Wording
from jointid.estimate.findings import TITLE
from jointid.identification.warnings.registry import finding_types

sys.path.insert(0, str(Path(__file__).parents[2] / "tools"))
from documentation.defective import Case, cases

QUICK = {"design": ["--evaluations", "64", "--joints", "2", "--rehearsals", "10", "--quiet"]}
FAST = ("undetermined", "slow_motion", "torque_saturated")  # design, compare, one plain act


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Case]:
    return cases(tmp_path_factory.mktemp("cases"))


@pytest.mark.parametrize(
    "code",
    [pytest.param(c, marks=[] if c in FAST else [pytest.mark.slow]) for c in finding_types()],
)
def test_the_first_action_is_one_that_can_be_done(
    code: str, made: dict[str, Case], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    case = made[code]
    estimate = case.estimate()
    found = next(each for each in estimate.findings if each.code == code)
    assert len(found.title) <= TITLE
    if not found.advice:
        assert found.severity == "info"
        return
    typed = ["identify", "run.csv"]
    case.recording.save("run.csv")
    if case.joint is not None:
        case.joint.save("joint.toml")
        typed += ["--joint", "joint.toml"]
    estimate.save("estimate.json")
    wording = Wording(
        "identify",
        model=str(case.identify.get("model", "")),
        joint_file="joint.toml" if case.joint is not None else "the joint file",
        saved="estimate.json",
        typed=(*typed, "--save", "estimate.json"),
    )
    what = wording.of_command(found.advice[0])
    assert what
    assert "..." not in what
    if code == "torque_side":  # the saved recording has its side already
        assert "--side torque=motor" in what
    elif what.startswith("jointid "):
        words = shlex.split(what)[1:]
        assert main([*words, *QUICK.get(words[0], ["--quiet"])]) == 0
