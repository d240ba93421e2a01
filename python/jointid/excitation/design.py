"""A designed motion: where it goes, what it keeps, and how well it will identify a joint."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from jointid.excitation.design_fields import DesignFields

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True, slots=True, kw_only=True)
class Design(DesignFields):
    """What `design_excitation` found; `load_design` reads it from a file.

    Attributes
    ----------
    status : str
        "complete", or in a few words what is wrong with it.
    reason : str
        The same in a sentence. Default: empty.
    trajectory : Trajectory
        For `simulate`, a session, files.
    joint : Joint
        The nominal one: the middle of what is believed.
    controller : Controller
        That drives the joint.
    sensors : Sensors
        That are read.
    limits : MotionLimits
        What the motion keeps.
    peaks : Peaks
        What joints drawn from what is believed reach, with noise.
    parameters : mapping of str to ExpectedError
        Of those that the motion was designed for.
    reference : mapping of str to float
        Relative error of each parameter in the thesis's motion (20 degrees, ending at rest), counted for
        the nominal joint with the same controller, sensors and duration. Default: not computed.
    criterion : str
        "worst" or "determinant".
    joints : int
        How many it was judged with.
    evaluations : int
        Motions that the search tried.
    seed : int
    duration : float
        [s]
    believed : mapping of str to (float, float)
        The range of each free parameter, from which joints were drawn. Default: not known.
    control_period : float
        Of the controller [s]. Default 1 ms.
    weakest : str
        The parameter with the largest error.
    limited_by : str
        What keeps that error from being smaller: a limit that is reached, the duration, the noise, …

    Examples
    --------
    >>> design = jid.load_design("motion.toml")
    >>> design.trajectory.duration
    4.0
    """

    def summary(self) -> str:
        """Return the design as text: expected errors, limits, what limits the weakest."""
        from jointid.excitation.tables import summary

        return summary(self)

    def plot(self) -> tuple[Axes, Axes, Axes]:
        """Draw position and velocity over time with their limits, and where friction is sampled.

        Returns
        -------
        tuple of Axes
            As `jointid.plot.designed_motion`.
        """
        from jointid.plot.design import designed_motion

        return designed_motion(self)

    def to_dict(self) -> dict[str, Any]:
        """Return what `save` writes, in JSON's types; a number that is not finite is a text."""
        from jointid.excitation.design_document import document_of

        return document_of(self)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write a file (.toml) that a session, `simulate` and `load_design` read; a failed write changes none.

        Raises
        ------
        InputError
            Another ending than ``.toml``, or a folder that does not exist.
        OSError
            The file cannot be written; an existing one is untouched.
        """
        from jointid.excitation.design_document import save_design

        save_design(self, path)

    def __str__(self) -> str:
        return self.summary()

    def _repr_html_(self) -> str:
        from jointid.excitation.tables import html_summary

        return str(html_summary(self))
