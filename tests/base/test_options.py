"""Options that are declared once: what a function that takes them shows, gets and refuses."""

import inspect
from typing import Annotated, TypedDict, Unpack

import pytest

from jointid.base.options import Option, checked, options_of, takes


class Meal(TypedDict, total=False):
    """What a guest may order."""

    dish: Annotated[str, Option(kind="str", help="What is cooked. " * 8, default="soup")]
    spoons: Annotated[
        int | None,
        Option(kind="int, optional", help="How many.", checked=lambda _, value: abs(value)),
    ]


@takes(Meal)
def serve(guest: str, *, table: int = 1, **options: Unpack[Meal]) -> tuple[str, int, object]:
    """Serve a guest.

    Parameters
    ----------
    guest : str
    **options
    table : int

    Returns
    -------
    tuple
    """
    return guest, table, options


@takes(Meal)
class Kitchen:
    """A kitchen.

    Parameters
    ----------
    **options
    """

    def __init__(self, **options: Unpack[Meal]) -> None:
        self.options = options


def test_the_signature_has_each_option_with_type_and_default() -> None:
    shown = inspect.signature(serve).parameters
    assert [*shown] == ["guest", "table", "dish", "spoons"]
    assert (shown["dish"].default, shown["dish"].annotation) == ("soup", str)
    assert shown["spoons"].kind == inspect.Parameter.KEYWORD_ONLY
    assert [*inspect.signature(Kitchen).parameters] == ["dish", "spoons"]


def test_the_docstring_has_each_option_in_the_place_of_the_line() -> None:
    text = inspect.cleandoc(serve.__doc__ or "")
    assert "guest : str\ndish : str\n    What is cooked. What" in text
    assert "spoons : int, optional\n    How many.\ntable : int\n" in text
    assert max(map(len, text.splitlines())) < 100
    assert "spoons : int, optional\n        How many." in (Kitchen.__doc__ or "")


def test_the_function_gets_every_option() -> None:
    assert serve("Ann", spoons=2) == ("Ann", 1, {"dish": "soup", "spoons": 2})
    assert Kitchen(dish="pie").options == {"dish": "pie", "spoons": None}


def test_any_other_keyword_is_refused_by_the_name_of_the_function() -> None:
    with pytest.raises(TypeError, match=r"serve\(\) got an unexpected keyword argument 'fork'"):
        serve("Ann", fork=1)  # type: ignore[call-arg]
    with pytest.raises(TypeError, match=r"Kitchen.__init__\(\) got an unexpected keyword"):
        Kitchen(fork=1)  # type: ignore[call-arg]


def test_values_are_checked_by_the_declaration() -> None:
    assert checked(Meal, {"spoons": -3, "fork": 1}) == {"dish": "soup", "spoons": 3}
    assert [*options_of(Meal)] == ["dish", "spoons"]
