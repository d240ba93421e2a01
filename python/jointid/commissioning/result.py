"""Result of a commissioning: its runs and estimates, and tables of tracking errors and parameters."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from jointid.base.advice import Action
from jointid.base.json_layout import json_types
from jointid.base.result import Overview, Result
from jointid.estimate.estimate import Estimate
from jointid.estimate.findings import Finding
from jointid.recording.recording import Recording
from jointid.simulation.arguments import Controller


@dataclass(frozen=True, slots=True, kw_only=True)
class BenchRun:
    """One motion of the joint.

    Attributes
    ----------
    name : str
        Name of the run: "initial", "cycle 1", …, "true parameters".
    recording : Recording
    controller : AdaptiveRobust, CompensatedPid or LugreObserver
        Controller with its assumed parameters.
    tracking_error, peak_error : float
        Root mean square and largest magnitude of position minus reference [rad], without the first sixth of the run.
    """

    name: str
    recording: Recording
    controller: Controller
    tracking_error: float
    peak_error: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Commissioning(Result):
    """Result of a commissioning.

    Attributes
    ----------
    runs : tuple of BenchRun
        Initial run, then one run for each cycle that `agree` allowed and that has no blocking finding.
    estimates : tuple of Estimate
        One estimate for each cycle, from all recordings up to this cycle; empty if the joint was only recorded.
    truth : mapping of str to float
        True parameters of an emulated joint; empty otherwise.
    true_run : BenchRun or None
        Last run of an emulated joint, in which the controller uses the true parameters; otherwise None.
    without_ripple : Estimate or None
        Last estimate, repeated without the model's ripple; None if the model has no ripple.
    """

    runs: tuple[BenchRun, ...]
    estimates: tuple[Estimate, ...]
    truth: Mapping[str, float]
    true_run: BenchRun | None = None
    without_ripple: Estimate | None = None

    _KIND = "commissioning"

    @property
    def overview(self) -> Overview:
        """Summary that a report page shows."""
        from jointid.estimate.overview import made_by, quantity_of

        estimate = self.estimates[-1] if self.estimates else None
        level, *said = outcome(self)
        name, runs = self.runs[0].recording.name or "joint", len(self.runs)
        if estimate is not None:
            name = estimate.joint.name or name
        return Overview(
            title=f"{name}: session of {runs} run{'s' * (runs > 1)}",
            footer="" if estimate is None else made_by(estimate.settings),
            answer=(
                *said,
                *([f"The motion: {self.motion_warning}."] if self.motion_warning else []),
            ),
            level=level,
            parameters=tuple(map(quantity_of, estimate.parameters.values())) if estimate else (),
            findings=estimate.findings if estimate else (),
            inner={f"cycle {len(self.estimates)}": estimate} if estimate else {},
        )

    @property
    def blocked(self) -> Finding | None:
        """Blocking finding of the last estimate; None if it has none. The joint does not move with this estimate."""
        return None if not self.estimates else blocking(self.estimates[-1])

    @property
    def motion_warning(self) -> str:
        """Differences from the bench that the motion was designed for; empty if there are none."""
        return str(self.runs[0].recording.metadata.get("motion_warning", ""))

    @property
    def improvement(self) -> float:
        """Tracking error of the first run, divided by the tracking error of the last run."""
        return self.runs[0].tracking_error / self.runs[-1].tracking_error

    def recordings(self) -> dict[str, Recording]:
        """Return the runs' recordings by name, e.g. for `jointid.plot.tracking_error`."""
        last = () if self.true_run is None else (self.true_run,)
        return {run.name: run.recording for run in (*self.runs, *last)}

    def to_dict(self) -> dict[str, Any]:
        """Return the numbers in JSON types."""
        estimates = [
            {name: found.value for name, found in estimate.parameters.items()}
            for estimate in self.estimates
        ]
        last = () if self.true_run is None else (self.true_run,)
        document = {
            "runs": [
                {"name": r.name, "tracking_error": r.tracking_error, "peak_error": r.peak_error}
                for r in (*self.runs, *last)
            ],
            "improvement": self.improvement,
            "blocked": None if self.blocked is None else self.blocked.code,
            "estimates": estimates,
            "truth": dict(self.truth),
            "without_ripple": None
            if self.without_ripple is None
            else {name: found.value for name, found in self.without_ripple.parameters.items()},
        }
        return dict(json_types(document))

    def report(self, action: Callable[[Action], str] = str, *, verbose: bool = False) -> str:
        """Return tables of tracking errors and parameters.

        Parameters
        ----------
        action : callable
            Function that returns the text of a finding's advice. Default: the text for a Python prompt.
        verbose : bool
            Has no effect: this report is always complete.
        """
        del verbose
        return text_report(self, action)


