"""`compare_models`: find the friction model that predicts held-out motion best."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Literal, Unpack, overload

import numpy as np

from jointid import _core
from jointid.base.errors import InputError
from jointid.base.options import options_of, takes
from jointid.comparison.contenders import compared_models, default_models, shown_gravity, text_of
from jointid.comparison.fitter import ComparisonStep, Fitter, with_causes
from jointid.comparison.held_out import folds_by_block, folds_by_recording
from jointid.comparison.judging import Entrant, judged
from jointid.comparison.load_evidence import load_refusal
from jointid.comparison.result import Comparison
from jointid.comparison.row import ComparedModel
from jointid.estimate.estimate import Estimate
from jointid.estimate.settings import model_of
from jointid.identification.options import CompareOptions
from jointid.identification.prepared import require_joint
from jointid.identification.search.search import Search
from jointid.joint.joint import Joint
from jointid.joint.model import Model
from jointid.problem.constant_torque import undivided
from jointid.problem.recordings import listed
from jointid.problem.settings import Settings
from jointid.problem.windows import Windows
from jointid.recording.recording import Recording

if TYPE_CHECKING:
    from jointid.servo.comparison_result import ServoComparison


@overload
def compare_models(
    recordings: Recording | Sequence[Recording],
    joint: Joint | None = None,
    *,
    score: Literal["rollout"],
    models: Model | str | Sequence[Any] | None = None,
) -> ServoComparison: ...


@overload
def compare_models(
    recordings: Recording | Sequence[Recording],
    joint: Joint | None = None,
    *,
    score: Literal["windows"] = "windows",
    models: Model | str | Sequence[Any] | None = None,
    folds: int = 5,
    callback: Callable[[ComparisonStep], object] | None = None,
    **options: Unpack[CompareOptions],
) -> Comparison: ...


@takes(CompareOptions)
def compare_models(
    recordings: Recording | Sequence[Recording],
    joint: Joint | None = None,
    *,
    score: Literal["windows", "rollout"] = "windows",
    models: Model | str | Sequence[Any] | None = None,
    folds: int = 5,
    callback: Callable[[ComparisonStep], object] | None = None,
    **options: Unpack[CompareOptions],
) -> Comparison | ServoComparison:
    """Compare friction models by their prediction of held-out data.

    One recording is cut into contiguous blocks. Several recordings are one block each. Every model is fitted to all
    blocks except one and predicts that block. This is repeated for every block. The chosen model has the fewest
    parameters and a score within one standard error of the best score (one-standard-error rule, Breiman et al., 1984).
    A model cannot be chosen if its estimate from all data has the warning `model_too_rich` or a parameter at a bound.

    The options of `identify` are the same for all models. Delays are identified from all data. The default of windows
    is the shortest of the models' defaults.

    Parameters
    ----------
    recordings : Recording or sequence of Recording
    joint : Joint, optional
        Known values, as in `identify`; its model's name and `asymmetric` are not used.
    score : str
        "windows" (default): the balance of held-out windows. "rollout": the simulated closed loop of held-out runs, for
        a servo without a torque signal; `models` is then the only option, see `compare`.
    models : sequence of Model, str or mapping, optional
        Models or their texts, such as "coulomb_viscous:asymmetric". Default: `default_models()`, all with the gravity
        that `identify` would choose. Models that cannot be used with these data are omitted and listed in
        `settings["left_out"]`.
    folds : int
        Number of blocks of one recording, or largest number of groups of several recordings. Default 5.
    **options
    callback : callable, optional
        Called with a `ComparisonStep` after every fit.

    Returns
    -------
    Comparison
        A `ServoComparison` with ``score="rollout"``.

    Raises
    ------
    InputError
        The input cannot be used. The error names the argument and the reason.
    KeyboardInterrupt
        Ctrl-C.

    Examples
    --------
    >>> found = jid.compare(recording, joint, models=["coulomb_viscous", "stribeck"], folds=3)
    >>> found.winner, found.estimate.settings["model"]
    ('stribeck', 'stribeck')
    """
    if score == "rollout":
        usual = {name: option.default for name, option in options_of(CompareOptions).items()}
        if folds != 5 or callback is not None or options != usual:
            raise InputError(
                "for a servo, only the option models is allowed here; compare(recordings, servo) has more options",
                argument="score",
                value=score,
            )
        from jointid.servo.comparing import compare_servo_models

        return compare_servo_models(listed(recordings), _servo(joint), models=_listed(models))
    if score != "windows":
        raise InputError("windows or rollout is expected", argument="score", value=score)
    runs = listed(recordings)
    require_joint(joint)
    settings, search = Settings.of(options), Search.of(options["search"])
    windows = settings.windows
    specs = compared_models(models) if models is not None else default_models()
    if models is None:
        gravity = shown_gravity(runs, joint, settings)
        specs = tuple(spec.replace(gravity=gravity) for spec in specs)
    if isinstance(folds, bool) or not isinstance(folds, int | np.integer) or folds < 2:
        raise InputError("a whole number of 2 or more is expected", argument="folds", value=folds)
    parts = int(folds) if len(runs) == 1 else min(int(folds), len(runs))
    if settings.residual is None and any(spec.load_friction for spec in specs):
        # The residual that all models have, because fits with different residuals are not comparable.
        settings = replace(settings, residual="torque")
    fitter = Fitter(
        joint=joint,
        settings=settings,
        search=search,
        total=len(specs) * (1 + parts),
        callback=callback,
    )
    whole: dict[Model, Estimate] = {}
    left_out: dict[str, str] = {}
    for spec in specs:
        try:
            whole[spec] = fitter.fit(spec, runs, windows, attribute=len(specs) == 1)
        except InputError as error:
            if models is not None or spec == specs[0]:
                raise
            cause = error.__cause__
            left_out[text_of(spec)] = _without_remedy(
                cause if isinstance(cause, InputError) else error
            )
            fitter.total -= 1 + parts
    # Delays come from the data, not from the model: those of all data apply to every part.
    fitter.shift(next(iter(whole.values())).settings["shift"])
    # Residuals over windows of different duration are not comparable, so all models get the shortest windows.
    duration = min(estimate.settings["windows"] for estimate in whole.values())
    cut = _core.WindowOptions(duration=duration, cumulative=_cumulative(windows))
    for spec, estimate in whole.items():
        if not np.isclose(estimate.settings["windows"], duration, rtol=1e-9, atol=0.0):
            fitter.total += 1
            whole[spec] = fitter.fit(spec, runs, cut)
    first = next(iter(whole.values()))
    splits = (
        folds_by_block(runs[0], first.windows, parts)
        if len(runs) == 1
        else folds_by_recording(runs, parts)
    )
    rows = [
        _row(spec, estimate, fitter.scores(_as_found(spec, estimate), splits, cut, estimate))
        for spec, estimate in whole.items()
    ]
    reasoned, winner, reason = judge(rows)
    kind = "block" if len(runs) == 1 else "recording" if parts == len(runs) else "recordings"
    return Comparison(
        rows=reasoned,
        winner=reasoned[winner].model,
        reason=reason,
        estimate=with_causes(whole[reasoned[winner].spec]),
        settings={
            "folds": parts,
            "held_out": kind,
            "windows": duration,
            "method": search.chosen_method,
            "residual": first.settings["residual"],
            "left_out": left_out,
        },
    )


def _servo(joint: Joint | None) -> Joint:
    if joint is None or joint.voltage is None:
        raise InputError(
            'rollouts need a joint with input = "voltage" in its drive',
            argument="score",
            value="rollout",
        )
    return joint


def _listed(models: Model | str | Sequence[Any] | None) -> Sequence[Any] | None:
    return (models,) if isinstance(models, str | Model | Mapping) else models


def _as_found(spec: Model, estimate: Estimate) -> Model:
    """Return a model with the load terms chosen from all data, so that every fold has the same terms."""
    if not spec.load_friction:
        return spec
    return spec.replace(load_friction=model_of(estimate.settings).load_friction)


def _without_remedy(error: InputError) -> str:
    """Return an error's sentence without its remedy, because the caller did not choose this model."""
    return str(
        InputError(error.reason, argument=error.argument, value=error.value, place=error.place)
    )


