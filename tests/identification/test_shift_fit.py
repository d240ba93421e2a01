"""The fit of a signal's delay: in any unit, beside windows that miss by far, and no further than it may reach."""

import numpy as np
import pytest

from jointid import _core

TIME = np.arange(6000) * 1e-3
DELAY = 2e-3


def parts(time: np.ndarray) -> np.ndarray:
    """What has nothing to do with friction, and friction."""
    swing = np.sin(11.0 * time) + 0.5 * np.sin(29.0 * time)
    return np.column_stack([np.cos(17.0 * time), np.tanh(4.0 * swing)])


def fitted(
    unit: float = 1.0,
    *,
    delay: float = DELAY,
    reach: float = 0.0,
    robust: bool = False,
    knocks: float = 0.0,
) -> _core.FittedShift | None:
    rng = np.random.default_rng(2)
    noise = 0.05 * rng.normal(size=TIME.size)
    for place in rng.integers(0, TIME.size - 40, 12):
        noise[place : place + 20] += knocks * rng.choice([-1.0, 1.0])
    windows = _core.SmoothWindows(
        TIME,
        TIME,
        TIME,
        np.ones(TIME.size, dtype=bool),
        derived=False,
        half=20,
        margin=80,
    )
    weight = np.hanning(41)[1:-1] / 20.0
    around = np.asarray(windows.used)[:, None] + np.arange(-19, 20)
    return _core.fit_shift(
        [windows],
        [unit * (parts(TIME - delay).sum(axis=1) + noise)],
        np.asfortranarray(np.einsum("w,rwc->rc", weight, parts(TIME)[around])),
        conservative=1,
        held=False,
        reach=reach,
        robust=robust,
        least=0.0,
    )


def numbers(unit: float) -> list[float]:
    found = fitted(unit)
    assert found is not None
    return [*found.whole, *found.conservative, *found.friction]


def test_no_unit_changes_a_delay_or_its_error() -> None:
    usual = numbers(1.0)
    assert usual[0] == pytest.approx(DELAY, abs=3.0 * usual[1])
    assert 0.0 < usual[1] < 0.2 * DELAY
    for unit in (1e-4, 1e4):
        assert numbers(unit) == pytest.approx(usual, rel=1e-6)


def test_windows_that_miss_by_far_count_for_less() -> None:
    plain, robust = fitted(knocks=1.5), fitted(knocks=1.5, robust=True)
    assert plain is not None
    assert robust is not None
    assert abs(robust.whole[0] - DELAY) < 0.4 * abs(plain.whole[0] - DELAY)


def test_a_delay_beyond_twice_the_reach_is_none() -> None:
    assert fitted(delay=8e-3, reach=1e-3) is None
    far = fitted(delay=8e-3, reach=8e-3)
    assert far is not None
    assert far.whole[0] == pytest.approx(8e-3, abs=2e-4)
