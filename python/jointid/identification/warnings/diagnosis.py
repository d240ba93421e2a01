"""All findings about an estimate: the results of all checks, without consequences of other findings."""

from dataclasses import replace

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Severity
from jointid.identification.warnings import registry
from jointid.identification.warnings.evidence import Evidence

_OF_THE_FILE = ("hardly_moves", "implausible_units", "gaps", "assumed_units", "stopped")
_ORDER: tuple[Severity, ...] = ("blocking", "warning", "info")


def diagnose(evidence: Evidence) -> tuple[Finding, ...]:
    """Return all findings, the most severe first; those of one severity in the order of the checks."""
    kept = []
    for check in registry.CHECKS:
        raised = check.findings(evidence)
        kept += raised
        if any(found.severity == "blocking" for found in raised):
            # An impossible signal explains the residual, so other causes are not reported.
            evidence = replace(evidence, causes=None)
    units = [found for found in kept if found.code == "implausible_units"]
    # If degrees are read as radians, the motor's angle is wrong, too: a residual that oscillates with it is not ripple.
    other = _another_cause(evidence)
    spurious = [found for found in kept if found.code == "ripple" and (units or other)]
    again = [each for place, each in enumerate(units) if _again_of(each, units[:place])]
    left = [found for found in kept if found not in (*again, *spurious)]
    left = [found for place, found in enumerate(left) if not _again(found, left[:place])]
    if any(
        found.code == "hardly_moves" for found in left
    ):  # without motion, findings about values are only consequences
        left = [found for found in left if found.code in _OF_THE_FILE]
    if any(found.severity == "blocking" for found in left):
        asked = {
            name for found in left if found.severity == "blocking" for name in _units_in(found)
        }
        left = [_without_other_fits(found, asked) for found in left]
    return tuple(sorted(left, key=lambda found: _ORDER.index(found.severity)))


def _another_cause(evidence: Evidence) -> bool:
    """Return whether most of the residual has another cause: events contain all multiples of the motor's angle."""
    causes = evidence.causes.found if evidence.causes is not None else ()
    return bool(causes) and causes[0].share > 0.5 and all(each.name != "ripple" for each in causes)


def _again(found: Finding, before: list[Finding]) -> bool:
    """Return whether a separate check has already found a cause that the attribution also names."""
    return "share" in found.evidence and found.code in {each.code for each in before}


def _again_of(found: Finding, before: list[Finding]) -> bool:
    """Return whether other findings already cover all recordings of this finding, or all recordings."""
    named = {name for each in before for name in each.recordings}
    return bool(before) and set(found.recordings) <= named


def _units_in(found: Finding) -> set[str]:
    """Return the signals with a unit that a finding proposes."""
    return {name for each in found.advice for name in each.arguments.get("units", ())}


def _without_other_fits(found: Finding, asked: set[str]) -> Finding:
    """Return the finding without advice based on unusable values; a blocking finding keeps its advice.

    Such advice is: other fits, limits of a motion, and units if a blocking finding proposes others (`asked`).
    """
    if found.severity == "blocking":
        return found
    kept = (_as_far_as_known(each, asked) for each in found.advice)
    return replace(found, advice=tuple(each for each in kept if each is not None))


def _as_far_as_known(action: Action, asked: set[str]) -> Action | None:
    if (action.kind, action.function) == ("call", "identify"):
        return None
    if action.designs:
        return Action("record", text=action.text)
    if action.kind == "call" and asked & set(action.arguments.get("units", ())):
        units = {
            name: unit for name, unit in action.arguments["units"].items() if name not in asked
        }
        others = {**action.arguments, "units": units} if units else None
        return replace(action, arguments=others) if others else None
    return action
