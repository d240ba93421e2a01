"""Endings of file names."""

from pathlib import Path

import pytest

from jointid.base.error_text import alternatives, reason_of
from jointid.base.errors import InputError
from jointid.base.file_endings import ending_of


@pytest.mark.parametrize(
    ("name", "ending"),
    [("a.csv", ".csv"), ("A.CSV.GZ", ".csv.gz"), ("x.npz.csv", ".csv"), ("a.gz", ".gz")],
)
def test_the_longest_ending_is_found_in_any_case(name: str, ending: str) -> None:
    assert ending_of(Path(name), (".gz", ".csv", ".csv.gz")) == ending


@pytest.mark.parametrize("name", ["a.txt", "csv", "a.csv.bak", ""])
def test_another_ending_is_refused(name: str) -> None:
    with pytest.raises(
        InputError, match=r"a file name that ends in \.csv or \.npz is exp"
    ) as caught:
        ending_of(Path(name), (".csv", ".npz"))
    assert caught.value.place == str(Path(name))


def test_alternatives() -> None:
    assert alternatives([".csv"]) == ".csv"
    assert alternatives([".csv", ".npz"]) == ".csv or .npz"
    assert alternatives(["a", "b", "c"]) == "a, b or c"


def test_the_reason_of_an_error_is_one_short_sentence() -> None:
    assert reason_of(ValueError("bad\n magic. Try another")) == "bad magic"
    assert reason_of(EOFError()) == "EOFError"
    assert len(reason_of(ValueError("x" * 500))) == 120
