"""Parameters: what makes one usable, and how tables of them are laid over each other."""

import pickle
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from jointid import _core
from jointid.base.errors import InputError
from jointid.joint.checks import suggestion
from jointid.joint.parameters import Parameter, merge, parameter_table

NAMES = st.sampled_from(_core.parameter_names())
FINITE = st.floats(allow_nan=False, allow_infinity=False)
_ABOVE_ZERO = {name for term in _core.terms() if term.above_zero for name in term.shapes}
POSITIVE = st.floats(min_value=0.0, exclude_min=True, allow_infinity=False)


@st.composite
def parameters(draw: st.DrawFn, name: str) -> Parameter:
    numbers = POSITIVE if name in _ABOVE_ZERO else FINITE
    low, value, high = sorted(draw(st.tuples(numbers, numbers, numbers)))
    given_value = draw(st.booleans())
    return Parameter(
        name=name,
        value=value if given_value else None,
        min=draw(st.sampled_from((low, None))),
        max=draw(st.sampled_from((high, None))),
        vary=draw(st.booleans()) or not given_value,
    )


TABLES = st.sets(NAMES).flatmap(
    lambda names: st.fixed_dictionaries({name: parameters(name) for name in sorted(names)})
)


def test_a_parameter_is_free_and_unknown_by_default() -> None:
    parameter = Parameter(name="coulomb")
    assert (parameter.value, parameter.min, parameter.max) == (None, None, None)
    assert parameter.vary


def test_numbers_become_floats() -> None:
    numbers: dict[str, Any] = {"value": np.float32(2.5), "min": 0, "max": np.int64(5)}
    parameter = Parameter(name="coulomb", **numbers)
    assert [type(x) for x in (parameter.value, parameter.min, parameter.max)] == [float] * 3
    assert parameter == Parameter(name="coulomb", value=2.5, min=0.0, max=5.0)


def test_bounds_belong_to_the_range() -> None:
    assert Parameter(name="coulomb", value=1.0, min=1.0, max=1.0).value == 1.0


@pytest.mark.parametrize(
    ("fields", "said"),
    [
        ({"name": "coulom"}, "coulom: there is no such parameter; did you mean 'coulomb'?"),
        ({"name": "zzz"}, "zzz: there is no such parameter; choose one of inertia, coulomb"),
        ({"value": float("nan")}, "value is nan: a finite number"),
        ({"min": float("-inf")}, "min is -inf: a finite number"),
        ({"max": 10**400}, "max is inf: a finite number"),
        ({"value": "25"}, "value is '25': a number"),
        ({"value": True}, "value is True: a number"),
        ({"value": 1j}, "value is a complex: a number"),
        ({"min": 3.0, "max": 2.0}, "min is 3.0: it is above max 2.0"),
        ({"value": 1.0, "min": 2.0}, "value is 1.0: it is below min 2.0"),
        ({"value": 3.0, "max": 2.0}, "value is 3.0: it is above max 2.0"),
        ({"name": "stribeck_velocity", "value": -1.0}, "value is -1.0: more than 0"),
        ({"name": "stribeck_exponent[1]", "min": 0.0}, "min is 0.0: more than 0"),
        ({"vary": False}, "vary is False: a fixed parameter needs a value"),
        ({"value": 1.0, "vary": 0}, "vary is 0: true or false"),
        ({"vary": None}, "vary is None: true or false"),
    ],
)
def test_a_parameter_that_cannot_be(fields: dict[str, Any], said: str) -> None:
    with pytest.raises(InputError) as refused:
        Parameter(**{"name": "coulomb", **fields})
    sentence = str(refused.value)
    assert said in sentence
    assert "\n" not in sentence
    assert "name" in fields or sentence.startswith("parameter 'coulomb': ")
    assert str(pickle.loads(pickle.dumps(refused.value))) == sentence


def test_a_table_takes_numbers_mappings_and_parameters() -> None:
    static = Parameter(name="static", value=3.0)
    table = parameter_table({"static": static, "viscous": 12, "coulomb": {"max": 50, "value": 20}})
    assert table == {
        "coulomb": Parameter(name="coulomb", value=20.0, max=50.0),
        "static": static,
        "viscous": Parameter(name="viscous", value=12.0, vary=False),
    }
    assert list(table) == ["coulomb", "static", "viscous"]


