"""Randomly damaged files: nothing but an InputError, whichever reader. `make fuzz` tries a million of each."""

import os

import pytest

from fuzz.seeds import readers
from fuzz.trying import faults

_CASES = int(os.environ.get("JOINTID_FUZZ") or (5_000 if os.environ.get("CI") else 300))
_START = int(os.environ.get("JOINTID_FUZZ_SEED") or 0)


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", tuple(readers()))
def test_damage_is_one_sentence_or_harmless(name: str) -> None:
    wrong = faults(name, _START, _CASES)
    assert not wrong, f"{len(wrong)} of {_CASES}\n" + "\n".join(wrong[:10])
