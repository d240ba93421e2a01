"""A row of a robot's comparison: one candidate with its residuals on held-out parts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from jointid.robot.links.inertia_modes import Inertia


@dataclass(frozen=True, slots=True, kw_only=True)
class ComparedRobotModel:
    """One candidate of a comparison.

    Attributes
    ----------
    inertia : str
        "urdf", "scaled" or "free".
    model : str
        Friction model of all joints.
    parameters : int
        Number of parameters in the fit to all recordings, including those at a bound.
    score : float
        Relative residual of held-out torque: mean over joints and blocks.
    stderr : float
        Its standard error over the blocks.
    fold_scores : tuple of float
        Score of each block: mean over the joints.
    joints : mapping of str to tuple of float
        Relative residual of each joint in each block; NaN where it does not move.
    reason : str
        Reason why the candidate is chosen or not.
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
        """Inertia and model as one text."""
        return f"inertia {self.inertia}, {self.model}"

    def mean_of(self, joint: str) -> float:
        """Return a joint's mean residual over the blocks in which it moves; NaN if there are none."""
        moving = [each for each in self.joints[joint] if each == each]
        return sum(moving) / len(moving) if moving else float("nan")
