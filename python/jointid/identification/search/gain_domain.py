"""Bounds of a sensor gain when the caller sets none: sign and size by least squares with either sign."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.balance.least_squares import bounded_minima
from jointid.base.errors import InputError
from jointid.base.values import dataclass

# A gain lies within this factor of the least-squares value, which may be very wrong in a motion with mostly
# friction, where no shape fits well ...
_ROOM = 100.0
# ... or between these multiples of the gain that makes the sensor's standard deviation equal to the torque's.
_LEAST, _MOST = 0.001, 10.0
# Wrong signs occurred up to a contrast of 1.023 (motions of 2 and 5 degrees, mostly friction).
_CLEAR = 1.03

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class GainGuess:
    """Sensor gain by least squares.

    Attributes
    ----------
    value : float
        Gain with its sign; 0 if no gain of either sign improves the fit.
    sign : float
        1 or -1.
    swing : float
        Gain that makes the sensor's standard deviation equal to the torque's.
    contrast : float
        Residual of the best gain with the other sign over the residual of this gain; infinite if only one sign
        is allowed.
    """

    value: float
    sign: float
    swing: float
    contrast: float

    @property
    def clear(self) -> bool:
        """Whether the recording determines the sign."""
        return self.contrast > _CLEAR

    @property
    def bounds(self) -> tuple[float, float]:
        """Lower and upper bound, both of the same sign."""
        size = abs(self.value) if self.value != 0.0 else self.swing
        low = min(size / _ROOM, _LEAST * self.swing)
        high = max(size * _ROOM, _MOST * self.swing)
        return (low, high) if self.sign > 0.0 else (-high, -low)


def around(value: float) -> tuple[float, float]:
    """Return bounds around a gain that the caller sets without bounds."""
    ends = sorted((value / _ROOM, value * _ROOM))
    return ends[0], ends[1]


def guess_gain(
    penalty: _core.Penalty,
    columns: Iterable[Array],
    fixed: Mapping[str, float],
    signs: tuple[float, ...] = (1.0, -1.0),
) -> GainGuess:
    """Return the gain, of either sign, that fits best with friction coefficients of 0 or more.

    The zero and polarity of a sensor are arbitrary. Therefore neither the product of reading and torque nor the
    size of the reading determines the gain. In a small motion, a gain with the wrong sign fits if friction is
    negative; negative friction is therefore excluded. The reading is regressed on the torque, because the torque has
    less noise. If the reading is projected on instruments, the torque is regressed on the reading, as in the
    fit. In a small motion the reading is a small part of the balance, and an error of the other terms can reverse
    the sign of the other regression.

    Parameters
    ----------
    penalty : Penalty
        Penalty with a sensor.
    columns : iterable of ndarray, shape (windows, coefficients)
        Integrals of the terms, for some shapes of the Stribeck term.
    fixed : mapping of str to float
        Values of the fixed coefficients.
    signs : tuple of float
        Signs that the bounds allow. Default: both.

    Raises
    ------
    InputError
        The reading does not vary.
    """
    best, value, swing = np.inf, 0.0, 0.0
    misfits = dict.fromkeys((1.0, -1.0), np.inf)
    projected: Array | None = None
    for each in columns:
        swing = swing or _swing(penalty, each)
        if penalty.first_stage is not None and projected is None:
            projected = _projected(penalty)
        for sign in signs:
            misfit, gain = _fitted(penalty, each, projected, fixed, sign)
            misfits[sign] = min(misfits[sign], misfit)
            if misfit < best * (1.0 - 1e-9):
                best, value = misfit, gain
    return GainGuess(
        value=value,
        sign=np.sign(value) or signs[0],
        swing=swing,
        contrast=max(misfits.values()) / max(best, 1e-300),
    )


def _swing(penalty: _core.Penalty, columns: Array) -> float:
    column = columns[:, penalty.names.index("sensor_gain")]
    reading = column / penalty.usable_duration
    mean = float(column.sum() / penalty.usable_duration.sum())
    spread = float(np.std(reading))
    if spread <= 1e-9 * max(abs(mean), 1e-300):
        raise InputError(
            "the reading never changes, so the sensor gain cannot be identified",
            argument="sensor",
            place="recording",
            remedy="check the column, or leave the sensor out",
        )
    return float(np.std(penalty.target / penalty.usable_duration)) / spread


def _projected(penalty: _core.Penalty) -> Array:
    """Return the projected reading, which does not depend on a shape; `penalty.columns` has the original reading."""
    columns = penalty.linear_columns(np.ones(len(penalty.names)))
    return np.array(columns[:, penalty.names.index("sensor_gain")])


def _fitted(
    penalty: _core.Penalty,
    columns: Array,
    projected: Array | None,
    fixed: Mapping[str, float],
    sign: float,
) -> tuple[float, float]:
    """Return residual and gain. Friction is not negative; the gain has this sign or is 0."""
    names = penalty.names[: penalty.coefficients]
    of_gain = names.index("sensor_gain")
    torque = np.array(penalty.target)
    signed: list[int] = []
    free: list[int] = []
    for index, (name, term) in enumerate(zip(names, penalty.terms, strict=False)):
        if index == of_gain:
            continue
        if name in fixed:
            torque -= fixed[name] * columns[:, index]
        else:
            (signed if term.non_negative else free).append(index)
    reading = columns[:, of_gain] if projected is None else projected
    reversed_roles = penalty.residual != _core.Residual.torque and projected is None
    if reversed_roles:
        # reading = (torque - other terms) / gain: linear in 1 / gain and in the other coefficients / gain.
        sides, target = [sign * torque, *(-sign * columns[:, i] for i in signed)], reading
    else:
        sides, target = [sign * reading, *(columns[:, i] for i in signed)], torque
    matrix = np.column_stack(sides)
    whole = np.column_stack([*(columns[:, i] for i in free), matrix, target])
    sizes = np.linalg.norm(whole, axis=0)
    sizes[sizes == 0.0] = 1.0
    triangle: Array = np.asarray(np.linalg.qr(whole / sizes, mode="r"))
    rest = triangle[len(free) :, len(free) :]  # without the terms that may have either sign
    left, right = rest[:, :-1], rest[:, -1]
    solution = bounded_minima((left.T @ left)[None], -(left.T @ right)[None], 0.0, np.inf)[0]
    misfit = float(np.linalg.norm(left @ solution - right))
    lead = float(sign * solution[0] * sizes[-1] / sizes[len(free)])
    if lead == 0.0:
        return misfit, 0.0
    return misfit, 1.0 / lead if reversed_roles else lead
