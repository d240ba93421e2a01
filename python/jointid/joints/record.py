"""Fields of several joints' estimates: the result of each joint, and the couplings between their residuals."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import field

from jointid.base.error_text import joint_phrase
from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.estimate.estimate import Estimate
from jointid.joints.coupling import Share
from jointid.joints.signals import MEANING
from jointid.recording.wide.joint_names import joint_named

IDENTIFIED, FAILED = "identified", "failed"


@dataclass(frozen=True, slots=True, kw_only=True)
class JointResult:
    """The result of one joint.

    Attributes
    ----------
    name : str
    status : str
        "identified", or "failed" when its recording cannot be used.
    estimate : Estimate or None
        None if it failed.
    error : InputError or None
        Reason of the failure; None if it was identified.
    side : str
        Side of the gear for the values: "joint", or "motor" if no gear ratio is known.
    others : tuple of Share
        Shares of its residual that other joints explain, in the order of their detection.
    """

    name: str
    status: str
    estimate: Estimate | None = None
    error: InputError | None = None
    side: str = "joint"
    others: tuple[Share, ...] = ()

    @property
    def explained(self) -> float:
        """Share of the residual that other joints certainly explain, 0 to 1."""
        return min(1.0, float(sum(share.share for share in self.others if share.certain)))

    def sentences(self) -> tuple[str, ...]:
        """Return the effects of the other joints as sentences.

        Examples
        --------
        >>> share = Share(joint="6", by="speed", share=0.41, scale=0.07)
        >>> JointResult(name="5", status="identified", others=(share,)).sentences()
        ("joint 6's speed explains 41 % of joint 5's residual (friction of a coupled drive)",)
        """
        return tuple(_sentence(self.name, share) for share in self.others)


def _sentence(name: str, share: Share) -> str:
    alike = ""
    if share.alike:
        others = " and ".join(joint_phrase(each) for each in share.alike)
        alike = f"; {others} would explain the same share, because these joints move alike"
    if share.own_too:
        alike += f"; {joint_phrase(name)}'s own motion explains nearly the same share"
    verb = "explains" if share.certain else "perhaps explains"
    percent = max(1, round(100.0 * share.share))
    return (
        f"{joint_phrase(share.joint)}'s {share.by} {verb} {percent} % of {joint_phrase(name)}'s residual "
        f"({MEANING[share.by]}{alike})"
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class JointEstimatesRecord(Mapping[str, Estimate]):
    """Fields of `JointEstimates`, which documents them, as a mapping from names to estimates."""

    results: Mapping[str, JointResult]
    name: str = ""
    seconds: float = field(default=0.0, repr=False, compare=False)

    @property
    def failed(self) -> tuple[str, ...]:
        """Names of the joints with recordings that cannot be used."""
        return tuple(name for name, each in self.results.items() if each.status == FAILED)

    def sentences(self) -> tuple[str, ...]:
        """Return the couplings between joints' residuals as sentences."""
        return tuple(text for each in self.results.values() for text in each.sentences())

    def __getitem__(self, joint: str | int) -> Estimate:
        try:
            result = self.results[joint_named(joint, list(self.results), self.name or "estimates")]
        except InputError as error:
            raise KeyError(str(error)) from None
        if result.estimate is None:
            raise KeyError(f"{joint_phrase(str(joint))} failed: {result.error}")
        return result.estimate

    def __iter__(self) -> Iterator[str]:
        return (name for name, each in self.results.items() if each.estimate is not None)

    def __len__(self) -> int:
        return sum(each.estimate is not None for each in self.results.values())
