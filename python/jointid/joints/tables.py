"""Several joints' estimates as text: one table, the couplings, and each joint's findings."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from jointid import _core
from jointid.base.advice import Action
from jointid.base.error_text import joint_phrase, printable
from jointid.base.errors import InputError
from jointid.base.text_table import aligned
from jointid.estimate.estimate import Estimate
from jointid.estimate.statistics import ParameterEstimate
from jointid.estimate.wording import rounded, two_digits
from jointid.joints.record import JointEstimatesRecord, JointResult

_NOTHING = 1e-9  # of a free value without an error: remainder at a bound of zero
_NO_COUPLING = "no joint explains another joint's residual by more than chance"


def shown_parameters(result: JointEstimatesRecord) -> list[str]:
    """Return the names of the parameters in the table: friction and inertia, if any joint has them."""
    present = {name for estimate in result.values() for name in estimate.parameters}
    friction = [
        each for term in _core.terms() if term.friction for each in (term.name, *term.shapes)
    ]
    return [name for name in dict.fromkeys([*friction, "inertia"]) if name in present]


def head(result: JointEstimatesRecord) -> list[str]:
    """Return the table's head."""
    units = {
        name: parameter.unit
        for estimate in result.values()
        for name, parameter in estimate.parameters.items()
    }
    shown = [f"{name} [{units[name]}]" for name in shown_parameters(result)]
    return ["joint", "model", *shown, "residual", "others explain", "warnings"]


def rows(result: JointEstimatesRecord) -> list[list[str]]:
    """Return one row for each joint, in the order of the head."""
    names = shown_parameters(result)
    return [_row(each, names) for each in result.results.values()]


def _row(result: JointResult, names: list[str]) -> list[str]:
    estimate = result.estimate
    if estimate is None:
        return [result.name, "failed", *("–" for _ in names), "–", "–", "–"]
    cells = [value_with_error(estimate.parameters.get(name)) for name in names]
    codes = ", ".join(dict.fromkeys(found.code for found in estimate.warnings)) or "none"
    explained = f"{100.0 * result.explained:.0f} %" if result.explained else "–"
    residual = f"{100.0 * estimate.residuals.relative:.1f} %"
    return [result.name, model_of(estimate), *cells, residual, explained, codes]


def model_of(estimate: Estimate) -> str:
    """Return the model's name and its options."""
    return str(estimate.settings["model"])


def value_with_error(parameter: ParameterEstimate | None) -> str:
    """Return a value with its standard error, which sets the number of digits: ``7.74 ± 0.21``."""
    if parameter is None:
        return "–"
    bound = " (at bound)" if parameter.at_bound is not None else ""
    if parameter.stderr is None or not 0.0 < parameter.stderr < float("inf"):
        fixed = "" if parameter.vary else " (fixed)"
        tiny = parameter.vary and abs(parameter.value) <= _NOTHING
        return f"{0.0 if tiny else parameter.value:.4g}{fixed}{bound}"
    return f"{rounded(parameter.value, parameter.stderr)} ± {two_digits(parameter.stderr)}"


def notes(result: JointEstimatesRecord) -> list[str]:
    """Return remarks that apply to the whole table."""
    lines = []
    at_motor = [name for name, each in result.results.items() if each.side == "motor"]
    if at_motor:
        lines.append(
            f"no gear ratio is known: the values of joint{'s' * (len(at_motor) > 1)} {', '.join(at_motor)} are on the "
            "motor side"
        )
    return lines


def couplings(result: JointEstimatesRecord) -> list[str]:
    """Return the couplings between the joints' residuals, one sentence each."""
    if len(result.results) < 2 and not result.sentences():
        return []
    return list(result.sentences()) or [_NO_COUPLING]


def text_report(
    result: JointEstimatesRecord,
    action: Callable[[Action, str], str] = lambda action, _: str(action),
    error: Callable[[InputError], str] = str,
) -> str:
    """Return the result as text.

    Parameters
    ----------
    result : JointEstimates
    action : callable
        Gives the text of a finding's advice for a joint, by the joint's name. Default: the text for a Python prompt.
    error : callable
        Gives the text of the reason why a joint failed. Default: the text of the Python error.
    """
    lines = [f"jointid estimates — {result.name or 'robot'}", ""]
    lines += aligned([head(result), *rows(result)])
    lines += ["", *notes(result), *couplings(result), ""]
    for each in result.results.values():
        if each.error is not None:
            lines.append(f"{joint_phrase(each.name)} failed: {error(each.error)}")
        if each.estimate is not None:
            worded = partial(_of_joint, action, each.name)
            lines += [
                f"{joint_phrase(each.name)}, {found.severity} ({found.code}): {found.worded(worded)}"
                for found in each.estimate.findings
                if found.code != "motor_side"  # stated once, for all joints
            ]
    return printable("\n".join(lines).rstrip())


def _of_joint(worded: Callable[[Action, str], str], joint: str, action: Action) -> str:
    return worded(action, joint)
