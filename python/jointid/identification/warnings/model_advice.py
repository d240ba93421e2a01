"""Models as text for advice, e.g. "stribeck:ripple=2"."""

from jointid.identification.warnings.evidence import Evidence


def model_with_ripple(evidence: Evidence, order: float) -> str:
    """The model used, with one more order of ripple."""
    return _text(evidence, evidence.model, (*evidence.problem.choice.ripple, order))


def simpler_model(evidence: Evidence) -> str:
    """The model used, without the Stribeck effect."""
    return _text(evidence, "coulomb_viscous", evidence.problem.choice.ripple)


def _text(evidence: Evidence, name: str, ripple: tuple[float, ...]) -> str:
    choice = evidence.problem.choice
    parts = [name]
    parts += ["asymmetric"] if choice.asymmetric else []
    for option, orders in (("ripple", ripple), ("harmonics", choice.harmonics)):
        if orders:
            parts.append(f"{option}={','.join(f'{order:g}' for order in orders)}")
    parts += ["load_friction"] if choice.load_friction else []
    return ":".join(parts)