@pytest.mark.parametrize(
    ("entries", "said"),
    [
        (
            {"viscos": 1.0},
            "parameters: viscos: there is no such parameter; did you mean 'viscous'?",
        ),
        ({5: 1.0}, "parameters: 5: there is no such parameter"),
        (
            {"viscous": {"maximum": 1.0}},
            "parameter 'viscous': maximum: a parameter has no such field",
        ),
        ({"viscous": {"Max": 1.0}}, "Max: a parameter has no such field; did you mean 'max'?"),
        ({"viscous": {"name": "viscous"}}, "name: a parameter has no such field"),
        ({"viscous": "fixed"}, "parameters: viscous is 'fixed': a number (it fixes"),
        ({"viscous": None}, "parameters: viscous is None: a number"),
        ({"viscous": False}, "parameters: viscous is False: a number"),
        ({"viscous": float("inf")}, "parameters: viscous is inf: a finite number"),
        ({"viscous": Parameter(name="static")}, "viscous: it holds the parameter 'static'"),
        ([("viscous", 1.0)], "a mapping from names"),
    ],
)
def test_a_table_that_cannot_be(entries: Any, said: str) -> None:
    with pytest.raises(InputError) as refused:
        parameter_table(entries)
    assert said in str(refused.value)
    assert "\n" not in str(refused.value)


@given(TABLES)
def test_merging_with_nothing_changes_nothing(table: dict[str, Parameter]) -> None:
    assert merge(table, {}) == merge({}, table) == merge(table, table) == table


@given(TABLES, TABLES)
def test_names_of_both_are_merged_in_the_order_of_the_core(
    base: dict[str, Parameter], changes: dict[str, Parameter]
) -> None:
    apart = {name: entry for name, entry in changes.items() if name not in base}
    merged = merge(base, apart)
    assert merged == {**base, **apart}
    assert list(merged) == [name for name in _core.parameter_names() if name in merged]


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        (6.0, {"value": 6.0, "min": 1.0, "max": 9.0, "vary": False}),
        ({}, {"value": 5.0, "min": 1.0, "max": 9.0, "vary": True}),
        ({"vary": False}, {"value": 5.0, "min": 1.0, "max": 9.0, "vary": False}),
        ({"max": 7.0}, {"value": 5.0, "min": 1.0, "max": 7.0, "vary": True}),
        ({"max": None}, {"value": 5.0, "min": 1.0, "max": None, "vary": True}),
        (
            Parameter(name="coulomb", min=2.0, value=3.0, vary=False),
            {"value": 3.0, "min": 2.0, "max": 9.0, "vary": False},
        ),
        (Parameter(name="coulomb"), {"value": 5.0, "min": 1.0, "max": 9.0, "vary": True}),
    ],
)
def test_later_wins_field_by_field(change: Any, expected: dict[str, Any]) -> None:
    base = {"coulomb": Parameter(name="coulomb", value=5.0, min=1.0, max=9.0)}
    before = dict(base)
    assert merge(base, {"coulomb": change}) == {"coulomb": Parameter(name="coulomb", **expected)}
    assert base == before


def test_a_fixed_parameter_is_freed() -> None:
    base = parameter_table({"inertia": 2.5})
    freed = merge(base, {"inertia": {"vary": True}})
    assert freed["inertia"] == Parameter(name="inertia", value=2.5, vary=True)
    assert not merge(base, {"inertia": {"max": 3.0}})["inertia"].vary
    assert merge(base, {"inertia": Parameter(name="inertia", max=3.0)})["inertia"].vary


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (12.0, "value is 12.0: it is above max 9.0"),
        ({"min": 6.0}, "value is 5.0: it is below min 6.0"),
        ({"value": None, "vary": False}, "vary is False: a fixed parameter needs a value"),
    ],
)
def test_a_change_that_does_not_fit(change: Any, said: str) -> None:
    base = {"coulomb": Parameter(name="coulomb", value=5.0, min=1.0, max=9.0)}
    with pytest.raises(InputError, match=said):
        merge(base, {"coulomb": change})


def test_a_suggestion_lists_ten_names() -> None:
    names = [f"x{number}" for number in range(30)]
    assert suggestion("qqq", names) == f"choose one of {', '.join(names[:10])}, … (30 in all)"
    assert suggestion("qqq", names[:10]) == f"choose one of {', '.join(names[:10])}"
