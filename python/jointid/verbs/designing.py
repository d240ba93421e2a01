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

    Motions are sums of sines that start and end at rest. A genetic algorithm searches them. The score of a motion is
    its information about the parameters. It comes from a noise-free simulation with the controller that will drive the
    joint, for several joints within the prior. The best motions are then simulated with noise and identified.

    After an estimate, the motion is the one that adds most information to its recordings. Joints are drawn from its
    intervals, and the controller uses its values. Then identify both recordings together:
    ``identify([first, second], joint)``.

    Parameters
    ----------
    subject : Joint or Estimate
        The motion is designed for the free parameters of its model.
    limits : MotionLimits or mapping, optional
        Position (low, high) [rad], velocity [rad/s], acceleration [rad/s²], torque [N·m] and range of
        the sensor [N·m]; every joint of the prior keeps them. Default: the joint's.
    duration : float
        Duration of the motion [s]. Default 12.
    controller : controller, optional
        The controller that will drive the joint. Default: an adaptive-robust law with the values of the nominal
        joint and without feedback of the torque sensor.
    sensors : Sensors, optional
        Sensors of the simulation. Default: noise of 0.3 % of the torque limit at the torque sensor; without one, an
        encoder of 8000 counts per motor revolution. After an estimate: with the noise of its residuals.
    parameters : sequence of str, optional
        Parameters to design for. Default: all free parameters.
    criterion : {"worst", "determinant"}
        Minimize the largest relative error, or the product of all. Default "worst". A value near 0 counts as a
        tenth of its range.
    prior : mapping of str to (low, high), or sequence of mappings, optional
        Ranges of the free parameters, or values of several joints; the first one is the nominal joint. Default: the
        joint's bounds; 30 % around a value without bounds. After an estimate: drawn from its intervals.
    search : DesignSearch, optional
    control_period : float
        Period of the controller [s]. Default 0.001.
    known : Known, optional
        Joint: information about parameters from existing recordings.
    callback : callable, optional
        Called with a `DesignProgress` at intervals; if it returns True, the search ends early.

    Other Parameters
    ----------------
    joint : Joint, optional
        Estimate: facts that the identified joint lacks, such as a link.

    Returns
    -------
    Design
        After an estimate, errors are those expected from both recordings together; `before` has the errors of the
        estimate.

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


_OF_ONE = "give a jid.Joint for one of its joints"
_REMEDIES: dict[OtherKind, str] = {
    "robot": _OF_ONE,
    "robot estimate": _OF_ONE,
    "servo estimate": "give its .identified joint, which takes a torque",
    "joint estimates": "choose one: `found[NAME]`",
}
