"""Ticks are round, within the axis, not too many, and their texts are their values."""

import math

import numpy as np
import pytest

from jointid.report.drawing.ticks import linear_ticks, logarithmic_ticks


@pytest.mark.parametrize("most", [2, 3, 5, 7])
def test_round_values_within_the_axis(most: int) -> None:
    random = np.random.default_rng(4)
    for _ in range(300):
        low = float(random.normal() * 10.0 ** random.integers(-12, 12))
        high = low + abs(low) * float(10.0 ** random.uniform(-3.0, 3.0))
        ticks = linear_ticks(low, high, most)
        assert 1 <= len(ticks.values) <= most
        slack = 1e-6 * (high - low)
        assert all(low - slack <= value <= high + slack for value in ticks.values)
        for value, text in zip(ticks.values, ticks.texts, strict=True):
            read = float(text.replace("−", "-")) * 10.0**ticks.exponent
            assert read == pytest.approx(value, rel=1e-9, abs=1e-9 * (high - low))
        if len(ticks.values) > 1:
            step = ticks.values[1] - ticks.values[0]
            lead = step / 10.0 ** math.floor(math.log10(step) + 1e-9)
            assert min(abs(lead - round_value) for round_value in (1.0, 2.0, 5.0)) < 1e-3


@pytest.mark.parametrize(
    ("low", "high", "texts", "exponent"),
    [
        (-1.02, 1.04, ("−1", "0", "1"), 0),
        (0.0, 0.011, ("0.000", "0.005", "0.010"), 0),
        (-2e-7, 4.1e-7, ("−200", "0", "200", "400"), -9),
        (1.9e6, 6.2e6, ("2", "4", "6"), 6),
    ],
)
def test_texts(low: float, high: float, texts: tuple[str, ...], exponent: int) -> None:
    ticks = linear_ticks(low, high, 4)
    zero = tuple("0" if float(text.replace("−", "-")) == 0.0 else text for text in texts)
    assert (ticks.texts, ticks.exponent) == (zero, exponent)


def test_decades() -> None:
    assert logarithmic_ticks(1e-3, 1e2, 6).texts == ("10⁻³", "10⁻²", "10⁻¹", "10⁰", "10¹", "10²")
    assert logarithmic_ticks(1e-9, 1e9, 6).texts == ("10⁻⁹", "10⁻⁵", "10⁻¹", "10³", "10⁷")
    assert logarithmic_ticks(0.9, 9.0, 6).texts == ("1", "2", "5")
    assert logarithmic_ticks(2.2, 4.1, 6).texts == ("2.5", "3.0", "3.5", "4.0")
