"""A row of a robot's comparison: one candidate with its residuals on held-out parts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from jointid.robot.links.inertia_modes import Inertia


@dataclass(frozen=True, slots=True, kw_only=True)
class ComparedRobotModel:
    """One row of a comparison.

    Attributes
    ----------
    inertia : str
        "urdf", "scaled" or "free".
    model : str
        Of all joints.
    parameters : int
        Of the fit to all recordings, also those that end at a bound: the model has them.
    score : float
        Relative residual of held-out torque: mean over joints and blocks.
    stderr : float
        Its standard error over the blocks.
    fold_scores : tuple of float
        Of the blocks, mean over the joints.
    joints : mapping of str to tuple of float
        Relative residual of each joint in each block; NaN where it does not move.
    reason : str
        Why it wins or does not win.
    """

    inertia: Inertia
    model: str
    parameters: int
    score: float
    stderr: float
    fold_scores: tuple[float, ...]
    joints: Mapping[str, tuple[float, ...]]
    reason: str = ""

    @property
    def name(self) -> str:
        """Inertia and model in one text."""
        return f"inertia {self.inertia}, {self.model}"

    def mean_of(self, joint: str) -> float:
        """Return a joint's mean residual over the blocks in which it moves; NaN without one."""
        moving = [each for each in self.joints[joint] if each == each]
        return sum(moving) / len(moving) if moving else float("nan")
