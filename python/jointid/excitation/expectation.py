"""Expected errors of a motion, and the cause that limits the largest."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.excitation.design import Design
from jointid.excitation.expected_error import ExpectedError
from jointid.excitation.judging import Situation
from jointid.excitation.rehearsal import Rehearsal

Array = NDArray[np.float64]

_REACHED = 0.95  # share of a limit
_LARGE = 0.3  # relative error of a parameter that is hardly determined
_WEAKEST = 1e-13  # eigenvalue of a correlation matrix
_TOGETHER = 0.8  # correlation above which two errors count as correlated


def expected_errors(
    situation: Situation,
    judgements: Sequence[_core.MotionJudgement],
    values: Sequence[dict[str, float]],
    rehearsal: Rehearsal,
) -> dict[str, ExpectedError]:
    """Return the expected error of each wanted parameter.

    The errors counted in the rehearsal hold for the nominal joint. Errors of other joints grow by the same
    factor as their errors from the information. With information from other recordings, this motion's
    information shrinks by the same factors, so that prior knowledge can only reduce an error.
    """
    request, ranges = situation.request, situation.ranges
    units = _units(situation)
    counted = rehearsal.rms()
    known = bool(np.any(situation.known))
    scales = np.array([ranges.scale(name, values[0][name]) for name in request.names])
    alone = _alone(judgements[0].information) if known else scales * judgements[0].errors
    factors = [
        max(1.0, counted[name] / float(alone[place])) for place, name in enumerate(request.names)
    ]
    if known:
        stretch = np.outer(factors, factors)
        errors = [_alone(each.information / stretch + situation.known) for each in judgements]
    found = {}
    for place, name in enumerate(request.names):
        if name not in request.wanted:
            continue
        scale = ranges.scale(name, values[0][name])
        if known:
            stderr = float(errors[0][place])
            shares = [
                float(error[place]) / ranges.scale(name, joint[name])
                for error, joint in zip(errors, values, strict=True)
            ]
        else:
            stderr = counted[name]
            shares = [factors[place] * float(each.errors[place]) for each in judgements]
        found[name] = ExpectedError(
            name=name,
            unit=units.get(name, ""),
            value=values[0][name],
            stderr=stderr,
            relative=stderr / scale,
            worst=max(stderr / scale, *(shares[1:] or shares)),
        )
    return found


def what_limits(design: Design, situation: Situation, judgement: _core.MotionJudgement) -> str:
    """Return one sentence with the causes: limits that are reached, correlated parameters, noise and duration."""
    reasons = []
    if not design.parameters[design.weakest].relative < _LARGE:
        reasons.append("no motion within the limits determines this parameter")
    reached = [name.replace("_", " ") for name, share in design.shares.items() if share >= _REACHED]
    limits = [f"the limit of {' and '.join(reached)}"] if reached else []
    limits.append(f"the duration of {design.duration:g} s and the noise of the sensors")
    text = "; ".join((*reasons, f"causes: {', '.join(limits)}"))
    partner = _partner(situation, judgement, design.weakest)
    return text + (f"; the error is correlated with the error of {partner}" if partner else "")


def _partner(situation: Situation, judgement: _core.MotionJudgement, weakest: str) -> str:
    names = situation.request.names
    covariance = np.linalg.pinv(judgement.information + situation.known, hermitian=True)
    size = np.sqrt(np.maximum(np.diag(covariance), 1e-300))
    row = np.abs(covariance / np.outer(size, size))[names.index(weakest)]
    row[names.index(weakest)] = 0.0
    best = int(np.argmax(row))
    return f"{names[best]} (correlation {row[best]:.2f})" if row[best] > _TOGETHER else ""


def _alone(information: Array) -> Array:
    """Return the standard errors from an information matrix; infinite where it is zero."""
    seen = np.sqrt(np.maximum(np.diag(information), 0.0))
    size = np.where(seen > 0.0, seen, 1.0)
    strength, directions = np.linalg.eigh(information / np.outer(size, size))
    errors = np.sqrt(directions**2 @ (1.0 / np.maximum(strength, _WEAKEST))) / size
    return np.where(seen > 0.0, errors, np.inf)


def _units(situation: Situation) -> dict[str, str]:
    prismatic = situation.joint.kind == "prismatic"
    rows = [_core.term(key) for key in situation.request.terms]
    units = {row.name: row.unit_prismatic if prismatic else row.unit for row in rows}
    shapes = {row.name: row.unit_prismatic if prismatic else row.unit for row in _core.shapes()}
    return units | shapes
