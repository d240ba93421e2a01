"""Friction from a table of steady speeds and torques; without acceleration there is no inertia."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.errors import InputError
from jointid.base.text_table import aligned
from jointid.base.values import dataclass
from jointid.estimate.student import quantile
from jointid.estimate.tables import shown_name
from jointid.estimate.wording import number, percent, two_digits

Array = NDArray[np.float64]

_FLOOR = 1e-4  # of the rms torque: a smaller residual is rounding, and justifies no further term
_SHAPES = 40  # number of tried Stribeck shapes
_ZOOMS = 3  # number of refinements of the grid around the best shape
_CERTAIN = 3.0  # standard errors: least improvement by a further term, and least static friction
_SPARE = 2  # least number of rows in excess of the parameters
_UNITS = {"viscous": ("N·m·s/rad", "N·s/m"), "stribeck": ("s²/rad²", "s²/m²")}


@dataclass(frozen=True, slots=True, kw_only=True)
class SteadyFriction:
    """Friction map from steady speeds.

    Attributes
    ----------
    values, errors : mapping of str to float
        Parameter values, named as in `Estimate`, and their standard errors.
    kind : str
        "revolute" or "prismatic".
    speeds : tuple of float
        Smallest and largest speed [rad/s or m/s].
    directions : int
        Number of directions, 1 or 2.
    rows, at_rest : int
        Number of fitted rows, and of rows at rest, which are not used because friction at rest is set-valued.
    rms : float
        Root mean square of the residual [N·m or N].
    share : float
        `rms` over the rms torque.
    assumed : tuple of str
        Signals without a stated unit; SI is assumed.
    """

    values: Mapping[str, float]
    errors: Mapping[str, float]
    kind: str
    speeds: tuple[float, float]
    directions: int
    rows: int
    at_rest: int
    rms: float
    share: float
    assumed: tuple[str, ...] = ()

    def document(self) -> dict[str, object]:
        """Return the map in JSON's types."""
        parameters = {
            name: {
                "value": value,
                "stderr": self.errors[name],
                "interval": list(self._interval(name)),
                "unit": self._unit(name),
            }
            for name, value in self.values.items()
        }
        others = ("kind", "speeds", "directions", "rows", "at_rest", "rms", "share", "assumed")
        return {"friction_map": {"parameters": parameters} | {k: getattr(self, k) for k in others}}

    def report(self) -> str:
        """Return the map as text."""
        table = [("parameter", "value", "± std. error", "95 % interval", "unit")]
        for name, value in self.values.items():
            low, high = self._interval(name)
            error = two_digits(self.errors[name])
            shown = (shown_name(name), number(value), error, f"{low:.5g} … {high:.5g}")
            table.append((*shown, self._unit(name)))
        torque, speed = ("N·m", "rad/s") if self.kind == "revolute" else ("N", "m/s")
        ways = "both directions" if self.directions == 2 else "one direction"
        rest = f"; {self.at_rest} at rest left out" if self.at_rest else ""
        lines = [
            *("friction map of steady speeds", "", *aligned(table), ""),
            f"speeds     {self.speeds[0]:.4g} … {self.speeds[1]:.4g} {speed} in {ways}, {self.rows} rows{rest}",
            f"fit        residual {two_digits(self.rms)} {torque} rms, {percent(self.share)} of the torque",
            "missing    inertia and gravity: a table of steady speeds has no acceleration and no position; for "
            "inertia and gravity, record time, position and torque of a motion",
        ]
        if self.assumed:
            lines.append(f"note       SI units assumed: {', '.join(self.assumed)}")
        if any(self.values[name] < 0.0 for name in self.values if name.startswith("coulomb")):
            lines.append(
                "warning    friction is negative: the torque must have the sign of the speed; check the signs"
            )
        elif "coulomb_positive" in self.values:
            lines.append(
                "note       an offset of the torque looks like a difference between coulomb_positive and "
                "coulomb_negative"
            )
        return "\n".join(lines)

    def _interval(self, name: str) -> tuple[float, float]:
        half = quantile(0.975, self.rows - len(self.values)) * self.errors[name]
        return self.values[name] - half, self.values[name] + half

    def _unit(self, name: str) -> str:
        base = name.partition("_")[0]
        return _UNITS.get(base, ("N·m", "N"))[self.kind == "prismatic"]


