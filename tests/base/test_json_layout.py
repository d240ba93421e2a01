"""JSON text of lists of numbers: what Python itself writes, bit for bit."""

import json
import math

import numpy as np
import pytest

from jointid import _core
from jointid.base.json_layout import json_text, json_types

_EDGES = [
    0.0,
    -0.0,
    1.0,
    -1.5,
    123.0,
    0.1,
    1e-4,
    9.999e-5,
    1e-5,
    1e15,
    1e16,
    1.5e16,
    9007199254740993.0,
    1e22,
    1e23,
]
_EXTREMES = [
    5e-324,
    2.2250738585072014e-308,
    1.7976931348623157e308,
    -1e-300,
    1e100,
    123456789.125,
    1 / 3,
    2e-323,
]


def test_edges_are_written_as_python_writes_them() -> None:
    for value in (*_EDGES, *_EXTREMES):
        assert json_text([value]) == json.dumps([value])


def test_random_numbers_are_written_as_python_writes_them() -> None:
    random = np.random.default_rng(7)
    bits = random.integers(0, 2**63, 20_000, dtype=np.uint64) * np.uint64(2) + random.integers(
        0, 2, 20_000, dtype=np.uint64
    )
    any_bits = bits.view(np.float64)
    usual = random.normal(size=20_000) * 10.0 ** random.integers(-8, 20, 20_000)
    rounded = np.round(random.normal(size=20_000) * 1e3, 3)
    for values in (any_bits[np.isfinite(any_bits)], usual, rounded):
        listed = values.tolist()
        assert _core.number_list(listed) in (None, json.dumps(listed))
        assert json_text(listed) == json.dumps(listed)


def test_integers_among_numbers_stay_integers() -> None:
    assert json_text([1, 2.5, True, None]) == "[1, 2.5, true, null]"
    assert json_text([]) == "[]"


@pytest.mark.parametrize("value", [math.inf, -math.inf, math.nan])
def test_what_is_not_finite_is_refused(value: float) -> None:
    assert _core.number_list([1.0, value]) is None
    with pytest.raises(ValueError, match="not JSON compliant"):
        json_text([1.0, value])


def test_whatever_a_result_holds_becomes_a_type_of_json() -> None:
    held = {
        "tuple": (1, (2.5, math.inf)),
        "array": np.array([[1.0, -math.inf], [math.nan, 0.5]]),
        "number": np.float64(0.25),
        "flag": np.bool_(True),
        7: None,
    }
    plain = json_types(held)
    assert plain == {
        "tuple": [1, [2.5, "inf"]],
        "array": [[1.0, "-inf"], ["nan", 0.5]],
        "number": 0.25,
        "flag": True,
        "7": None,
    }
    assert json.loads(json.dumps(plain, allow_nan=False)) == plain
