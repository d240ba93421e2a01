"""The result of a rollout: logged and simulated positions, for servos and robots."""

from __future__ import annotations

import math
from dataclasses import field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from jointid.base.json_layout import json_types
from jointid.base.result import Overview, Quantity, Result
from jointid.base.text_table import aligned
from jointid.base.values import dataclass

Array = NDArray[np.float64]

BISTABLE = math.radians(5.0)
"""Limit for bistable runs: a small change of the motor's torque moves the rollout further than this [rad]."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class RunRollout:
    """One simulated run of a servo, or of one joint of a robot.

    Attributes
    ----------
    name : str
    time, position, velocity : ndarray, shape (n,)
        Simulated motion at the log's time stamps [s], [rad or m], [rad/s or m/s].
    measured : ndarray, shape (n,)
        Logged position [rad or m].
    error : float
        Mean absolute error of the position [rad or m].
    spread : float or None
        Largest change of the rollout if the motor's torque changes by 1 % [rad]; None: not computed.
    closed : bool
        Whether the position loop was closed; otherwise the logged duty or torque drove the motor or the joint.
    before : float or None
        Mean absolute error of the position with the URDF without friction [rad or m]; None: not computed.
    kind : {"revolute", "prismatic"}
    """

    name: str
    time: Array = field(repr=False)
    position: Array = field(repr=False)
    velocity: Array = field(repr=False)
    measured: Array = field(repr=False)
    error: float
    spread: float | None = None
    closed: bool
    before: float | None = None
    kind: str = "revolute"

    @property
    def bistable(self) -> bool:
        """Whether nearly equal servos give very different motions, so that the error means little."""
        return self.spread is not None and self.spread > BISTABLE

    @property
    def remark(self) -> str:
        """Short note on the error; empty if there is none."""
        opened = self.spread is not None and not self.closed
        return ", ".join(["bistable"] * self.bistable + ["duty as logged"] * opened)

    @property
    def unit(self) -> str:
        """Unit of a shown position: "deg" or "mm"."""
        return "mm" if self.kind == "prismatic" else "deg"

    def shown(self, position: Any) -> Any:
        """Return positions or errors in `unit`."""
        return 1e3 * position if self.kind == "prismatic" else np.degrees(position)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Rollout(Result):
    """Simulations of all runs of a servo or robot.

    Attributes
    ----------
    runs : tuple of RunRollout
        Simulated runs; for a robot, one run per recording and joint.
    horizon : float or None
        Duration of the simulated stretches [s]; each stretch starts at the logged state. None: each run is one
        stretch.
    """

    runs: tuple[RunRollout, ...]
    horizon: float | None = None

    _KIND = "rollout"

    @property
    def errors(self) -> Array:
        """Mean absolute error of each run's position [rad or m]."""
        return np.array([run.error for run in self.runs])

    @property
    def median(self) -> float:
        """Median of the runs' errors [rad or m]; it is robust against bistable runs."""
        return float(np.median(self.errors))

    @property
    def bistable(self) -> tuple[str, ...]:
        """Names of the bistable runs."""
        return tuple(run.name for run in self.runs if run.bistable)

    @property
    def overview(self) -> Overview:
        """Return the summary that a report page shows."""
        runs = len(self.runs)
        return Overview(
            title=f"rollout of {runs} run{'s' * (runs != 1)}",
            answer=(self.sentence,),
            parameters=tuple(
                Quantity(
                    name=run.name,
                    value=float(run.shown(run.error)),
                    unit=run.unit,
                    meaning="mean absolute error of the position",
                    remark=run.remark,
                )
                for run in self.runs
            ),
        )

    @property
    def sentence(self) -> str:
        """Sentence with the median error, the length of the stretches, and the error without friction."""
        worst = max(self.runs, key=lambda run: run.error)
        shown = "median" if len({run.kind for run in self.runs}) == 1 else "largest"
        error = self.median if shown == "median" else worst.error
        text = f"Mean position error ({shown} of {len(self.runs)} runs): {worst.shown(error):.3g} {worst.unit}"
        if self.horizon is not None:
            text += f", in simulations of {self.horizon:g} s that begin at the logged state"
        known = [run.before for run in self.runs if run.before is not None]
        if known and shown == "median":
            before = float(np.median(known))
            text += f"; with the URDF and without friction: {worst.shown(before):.3g} {worst.unit}"
        return f"{text}."

    def report(self, *, verbose: bool = False) -> str:
        """Return the errors as text.

        Parameters
        ----------
        verbose : bool
            No effect: the report is always complete.
        """
        del verbose
        head, rows = self.table()
        if len({run.kind for run in self.runs}) == 1:
            error = f"{self.runs[0].shown(self.median):.2f}"
            rows.append(["median", error, *("" for _ in head[2:])])
        return "\n".join(aligned([head, *rows]))

    def table(self) -> tuple[list[str], list[list[str]]]:
        """Return header and rows of a table: error of each run and, if known, error without friction and spread."""
        unit = " or ".join(dict.fromkeys(run.unit for run in self.runs))
        columns = {f"error [{unit}]": [f"{run.shown(run.error):.2f}" for run in self.runs]}
        if any(run.before is not None for run in self.runs):
            columns[f"without friction [{unit}]"] = [_shown(run, run.before) for run in self.runs]
        if any(run.spread is not None for run in self.runs):
            columns[f"moved by 1 % of torque [{unit}]"] = [
                _shown(run, run.spread) for run in self.runs
            ]
            columns["remark"] = [run.remark for run in self.runs]
        names = [run.name for run in self.runs]
        return ["run", *columns], [list(row) for row in zip(names, *columns.values(), strict=True)]

    def to_dict(self) -> dict[str, Any]:
        """Return the errors in JSON's types."""
        names = ("name", "error", "before", "spread", "bistable", "closed")
        runs = [{name: getattr(run, name) for name in names} for run in self.runs]
        document: dict[str, Any] = json_types(
            {"median": self.median, "horizon": self.horizon, "runs": runs}
        )
        return document

    document = to_dict


def _shown(run: RunRollout, value: float | None) -> str:
    return "–" if value is None else f"{run.shown(value):.2f}"
