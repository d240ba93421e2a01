"""How many digits of a value are shown: those that its standard error has."""

import pytest

from jointid.estimate.wording import percent_with_error, rounded


@pytest.mark.parametrize(
    ("value", "stderr", "shown"),
    [
        (2034.0, 170.0, "2030"),
        (7.7412, 0.21, "7.74"),
        (3.00001234, 3.4e-5, "3.000012"),
        (3.0, 3.4e-5, "3.000000"),
        (2.5123e-5, 3.1e-7, "2.512e-05"),
        (1234.5, 3e-9, "1234.500"),
        (1e-9, 3e-5, "0"),
        (0.0, 3e-5, "0"),
        (-0.0003, 1.8, "0.0"),
        (-3.0, 1800.0, "0"),
    ],
)
def test_a_value_has_the_digits_of_its_error(value: float, stderr: float, shown: str) -> None:
    assert rounded(value, stderr) == shown


def test_a_share_is_alone_where_its_error_is_not_known() -> None:
    assert percent_with_error(0.1, 0.01) == "10.0 ± 1.0 %"
    assert percent_with_error(0.1, float("nan")) == "10 %"
