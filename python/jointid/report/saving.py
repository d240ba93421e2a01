"""The report of any result as a page, and as a file."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

from jointid.base.advice import Action
from jointid.base.argument_checks import require_page
from jointid.base.errors import InputError
from jointid.base.files import write_whole
from jointid.problem.recordings import listed

if TYPE_CHECKING:
    from jointid.commissioning.result import Commissioning
    from jointid.comparison.result import Comparison
    from jointid.excitation.design import Design
    from jointid.estimate.estimate import Estimate
    from jointid.joints.result import JointEstimates
    from jointid.recording.recording import Recording
    from jointid.robot.result.comparison_result import RobotComparison
    from jointid.robot.result.result import RobotEstimate
    from jointid.servo.estimate import ServoEstimate
    from jointid.study.study_result import Study

    Result: TypeAlias = (
        Estimate
        | JointEstimates
        | RobotEstimate
        | RobotComparison
        | ServoEstimate
        | Comparison
        | Study
        | Design
        | Commissioning
    )

# By name, so that only the page that is asked for is imported.
_PAGES = {
    "Estimate": "html:html_report",
    "JointEstimates": "joints_page:joints_report",
    "RobotEstimate": "robot_page:robot_report",
    "RobotComparison": "robot_page:robot_comparison_report",
    "Comparison": "comparison_page:comparison_report",
    "ServoEstimate": "servo_page:servo_report",
    "Commissioning": "session_page:session_report",
}
_WITHOUT_FINDINGS = {"Study": "study_page:study_report", "Design": "design_page:design_report"}


def report_page(
    result: Result,
    action: Callable[[Action], str] = str,
    recordings: Recording | Sequence[Recording] | None = None,
) -> str:
    """Return the report of a result as one HTML page that needs no other file.

    Parameters
    ----------
    result : Estimate, JointEstimates, RobotEstimate, ServoEstimate, Comparison, RobotComparison, Study, Design, ...
    action : callable
        Words the advice of a finding. Default: as at a Python prompt.
    recordings : Recording or sequence of Recording, optional
        See `save_report`.

    Returns
    -------
    str

    Raises
    ------
    InputError
        Anything else, of which there is no report; recordings that the result was not made from.
    """
    kind: Any = type(result)
    pages = {**_PAGES, **_WITHOUT_FINDINGS}
    if kind.__name__ not in pages or not kind.__module__.startswith("jointid."):
        raise InputError(
            f"this has no report; reports are made of {', '.join(pages)}",
            argument="result",
            value=kind.__name__,
        )
    module, _, function = pages[kind.__name__].partition(":")
    maker = getattr(import_module(f"jointid.report.{module}"), function)
    if recordings is not None:
        if kind.__name__ != "Estimate":
            raise InputError(
                "only the report of one joint's estimate shows its recordings",
                argument="recordings",
            )
        return str(maker(result, action, listed(recordings)))
    made: str = maker(result) if kind.__name__ in _WITHOUT_FINDINGS else maker(result, action)
    return made


def save_report(
    result: Result,
    path: str | Path,
    action: Callable[[Action], str] = str,
    recordings: Recording | Sequence[Recording] | None = None,
) -> Path:
    """Write the report of a result as one HTML page that needs no other file, whole or not at all.

    The page begins with the verdict or the answer; pictures are inside; a phone shows it, and a dark screen.

    Parameters
    ----------
    result : Estimate, JointEstimates, RobotEstimate, ServoEstimate, Comparison, RobotComparison, Study, Design, ...
        What `identify`, `identify_joints`, `identify_robot`, `identify_servo`, `compare_models`,
        `compare_robot_models`, `sweep`, `design_excitation` and `commission` return.
    path : path
        Ends in .html; replaced when it exists.
    action : callable
        Words the advice of a finding. Default: as at a Python prompt.
    recordings : Recording or sequence of Recording, optional
        That an `Estimate` was made from, in this order: the page then shows their signals, with what was left out
        shaded, and the residual over the position. Default: a page without these.

    Returns
    -------
    Path

    Raises
    ------
    InputError
        Of this there is no report; the estimate was made from other recordings; the path is no name of a page, or its
        folder does not exist.
    OSError
        The file cannot be written; an existing one is untouched.

    Examples
    --------
    >>> jid.save_report(jid.identify(recording, joint), "report.html", recordings=recording).name
    'report.html'
    """
    target = require_page("path", path)
    write_whole(target, report_page(result, action, recordings).encode())
    return target
