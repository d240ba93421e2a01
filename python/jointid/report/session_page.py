"""The report of a session: how it followed, how near it came to its limits, what was identified, what is next."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from jointid.base.advice import Action
from jointid.base.html import Html, element, page, table
from jointid.report.answering import answer, verdict_lines
from jointid.report.drawing.marks import Level, Line, Mark, Panel
from jointid.report.figure import captioned
from jointid.report.html import footer, sections, shown_by
from jointid.report.limit_margins import margin_rows
from jointid.report.style import STYLE

if TYPE_CHECKING:
    from jointid.commissioning.result import BenchRun, Commissioning
    from jointid.estimate.estimate import Estimate

_REFERENCE = "true parameters"  # the run with the emulated joint's own values
_SMALL = 1.2  # a tracking error that fell by less did not get better


def session_report(result: Commissioning, action: Callable[[Action], str] = str) -> str:
    """The report as one HTML page that needs no other file.

    Parameters
    ----------
    result : Commissioning
    action : callable
        Words the advice of a finding. Default: as at a Python prompt.
    """
    from jointid.commissioning.result import TIMING, parameter_rows, run_rows, timing_rows

    first = result.runs[0].recording
    name = first.name or "joint"
    if result.estimates:
        name = result.estimates[-1].joint.name or name
    title = f"{name}: session of {len(result.runs)} run{'s' * (len(result.runs) > 1)}"
    body: list[Html | str] = [
        element("h1", title),
        *_answer(result),
        *(element("p", sentence) for sentence in next_step(result, action)),
        element("h2", "Tracking error", id="tracking"),
        _tracking(result),
        _table(run_rows(result)),
        element("p", "Tracking errors by the encoder, without the first sixth of each run."),
        element("h2", "Limits", id="limits"),
        _table(margin_rows([run.recording for run in result.runs])),
        element("p", "The largest recorded values of all runs, and their share of the limit."),
        element("h2", "Stops", id="stops"),
        *_stops(result),
    ]
    timing = timing_rows(result)
    if len(timing) > 1:
        body += [element("h2", "Timing", id="timing"), _table(timing), element("p", TIMING)]
    body += _drive(first.metadata)
    if result.estimates:
        changed = "What was assumed and what was identified"
        body += [element("h2", changed, id="identified"), *_verdict(result.estimates[-1], action)]
        body.append(_table(parameter_rows(result)))
        body += sections(result.estimates[-1], action)
        body.append(footer(result.estimates[-1]))
    return page(title, STYLE, *body)


def _answer(result: Commissioning) -> list[Html]:
    """What came of the session, before all else why it was stopped if it was."""
    from jointid.commissioning.result import summary

    emulated = "An emulated joint on an emulated drive: no hardware moved."
    lines = [element("p", emulated)] if result.truth else []
    stopped = [each for each in result.runs if each.recording.metadata.get("stop")]
    if stopped:
        sentences = [f"{run.name}: {run.recording.metadata['stop']}." for run in stopped]
        return [*(answer(said, "not usable") for said in sentences), *lines]
    said = summary(result)
    level = result.estimates[-1].verdict.level if result.estimates else None
    if level is not None and result.blocked is None:
        said = [f"{' '.join(said)} The identified values are {level}.".strip()]
    return [*(answer(sentence, level) for sentence in said), *lines]


def next_step(result: Commissioning, action: Callable[[Action], str] = str) -> list[str]:
    """What to do with the outcome, in a sentence."""
    if any(run.recording.metadata.get("stop") for run in result.runs):
        return ["Next: find out why the limit was reached before the joint moves again."]
    if not result.estimates:
        return ["Next: identify the joint from the recordings."]
    warned = [found for found in result.estimates[-1].warnings if found.advice]
    if result.blocked is None and result.improvement < _SMALL:
        return ["Next: do not use these values; the joint does not follow better with them."]
    if warned:
        return [f"Next: {action(warned[0].advice[0])} (finding {warned[0].code})."]
    if result.blocked is not None:
        return []
    return ["Next: save these values to the joint file; no finding warns of them."]


def _verdict(estimate: Estimate, action: Callable[[Action], str]) -> list[Html]:
    return verdict_lines(estimate.verdict, estimate.findings, shown_by(estimate), action)


def _tracking(result: Commissioning) -> Html:
    """First and last run on the same axis; reference runs and those between on their own."""
    revolute = result.runs[0].recording.kind == "revolute"
    unit = "mrad" if revolute else "mm"
    last = () if result.true_run is None else (result.true_run,)
    ends = result.runs[:1] if len(result.runs) == 1 else (result.runs[0], result.runs[-1])
    others = (*result.runs[1:-1], *last)
    panels = [_errors(ends, ("measured", "fitted"), unit)]
    caption = "Position minus reference over time, by the encoder"
    if others:
        panels.append(_errors(others, ("second", "third", "fourth", "fifth"), unit, height=110))
        caption += "; below: the other runs, on a scale of their own"
    return captioned(f"{caption}.", *panels)


def _errors(
    runs: tuple[BenchRun, ...], looks: tuple[str, ...], unit: str, height: int = 220
) -> Panel:
    marks: list[Mark] = []
    for number, run in enumerate(runs):
        recording = run.recording
        if recording.reference is None:
            continue
        error = 1e3 * (recording.position - recording.reference)
        label = f"{run.name}, rms {1e3 * run.tracking_error:.3g} {unit}"
        time = recording.time - recording.time[0]
        marks.append(
            Line(
                look=looks[number % len(looks)],
                label=label,
                across=time,
                up=error,
                dashed=run.name == _REFERENCE,  # it may lie upon what was identified
            )
        )
    marks.append(Level(look="measured", up=0.0))
    across, up = "time [s]", f"tracking error [{unit}]"
    return Panel(marks=tuple(marks), across=across, up=up, height=height)


def _stops(result: Commissioning) -> list[Html | str]:
    """Whether a run ended before its time, and whether the motor is off."""
    said: list[Html | str] = [
        element("p", f"{run.name}: {reason}.")
        for run in result.runs
        if (reason := run.recording.metadata.get("stop"))
    ]
    off = result.runs[-1].recording.metadata.get("motor_off")
    if not said:
        said.append(element("p", "No run was stopped by a limit."))
    if off is not None:
        words = "The drive confirmed that the motor is off." if off else "The motor may be on."
        said.append(element("p", words))
    return said


def _drive(told: Mapping[str, Any]) -> list[Html | str]:
    """Which drive it was, and the limits in it."""
    drive = told.get("drive")
    if not isinstance(drive, dict):
        return []
    rows = [
        [str(name), ", ".join(f"{key} {each}" for key, each in value.items())]
        if isinstance(value, dict)
        else [str(name), str(value)]
        for name, value in drive.items()
    ]
    return [
        element("h2", "Drive", id="drive"),
        table([list(row) for row in rows], class_="facts"),
    ]


def _table(rows: list[list[str]]) -> Html:
    head, *others = rows
    return table([[element("th", row[0]), *row[1:]] for row in others], head=head, class_="numbers")