def blocking(estimate: Estimate) -> Finding | None:
    """Return the first finding by which the values cannot be used; None without one."""
    return next((each for each in estimate.findings if each.severity == "blocking"), None)


def text_report(result: Commissioning, action: Callable[[Action], str] = str) -> str:
    """Return tables of tracking errors and parameters.

    Parameters
    ----------
    result : Commissioning
    action : callable
        Returns the text of a finding's advice. Default: as at a Python prompt.
    """
    lines = _runs(result)
    if result.estimates:
        lines += ["", *_table(parameter_rows(result))]
    if result.without_ripple is not None and result.truth:
        lines += ["", _ripple(result)]
    if result.motion_warning:
        lines += ["", f"The motion: {result.motion_warning}."]
    warned = [
        f"- {found.code}: {found.worded(action)}"
        for estimate in result.estimates[-1:]
        for found in estimate.warnings
    ]
    if warned:
        lines += ["", "The last estimate warns:", *warned]
    lines += _timing(result)
    return "\n".join(lines)


def run_rows(result: Commissioning) -> list[list[str]]:
    """Return the tracking error of each run. The first row is the header."""
    unit = "mrad" if result.runs[0].recording.kind == "revolute" else "mm"
    rows = [["run", f"rms error [{unit}]", f"largest [{unit}]", "than the first"]]
    last = () if result.true_run is None else (result.true_run,)
    first = result.runs[0].tracking_error
    rows += [
        [
            run.name,
            f"{1e3 * run.tracking_error:.4f}",
            f"{1e3 * run.peak_error:.4f}",
            "" if run is result.runs[0] else _compared(first / run.tracking_error),
        ]
        for run in (*result.runs, *last)
    ]
    return rows


def summary(result: Commissioning) -> list[str]:
    """Return the result in sentences; empty if the joint was only recorded."""
    if result.blocked is not None:
        return [
            f"{result.blocked.code} is blocking: {result.blocked.cause}.",
            "The joint was not moved with this estimate, and its values cannot be used.",
        ]
    if len(result.runs) == 1:
        return []
    sentence = f"The tracking error fell by a factor of {result.improvement:.1f}"
    if result.true_run is not None:
        ratio = result.runs[-1].tracking_error / result.true_run.tracking_error
        sentence += (
            f"; at the end, it is {ratio:.3f} times the tracking error with the true parameters"
        )
    return [sentence + "."]


def outcome(result: Commissioning) -> tuple[str, ...]:
    """Return the level of the result and the result in sentences. Reasons of a stop come first."""
    emulated = "An emulated joint on an emulated drive: no hardware moved."
    lines = [emulated] if result.truth else []
    stopped = [each for each in result.runs if each.recording.metadata.get("stop")]
    if stopped:
        reasons = [f"{run.name}: {run.recording.metadata['stop']}." for run in stopped]
        return "not usable", *reasons, *lines
    if not result.estimates:
        return "", "The joint was recorded, and nothing was identified.", *lines
    level, said = result.estimates[-1].verdict.level, summary(result)
    if result.blocked is None:
        said = [f"{' '.join(said)} The identified values are {level}.".strip()]
    return level, *said, *lines


