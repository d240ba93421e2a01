"""All findings about an estimate: the results of all checks, without those that another finding explains."""

from jointid.estimate.findings import Finding, Severity
from jointid.identification.warnings import registry
from jointid.identification.warnings.evidence import Evidence

_ORDER: tuple[Severity, ...] = ("blocking", "warning", "info")


def diagnose(evidence: Evidence) -> tuple[Finding, ...]:
    """All findings, the most severe first; those of one severity in the order of the checks."""
    kept = [found for check in registry.CHECKS for found in check.find(evidence)]
    units = [found for found in kept if found.code == "implausible_units"]
    # With degrees the motor's angle is wrong, too: a residual that oscillates with it is not ripple.
    spurious = [found for found in kept if units and found.code == "ripple"]
    left = [found for found in kept if found not in (*units[1:], *spurious)]
    return tuple(sorted(left, key=lambda found: _ORDER.index(found.severity)))
