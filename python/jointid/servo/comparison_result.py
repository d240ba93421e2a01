"""Result of a comparison of a servo's models: errors of each model's simulations of held-out runs."""

from __future__ import annotations

import json
import math
from dataclasses import field
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from numpy.typing import NDArray

from jointid.base.json_layout import json_types
from jointid.base.result import KeptResult, Overview, Quantity, require_text
from jointid.base.text_table import aligned
from jointid.base.values import dataclass
from jointid.servo.estimate import ServoEstimate

if TYPE_CHECKING:
    import pandas as pd

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ServoComparison(KeptResult):
    """Friction models of a servo, and the errors of their simulations of held-out runs.

    Attributes
    ----------
    models : tuple of str
    errors : ndarray, shape (models, runs)
        Mean absolute error of the simulated position in each run [rad]. The fit uses only other runs.
    bistable : ndarray of bool, shape (models, runs)
    runs : tuple of str
    groups : tuple of str
        Group of each run; runs of a group were held out together.
    estimate : ServoEstimate
        Estimate of the best model from all runs.
    """

    models: tuple[str, ...]
    errors: Array = field(repr=False)
    bistable: NDArray[np.bool_] = field(repr=False)
    runs: tuple[str, ...]
    groups: tuple[str, ...]
    estimate: ServoEstimate

    _KIND = "servo comparison"

    @property
    def medians(self) -> Array:
        """Median of each model's errors [rad]. A single bistable run hardly changes a median."""
        return np.asarray(np.median(self.errors, axis=1))

    @property
    def best(self) -> str:
        """The model with the smallest median."""
        return self.models[int(np.argmin(self.medians))]

    @property
    def overview(self) -> Overview:
        """Summary for a report page."""
        return Overview(
            title=f"{self.estimate.joint.name or 'servo'}: {len(self.models)} models compared",
            answer=(
                f"Use {self.best}: {self.estimate.verdict.level}.",
                "Its simulated closed loop is nearest to the held-out runs.",
            ),
            level=self.estimate.verdict.level,
            parameters=tuple(
                Quantity(
                    name=row["model"],
                    value=math.degrees(row["median"]),
                    unit="°",
                    meaning="median error of the position of held-out runs",
                    remark=f"worst {math.degrees(row['worst']):.3g}°",
                )
                for row in self._rows()
            ),
            facts=(("held out", self._setting),),
            findings=self.estimate.findings,
            inner={self.best: self.estimate},
        )

    def report(self, *, verbose: bool = False) -> str:
        """Return the table as text.

        Parameters
        ----------
        verbose : bool
            Whether to add the report of the best model's estimate. Default False.
        """
        table = [["model", "median [deg]", "worst [deg]", "bistable runs"]]
        table += [
            [
                row["model"],
                f"{math.degrees(row['median']):.2f}",
                f"{math.degrees(row['worst']):.2f}",
                str(row["bistable"]),
            ]
            for row in self._rows()
        ]
        head = f"Closed loop of {self._setting}: mean absolute error of the position"
        lines = [head, "", *aligned(table), "", f"best: {self.best}"]
        return "\n".join([*lines, "", self.estimate.report(verbose=True)] if verbose else lines)

    def to_dict(self) -> dict[str, Any]:
        """Return the whole comparison in JSON's types; the estimate has the format of `ServoEstimate.to_dict`."""
        from jointid.servo.comparison_reading import KIND, SCHEMA

        return {
            "schema": SCHEMA,
            "kind": KIND,
            "best": self.best,
            "models": list(self.models),
            "runs": list(self.runs),
            "groups": list(self.groups),
            "errors": json_types(self.errors),
            "bistable": json_types(self.bistable),
            "estimate": self.estimate.to_dict(),
        }

    def to_json(self) -> str:
        """Return `to_dict` as JSON text; `from_json` reads the text."""
        return json.dumps(self.to_dict(), indent=1, ensure_ascii=False, allow_nan=False)

    @classmethod
    def from_json(cls, text: str) -> Self:
        """Return the comparison from a JSON text.

        Parameters
        ----------
        text : str
            JSON text from `to_json`.

        Raises
        ------
        InputError
            The text is not JSON or not a servo's comparison, has another schema, or holds an invalid value. The message
            names the place in the text.
        """
        from jointid.servo.comparison_reading import comparison_fields

        return cls(**comparison_fields(require_text(text), ServoEstimate))

    def to_pandas(self) -> pd.DataFrame:
        """Return a row for each model as a data frame.

        Returns
        -------
        DataFrame
            Data frame indexed by model: median and largest error of the held-out runs [rad], and number of bistable
            runs.

        Raises
        ------
        InputError
            pandas is not installed.
        """
        from jointid.base.frames import data_frame

        return data_frame(self._rows(), index="model")

    def _rows(self) -> list[dict[str, Any]]:
        return [
            {
                "model": name,
                "median": float(self.medians[k]),
                "worst": float(self.errors[k].max()),
                "bistable": int(self.bistable[k].sum()),
            }
            for k, name in enumerate(self.models)
        ]

    @property
    def _setting(self) -> str:
        return f"{len(self.runs)} runs, held out in {len(set(self.groups))} groups"
