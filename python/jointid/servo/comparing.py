"""`compare_servo_models`: compare friction models by closed-loop simulations of held-out runs."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from typing import Unpack

import numpy as np

from jointid.base.errors import InputError
from jointid.base.options import takes
from jointid.joint.joint import Joint
from jointid.joint.model import Model
from jointid.recording.recording import Recording
from jointid.servo.comparison_result import ServoComparison
from jointid.servo.identifying import identify_servo
from jointid.servo.layout import DEFAULT_MODEL
from jointid.servo.options import ServoFitOptions
from jointid.servo.rolling_out import rollout
from jointid.servo.signals import signals_of

MODELS = tuple(Model.parse(DEFAULT_MODEL).replace(load_friction=load) for load in (False, True))
"""Models that are compared by default."""


@takes(ServoFitOptions)
def compare_servo_models(
    recordings: Sequence[Recording],
    joint: Joint,
    *,
    models: Sequence[Model | str] | None = None,
    groups: Sequence[Hashable] | None = None,
    threads: int = 0,
    **options: Unpack[ServoFitOptions],
) -> ServoComparison:
    """Compare friction models of a servo by simulations of held-out runs.

    Parameters
    ----------
    recordings : sequence of Recording
        Several runs, as for `identify`.
    joint : Joint
    models : sequence of Model or str, optional
        Friction models to compare. Default: `MODELS`, with and without friction of the load.
    groups : sequence, optional
        A label per run; runs with the same label are held out together. Default: by the position loop's gain if there
        are several, otherwise each run alone.
    threads : int
        Number of threads for the simulations; 0 (default): all.
    **options

    Returns
    -------
    ServoComparison

    Raises
    ------
    InputError
        There are fewer than two groups, or one of the errors of `identify` and `simulate` occurs.

    Examples
    --------
    >>> compared = jid.compare(servo_runs, servo)
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
            "at least two groups of runs are needed, because one is held out",
            argument="groups",
            value=[str(label) for label in labels],
        )
    return labels
