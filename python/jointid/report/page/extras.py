"""Inputs of a page other than the result: wording of advice, recordings, a rollout."""

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
    """Inputs of a page other than the result.

    Attributes
    ----------
    action : callable
        Returns the words of a finding's advice. Default: as at a Python prompt.
    recordings : tuple of Recording
        Recordings of the estimate, for pictures of their signals. Default: none.
    rollout : Rollout or None
        Rollout of a servo's runs, for pictures of its closed loop. Default: none.
    prefix : str
        Prefix of the names of parts, which makes them unique if a page has several results.
    overview : Overview
        Overview of the result on the page.
    parts_of : callable
        Returns the parts of an inner result. Default: none.
    """

    action: Callable[[Action], str] = str
    recordings: tuple[Recording, ...] = ()
    rollout: Rollout | None = None
    prefix: str = ""
    overview: Overview = Overview(title="")
    parts_of: Callable[[Result, Extras], list[Part]] = _no_parts
