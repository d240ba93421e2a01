"""Pictures of the tracking error of runs."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from jointid.base.values import dataclass
from jointid.panels.marks import Level, Line, Mark, Panel, Picture
from jointid.panels.palette import LOOKS

if TYPE_CHECKING:
    from jointid.commissioning.result import BenchRun, Commissioning

_REFERENCE = "true parameters"  # the run with the emulated joint's own values


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TrackingError:
    """Tracking error of one run.

    Attributes
    ----------
    name : str
        Name in the legend; may be empty.
    time : ndarray, shape (n,)
        Time from the start of the run [s].
    error : ndarray, shape (n,)
        Position minus reference [rad] or [m].
    size : float
        Root mean square of the error, in the same unit.
    dashed : bool
        Whether the line is dashed, because it may cover another one. Default False.
    """

    name: str
    time: NDArray[np.float64]
    error: NDArray[np.float64]
    size: float
    dashed: bool = False


def tracking(result: Commissioning) -> Picture:
    """Return the first and the last run on one axis, and the other runs on a second axis."""
    slides = result.runs[0].recording.kind == "prismatic"
    last = () if result.true_run is None else (result.true_run,)
    ends = result.runs[:1] if len(result.runs) == 1 else (result.runs[0], result.runs[-1])
    others = (*result.runs[1:-1], *last)
    panels = [tracking_panel(_of_runs(ends), slides)]
    caption = "Encoder position minus reference over time"
    if others:
        panels.append(tracking_panel(_of_runs(others), slides, LOOKS[2:], height=110))
        caption += "; below: the other runs, on their own scale"
    return Picture(caption=f"{caption}.", panels=tuple(panels))


def tracking_panel(
    errors: Sequence[TrackingError],
    slides: bool,
    looks: tuple[str, ...] = LOOKS,
    height: int = 220,
) -> Panel:
    """Return the errors of runs over time, with their root mean square in the legend.

    Parameters
    ----------
    errors : sequence of TrackingError
    slides : bool
        Whether the joint is prismatic.
    looks : tuple of str
        Looks of the runs, in turn. Default: all looks of the palette.
    height : int
        Height of the panel. Default 220.
    """
    unit = "mm" if slides else "mrad"
    marks: list[Mark] = [
        Line(
            look=looks[number % len(looks)],
            label=f"{run.name}{', ' if run.name else ''}rms {1e3 * run.size:.3g} {unit}",
            across=run.time,
            up=1e3 * run.error,
            dashed=run.dashed,
            series=len(errors) > 1 and not run.dashed,
        )
        for number, run in enumerate(errors)
    ]
    return Panel(
        marks=(*marks, Level(look="measured", up=0.0)),
        across="time [s]",
        up=f"tracking error [{unit}]",
        height=height,
    )


def _of_runs(runs: Iterable[BenchRun]) -> list[TrackingError]:
    return [
        TrackingError(
            name=run.name,
            time=run.recording.time - run.recording.time[0],
            error=run.recording.position - run.recording.reference,
            size=run.tracking_error,
            dashed=run.name == _REFERENCE,
        )
        for run in runs
        if run.recording.reference is not None
    ]
