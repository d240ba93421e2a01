"""MATLAB: a struct with parameters, units, uncertainty, and lookup tables for Simulink."""

from __future__ import annotations

import io
from collections.abc import Sequence
from typing import Any

import numpy as np

from jointid.base.errors import InputError
from jointid.exports.identifiers import identifier, parameter_identifier
from jointid.exports.law import Centred
from jointid.exports.provenance import statements
from jointid.exports.subject import ExportedValue, Subject
from jointid.exports.tables import speed_scale
from jointid.exports.target import Order, Target

_ROWS = 201  # rows of a lookup table, in each direction
_LONGEST = 63  # characters of a field's name in MATLAB


def _write(subject: Subject, order: Order) -> bytes:
    try:
        from scipy.io import savemat
    except ModuleNotFoundError as error:
        raise InputError(
            "a MATLAB file needs the package scipy, which is not installed",
            remedy="pip install scipy",
        ) from error
    notes = [
        "friction.velocity has no row at 0: between the two middle rows, interpolation gives a steep line through 0",
        "NaN stands for an unknown value",
    ]
    if subject.law.loaded_by:
        notes.append("lookup tables are valid at zero load; load_friction is the friction per load")
    if subject.speed is None:
        notes.append("the range of the tables is arbitrary, because the range of speeds is unknown")
    law = subject.law
    if law.centred:
        notes.append(
            "position_torque.centred and position_inertia: cos * (cos(position - centre) - 1) + sin * sin(position "
            "- centre); if the inertia varies, the torque also needs slope * velocity^2 / 2"
        )
    struct = {
        "name": subject.joint.name,
        "kind": subject.joint.kind,
        "model": subject.model,
        "source": subject.source,
        "date": subject.date,
        "jointid_version": subject.version,
        "statements": np.array(statements(subject, notes=notes), dtype=object),
        "units": {
            "position": subject.position_unit,
            "velocity": f"{subject.position_unit}/s",
            "torque": subject.torque_unit,
        },
        "parameters": {
            parameter_identifier(each.name)[:_LONGEST]: _parameter(each) for each in subject.values
        },
        "undetermined": np.array(subject.undetermined, dtype=object),
        "findings": np.array(subject.findings, dtype=object),
        "gear_ratio": law.gear_ratio,
        "torque_constant": _known(subject.joint.torque_constant),
        "inertia": _known(law.inertia),
        "link_inertia": law.link_inertia,
        "torque_offset": law.offset,
        "friction": _friction(subject),
        "position_torque": _periods(subject),
        "position_inertia": _centred(law.functions("inertia")),
        "limits": {
            name: _known(getattr(subject.joint.limits, name))
            for name in ("velocity", "torque", "current")
        },
    }
    if law.sensor is not None:
        struct["sensor"] = {"gain": law.sensor[0], "offset": law.sensor[1]}
    content = io.BytesIO()
    name = identifier(order.name)[:_LONGEST]
    savemat(
        content,  # type: ignore[arg-type]  # the stubs know names of files alone
        {name: struct},
        long_field_names=True,
        oned_as="column",
    )
    return content.getvalue()


def _parameter(value: ExportedValue) -> dict[str, Any]:
    return {
        "name": value.name,
        "value": value.value,
        "unit": value.unit,
        "meaning": value.meaning,
        "standard_error": _known(value.stderr),
        "interval": np.array(value.interval or (np.nan, np.nan)),
        "remark": value.remark,
    }


def _known(value: float | None) -> float:
    return float("nan") if value is None else value


def _friction(subject: Subject) -> dict[str, Any]:
    """Return the friction over the speed for each direction, and for both in one table with increasing velocity."""
    law, peak = subject.law, speed_scale(subject)
    # More rows at low speed, for the Stribeck curve.
    speed = peak * np.linspace(0.0, 1.0, _ROWS) ** 2
    speed[0] = 1e-6 * peak
    positive, negative = law.friction_torque(speed), law.friction_torque(-speed)
    return {
        "velocity": np.concatenate([-speed[::-1], speed]),
        "torque": np.concatenate([negative[::-1], positive]),
        "positive": {"speed": speed, "torque": positive},
        "negative": {"speed": speed, "torque": -negative},
    }


def _periods(subject: Subject) -> dict[str, Any]:
    """Return gravity, torques over the joint's angle, and ripple over the motor's angle, by order."""
    periods: dict[str, Any] = {"centred": _centred(subject.law.functions("torque"))}
    for over in ("gravity", "harmonics", "ripple"):
        found = [each for each in subject.law.harmonics if each.over == over]
        periods[over] = {
            "order": np.array([each.order for each in found]),
            "cos": np.array([each.cos for each in found]),
            "sin": np.array([each.sin for each in found]),
        }
    return periods


def _centred(found: Sequence[Centred]) -> dict[str, Any]:
    """Return an own function of the joint's angle; empty without one."""
    return {
        "centre": np.array([each.centre for each in found]),
        "cos": np.array([each.cos for each in found]),
        "sin": np.array([each.sin for each in found]),
    }


TARGET = Target(
    name="matlab", endings=(".mat",), meaning="MATLAB struct for Simulink", write=_write
)
