"""Load friction of the drive's torque, without a known value that fixes the scale of the balance."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from jointid.base.advice import Action
from jointid.estimate.findings import Finding
from jointid.estimate.statistics import ParameterEstimate
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence

LOAD_SCALE = FindingType(
    code="load_scale",
    severity="blocking",
    meaning="load friction is proportional to the drive's torque, and neither inertia nor gravity is known. All values "
    "multiplied by one factor then fit the data equally well",
    advice="leave load friction out, or state the joint's inertia or its link",
)


def scale_is_free(parameters: Mapping[str, ParameterEstimate], terms: tuple[str, ...]) -> bool:
    """Return whether load friction may scale all other values.

    If the load is the drive's torque, the balance of a driven joint is (1 - load_friction) times the torque. Any value
    fits, unless another coefficient is known.

    Parameters
    ----------
    terms : tuple of str
        Keys of the terms; the load of load_friction is the drive's torque.
    """
    load = parameters.get("load_friction")
    if "load_friction" not in terms or load is None or not load.vary:
        return False
    known = [parameters[name] for name in parameters if name.startswith(("inertia", "gravity"))]
    return not any(not each.vary and each.value for each in known)


def _find(evidence: Evidence) -> Iterator[Finding]:
    if not scale_is_free(evidence.parameters, evidence.problem.choice.terms):
        return
    model = evidence.problem.choice.model.replace(load_friction=False)
    yield LOAD_SCALE.finding(
        "load_friction scales all other values, because neither inertia nor gravity is known",
        Action("call", {"model": str(model)}),
        Action("inspect", text="the data sheet, and state the joint's inertia or its link"),
        details="the drive's torque alone does not determine these values",
        parameters=tuple(name for name, each in evidence.parameters.items() if each.vary),
    )


CHECK = Check(_find, (LOAD_SCALE,))
