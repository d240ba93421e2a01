"""The result of a self-test: the known parameters that are recovered from the user's motion and noise."""

from __future__ import annotations

import json
from dataclasses import asdict
from typing import Any

from jointid.base.error_text import printable
from jointid.base.json_layout import json_types
from jointid.base.result import Overview, Quantity, Result
from jointid.base.values import dataclass
from jointid.estimate.wording import number, percent, two_digits

SCHEMA = 1
"""Version; increased if a reader of the old form would misread the new one."""

_LARGE = 20.0  # errors above this multiple of the truth are not shown as a share
_REMARKS = {"yes": "recovered", "no": "not recovered"}
_HEAD = ("parameter", "truth", "identified", "error", "95 % interval", "unit", "recovered")


@dataclass(frozen=True, slots=True, kw_only=True)
class SelfTestRow:
    """One parameter in one trial.

    Attributes
    ----------
    trial : int
        0: the truth is the estimate itself. Above 0: the truth is drawn from its intervals.
    parameter : str
    unit : str
    truth : float
        The true value in the simulation.
    value : float
        The identified value.
    interval : tuple of float or None
        95 % confidence interval of the identified value; None if it ended on a bound.
    covered : bool
        Whether the interval contains the truth.
    close : bool
        Whether the identified value is accurate enough: within 5 % of the truth, or the error changes the torque
        by less than 0.5 %.
    """

    trial: int
    parameter: str
    unit: str
    truth: float
    value: float
    interval: tuple[float, float] | None
    covered: bool
    close: bool

    @property
    def error(self) -> float:
        """Identified value minus truth."""
        return self.value - self.truth

    @property
    def shown_error(self) -> str:
        """The error as text: relative to the truth, or with the unit if the truth is nearly zero."""
        sign = "-" if self.error < 0.0 else "+"
        if abs(self.error) <= _LARGE * abs(self.truth):
            return f"{sign}{percent(abs(self.error / self.truth))}" if self.error else "0 %"
        return f"{sign}{two_digits(abs(self.error))} {self.unit}"


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class SelfTest(Result):
    """The result of `Estimate.selftest`.

    Attributes
    ----------
    rows : tuple of SelfTestRow
        Trial by trial.
    trials : int
    seed : int
    failed : str
        Reason why the identification of a trial failed; empty if no trial failed.

    Examples
    --------
    >>> isinstance(estimate.selftest(), jid.SelfTest)
    True
    """

    rows: tuple[SelfTestRow, ...]
    trials: int
    seed: int
    failed: str = ""

    _KIND = "self-test"

    @property
    def overview(self) -> Overview:
        """Return the summary that a report page shows."""
        return Overview(
            title=f"self-test: {self.trials} trials",
            answer=(self.verdict,),
            parameters=tuple(
                Quantity(
                    name=row.parameter,
                    value=row.value,
                    unit=row.unit,
                    meaning=f"value identified in trial {row.trial + 1}; true value {number(row.truth)}",
                    remark=_REMARKS.get(_comes_back(row), _comes_back(row)),
                )
                for row in self.rows
            ),
            settings=(("trials", str(self.trials)), ("seed", str(self.seed))),
        )

    def __repr__(self) -> str:
        return f"<SelfTest of {self.trials} trials: {self.verdict}>"

    @property
    def parameters(self) -> tuple[str, ...]:
        """The tested parameters."""
        return tuple(dict.fromkeys(row.parameter for row in self.rows))

    def recovered(self, parameter: str) -> bool:
        """Return whether a parameter is recovered: `close` in every trial, and `covered` in all trials but at most one.

        One exception is allowed, because a 95 % interval sometimes does not contain the truth by chance.
        """
        mine = [row for row in self.rows if row.parameter == parameter]
        covered = sum(row.covered for row in mine)
        return bool(mine) and all(row.close for row in mine) and covered >= len(mine) - 1

    @property
    def lost(self) -> tuple[str, ...]:
        """Parameters that are not recovered."""
        return tuple(name for name in self.parameters if not self.recovered(name))

    @property
    def passed(self) -> bool:
        """Whether every parameter is recovered."""
        return not self.lost and not self.failed

    @property
    def verdict(self) -> str:
        """Result of the self-test as a sentence."""
        if self.failed:
            return f"a trial could not be identified: {self.failed}"
        if self.passed:
            return (
                f"all parameters are recovered in {self.trials} trials: with noise and residuals as recorded, this "
                "motion determines them if the model is right"
            )
        parts = [f"{name} ({self._worst(name)})" for name in self.lost]
        return (
            f"these parameters are not recovered: {', '.join(parts)}; with noise and residuals as recorded, this "
            "motion does not determine them, even if the model is right"
        )

    def _worst(self, parameter: str) -> str:
        mine = [row for row in self.rows if row.parameter == parameter]
        return f"off by up to {max(mine, key=lambda row: abs(row.error)).shown_error.lstrip('+-')}"

    def report(self, *, verbose: bool = False) -> str:
        """Return the result as text: one table per trial, then the verdict.

        Parameters
        ----------
        verbose : bool
            No effect: the report is always complete.
        """
        del verbose
        lines = [f"jointid self-test — {self.trials} trials, seed {self.seed}", ""]
        rows = [_HEAD, *map(_cells, self.rows)]
        widths = [max(len(row[column]) for row in rows) for column in range(len(_HEAD))]
        trial = -1
        for row, cells in zip((None, *self.rows), rows, strict=True):
            if row is not None and row.trial != trial:
                trial = row.trial
                lines.append(_title(trial))
            shown = [
                cell.rjust(width) if 0 < column < 4 and row is not None else cell.ljust(width)
                for column, (cell, width) in enumerate(zip(cells, widths, strict=True))
            ]
            lines.append("  ".join(shown).rstrip())
        return printable("\n".join([*lines, "", self.verdict]))

    def to_json(self) -> str:
        """Return the whole result as JSON with a schema version."""
        return json.dumps(self.to_dict(), indent=1, ensure_ascii=False, allow_nan=False)

    def to_dict(self) -> dict[str, Any]:
        """Return the whole result in JSON's types; a number that is not finite becomes a text."""
        document: dict[str, Any] = json_types(
            {
                "schema": SCHEMA,
                "kind": "jointid self-test",
                "passed": self.passed,
                "lost": self.lost,
                "verdict": self.verdict,
                "trials": self.trials,
                "seed": self.seed,
                "failed": self.failed,
                "rows": [asdict(row) | {"error": row.error} for row in self.rows],
            }
        )
        return document

    document = to_dict


def _title(trial: int) -> str:
    if trial == 0:
        return "trial 1: the estimate itself"
    return f"trial {trial + 1}: parameters drawn from the intervals of the estimate"


def _cells(row: SelfTestRow) -> tuple[str, ...]:
    interval = "on a bound"
    if row.interval is not None:
        interval = f"{row.interval[0]:.5g} … {row.interval[1]:.5g}"
    return (
        *(row.parameter, number(row.truth), number(row.value), row.shown_error),
        *(interval, row.unit, _comes_back(row)),
    )


def _comes_back(row: SelfTestRow) -> str:
    if row.close and not row.covered:
        return "outside its interval"
    return "yes" if row.covered and row.close else "no"
