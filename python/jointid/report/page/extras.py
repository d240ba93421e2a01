"""What a page takes besides the result: how advice is worded, the recordings, a rollout."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from jointid.base.advice import Action
from jointid.base.result import Overview
from jointid.base.values import dataclass

if TYPE_CHECKING:
    from jointid.base.result import Result
    from jointid.estimate.rollout import Rollout
    from jointid.recording.recording import Recording
    from jointid.report.page.content import Part


def _no_parts(_result: Result, _extras: Extras) -> list[Part]:
    return []


@dataclass(frozen=True, slots=True, eq=False)
class Extras:
    """What a page takes besides the result.

    Attributes
    ----------
    action : callable
        Words the advice of a finding. Default: as at a Python prompt.
    recordings : tuple of Recording
        That an estimate was made from, for pictures of their signals. Default: none.
    rollout : Rollout or None
        Of a servo's runs, for pictures of its closed loop. Default: none.
    prefix : str
        Stands before the names of parts, so that results on one page do not share them.
    overview : Overview
        Of the result that the page is made of.
    parts_of : callable
        Makes the parts of a result that this one consists of. Default: none.
    """

    action: Callable[[Action], str] = str
    recordings: tuple[Recording, ...] = ()
    rollout: Rollout | None = None
    prefix: str = ""
    overview: Overview = Overview(title="")
    parts_of: Callable[[Result, Extras], list[Part]] = _no_parts
