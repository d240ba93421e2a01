"""The kinds of a schema: what each accepts, and the path named when it does not."""

from pathlib import Path
from typing import Any

import pytest

from jointid.base.errors import InputError
from jointid.base.schema import (
    Flag,
    Kind,
    ListOf,
    Number,
    OrNull,
    Plain,
    Record,
    TableOf,
    Text,
    Unchecked,
    read_document,
    read_json,
    read_text,
)

NUMBER = Number(low=0.0, high=10.0)
RECORD = Record({"a": NUMBER}, {"b": Flag()})


@pytest.mark.parametrize(
    ("kind", "value"),
    [
        (NUMBER, 3),
        (Number(whole=True), -3),
        (Text(), ""),
        (Text(known=("a",)), "a"),
        (Flag(), False),
        (OrNull(Flag()), None),
        (ListOf(NUMBER, 1, 2), [1.0, 2.0]),
        (TableOf(NUMBER), {"x": 1.0}),
        (RECORD, {"a": 1.0}),
        (RECORD, {"b": True, "a": 1.0}),
        (Record({}, other=Plain()), {"x": [1, {"y": None}]}),
        (Plain(), [1, "a", None, True, {"b": 2.5}]),
    ],
)
def test_accepted(kind: Kind, value: Any) -> None:
    assert kind.read(value, "") == value


@pytest.mark.parametrize(
    ("kind", "value", "message"),
    [
        (NUMBER, True, "x: this is True: a number is expected"),
        (NUMBER, "1", "x: this is '1': a number is expected"),
        (NUMBER, "inf", "x: this is 'inf': a finite number is expected"),
        (NUMBER, float("nan"), "x: this is nan: a finite number"),
        (NUMBER, 10.5, "x: this is 10.5: a number from 0 to 10 is expected"),
        (NUMBER, -1, "x: this is -1: a number from 0 to 10"),
        (Number(), 10**400, "x: the number is too large"),
        (Number(infinite=True), "nan", "x: this is 'nan': a finite number"),
        (Number(undefined=True), "-inf", "x: this is '-inf': a finite number"),
        (Number(whole=True), 1.0, "x: this is 1.0: an integer is expected"),
        (Text(), 1, "x: this is 1: text is expected"),
        (Text(longest=2), "abc", "x: the text has 3 characters; at most 2"),
        (Text(known=("a", "b")), "c", "x: this is 'c': choose one of a, b"),
        (Text(), "\ud800", "x: the text has half a character"),
        (Flag(), 1, "x: this is 1: true or false"),
        (OrNull(Flag()), 0, "x: this is 0: true or false"),
        (ListOf(NUMBER), (1,), r"x: this is \(1,\): a list is expected"),
        (ListOf(NUMBER, 1), [], "x: 1 to 10000000 items are expected, not 0"),
        (ListOf(NUMBER, 0, 1), [1, 2], "x: 0 to 1 items are expected, not 2"),
        (ListOf(NUMBER), [1, None], r"x\[1\]: this is None"),
        (TableOf(NUMBER), [], r"x: this is \[\]: a table is expected"),
        (TableOf(NUMBER, 1), {"a": 1, "b": 2}, "x: at most 1 entries are expected, not 2"),
        (TableOf(NUMBER), {"a": None}, r"x\.a: this is None"),
        (TableOf(NUMBER), {"a" * 300: 1}, "x: the text has 300 characters"),
        (RECORD, {}, r"x\.a: this is missing"),
        (RECORD, {"a": 1, "c": 2}, r"x\.c: unknown key; choose one of b, a"),
        (RECORD, {"a": 1, "b": 2}, r"x\.b: this is 2: true or false"),
        (Record({}, other=Plain()), {"a" * 300: 1}, "x: the text has 300 characters"),
        (Plain(), [{"a": float("inf")}], r"x\[0\]\.a: this is inf"),
        (Plain(), {"a": "\udfff"}, r"x\.a: the text has half a character"),
    ],
)
def test_refused(kind: Kind, value: Any, message: str) -> None:
    with pytest.raises(InputError, match=f"^{message}"):
        kind.read(value, "x")


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("", "not JSON"),
        ("{", "not JSON"),
        ("1" * 5000, "not JSON"),
        ("[" * 100_000 + "]" * 100_000, "nested too deeply"),
        ("[" * 40 + "]" * 40, "nested too deeply"),
        ('{"a":' * 40 + "1" + "}" * 40, "nested too deeply"),
    ],
)
def test_text_that_is_no_file_of_ours(text: str, reason: str) -> None:
    with pytest.raises(InputError, match=reason):
        read_json(text)


def test_a_large_file_is_not_read(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    path = tmp_path / "large.json"
    path.write_text("[1, 2, 3, 4]", encoding="utf-8")
    assert read_text(path) == "[1, 2, 3, 4]"
    monkeypatch.setattr("jointid.base.schema.LARGEST", 10)
    with pytest.raises(InputError, match=r"large\.json: too large: at most 10 bytes are allowed"):
        read_text(path)
    with pytest.raises(InputError, match=r"none\.json: there is no such file"):
        read_text(tmp_path / "none.json")


def test_a_large_text_is_not_read(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("jointid.base.schema.LARGEST", 10)
    with pytest.raises(InputError, match="too large: 12 characters; at most 10 are allowed"):
        read_json("[1, 2, 3, 4]")
    assert read_json('{"a": [1]}') == {"a": [1]}


@pytest.mark.skipif(not Path("/dev/zero").exists(), reason="no such device")
def test_a_device_without_a_size_is_not_read_without_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("jointid.base.schema.LARGEST", 10)
    with pytest.raises(InputError, match="too large: at most 10 bytes are allowed"):
        read_text(Path("/dev/zero"))


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("[]", "this JSON is not a list of shoes: its field 'kind' is not 'shoes'"),
        ('{"kind": "hats", "schema": 1}', "is not a list of shoes"),
        ('{"kind": "shoes"}', "schema"),
        ('{"kind": "shoes", "schema": 0}', "schema: this is 0"),
        (
            '{"kind": "shoes", "schema": 3}',
            "schema: this is 3: this version of jointid reads schemas up to 2; update",
        ),
    ],
)
def test_a_document_of_another_kind_or_a_newer_schema_is_refused(text: str, says: str) -> None:
    with pytest.raises(InputError, match=says):
        read_document(text, "shoes", 2, "a list of shoes")


def test_a_document_of_the_kind_is_returned_unchecked() -> None:
    text = '{"kind": "shoes", "schema": 1, "left": [1, "a"]}'
    document = read_document(text, "shoes", 2, "a list of shoes")
    kept = Record({"left": Unchecked()}, other=Plain()).read(document, "")
    assert kept == {"kind": "shoes", "schema": 1, "left": [1, "a"]}