def steady_friction(velocity: Array, torque: Array, kind: str = "revolute") -> SteadyFriction:
    """Fit friction to steady speeds and torques by plain least squares.

    The model is Coulomb and viscous friction. Separate values per direction, and Stribeck friction, are added if each
    further parameter reduces the residual by at least three standard errors.

    Parameters
    ----------
    velocity, torque : ndarray, shape (n,)
        Speeds and torques: [rad/s] and [N·m], or [m/s] and [N].
    kind : str
        "revolute" or "prismatic".

    Raises
    ------
    InputError
        There are too few rows or speeds.
    """
    moving = velocity != 0.0
    v, tau = velocity[moving], torque[moving]
    directions = len(set(np.sign(v).tolist()))
    fits = [fit for terms in _models(directions) if (fit := _fitted(terms, v, tau)) is not None]
    if not fits:
        raise InputError(
            f"the table has {len(v)} rows with {len(set(np.abs(v).tolist()))} different speeds above 0; a friction map "
            f"needs at least {2 + _SPARE} rows and two speeds in each of its directions"
        )
    _, values, errors, rms = min(fits, key=lambda fit: fit[0])
    speeds = np.abs(v)
    return SteadyFriction(
        values=values,
        errors=errors,
        kind=kind,
        speeds=(float(speeds.min()), float(speeds.max())),
        directions=directions,
        rows=len(v),
        at_rest=int(np.count_nonzero(~moving)),
        rms=rms,
        share=rms / float(np.sqrt(np.mean(tau**2))) if np.any(tau) else 0.0,
    )


_Fit = tuple[float, dict[str, float], dict[str, float], float]
_WAYS = ("_positive", "_negative")


def _models(directions: int) -> list[list[str]]:
    """Return the candidates' terms: different sets of terms per direction, with and without Stribeck friction."""
    own = [(), ("coulomb",), ("coulomb", "viscous"), ("coulomb", "static", "viscous")]
    return [
        [f"{name}{way}" for name in names for way in (_WAYS if name in apart else ("",))]
        for apart in (own if directions == 2 else own[:1])
        for names in (("coulomb", "viscous"), ("coulomb", "static", "viscous"))
        if set(apart) <= set(names)
    ]


def _fitted(terms: Sequence[str], v: Array, tau: Array) -> _Fit | None:
    """Return criterion, values, standard errors and rms of a model; None if the rows do not determine it."""
    falls = any(term.startswith("static") for term in terms)
    count = len(terms) + falls
    if len(v) < count + _SPARE:
        return None
    shape = _best_shape(terms, v, tau) if falls else 0.0
    basis = _basis(terms, v, shape)
    found = np.linalg.lstsq(basis, tau, rcond=None)[0]
    square = float(np.sum((tau - basis @ found) ** 2))
    jacobian = basis
    if falls:
        step = 1e-4 * shape
        slope = (_basis(terms, v, shape + step) - _basis(terms, v, shape - step)) @ found
        jacobian = np.column_stack([basis, slope / (2.0 * step)])
    scale = np.linalg.norm(jacobian, axis=0)
    if not np.all(scale > 0.0) or np.linalg.matrix_rank(jacobian / scale, tol=1e-8) < count:
        return None
    normal = np.linalg.inv((jacobian / scale).T @ (jacobian / scale))
    errors = np.sqrt(np.diag(normal) * square / (len(v) - count)) / scale
    names = [*terms, *(["stribeck"] if falls else [])]
    values = dict(zip(names, map(float, (*found, *([shape] if falls else []))), strict=True))
    known = dict(zip(names, map(float, errors), strict=True))
    if any(values[name] < _CERTAIN * known[name] for name in terms if name.startswith("static")):
        return None
    floor = len(v) * (_FLOOR**2) * float(np.mean(tau**2))
    criterion = len(v) * math.log(max(square, floor, 1e-300) / len(v)) + count * _CERTAIN**2
    return criterion, values, known, math.sqrt(square / len(v))


def _basis(terms: Sequence[str], v: Array, shape: float) -> Array:
    return np.column_stack(
        [
            _core.friction_basis(term, v, np.array([shape] if term.startswith("static") else []))
            for term in terms
        ]
    )


def _best_shape(terms: Sequence[str], v: Array, tau: Array) -> float:
    """Return the Stribeck shape (4-1) with the smallest residual; the decay is between slowest and fastest rows."""
    speeds = np.abs(v)
    low, high = math.log(1.0 / float(speeds.max()) ** 2), math.log(4.0 / float(speeds.min()) ** 2)
    best = low
    for _ in range(1 + _ZOOMS):
        grid = np.linspace(low, high, _SHAPES)
        misfits = []
        for each in grid:
            basis = _basis(terms, v, math.exp(each))
            found = np.linalg.lstsq(basis, tau, rcond=None)[0]
            misfits.append(float(np.sum((tau - basis @ found) ** 2)))
        best = float(grid[int(np.argmin(misfits))])
        step = (high - low) / (_SHAPES - 1)
        low, high = best - step, best + step
    return math.exp(best)
