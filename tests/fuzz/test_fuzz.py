"""Randomly damaged files: nothing but an InputError, whichever reader. `make fuzz` tries a million of each."""

import os
import signal
from pathlib import Path

import pytest

import jointid as jid
from fuzz import trying
from fuzz.seeds import readers
from fuzz.trying import faults

_CASES = int(os.environ.get("JOINTID_FUZZ") or 300)
_START = int(os.environ.get("JOINTID_FUZZ_SEED") or 0)


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("cases", [20, pytest.param(_CASES, marks=pytest.mark.slow)])
@pytest.mark.parametrize("name", tuple(readers()))
def test_damage_is_one_sentence_or_harmless(name: str, cases: int) -> None:
    wrong = faults(name, _START, cases)
    assert not wrong, f"{len(wrong)} of {cases}\n" + "\n".join(wrong[:10])


def test_a_reader_that_hangs_is_told_although_it_makes_an_error_of_each_exception(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def use(path: Path) -> None:
        if path.read_bytes() != b"seed":
            try:
                signal.raise_signal(signal.SIGALRM)
            except Exception as error:
                raise jid.InputError("the file cannot be read") from error

    monkeypatch.setattr(trying, "seed_of", lambda _: ("seed.csv", b"seed", {}, use))
    assert faults("any", 0, 1) == ["case 0: _HangsError: no answer within 120 s"]
