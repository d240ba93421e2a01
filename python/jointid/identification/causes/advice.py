"""What to do about each cause: an option of the model where there is one, else another recording or a look."""

from __future__ import annotations

from collections.abc import Callable

from jointid.base.advice import Action
from jointid.identification.causes.attribution import Attributed
from jointid.identification.causes.fitted import Fitted
from jointid.joint.model import Model


def advice(fit: Fitted, cause: Attributed) -> tuple[Action, ...]:
    """Return the actions against a cause."""
    return _ADVICE[cause.candidate.name](fit, cause)


def _model(fit: Fitted, **changes: object) -> Action:
    """Identify with more in the model; the text has every field that is stated."""
    model: Model = fit.problem.choice.model.replace(**changes)
    return Action("call", {"model": str(model)})


def _gravity(fit: Fitted, cause: Attributed) -> tuple[Action, ...]:
    return (_model(fit, gravity="free"),)


def _inertia_varies(fit: Fitted, cause: Attributed) -> tuple[Action, ...]:
    return (
        Action("record", text="motion about one pose, or with a gentler acceleration"),
        Action("inspect", text="whether other joints change the inertia during the recording"),
    )


def _load_friction(fit: Fitted, cause: Attributed) -> tuple[Action, ...]:
    return (_model(fit, load_friction=True),)


def _slow_motion(fit: Fitted, cause: Attributed) -> tuple[Action, ...]:
    if any(name.startswith("static") for name in fit.names):
        return _stribeck_exponent(fit, cause)
    return (_model(fit, name="stribeck"),)


def _stribeck_exponent(fit: Fitted, cause: Attributed) -> tuple[Action, ...]:
    resolved = fit.problem.choice.model.resolved
    slow = Action("record", text="motion that passes zero speed faster, and slow motion apart")
    if resolved.name == "stribeck" and not resolved.asymmetric:
        return (_model(fit, name="stribeck_general"), slow)
    return (slow,)


def _presliding(fit: Fitted, cause: Attributed) -> tuple[Action, ...]:
    return (
        Action("record", text="longer strokes with fewer reversals"),
        Action("inspect", text="the friction just after each reversal"),
    )


def _drift(fit: Fitted, cause: Attributed) -> tuple[Action, ...]:
    return (
        Action("record", text="after warming up, or shorter, with the temperature"),
        Action("inspect", text="the values of the recording's first and last part, identified apart"),
    )


def _harmonic(fit: Fitted, cause: Attributed) -> tuple[Action, ...]:
    modelled = fit.problem.choice.model.resolved.harmonics
    return (_model(fit, harmonics=(*modelled, float(cause.candidate.detail))),)


def _ripple(fit: Fitted, cause: Attributed) -> tuple[Action, ...]:
    modelled = fit.problem.choice.model.resolved.ripple
    return (_model(fit, ripple=(*modelled, float(cause.candidate.detail))),)


def _delay(fit: Fitted, cause: Attributed) -> tuple[Action, ...]:
    return (Action("inspect", text=f"when the {cause.candidate.detail} is sampled and logged"),)


def _other_signal(fit: Fitted, cause: Attributed) -> tuple[Action, ...]:
    return (Action("record", text="with everything else at rest"),)


def _disturbance(fit: Fitted, cause: Attributed) -> tuple[Action, ...]:
    return (
        Action("record", text="without contact, or identify the parts before and after it"),
        Action("inspect", text=f"what happened from {cause.candidate.detail}"),
    )


def _asymmetry(fit: Fitted, cause: Attributed) -> tuple[Action, ...]:
    return (_model(fit, asymmetric=True),)


def _offset(fit: Fitted, cause: Attributed) -> tuple[Action, ...]:
    return (Action("call", {"torque_offset": True}, function="Joint"),)


def _wrong_scale(fit: Fitted, cause: Attributed) -> tuple[Action, ...]:
    return (
        Action("inspect", text="gear ratio, torque constant and inertia"),
        Action("call", {"parameters": {"inertia": {"vary": True}}}, text="to free the inertia"),
    )


_ADVICE: dict[str, Callable[[Fitted, Attributed], tuple[Action, ...]]] = {
    "gravity": _gravity,
    "inertia_varies": _inertia_varies,
    "load_friction": _load_friction,
    "slow_motion": _slow_motion,
    "presliding": _presliding,
    "stribeck_exponent": _stribeck_exponent,
    "drift": _drift,
    "harmonic": _harmonic,
    "ripple": _ripple,
    "delay": _delay,
    "other_signal": _other_signal,
    "disturbance": _disturbance,
    "asymmetry": _asymmetry,
    "offset": _offset,
    "wrong_scale": _wrong_scale,
}
