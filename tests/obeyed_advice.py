"""Call again as a finding advises: what a user or a program does with advice of kind "call"."""

from __future__ import annotations

from collections.abc import Iterator

import jointid as jid
from jointid.app.call import Call
from jointid.base.advice import Action


def obeyed(call: Call, estimate: jid.Estimate) -> Iterator[tuple[str, Action, Call]]:
    """Each finding's code with each call that it advises and a program can obey."""
    for finding in estimate.findings:
        for action in finding.advice:
            again = call.obey(action)
            if again is not None:
                yield finding.code, action, again
