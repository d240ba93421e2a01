"""Model that a finding advises, as text for all interfaces."""

from __future__ import annotations

from jointid.base.advice import Action
from jointid.identification.warnings.evidence import Evidence


def add_ripple(evidence: Evidence, order: float) -> Action:
    """Add one order of ripple to the identified model. If the order is present, its coefficients are fixed or bounded.

    The text has every stated field, including defaults, because the joint's value replaces an omitted field.
    """
    model = evidence.problem.choice.model
    modelled = model.resolved.ripple
    if order in modelled:
        names = f"ripple_cos_{order:g} and ripple_sin_{order:g}"
        text = f"the values and bounds of {names}, and free them"
        return Action("inspect", text=text)
    return Action("call", {"model": str(model.replace(ripple=(*modelled, order)))})


def simpler_model(evidence: Evidence) -> str:
    """Return the identified model without the Stribeck effect, with every stated field."""
    return str(evidence.problem.choice.model.replace(name="coulomb_viscous"))
