"""What to do about each cause: an option of the model where there is one, else another recording or a look."""

from __future__ import annotations

from typing import Any

from jointid.base.advice import Action
from jointid.identification.causes.attributed import Attributed
from jointid.identification.causes.candidates import FILTERED
from jointid.identification.causes.fitted import Fitted

_HALF = 0.2  # of a sample period: so near to half a period early, a torque is one that is held
_HELD = Action(
    "call", {"torque_hold": "zoh"}, text="if the torque is a command that is held between samples"
)
_EARLY = "the sampling times of torque and position, and the gear's play"
_OTHERWISE: dict[str, tuple[Action, ...]] = {
    "inertia_varies": (
        Action("record", text="motion about one pose, or with a gentler acceleration"),
        Action("inspect", text="whether other joints change the inertia"),
    ),
    "presliding": (
        Action("record", text="longer strokes with fewer reversals"),
        Action("inspect", text="the friction just after each reversal"),
    ),
    "drift": (
        Action("record", text="after warming up"),
        Action("inspect", text="the values of the first and the last part of the recording"),
    ),
    "other_signal": (Action("record", text="with everything else at rest"),),
    "disturbance": (
        Action("record", text="without contact"),
        Action("inspect", text="what happened at that time"),
    ),
    "offset": (Action("call", {"torque_offset": True}, function="Joint"),),
    "wrong_scale": (Action("inspect", text="gear ratio, torque constant and inertia"),),
    "other_run": (
        Action(
            "inspect", text="units, signs, zero position, load and temperature of that recording"
        ),
        Action("inspect", text="the values of each recording, identified by itself"),
    ),
}
_SLOW = (Action("record", text="motion that passes zero speed faster, and slow motion by itself"),)


def advice_against(fit: Fitted, cause: Attributed) -> tuple[Action, ...]:
    """Return the actions against a cause."""
    name, detail = cause.candidate.name, cause.candidate.detail
    model = fit.problem.choice.model.resolved
    if name in _OTHERWISE:
        return _OTHERWISE[name]
    if name == "gravity":
        return (_model(fit, gravity="free"),)
    if name == "load_friction":
        return (_compared(fit, load_friction=True),)
    if name == "asymmetry":
        if "sensor_offset" in fit.names:
            return (Action("inspect", text="the friction in each direction"),)
        return (_compared(fit, asymmetric=True),)
    if name == "harmonic":
        return (_model(fit, harmonics=(*model.harmonics, float(detail))),)
    if name == "ripple":
        return (_model(fit, ripple=(*model.ripple, float(detail))),)
    if name == "delay" and detail == FILTERED:
        return (Action("call", {"columns": {"velocity": None}}, function="load"),)
    if name == "delay":
        early = -float(cause.coefficients[0]) / fit.problem.recordings[0].sample_period
        look = Action("inspect", text=f"when the {detail} is sampled and logged")
        if detail == "torque" and early > 0.0:  # a torque does not come before its motion
            look = Action("inspect", text=_EARLY)
        unheld = detail == "torque" and fit.problem.hold(0) != "zoh"
        return (_HELD, look) if unheld and abs(early - 0.5) < _HALF else (look,)
    # Friction at low speed: the next richer law where there is one.
    richer = {"coulomb_viscous": "stribeck", "stribeck": "stribeck_general"}.get(model.name)
    if richer is None or (richer == "stribeck_general" and model.asymmetric):
        return _SLOW
    return (_compared(fit, name=richer), *_SLOW)


def _model(fit: Fitted, **changes: Any) -> Action:
    """Identify with more in the model; the text has every field that is stated."""
    return Action("call", {"model": str(fit.problem.choice.model.replace(**changes))})


def _compared(fit: Fitted, **changes: Any) -> Action:
    """Compare with a richer law of friction, which the recording may not determine."""
    model = fit.problem.choice.model
    models = (str(model), str(model.replace(**changes)))
    return Action("call", {"models": models}, function="compare_models")
