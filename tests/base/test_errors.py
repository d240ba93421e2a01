"""An error is a value: its fields are shown, and another process gets them all."""

import copy
import pickle
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from typing import Any

import pytest

from jointid.base.advice import Action
from jointid.base.errors import NOT_GIVEN, InputError
from jointid.cli.wording import Wording

FIELDS: dict[str, Any] = {
    "argument": "columns",
    "place": "log.csv",
    "remedy": (Action("call", {"columns": {"velocity": None}}, function="load"), "check it"),
}


def refuse(value: Any) -> None:
    raise InputError("no such column", value=value, **FIELDS).at("folder")


def fields_of(error: InputError) -> tuple[Any, ...]:
    return error.reason, error.argument, error.value, error.place, error.remedy


@pytest.mark.parametrize("value", [NOT_GIVEN, None, 3.0, [1, 2]])
def test_an_error_of_another_process_has_all_its_parts(value: Any) -> None:
    with (
        ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool,
        pytest.raises(InputError) as caught,
    ):
        pool.submit(refuse, value).result()
    with pytest.raises(InputError) as own:
        refuse(value)
    assert fields_of(caught.value) == fields_of(own.value)
    assert (caught.value.value is NOT_GIVEN) == (value is NOT_GIVEN)
    assert str(caught.value) == str(own.value)


def test_a_value_that_cannot_be_pickled_is_shown() -> None:
    error = InputError("a number is expected", argument="seed", value=lambda: 1)
    again = pickle.loads(pickle.dumps(error))
    assert (again.value, again.argument, again.reason) == ("a function", "seed", error.reason)
    assert callable(error.value)
    assert fields_of(copy.copy(InputError("no", value=3))) == ("no", "", 3, "", ())


def test_the_fields_are_shown() -> None:
    error = InputError("choose one of a, b", argument="x", value="c", place="f", remedy="look")
    assert repr(error) == (
        "InputError('choose one of a, b', argument='x', place='f', remedy=('look',), value='c')"
    )
    assert repr(InputError("no")) == "InputError('no')"


def test_a_name_out_of_a_file_stays_on_the_line() -> None:
    error = InputError("it is not read", place="topic /a\nb\x1b[2J", remedy="load `c\r`")
    assert str(error) == r"topic /a\nb\x1b[2J: it is not read; load `c\r`"
    assert Wording("identify").of_error(error).isprintable()


@pytest.mark.parametrize(
    "name", ["測定\u3000結果", "9.41\u202fAM", "👨\u200d👩", "é ❤️", "C:\\new\\table"]
)
def test_a_name_that_can_be_read_stays_as_it_is(name: str) -> None:
    assert str(InputError("it is not read", place=name)) == f"{name}: it is not read"
