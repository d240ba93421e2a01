"""Tables of a servo's parameters with their errors, and its estimate as text."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.advice import Action
from jointid.base.error_text import printable
from jointid.base.text_table import aligned
from jointid.estimate.statistics import ParameterEstimate
from jointid.estimate.wording import two_digits
from jointid.servo.layout import BACK_EMF, HELD, LOAD_FRICTION, MOTOR, TERMS, TORQUE
from jointid.servo.record import ServoEstimateRecord
from jointid.servo.solving import Unknowns
from jointid.servo.verdict import judged_servo

Array = NDArray[np.float64]

_LABEL = 8  # characters of a label
_MEANING = {
    "torque_per_voltage": ("torque of the motor per voltage, k_t / R", "N·m/V"),
    "back_emf": ("braking by back-EMF while driven, k_t² / R", "N·m·s/rad"),
    "torque_constant": ("torque constant k_t at the output", "N·m/A"),
    "resistance": ("resistance of the winding", "Ω"),
    **{term.name: (term.meaning, "" if term.unit == "1" else term.unit) for term in TERMS},
}


def parameters_of(
    values: Array,
    draws: Array,
    unknowns: Unknowns,
    units: int,
    moved: Mapping[str, Array],
) -> dict[str, ParameterEstimate]:
    """Return the parameters of a solution, with the errors from `draws`, (draws, size), of resampled units.

    `moved` contains the parameters with other windows and another lead.
    """
    facts = zip(MOTOR, (unknowns.torque_constant, unknowns.resistance), strict=True)
    given = {name: fact for name, fact in facts if fact is not None}
    known = {*unknowns.fixed, *given}
    if len(given) == len(MOTOR):
        known |= {"torque_per_voltage", "back_emf"}
    undivided = () if unknowns.divided else ("back_emf", unknowns.layout.linear, *MOTOR)
    # With few units the spread of the draws is too small by this factor, and the quantile is Student's.
    short = math.sqrt(units / max(units - 1.0, 1.0))
    quantile = float(_core.student_quantile(0.975, float(max(units - 1, 1))))
    own, sets = _with_motor(values[None])[0], _with_motor(draws)
    others = {part: _with_motor(other[None])[0] for part, other in moved.items()}
    found = {}
    for k, name in enumerate((*unknowns.layout.names, *MOTOR)):
        if name == LOAD_FRICTION.name and not unknowns.loaded:
            continue
        value = given.get(name, own[k])
        systematic = {part: abs(float(other[k]) - float(own[k])) for part, other in others.items()}
        p = _parameter(name, value, sets[:, k], name not in known, short, quantile, systematic)
        if p.vary and name in undivided:
            p = replace(p, stderr=np.inf, interval=(0.0, np.inf))
        found[name] = p
    return found


def _with_motor(values: Array) -> Array:
    """Return solutions with k_t = (k_t²/R) / (k_t/R) and R = k_t / (k_t/R) instead of `HELD`."""
    with np.errstate(divide="ignore", invalid="ignore"):
        k_t = values[:, BACK_EMF] / values[:, TORQUE]
        found = np.column_stack((values[:, :HELD], k_t, k_t / values[:, TORQUE]))
    return np.where(np.isfinite(found), found, np.inf)


def _parameter(
    name: str,
    value: float,
    draws: Array,
    free: bool,
    short: float,
    quantile: float,
    systematic: Mapping[str, float],
) -> ParameterEstimate:
    meaning, unit = _MEANING[name]
    at_bound = "min" if free and value <= 0.0 else None
    stderr, interval = None, None
    finite = draws[np.isfinite(draws)]
    if free and len(finite) > 1:
        spread = short * float(np.std(finite, ddof=1))
        half = quantile * math.hypot(spread, *systematic.values())
        stderr = None if at_bound else spread
        interval = (max(0.0, value - half), value + half)
    return ParameterEstimate(
        name=name,
        meaning=meaning,
        unit=unit,
        value=float(value),
        stderr=stderr,
        interval=interval,
        min=0.0,
        max=np.inf,
        vary=free,
        at_bound=at_bound,
        shift_halved=None,
        shift_doubled=None,
        systematic=systematic if free else {},
    )


def head() -> list[str]:
    """Return the table's head."""
    return ["parameter", "value", "± std. error", "95 % interval", "unit", "meaning"]


def rows(estimate: ServoEstimateRecord) -> list[list[str]]:
    """Return one row for each parameter."""
    return [
        [p.name, f"{p.value:.4g}", _error(p), _interval(p), p.unit or "1", p.meaning]
        for p in estimate.parameters.values()
    ]


def _error(p: ParameterEstimate) -> str:
    if not p.vary:
        return "given"
    if p.at_bound:
        return "at its bound"
    if p.stderr is None:
        return ""
    return "not known" if np.isinf(p.stderr) else two_digits(p.stderr)


def _interval(p: ParameterEstimate) -> str:
    if p.interval is None or np.isinf(p.interval[1]):
        return ""
    return f"{p.interval[0]:.3g} … {p.interval[1]:.3g}"


def text_report(estimate: ServoEstimateRecord, action: Callable[[Action], str] = str) -> str:
    """Return the report of `ServoEstimate.report`; `action` gives the text of an advice."""
    name = estimate.joint.name or "servo"
    lines = [
        f"{name}: {', '.join(text for _, text in recorded(estimate))}",
        "",
        *judged_servo(estimate).lines(),
        "",
        *aligned([head(), *rows(estimate)]),
        "",
        *(f"{label.ljust(_LABEL)}  {text}" for label, text in quality(estimate)),
    ]
    if estimate.findings:
        lines += ["", "Findings"]
        lines += [f"- {each.code}: {each.worded(action)}" for each in estimate.findings]
    return printable("\n".join(lines))


def recorded(estimate: ServoEstimateRecord) -> list[tuple[str, str]]:
    """Return the inputs of the estimate, as pairs of label and text."""
    runs, used = len(estimate.runs), float(np.mean(estimate.moving))
    return [
        ("runs", f"{runs} run{'s' * (runs != 1)}"),
        ("windows", f"{estimate.windows} windows of {1e3 * estimate.window:g} ms"),
        ("used", f"{100.0 * used:.0f} % of the time used"),
    ]


def quality(estimate: ServoEstimateRecord) -> list[tuple[str, str]]:
    """Return the quality of the fit and its inputs, as pairs of label and text."""
    left = (
        f"residual {1e3 * estimate.rms:.3g} mN·m, "
        f"{100.0 * estimate.relative_residual:.1f} % of the load's torque"
    )
    return [
        ("fit", left),
        ("rows", _lead(estimate)),
        *_command(estimate),
        ("time", f"{1e3 * estimate.seconds:.0f} ms"),
    ]


def _lead(estimate: ServoEstimateRecord) -> str:
    shown = f"a row's position is {1e3 * estimate.lead:.1f} ms older than its duty"
    if estimate.lead_found:
        return f"{shown} (found)"
    return f"{shown} (given)" if estimate.lead else "position and duty are taken as simultaneous"


def _command(estimate: ServoEstimateRecord) -> list[tuple[str, str]]:
    if estimate.command_lag is None:
        return []
    if estimate.command_lag == 0.0:
        text = "interpolated linearly: no evidence that the command is held between rows"
        return [("command", text)]
    late = f"{1e3 * estimate.command_lag:.1f} ms"
    text = f"held between rows; the command acts {late} after its row on average (identified)"
    return [("command", text)]
