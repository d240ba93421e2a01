"""A finding about the data or the fit: what was found, severity, reason and remedies, as data."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import field
from types import MappingProxyType
from typing import Any, Literal, get_args

from jointid.base.advice import Action
from jointid.base.values import dataclass

Severity = Literal["info", "warning", "blocking"]
TITLE = 90
"""Largest length of a title in characters: with the severity, it fits on one line."""


@dataclass(frozen=True, slots=True)
class Measured:
    """One number that supports a finding.

    Attributes
    ----------
    value : float
    unit : str
        Unit; "" for a pure number. A share is a pure number: 0.05 for 5 %.
    """

    value: float
    unit: str = ""


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Finding:
    """A problem or a remark that the data or the fit show.

    Attributes
    ----------
    code : str
        Stable name, e.g. "undetermined"; `docs/findings.md` lists them.
    severity : {"info", "warning", "blocking"}
        "info" is worth knowing, "warning" may bias values, "blocking" makes the values unusable.
    parameters : tuple of str
        Affected parameters.
    evidence : mapping of str to Measured
        Numbers that support the finding, by name.
    title : str
        What was found, with its numbers, in at most 90 characters without the syntax of any interface.
    details : str
        Reason, consequences, and further numbers. Default: none.
    advice : tuple of Action
        Remedies; the first one that is possible helps most.
    recordings : tuple of str
        Names of the affected recordings; empty if the finding is about all of them.
    """

    code: str
    severity: Severity = "warning"
    parameters: tuple[str, ...] = ()
    evidence: Mapping[str, Measured] = field(default_factory=dict, hash=False)
    title: str
    details: str = ""
    advice: tuple[Action, ...] = field(default=(), hash=False)
    recordings: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if self.severity not in get_args(Severity):
            raise ValueError(f"a severity is one of {', '.join(get_args(Severity))}")
        object.__setattr__(self, "evidence", MappingProxyType(dict(self.evidence)))

    def __repr__(self) -> str:
        return f"<Finding {self.code} ({self.severity}): {_shortened(self.title)}>"

    def worded(self, action: Callable[[Action], str] = str) -> str:
        """Return the whole finding: title, details, and the remedies in the wording of an interface.

        Parameters
        ----------
        action : callable
            Words one action. Default: for a Python prompt.
        """
        advice = "; or ".join(action(each) for each in self.advice)
        return f"{self.cause}; {advice}" if advice else self.cause

    @property
    def cause(self) -> str:
        """Title and details."""
        return f"{self.title}; {self.details}" if self.details else self.title

    @property
    def message(self) -> str:
        """Title, details and remedies, in Python's wording."""
        return self.worded()

    def __str__(self) -> str:
        return self.message

    def __reduce__(self) -> tuple[Any, ...]:
        # A read-only mapping cannot be pickled.
        values = {
            "code": self.code,
            "severity": self.severity,
            "parameters": self.parameters,
            "evidence": dict(self.evidence),
            "title": self.title,
            "details": self.details,
            "advice": self.advice,
            "recordings": self.recordings,
        }
        return _rebuilt, (values,)


def _rebuilt(values: dict[str, Any]) -> Finding:
    return Finding(**values)


def _shortened(text: str, most: int = 100) -> str:
    return text if len(text) <= most else f"{text[:most].rsplit(' ', 1)[0]} …"
