"""Terms of a joint's model, and checks whether a simulation or a controller can use them."""

from collections.abc import Collection, Sequence
from typing import Any

from jointid import _core
from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.joint.joint import Joint

# Fields of a model that switch terms on, and the value that switches them off.
_OFF: dict[str, Any] = {
    "gravity": "none",
    "load_friction": False,
    "ripple": (),
    "harmonics": (),
    "terms": {},
}


def terms_of(joint: Joint) -> tuple[_core.Term, ...]:
    """Return the terms of a joint's torque balance, in the core's order. A family is one entry."""
    model = joint.model.resolved
    friction = _core.model_terms(model.name, asymmetric=model.asymmetric)
    # Switches of the joint. A model's field switches on the terms that name it.
    present = {
        "": True,
        "gravity": model.gravity != "none",
        "torque_offset": _has_value(joint, "torque_offset"),
        "sensor": joint.sensor,
    }
    return tuple(
        term
        for term in _core.terms()
        if not (term.needs_load and term.behind_gear != (model.load_friction == "link"))
        and (
            term.key in friction
            if term.option == "name"
            else present.get(term.option, bool(getattr(model, term.option, False)))
        )
    )


def require_simulated(joint: Joint, terms: Sequence[_core.Term]) -> None:
    """Refuse a joint with a term that the simulated joint does not have."""
    usable = {term.key for term in _core.terms() if term.simulated}
    for term in terms:
        if not term.simulated:
            raise _refusal(
                joint, term, f"a simulation does not have {_named(term)}", usable, "Joint"
            )


def require_compensated(joint: Joint, terms: Sequence[_core.Term]) -> None:
    """Refuse a joint with a term that a controller neither has nor may omit."""
    refused = _core.Control.refused
    usable = {term.key for term in _core.terms() if term.control != refused}
    for term in terms:
        if term.control == refused:
            reason = f"controllers do not compensate {_named(term)}"
            raise _refusal(joint, term, reason, usable, "identify")


def require_used(terms: Sequence[_core.Term], used: Collection[str]) -> None:
    """Raise if the core declares a term as usable, but its value was not read here."""
    for term in terms:
        names = () if term.family else (term.name, *term.shapes)
        for name in names:
            if name not in used:
                raise NotImplementedError(f"the value of '{name}' is not used")


def _named(term: _core.Term) -> str:
    return f"the term '{term.key}', {term.meaning}"


def _refusal(
    joint: Joint, term: _core.Term, reason: str, usable: Collection[str], function: str
) -> InputError:
    """Return the error. Its remedy is another friction model, or the term's option switched off."""
    if term.option != "name":
        if term.option not in _OFF:
            return InputError(reason, argument=term.option, value=True)
        value = getattr(joint.model.resolved, term.option)
        model = joint.model.replace(**{term.option: _OFF[term.option]})
        remedy = Action("call", {"model": str(model)}, function=function)
        return InputError(reason, argument=term.option, value=value, remedy=remedy)
    models = [model.name for model in _core.models() if set(model.terms) <= set(usable)]
    other = str(joint.model.replace(name=models[-1]))
    remedy = Action("call", {"model": other}, f"usable are {', '.join(models)}", function=function)
    return InputError(reason, argument="model", value=joint.model.resolved.name, remedy=remedy)


def _has_value(joint: Joint, name: str) -> bool:
    parameter = joint.parameters.get(name)
    return parameter is not None and parameter.value is not None
