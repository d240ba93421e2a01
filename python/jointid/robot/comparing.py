"""`compare_robot_models`: find the inertia and friction models that predict held-out torque best."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Unpack

import numpy as np
from numpy.typing import NDArray

from jointid.balance.held_out import in_errors, one_error, preferred
from jointid.base.argument_checks import require_kind, whole_number
from jointid.base.errors import InputError
from jointid.base.options import checked, takes
from jointid.comparison.judging import Entrant, judged
from jointid.joint.model import Model
from jointid.problem.settings import MaskOptions
from jointid.recording.wide.robot_recording import RobotRecording
from jointid.robot.balance.held_out import blocks_of, part_of_balance, predicted_torque
from jointid.robot.fit.attempt import Attempt, Request, fitted
from jointid.robot.fit.velocity_choice import with_better_velocities
from jointid.robot.identifying import identify_robot
from jointid.robot.links.inertia_modes import MODES, Inertia
from jointid.robot.links.models import MODELS, PLAIN, SHAPED, friction_models, name_of
from jointid.robot.links.robot import Robot
from jointid.robot.motion.request import least_speeds, recordings_of
from jointid.robot.motion.shifts import shift_option
from jointid.robot.motion.stamps import all_on_even_clocks
from jointid.robot.options import RobotFitOptions
from jointid.robot.result.comparison_result import RobotComparison
from jointid.robot.result.comparison_row import ComparedRobotModel

Array = NDArray[np.float64]
Whole = NDArray[np.int64]


@takes(RobotFitOptions)
def compare_robot_models(
    recordings: RobotRecording | Sequence[RobotRecording],
    robot: Robot,
    *,
    models: Sequence[Model | str] = (PLAIN, SHAPED),
    inertia: Inertia | Sequence[Inertia] = MODES,
    folds: int = 5,
    **options: Unpack[RobotFitOptions],
) -> RobotComparison:
    """Compare inertias and friction models of a robot by their prediction of held-out torque.

    One recording is cut into contiguous blocks. Several recordings are one block each. Each inertia with each friction
    model is fitted to all blocks except one, and predicts the torque of that block. This is repeated for every block.
    The candidate with the fewest parameters is chosen that is at most one standard error worse than the best. The
    standard error is that of their difference over the blocks. Each joint's model is then chosen by the same rule from
    the joint's own torque, with the chosen inertia. Options are the same for all candidates. Delays and zeros are
    identified from all recordings.

    Parameters
    ----------
    recordings : RobotRecording, or sequence of it
    robot : Robot
    models : sequence of Model or str
        Friction models to compare, for all joints. Default: "coulomb_viscous" and "stribeck".
    inertia : sequence of str
        Inertias to compare: any of "urdf", "scaled" and "free". Default: all.
    folds : int
        Number of blocks of one recording, or largest number of groups of several. Default 5.
    **options

    Returns
    -------
    RobotComparison

    Raises
    ------
    InputError
        The errors of `identify`, or invalid candidates or folds.

    Examples
    --------
    >>> robot = jid.Robot.from_urdf("arm.urdf")
    >>> found = jid.compare(jid.load("arm.csv", joints="all"), robot, inertia="urdf")
    >>> isinstance(found, jid.RobotComparison), found.winner.inertia
    (True, 'urdf')
    """
    require_kind("robot", robot, Robot)
    given = recordings_of(recordings)
    modes = _modes(inertia)
    every = _models(models, robot)
    count = whole_number("folds", folds, 2, 1000)
    slowest, mask = least_speeds(options["min_speed"], robot), checked(MaskOptions, options)
    request = Request(
        inertia=modes[0],
        models=(PLAIN,) * robot.n,
        windows=options["windows"],
        slowest=slowest,
        **mask,
        further_modes=modes[1:],
    )
    runs = all_on_even_clocks(given)
    alignment = with_better_velocities(runs, robot, request, options["shift"]).alignment
    attempt = alignment.attempt
    blocks = blocks_of(attempt.balance.rows, attempt.runs, count)
    rows, left_out = [], {}
    for mode in modes:
        for model in every:
            try:
                rows.append(_row(attempt, mode, model, blocks))
            except InputError as error:
                left_out[f"inertia {mode}, {model}"] = str(error)
    if not rows:
        raise InputError(
            f"no model can be fitted: {next(iter(left_out.values()))}", argument="inertia"
        )
    verdict = judged([_entrant(row) for row in rows], paired=True)
    reasoned = [
        replace(row, reason=reason) for row, reason in zip(rows, verdict.reasons, strict=True)
    ]
    winner = reasoned[verdict.winner]
    rivals = [row for row in reasoned if row.inertia == winner.inertia]
    found = {name: _model_of(name, rivals, winner) for name in robot.names}
    estimate = identify_robot(
        given,
        attempt.robot,
        inertia=winner.inertia,
        model=found,
        windows=attempt.duration,
        min_speed=slowest.tolist(),
        **mask,
        shift=shift_option(attempt.delay, attempt.robot, alignment.request.lag),
    )
    several = len(given) > 1
    return RobotComparison(
        rows=tuple(reasoned),
        winner=winner,
        models=found,
        reason=verdict.sentence,
        estimate=estimate,
        settings={
            "folds": int(blocks.max()) + 1,
            "held_out": "block"
            if not several
            else "recording"
            if len(given) <= count
            else "recordings",
            "window_duration": attempt.duration,
            "left_out": left_out,
        },
    )


def _modes(inertia: object) -> tuple[Inertia, ...]:
    found: Any = (inertia,) if isinstance(inertia, str) else inertia
    if not isinstance(found, list | tuple) or not found or set(found) - set(MODES):
        raise InputError(
            f"one or more of {', '.join(MODES)} are expected", argument="inertia", value=inertia
        )
    return tuple(dict.fromkeys(found))


def _models(models: object, robot: Robot) -> list[str]:
    found = (models,) if isinstance(models, str | Model) else models
    if not isinstance(found, list | tuple) or not found:
        raise InputError("a list of models is expected", argument="models", value=models)
    names = [friction_models(each, robot.names)[0] for each in found]
    if {name_of(each) for each in names} - set(MODELS):
        raise InputError(
            f"the models are {', '.join(MODELS)}, each also as NAME:asymmetric. A mapping from joints to models is not "
            "expected: the comparison chooses each joint's model.",
            argument="models",
            value=models,
        )
    return list(dict.fromkeys(names))


def _row(attempt: Attempt, mode: Inertia, model: str, blocks: Whole) -> ComparedRobotModel:
    robot, balance = attempt.robot, attempt.balance
    models = [model] * robot.n
    whole, _ = fitted(robot, balance, mode, models)
    scores = np.full((int(blocks.max()) + 1, robot.n), np.nan)
    for fold in range(len(scores)):
        fit, _ = fitted(robot, part_of_balance(balance, blocks != fold), mode, models)
        held = part_of_balance(balance, blocks == fold)
        missed = held.rows.torque - predicted_torque(fit, held)
        for joint, place in enumerate(held.places):
            measured = float(np.linalg.norm(held.rows.torque[place]))
            if measured > 0.0:
                scores[fold, joint] = float(np.linalg.norm(missed[place])) / measured
    if np.all(np.isnan(scores), axis=1).any():
        raise InputError("no joint moves in one of the blocks", argument="folds", value=len(scores))
    means = np.nanmean(scores, axis=1)
    return ComparedRobotModel(
        inertia=mode,
        model=model,
        parameters=whole.at_bound.size,
        score=float(means.mean()),
        stderr=float(means.std(ddof=1) / np.sqrt(means.size)),
        fold_scores=tuple(means.tolist()),
        joints={name: tuple(scores[:, k].tolist()) for k, name in enumerate(robot.names)},
    )


def _entrant(row: ComparedRobotModel) -> Entrant:
    return Entrant(
        name=row.name,
        parameters=row.parameters,
        score=row.score,
        stderr=row.stderr,
        parts=row.fold_scores,
    )


def _model_of(name: str, rivals: Sequence[ComparedRobotModel], winner: ComparedRobotModel) -> str:
    """Return the model of one joint, chosen by its own torque."""
    scores = np.array([row.joints[name] for row in rivals])
    scores = scores[:, ~np.isnan(scores).any(axis=0)]
    if not scores.shape[1]:
        return winner.model
    limit = one_error(scores.shape[1])
    _, chosen = preferred(
        scores.mean(axis=1).tolist(),
        [row.parameters for row in rivals],
        lambda each, best: in_errors(scores[each] - scores[best]) > limit,
    )
    return rivals[chosen].model
