"""Default bounds of shape parameters come from the core's table; an unknown name is never guessed."""

import pytest

from jointid import _core
from jointid.identification.search.computed_bounds import shape_bounds


def test_default_bounds_are_those_of_the_table() -> None:
    assert shape_bounds("stribeck", 2.0) == ((0.5 * 2.0) ** -2, (0.01 * 2.0) ** -2)
    assert shape_bounds("stribeck_velocity", 2.0) == (0.02, 1.0)
    assert shape_bounds("stribeck_exponent", 2.0) == (0.5, 4.0)
    for shape in _core.shapes():
        low, high = shape_bounds(shape.name, 0.7)
        assert 0.0 <= low < high, shape.name
        assert low > 0.0 or shape.name in ("load_friction", "link_share")


def test_an_unknown_shape_is_refused() -> None:
    with pytest.raises(ValueError, match="unknown shape 'width'"):
        shape_bounds("width", 2.0)
