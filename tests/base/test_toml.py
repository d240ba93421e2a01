"""TOML of ours: what is written is read, and what cannot be read is named."""

import math
import tomllib
from pathlib import Path

import numpy as np
import pytest

from jointid.base.errors import InputError
from jointid.base.toml_file import read_toml
from jointid.base.toml_text import toml_of

TABLES = {
    "schema": 1,
    "a": {"b": {"c": 1.5, "deep": {"x": [1, 2.5, "y"]}}, "plain": True, "nothing": None},
    "empty": {},
    "names with spaces": {"ü.ä": 'quote " and \\ and \n and \x00 and \x7f and 😀'},
    "small": 5e-324,
    "large": 1e300,
    "list": [],
}
READ = TABLES | {"a": {"b": {"c": 1.5, "deep": {"x": [1, 2.5, "y"]}}, "plain": True}}


def test_what_is_written_is_read() -> None:
    assert tomllib.loads(toml_of(TABLES)) == READ


def test_numbers_that_are_not_finite_are_texts() -> None:
    text = toml_of({"a": {"b": math.inf, "c": -math.inf, "d": [math.nan]}})
    assert tomllib.loads(text) == {"a": {"b": "inf", "c": "-inf", "d": ["nan"]}}


def test_numbers_of_numpy_are_numbers() -> None:
    text = toml_of({"a": np.float64(0.1), "b": [np.float64(-2.5)], "c": np.float64("inf")})
    assert text == 'a = 0.1\nb = [-2.5]\nc = "inf"\n'


def test_comments_stand_behind_keys_and_tables() -> None:
    text = toml_of({"a": {"b": 1, "c": {"d": 2}}}, {"a": "first", "a.b": "one", "a.c.d": "two"})
    assert text == "[a]  # first\nb = 1  # one\n\n[a.c]\nd = 2  # two\n"


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (b"a = ", "not TOML: Invalid value"),
        (b"a = 1\na = 2", r"Cannot overwrite a value \(end of document\)"),
        (b"a = 1\nb 2\n", r"line 2"),
        (b"a = " + b"9" * 5000, "not TOML: .*digit"),
        (b"a = " + b"[" * 40 + b"]" * 40, "not TOML of jointid: nested too deeply"),
        (b"a = " + b"[" * 100_000, "not TOML: it is nested too deeply"),
        (b"\xff\xfe", "not text in UTF-8"),
    ],
)
def test_what_is_no_toml_is_named(tmp_path: Path, content: bytes, says: str) -> None:
    path = tmp_path / "file.toml"
    path.write_bytes(content)
    with pytest.raises(InputError, match=rf"file\.toml: .*{says}"):
        read_toml(path)


def test_a_byte_order_mark_is_not_the_first_key(tmp_path: Path) -> None:
    path = tmp_path / "file.toml"
    path.write_bytes(b"\xef\xbb\xbfa = 1\n")
    assert read_toml(path) == {"a": 1}