def _cumulative(windows: Windows) -> bool:
    given = isinstance(windows, _core.WindowOptions) and windows.cumulative
    return given or windows == "cumulative"


def _row(spec: Model, estimate: Estimate, scores: Sequence[float]) -> ComparedModel:
    reason = refusal(estimate)
    return ComparedModel(
        model=text_of(spec),
        spec=spec,
        parameters=counted(estimate),
        score=float(np.mean(scores)),
        stderr=float(np.std(scores, ddof=1) / np.sqrt(len(scores))),
        fold_scores=tuple(scores),
        penalty=estimate.penalty,
        eligible=reason is None,
        reason=reason or "",
    )


def judge(rows: Sequence[ComparedModel]) -> tuple[tuple[ComparedModel, ...], int, str]:
    """Choose a model by the one-standard-error rule.

    Returns
    -------
    rows : tuple of ComparedModel
        The rows, each with its reason.
    winner : int
        Index of the chosen row.
    reason : str
        Reason of the choice, in a sentence.
    """
    found = judged(
        [
            Entrant(
                name=row.model,
                parameters=row.parameters,
                score=row.score,
                stderr=row.stderr,
                parts=row.fold_scores,
                eligible=row.eligible,
            )
            for row in rows
        ]
    )
    reasons = [
        "; ".join(filter(None, both))
        for both in zip((row.reason for row in rows), found.reasons, strict=True)
    ]
    reasoned = [replace(row, reason=reason) for row, reason in zip(rows, reasons, strict=True)]
    sentence = found.sentence
    refused = [row.model for row in rows if not row.eligible]
    if len(refused) == len(rows):
        sentence += "; but the data support none of the models: see the warnings of the chosen model's estimate"
    elif refused:
        sentence += f"; the data do not support {', '.join(refused)}"
    return tuple(reasoned), found.winner, sentence


def counted(estimate: Estimate) -> int:
    """Return the number of parameters that the data determine, without an inseparable offset."""
    free = [parameter.name for parameter in estimate.parameters.values() if parameter.vary]
    return len(free) - len(undivided(free))


def refusal(estimate: Estimate) -> str | None:
    """Return why the data do not support a model, or None if they do."""
    for warning in estimate.warnings:
        if warning.code in ("model_too_rich", "load_scale"):
            return f"not eligible: {warning.cause}"
    ended = [p for p in estimate.parameters.values() if p.at_bound is not None]
    if ended:
        bounds = ", ".join(
            f"{p.name} at its {'lower' if p.at_bound == 'min' else 'upper'} bound" for p in ended
        )
        return f"not eligible: {bounds}"
    reason = load_refusal(estimate)
    return None if reason is None else f"not eligible: {reason}"
