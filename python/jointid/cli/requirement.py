"""Option `--require`: the exit code of a verdict."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Mapping
from typing import TYPE_CHECKING

from jointid.cli.exit_codes import DONE, WORSE

if TYPE_CHECKING:
    from jointid.estimate.verdict import Level, Verdict

LEVELS: Mapping[str, Level] = {"usable": "usable", "care": "usable with care"}
"""Worst level that each value of `--require` accepts."""


def required(verdicts: Mapping[str, Verdict | None], arguments: argparse.Namespace) -> int:
    """Return the exit code of verdicts, and print which one is worse than required.

    Parameters
    ----------
    verdicts : mapping of str to Verdict or None
        Verdicts by joint; the name may be empty. None means that the joint could not be identified.
    arguments : Namespace
        Arguments of `jointid identify`.
    """
    if arguments.require is None:
        return DONE
    from jointid.estimate.verdict import LEVELS as ORDER

    asked = LEVELS[arguments.require]
    code = DONE
    for name, verdict in verdicts.items():
        level = "not usable" if verdict is None else verdict.level
        if ORDER.index(level) > ORDER.index(asked):
            reason = f": {verdict.reasons[0]}" if verdict is not None and verdict.reasons else ""
            subject = f"the verdict on {name}" if name else "the verdict"
            print(
                f'jointid identify: {subject} is "{level}", but --require needs "{asked}"{reason}',
                file=sys.stderr,
            )
            code = WORSE
    return code
