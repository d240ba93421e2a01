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

    One recording is cut into contiguous blocks. Several recordings are one block each. Every model is fitted to all
    blocks except one and predicts that block. This is repeated for every block. The chosen model has the fewest
    parameters and a score within one standard error of the best score (one-standard-error rule, Breiman et al.,
    1984).

    - Joint: the score is the residual of held-out windows. A model cannot be chosen if its
      estimate from all data has the warning `model_too_rich` or a parameter at a bound.
    - Servo: the score is the error of the simulated closed loop in held-out runs. The model with the smallest median
      error is chosen. `identify` defines which joints are servos.
    - Robot: the score is the residual of the held-out torque of all joints. Candidates are all combinations of
      `inertia` and `models`.

    Options are the same for all models. Delays are identified from all data. The default duration of the windows is
    the shortest default of all models.

    Parameters
    ----------
    recordings : Recording, RobotRecording, or sequence of these
    subject : Joint or Robot, optional
        Known values, as in `identify`. The name and the field `asymmetric` of its model are not used.
    score : {"windows", "rollout"}, optional
        Score for a joint with `voltage`: "windows" compares the torque, "rollout" compares the simulated closed loop.
        Default: "windows" if `identify` uses the torque, otherwise "rollout".
    models : sequence of Model, str or mapping, optional
        Models or their texts, such as "coulomb_viscous:asymmetric". Default for a joint: all models that these data
        allow, with the gravity that `identify` would choose. `settings["left_out"]` lists the other models. Default
        for a servo: models with and without `load_friction`. Default for a robot: "coulomb_viscous" and "stribeck".
    folds : int
        Joint and robot: number of blocks of one recording, or largest number of groups of several recordings. Default
        5.
    **options
    callback : callable, optional
        Joint: function that is called with a `ComparisonStep` after every fit.

    Other Parameters
    ----------------
    groups : sequence, optional
        Servo: one label for each run. Runs with the same label are held out together. Default: the gain of the
        position loop, if the gains differ; otherwise each run is held out alone.
    threads : int
        Servo: number of threads for the simulations. Default 0: all processors.
    **servo
    inertia : sequence of str
        Robot: inertias to compare, any of "urdf", "scaled" and "free". Default: all.
    **robot

    Returns
    -------
    Comparison, ServoComparison or RobotComparison

    Raises
    ------
    InputError
        The input cannot be used, or an option does not apply to the subject. The error states the reason.
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
            "compare accepts one joint or a whole robot, but not several joints",
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
