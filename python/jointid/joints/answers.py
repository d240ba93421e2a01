"""Several joints' answer in a few lines: a line for each joint, the first finding, and its advice."""

from __future__ import annotations

from collections.abc import Callable

from jointid.base.advice import Action
from jointid.base.error_text import joint_phrase, printable
from jointid.base.errors import InputError
from jointid.estimate.answers import cut, findings, in_line, joint_lines
from jointid.estimate.findings import Finding
from jointid.estimate.reasons_against_use import acts_against_motion
from jointid.estimate.verdict import LEVELS
from jointid.joints.record import FAILED, JointEstimatesRecord, JointResult

_SHOWN = 3  # largest number of values in a line
_FINDINGS = 1
_SEVERITIES = ("blocking", "warning", "info")
_ORDER = (*LEVELS, FAILED)


def answer(
    result: JointEstimatesRecord,
    action: Callable[[Action, str], str] = lambda action, _: str(action),
    error: Callable[[InputError], str] = str,
    saved: str = "",
) -> str:
    """Return the answer: at most 7 lines plus one for each joint, with the worst joint first if it is not usable.

    Parameters
    ----------
    result : JointEstimates
    action : callable
        Gives the text of an action for a joint, by the joint's name. Default: the text for a Python prompt.
    error : callable
        Gives the text of the reason why a joint failed. Default: the text of the Python error.
    saved : str
        File of the estimates. Default: none.
    """
    joints = list(result.results.values())
    if _worst(result) not in LEVELS[:2]:
        joints.sort(key=lambda each: -_ORDER.index(_level(each)))
    lines = [headline(result)]
    lines += joint_lines([_row(each) for each in joints])
    failures = _failures(result, error)
    lines += failures or _coupled(result)
    found = ordered_findings(result)
    name, first = found[0] if found else ("", None)
    told = findings(
        [each for _, each in found],
        lambda each: action(each, name),
        _FINDINGS,
        saved,
        clean=[] if failures else ["no warnings"],
    )
    if first is not None and first.severity != "info":  # its joint's line shows the severity
        told[0] = cut(f"{joint_phrase(name)}: {first.title}")
    return printable("\n".join([*lines, *told]))


def headline(result: JointEstimatesRecord) -> str:
    """Return the level of the worst joint, as one line."""
    joints = result.results.values()
    at_motor = any(each.side == "motor" for each in joints)
    side = " (on the motor side, because no gear ratio is known)" if at_motor else ""
    return f"{result.name or 'robot'}, {len(joints)} joints: {_worst(result)}{side}"


def worst_level(result: JointEstimatesRecord) -> str:
    """Return the level of the worst joint; a joint that failed is not usable."""
    worst = _worst(result)
    return LEVELS[-1] if worst == FAILED else worst


def _worst(result: JointEstimatesRecord) -> str:
    return max(map(_level, result.results.values()), key=_ORDER.index)


def _level(result: JointResult) -> str:
    return FAILED if result.estimate is None else result.estimate.verdict.level


def _row(result: JointResult) -> list[str]:
    estimate = result.estimate
    if estimate is None:
        return [result.name, _level(result), *[""] * _SHOWN]
    # Friction comes first, because inertia and gravity also depend on the links.
    values = [p for p in estimate.parameters.values() if p.vary]
    ordered = sorted(values, key=lambda p: not acts_against_motion(p.name))
    cells = [in_line(p) for p in ordered[:_SHOWN]]
    return [result.name, _level(result), *cells, *[""] * (_SHOWN - len(cells))]


def ordered_findings(result: JointEstimatesRecord) -> list[tuple[str, Finding]]:
    """Return all findings with the joint's name, the most severe first, without those in the headline."""
    found = [
        (name, each)
        for name, estimate in result.items()
        for each in estimate.findings
        if each.code != "motor_side"
    ]
    return sorted(found, key=lambda pair: _SEVERITIES.index(pair[1].severity))


def _failures(result: JointEstimatesRecord, error: Callable[[InputError], str]) -> list[str]:
    """Return why the first joint failed, and which others failed."""
    failed = [each for each in result.results.values() if each.error is not None]
    if not failed or failed[0].error is None:
        return []
    others = ", ".join(each.name for each in failed[1:])
    also = f" (these failed, too: {others})" if others else ""
    return [f"{joint_phrase(failed[0].name)} failed: {error(failed[0].error)}{also}"]


def _coupled(result: JointEstimatesRecord) -> list[str]:
    """Return the first coupling between joints, and the number of the others."""
    sentences = result.sentences()
    more = f", and {len(sentences) - 1} more couplings" if len(sentences) > 1 else ""
    return [cut(f"{sentences[0]}{more}")] if sentences else []
