"""The generator of logs with one fault, and how it judges what the command line says to them."""

import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "benchmarks"))
from faulty_logs import KINDS, Answer, Judged, answered, drawn, judged, written
from log_plans import Log

SEED = 1
SHORT = 4.0  # s of each run
NUMBERS = {name: number for number, name in enumerate(KINDS)}


@pytest.fixture(scope="module")
def found(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Judged]:
    kinds = ("wrapped", "no_units", "current", "standing", "cut_line", "reversed_torque")
    plans = drawn(SEED, [NUMBERS[kind] for kind in kinds])
    folder = tmp_path_factory.mktemp("logs")
    return {
        kind: judged(number, kind, log, answered(log, folder / kind))
        for number, kind, log in written(plans, SHORT)
    }


def test_six_kinds_are_right_or_refused_by_name(found: dict[str, Judged]) -> None:
    outcomes = {kind: each.outcome for kind, each in found.items()}
    assert outcomes["wrapped"] == "right"
    assert outcomes["current"] == "right"
    assert outcomes["standing"] == "cause first"
    assert set(outcomes.values()) <= {"right", "cause first", "cause later"}, [
        each.text for each in found.values()
    ]


def test_a_log_is_repeated_by_its_number(found: dict[str, Judged]) -> None:
    number = NUMBERS["wrapped"]
    ((_, _, alone),) = written(drawn(SEED, [number]), SHORT)
    assert alone == found["wrapped"].log


def answer(value: float, interval: list[float], level: str, finding: str = "drift") -> Answer:
    uses = {use: {"level": level} for use in ("compensation", "simulation", "monitoring")}
    p = {"value": value, "vary": True, "interval": interval}
    serious = {"code": finding, "severity": "warning", "message": "it changes"}
    verdict = {"level": level, "reasons": [], "uses": uses}
    return Answer(
        document={"parameters": {"coulomb": p}, "verdict": verdict, "findings": [serious]}
    )


@pytest.mark.parametrize(
    ("said", "outcome"),
    [
        (answer(3.1, [3.05, 3.2], "usable"), "right"),  # within 5 %
        (answer(4.0, [2.9, 5.1], "usable with care"), "right"),  # inside its interval
        (answer(4.0, [3.9, 4.1], "usable with care"), "wrong and usable"),
        (answer(4.0, [3.9, 4.1], "not usable"), "cause first"),
        (answer(4.0, [3.9, 4.1], "not usable", "jumps"), "other cause"),
        (answer(3.0, [2.9, 3.1], "usable", "spikes"), "other cause"),  # a false finding
        (Answer(document={}, error="log.csv: the torque will drift"), "cause first"),
        (Answer(document={}, error="log.csv: no column of time"), "other cause"),
    ],
)
def test_wrong_and_usable_is_more_than_5_percent_off_and_outside(
    said: Answer, outcome: str
) -> None:
    log = Log(files={}, truth={"coulomb": 3.0}, causes="drift", never="spikes")
    assert judged(0, "wrapped", log, said).outcome == outcome


def test_kinds_take_turns() -> None:
    kinds = [kind for _, kind, _ in drawn(SEED, range(2 * len(KINDS)))]
    assert kinds == [*KINDS, *KINDS]
    assert [number for number, _, _ in drawn(SEED, range(50), "wrapped")] == [1, 24, 47]
    assert np.unique(kinds).size == 23
