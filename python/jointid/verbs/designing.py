"""`design`: find the motion that identifies a joint best, from prior knowledge or from an estimate."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from jointid.base.errors import InputError
from jointid.estimate.estimate import Estimate
from jointid.excitation.design import Design
from jointid.excitation.designing import design_excitation
from jointid.excitation.motion_limits import MotionLimits
from jointid.excitation.next_motion import motion_after
from jointid.joint.joint import Joint
from jointid.verbs.signatures import shows
from jointid.verbs.subjects import OtherKind, ask, check_options, keywords, other_kind


@shows(design_excitation, others={"joint": None})
def design(
    subject: Joint | Estimate,
    limits: MotionLimits | Mapping[str, Any] | None = None,
    duration: float = 12.0,
    **options: Any,
) -> Design:
    """Return the motion within limits that identifies a joint best.

    Motions are sums of sines that start and end at rest. A genetic algorithm searches for the motion with the best
    score. The score is the information of a motion about the parameters. The score comes from noise-free simulations
    of several joints within the prior. The controller is the one that will drive the joint. The best motions are then
    simulated with noise and identified.

    After an estimate, the motion adds as much information as possible to the estimate's recordings. The simulated
    joints are drawn from the estimate's intervals, and the controller uses its values. Then identify the old and the
    new recording together: ``identify([first, second], joint)``.

    Parameters
    ----------
    subject : Joint or Estimate
        The motion is designed for the free parameters of its model.
    limits : MotionLimits or mapping, optional
        Position (low, high) [rad], velocity [rad/s], acceleration [rad/s²], torque [N·m] and range of the sensor
        [N·m]. Every joint of the prior keeps these limits. Default: the joint's limits.
    duration : float
        Duration of the motion [s]. Default 12.
    controller : controller, optional
        The controller that will drive the joint. Default: an adaptive-robust law with the values of the nominal
        joint and without feedback of the torque sensor.
    sensors : Sensors, optional
        Sensors of the simulation. Default: a torque sensor with noise of 0.3 % of the torque limit; without a torque
        sensor, an encoder of 8000 counts per motor revolution. Default after an estimate: sensors with the noise of
        its residuals.
    parameters : sequence of str, optional
        Parameters to design for. Default: all free parameters.
    criterion : {"worst", "determinant"}
        Error to minimize: the largest relative error ("worst"), or the product of all relative errors. Default
        "worst". For a value near 0, the error is relative to a tenth of the range of the parameter.
    prior : mapping of str to (low, high), or sequence of mappings, optional
        Ranges of the free parameters, or values of several joints. The first joint is the nominal joint. Default: the
        joint's bounds, or ±30 % of a value without bounds. Default after an estimate: values drawn from its
        intervals.
    search : DesignSearch, optional
    control_period : float
        Period of the controller [s]. Default 0.001.
    known : Known, optional
        Joint: information about parameters from existing recordings.
    callback : callable, optional
        Function that is called with a `DesignProgress` during the search. If it returns True, the search ends early.

    Other Parameters
    ----------------
    joint : Joint, optional
        After an estimate: joint with facts that the identified joint lacks, such as a link.

    Returns
    -------
    Design
        After an estimate, the expected errors are those of an identification from the old and the new recording.
        `before` has the errors of the estimate.

    Raises
    ------
    InputError
        An argument cannot be used, a parameter has no range, the limits allow no motion, the loop is unstable for a
        joint of the prior, or the subject is not a joint.
    KeyboardInterrupt
        After Ctrl-C, within 0.1 s.

    Examples
    --------
    >>> limits = {"position": (-1.0, 1.0), "velocity": 3.4, "torque": 160.0}
    >>> search = jid.DesignSearch(evaluations=64, joints=2, rehearsals=10)  # the default takes seconds
    >>> motion = jid.design(known, limits, duration=4.0, search=search)
    >>> path = motion.save("new_motion.toml")

    After an estimate:

    >>> jid.design(estimate, limits, duration=4.0, search=search).duration
    4.0
    """
    if isinstance(subject, Estimate):
        names = {*keywords(motion_after), *keywords(design_excitation)} - {"known", "estimate"}
        check_options("design", "an estimate", options, sorted(names))
        return motion_after(subject, limits, duration, **options)
    _refuse(subject)
    found: Design = ask(
        "design", "a joint", design_excitation, subject, limits, duration, **options
    )
    return found


def _refuse(subject: object) -> None:
    """Refuse subjects without a design of motion."""
    kind = other_kind(subject)
    if kind:
        raise InputError(
            "design takes a Joint, or an Estimate of one joint",
            argument="subject",
            value=subject,
            remedy=_REMEDIES[kind],
        )


_OF_ONE = "give a jid.Joint for one joint of the robot"
_REMEDIES: dict[OtherKind, str] = {
    "robot": _OF_ONE,
    "robot estimate": _OF_ONE,
    "servo estimate": "give the servo's joint `estimate.identified`, because its input is a torque",
    "joint estimates": "choose one: `found[NAME]`",
}
