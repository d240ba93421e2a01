"""What was computed before the house was rearranged is computed still, bit for bit."""

import json
import platform
from pathlib import Path

import pytest
from bits import CASES

TABLE = json.loads((Path(__file__).parents[1] / "bits.json").read_text(encoding="utf-8"))


def test_the_table_and_the_cases_are_the_same() -> None:
    assert list(TABLE) == list(CASES)


# NumPy's and the linear algebra's last bits are a processor family's own.
@pytest.mark.skipif(platform.machine() != "x86_64", reason="the table was made on x86-64")
@pytest.mark.parametrize("case", CASES)
def test_the_bits_are_those_of_the_table(case: str) -> None:
    assert CASES[case]() == TABLE[case]
