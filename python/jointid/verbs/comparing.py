"""`compare`: find the model that predicts held-out data best, for a joint, a servo or a robot."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal, Unpack, overload

from jointid.base.errors import InputError
from jointid.comparison import comparison
from jointid.comparison.fitter import ComparisonStep
from jointid.comparison.result import Comparison
from jointid.identification.options import CompareOptions
from jointid.joint.joint import Joint
from jointid.joint.model import Model
from jointid.recording.recording import Recording
from jointid.recording.wide.robot_recording import RobotRecording
from jointid.robot.links.inertia_modes import MODES
from jointid.robot.options import RobotFitOptions
from jointid.servo.options import ServoFitOptions
from jointid.verbs.signatures import shows
from jointid.verbs.subjects import WORDS, Subject, ask, listed, second, subject_of

if TYPE_CHECKING:
    from jointid.robot.links.inertia_modes import Inertia
    from jointid.robot.links.robot import Robot
    from jointid.robot.result.comparison_result import RobotComparison
    from jointid.servo.comparison_result import ServoComparison


# A type checker cannot distinguish a servo from another joint: without servo options it assumes a joint.
@overload
def compare(
    recordings: Recording | Sequence[Recording],
    subject: Joint | None = None,
    *,
    score: Literal["windows"] | None = None,
    models: Model | str | Sequence[Any] | None = None,
    folds: int = 5,
    callback: Callable[[ComparisonStep], object] | None = None,
    **options: Unpack[CompareOptions],
) -> Comparison: ...


@overload
def compare(
    recordings: Recording | Sequence[Recording],
    subject: Joint,
    *,
    score: Literal["rollout"] | None = None,
    models: Model | str | Sequence[Any] | None = None,
    groups: Sequence[Hashable] | None = None,
    threads: int = 0,
    **options: Unpack[ServoFitOptions],
) -> ServoComparison: ...


@overload
def compare(
    recordings: RobotRecording | Sequence[RobotRecording],
    subject: Robot,
    *,
    models: Model | str | Sequence[Model | str] = ...,
    inertia: Inertia | Sequence[Inertia] = ...,
    folds: int = 5,
    **options: Unpack[RobotFitOptions],
) -> RobotComparison: ...


@shows(
    comparison.compare_models,
    others={"groups": None, "threads": 0, "inertia": MODES},
    options=CompareOptions,
    servo=ServoFitOptions,
    robot=RobotFitOptions,
)
def compare(
    recordings: Any,
    subject: Any = None,
    *,
    score: Literal["windows", "rollout"] | None = None,
    **of_other_subjects: Any,
) -> Any:
    """Compare friction models by their prediction of held-out data.

    One recording is cut into contiguous blocks; several recordings are one block each. Every model is fitted to all
    blocks except one and predicts that block. This is repeated for every block. The chosen model has the fewest
    parameters and a score within one standard error of the best (one-standard-error rule, Breiman et al., 1984).

    - Joint: the residual of held-out windows decides. A model that the data do not support cannot be chosen: its
      estimate from all data has the warning `model_too_rich`, or a parameter at a bound.
    - Servo: the simulated closed loop of held-out runs decides. The model with the smallest median error is chosen.
      `identify` defines which joints are servos.
    - Robot: the held-out torque of all joints decides. Candidates are all inertias of the links with each model.

    Options are the same for all models. Delays are identified from all data. The default of windows is the shortest of
    the models' defaults.

    Parameters
    ----------
    recordings : Recording, RobotRecording, or sequence of these
    subject : Joint or Robot, optional
        Known values, as in `identify`; the model's name and `asymmetric` are not used.
    score : {"windows", "rollout"}, optional
        Only for a joint with `voltage`: "windows" compares by its torque, "rollout" by its closed loop. Default: the
        torque if `identify` uses it.
    models : sequence of Model, str or mapping, optional
        Models or their texts, such as "coulomb_viscous:asymmetric". Default for a joint: all that these data allow,
        with the gravity that `identify` would choose; `settings["left_out"]` lists the others. For a servo: with and
        without friction of the load. For a robot: "coulomb_viscous" and "stribeck".
    folds : int
        Joint and robot: number of blocks of one recording, or largest number of groups of several. Default 5.
    **options
    callback : callable, optional
        Joint: called with a `ComparisonStep` after every fit.

    Other Parameters
    ----------------
    groups : sequence, optional
        Servo: a label per run; runs with the same label are held out together. Default: by the position loop's gain
        if there are several, otherwise each run alone.
    threads : int
        Servo: number of threads for the rollouts; 0 (default): all.
    **servo
    inertia : sequence of str
        Robot: any of "urdf", "scaled" and "free" (all by default).
    **robot

    Returns
    -------
    Comparison, ServoComparison or RobotComparison

    Raises
    ------
    InputError
        The input cannot be used, or the subject does not have an option. The error gives the reason.
    KeyboardInterrupt
        Ctrl-C.

    Examples
    --------
    A joint:

    >>> found = jid.compare(recording, joint, models=["coulomb_viscous", "stribeck"], folds=3)
    >>> found.winner, found.estimate.settings["model"]
    ('stribeck', 'stribeck')

    A servo:

    >>> jid.compare(servo_runs, servo).best
    'coulomb_viscous:load_friction'

    A robot:

    >>> robot = jid.Robot.from_urdf("arm.urdf")
    >>> found = jid.compare(jid.load("arm.csv", joints="all"), robot, inertia="urdf")
    >>> found.winner.inertia
    'urdf'
    """
    options = of_other_subjects
    subject, recordings = second(subject, options, "joint", "robot"), listed(recordings)
    kind = subject_of("compare", recordings, subject)
    if kind == "joints":
        raise InputError(
            "compare of several joints takes one joint at a time, or a robot",
            argument="recordings",
            value=recordings,
            remedy=("compare recordings.joint(NAME)", "give jid.Robot.from_urdf(path)"),
        )
    if score is not None:
        kind = _scored(score, kind)
    if kind == "joint":
        return ask(
            "compare", WORDS[kind], comparison.compare_models, recordings, subject, **options
        )
    if kind == "robot":
        from jointid.robot.comparing import compare_robot_models

        return ask("compare", WORDS[kind], compare_robot_models, recordings, subject, **options)
    from jointid.servo.comparing import compare_servo_models

    models = options.get("models")
    if isinstance(models, str | Model | Mapping):
        options["models"] = (models,)
    runs = [recordings] if isinstance(recordings, Recording) else recordings
    return ask("compare", WORDS[kind], compare_servo_models, runs, subject, **options)


def _scored(score: str, kind: Subject) -> Subject:
    """Return the subject that a score belongs to."""
    if kind == "robot":
        raise InputError("compare of a robot has no such option", argument="score", value=score)
    if score not in ("windows", "rollout"):
        raise InputError("windows or rollout is expected", argument="score", value=score)
    return "joint" if score == "windows" else "servo"
