"""The model that a finding advises, as the text that every face takes."""

from __future__ import annotations

from jointid.identification.warnings.evidence import Evidence


def model_with_ripple(evidence: Evidence, order: float) -> str:
    """The identified model with one more order of ripple."""
    model = evidence.problem.choice.model
    return str(model.replace(ripple=(*model.resolved.ripple, order)).resolved)


def simpler_model(evidence: Evidence) -> str:
    """The identified model without the Stribeck effect."""
    return str(evidence.problem.choice.model.replace(name="coulomb_viscous").resolved)