def _runs(result: Commissioning) -> list[str]:
    lines = [
        *_table(run_rows(result)),
        "",
        "Tracking errors are measured by the encoder, without the first sixth of each run.",
    ]
    said = summary(result)
    blank = [""] if result.blocked is not None else []
    return [*lines, *blank, *said]


def timing_rows(result: Commissioning) -> list[list[str]]:
    """Return the lateness of samples and loop in each run. The first row is the header, alone if no timing is known."""
    head = ["timing", "cycles", "late or lost", "skipped", "most in a row"]
    rows = [[*head, "woke late [ms]", "time left [ms]"]]
    for name, recording in result.recordings().items():
        timing = recording.metadata.get("timing")
        if timing is None:
            continue
        row = [name, *(str(timing[key]) for key in ("cycles", "lost", "skipped", "most_in_row"))]
        woke = f"{1e3 * timing['woke_late_median']:.2f} to {1e3 * timing['woke_late_most']:.2f}"
        left = f"{1e3 * timing['slack_median']:.2f} to {1e3 * timing['slack_least']:.2f}"
        rows.append([*row, woke, left])
    return rows


TIMING = "Late or lost samples are left out of the estimates; times are shown from median to worst."


def _timing(result: Commissioning) -> list[str]:
    rows = timing_rows(result)
    return ["", *_table(rows), "", TIMING] if len(rows) > 1 else []


def _compared(ratio: float) -> str:
    """Return how many times smaller or larger an error is."""
    if ratio < 1.0:
        return f"{1.0 / ratio:.1f} times larger"
    return f"{ratio:.1f} times smaller"


def parameter_rows(result: Commissioning) -> list[list[str]]:
    """Return the assumed values and those of each cycle. The first row is the header."""
    last = result.estimates[-1]
    head = ["parameter", "assumed at first"]
    head += [f"cycle {number}" for number in range(1, len(result.estimates) + 1)]
    head.append("± std. error")
    if result.truth:
        head += ["truth", "error"]
    rows = [head]
    assumed = last.joint.parameters
    initial = result.runs[0].controller.asdict()
    held = {name for name, found in last.parameters.items() if found.at_bound}
    for name in (each for each in last.parameters if each in {*last.free, *held}):
        if name not in assumed:
            continue
        found = [estimate.parameters[name] for estimate in result.estimates]
        row = [name, f"{initial[name]:.4g}" if name in initial else ""]
        row += [f"{each.value:.5g}{' (bound)' if each.at_bound else ''}" for each in found]
        error = found[-1].stderr
        row.append("" if error is None else f"{error:.2g}")
        if result.truth:
            row += _beside_truth(found[-1].value, result.truth.get(name))
        rows.append(row)
    return rows


def _beside_truth(value: float, truth: float | None) -> list[str]:
    if not truth:
        return ["", ""]
    return [f"{truth:.5g}", f"{100.0 * (value / truth - 1.0):+.2f} %"]


def _ripple(result: Commissioning) -> str:
    def worst(estimate: Estimate) -> str:
        off = {
            name: 100.0 * (estimate.parameters[name].value / value - 1.0)
            for name, value in result.truth.items()
            if value and name in estimate.parameters
        }
        return ", ".join(f"{name} {share:+.2f} %" for name, share in off.items())

    assert result.without_ripple is not None
    return f"Errors of an estimate without the sensor's ripple in the model: {worst(result.without_ripple)}."


def _table(rows: list[list[str]]) -> list[str]:
    widths = [max(len(row[column]) for row in rows) for column in range(len(rows[0]))]
    lines = [
        "  ".join(
            cell.ljust(width) if column == 0 else cell.rjust(width)
            for column, (cell, width) in enumerate(zip(row, widths, strict=True))
        ).rstrip()
        for row in rows
    ]
    return [lines[0], "  ".join("-" * width for width in widths), *lines[1:]]
