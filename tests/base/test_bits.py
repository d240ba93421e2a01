"""What was computed before the house was rearranged is computed still, bit for bit."""

import json
import platform
import re
from pathlib import Path

import pytest
from bits import CASES

from jointid import _core

TABLE = json.loads((Path(__file__).parents[1] / "bits.json").read_text(encoding="utf-8"))


def test_the_table_and_the_cases_are_the_same() -> None:
    assert list(TABLE) == list(CASES)


def compiled_by_gcc_12() -> bool:
    """Whether the core says so: compilers write their names into what they make."""
    content = Path(str(_core.__file__)).read_bytes()
    versions = set(re.findall(rb"GCC: \([^)]*\) (\d+)", content))
    return versions == {b"12"} and b"clang version" not in content


# The last bits of NumPy are a processor family's own.
@pytest.mark.skipif(platform.machine() != "x86_64", reason="the table was made on x86-64")
@pytest.mark.skipif(
    not compiled_by_gcc_12(), reason="bits are a build's own: the table was made with gcc 12"
)
@pytest.mark.parametrize("case", CASES)
def test_the_bits_are_those_of_the_table(case: str) -> None:
    assert CASES[case]() == TABLE[case]
