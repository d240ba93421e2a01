"""The command `explain`: what a finding means, and all that an estimate's finding says."""

from __future__ import annotations

import argparse
from pathlib import Path

from jointid.base.errors import InputError
from jointid.cli.parser import CommandParser


def add_explain(explain: CommandParser) -> None:
    """Add the command's grammar."""
    explain.epilog = (
        "examples:\n  jointid explain undetermined\n  jointid explain undetermined estimate.json"
    )
    explain.add_argument("code", nargs="?", help="of a finding; default: list all")
    explain.add_argument(
        "estimate", type=Path, nargs="?", help="estimate (.json) that has the finding"
    )


def explain(arguments: argparse.Namespace) -> None:
    """Print what a finding means and what to do; of an estimate, all that its finding says."""
    from jointid.identification.warnings.registry import finding_types

    types = finding_types()
    code = arguments.code
    if code is None:
        print("codes:", ", ".join(types))
        return
    if code not in types:
        from jointid.joint.checks import suggestion

        raise InputError(
            f"there is no such finding; {suggestion(code, types)}", argument="code", value=code
        )
    if arguments.estimate is not None:
        print(*_of_estimate(code, arguments.estimate), "", sep="\n")
    print(f"{code} ({types[code].severity}): {types[code].meaning}")
    print(f"  in general: {types[code].advice}")


def _of_estimate(code: str, path: Path) -> list[str]:
    """What the findings with this code say in a saved estimate."""
    from jointid.cli.wording import Wording
    from jointid.estimate.answers import explained
    from jointid.joints.reading import load_estimate

    estimate = load_estimate(path, None)
    found = [each for each in estimate.findings if each.code == code]
    if not found:
        raise InputError(
            f"the estimate has no such finding; it has {', '.join(e.code for e in estimate.findings) or 'none'}",
            place=str(path),
        )
    action = Wording("identify", saved=str(path)).of_command
    return [line for each in found for line in explained(each, action)]
