"""`compare_servo_models`: friction models compared by the closed loops of runs that their fits did not see."""

from __future__ import annotations

import math
from collections.abc import Hashable, Sequence
from dataclasses import field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from jointid.base.errors import InputError
from jointid.base.notebook import Shown
from jointid.base.text_table import aligned
from jointid.base.values import dataclass
from jointid.joint.joint import Joint
from jointid.joint.model import Model
from jointid.recording.recording import Recording
from jointid.servo.estimate import ServoEstimate
from jointid.servo.identifying import identify_servo
from jointid.servo.layout import DEFAULT_MODEL
from jointid.servo.rolling_out import rollout
from jointid.servo.signals import signals_of

Array = NDArray[np.float64]

MODELS = tuple(Model.parse(DEFAULT_MODEL).replace(load_friction=load) for load in (False, True))
"""What is compared by default."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ServoComparison(Shown):
    """Models and the errors of their rollouts on held-out runs.

    Attributes
    ----------
    models : tuple of str
    errors : ndarray, shape (models, runs)
        Mean absolute error of the position of each run, from the fit that did not see it [rad].
    bistable : ndarray of bool, shape (models, runs)
    runs : tuple of str
    groups : tuple of str
        The group that each run was held out with.
    estimate : ServoEstimate
        Of the best model, from all runs.
    """

    models: tuple[str, ...]
    errors: Array = field(repr=False)
    bistable: NDArray[np.bool_] = field(repr=False)
    runs: tuple[str, ...]
    groups: tuple[str, ...]
    estimate: ServoEstimate

    @property
    def medians(self) -> Array:
        """Median of each model's errors [rad]: a bistable run does not decide it."""
        return np.asarray(np.median(self.errors, axis=1))

    @property
    def best(self) -> str:
        """The model with the smallest median."""
        return self.models[int(np.argmin(self.medians))]

    def report(self) -> str:
        """Return the table as text."""
        table = [["model", "median [deg]", "worst [deg]", "bistable runs"]]
        for k, name in enumerate(self.models):
            table.append(
                [
                    name,
                    f"{math.degrees(self.medians[k]):.2f}",
                    f"{math.degrees(self.errors[k].max()):.2f}",
                    str(int(self.bistable[k].sum())),
                ]
            )
        groups = len(set(self.groups))
        head = f"Closed loop of {len(self.runs)} runs, held out in {groups} groups: mean absolute error"
        return "\n".join([head, "", *aligned(table), "", f"best: {self.best}"])


def compare_servo_models(
    recordings: Sequence[Recording],
    joint: Joint,
    *,
    models: Sequence[Model | str] | None = None,
    groups: Sequence[Hashable] | None = None,
    threads: int = 0,
    **options: Any,
) -> ServoComparison:
    """Compare friction models of a servo by rollouts of held-out runs.

    Parameters
    ----------
    recordings : sequence of Recording
        As for `identify_servo`; several.
    joint : Joint
    models : sequence of Model or str, optional
        Default: `MODELS`, with and without friction of the load.
    groups : sequence, optional
        A label for each run: runs of one label are held out together. Default: by the position loop's gain where
        there are several, else each run for itself.
    threads : int
        Of the rollouts; 0 (default): all.
    **options
        Of `identify_servo`: `window`, `slowest`, `lead`.

    Returns
    -------
    ServoComparison

    Raises
    ------
    InputError
        Fewer than two groups, or as in `identify_servo` and `rollout`.

    Examples
    --------
    >>> compared = jid.compare_servo_models(servo_runs, servo)
    >>> isinstance(compared, jid.ServoComparison)
    True
    """
    runs = list(recordings)
    chosen = MODELS if models is None else tuple(Model.of(each) for each in models)
    if not chosen:
        raise InputError("at least one model is expected", argument="models", value=[])
    labels = _labels(runs, joint, groups)
    errors = np.empty((len(chosen), len(runs)))
    unsure = np.zeros((len(chosen), len(runs)), dtype=bool)
    for label in dict.fromkeys(labels):
        out = [k for k, own in enumerate(labels) if own == label]
        train = [run for run, own in zip(runs, labels, strict=True) if own != label]
        for row, model in enumerate(chosen):
            found = identify_servo(train, joint, model=model, draws=0, **options)
            rolled = rollout(found, [runs[k] for k in out], threads=threads)
            errors[row, out] = rolled.errors
            unsure[row, out] = [each.bistable for each in rolled.runs]
    best = chosen[int(np.argmin(np.median(errors, axis=1)))]
    return ServoComparison(
        models=tuple(str(model) for model in chosen),
        errors=errors,
        bistable=unsure,
        runs=tuple(run.name for run in runs),
        groups=tuple(str(label) for label in labels),
        estimate=identify_servo(runs, joint, model=best, **options),
    )


def _labels(
    runs: Sequence[Recording], joint: Joint, groups: Sequence[Hashable] | None
) -> list[Hashable]:
    labels: list[Hashable]
    if groups is None:
        labels = [run.gain for run in signals_of(runs, joint)]
        if len(set(labels)) < 2:
            labels = list(range(len(runs)))
    else:
        labels = list(groups)
    if len(labels) != len(runs):
        raise InputError(
            f"one label for each of {len(runs)} runs is expected", argument="groups", value=labels
        )
    if len(set(labels)) < 2:
        raise InputError(
            "at least two groups of runs are needed, one to be held out",
            argument="groups",
            value=[str(label) for label in labels],
        )
    return labels
