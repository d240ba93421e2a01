"""Call again as a finding advises: what a user or a program does with advice of kind "call"."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import jointid as jid
from jointid.base.advice import Action

# As `Action` says; others replace what the call has.
_MERGED = ("columns", "units", "scale", "parameters")


@dataclass(frozen=True, kw_only=True)
class Call:
    """One identification as a user writes it: `identify(load(file, …), joint, …)`."""

    file: Path
    joint: jid.Joint | None = None
    load: Mapping[str, Any] = field(default_factory=dict)
    identify: Mapping[str, Any] = field(default_factory=dict)

    def recording(self) -> jid.Recording:
        return jid.load(self.file, **self.load)

    def run(self) -> jid.Estimate:
        return jid.identify(self.recording(), self.joint, **self.identify)

    def obey(self, action: Action) -> Call | None:
        """The call with the action's arguments; None where only the user knows a value."""
        if action.kind != "call" or _unknown(action.arguments):
            return None
        if action.function == "load":
            return replace(self, load=_merged(self.load, action.arguments))
        if action.function == "identify":
            return replace(self, identify=_merged(self.identify, action.arguments))
        if action.function == "Joint":
            return replace(self, joint=(self.joint or jid.Joint()).replace(**action.arguments))
        return None


def obeyed(call: Call, estimate: jid.Estimate) -> Iterator[tuple[str, Action, Call]]:
    """Each finding's code with each call that it advises and a program can obey."""
    for finding in estimate.findings:
        for action in finding.advice:
            again = call.obey(action)
            if again is not None:
                yield finding.code, action, again


def _merged(given: Mapping[str, Any], advised: Mapping[str, Any]) -> dict[str, Any]:
    merged = dict(given)
    for name, value in advised.items():
        if name in _MERGED and isinstance(value, Mapping) and merged.get(name) is not None:
            merged[name] = {**merged[name], **value}
        else:
            merged[name] = value
    return merged


def _unknown(value: object) -> bool:
    if isinstance(value, Mapping):
        return any(map(_unknown, value.values()))
    return value is ... or value == "..."
