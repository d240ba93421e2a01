"""Command `explain`: the meaning of a finding, and the details of an estimate's finding."""

from __future__ import annotations

import argparse
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from jointid.base.errors import InputError
from jointid.cli.parser import CommandParser

if TYPE_CHECKING:
    from jointid.estimate.findings import Finding
    from jointid.estimate.types_of_findings import FindingType

Types = Mapping[str, "FindingType"]

_JOINT, _ROBOT, _SERVO = "", "of a robot", "of a servo"


def add_explain(explain: CommandParser) -> None:
    """Add the command's grammar."""
    explain.epilog = (
        "examples:\n  jointid explain undetermined\n  jointid explain undetermined estimate.json"
    )
    explain.add_argument("code", nargs="?", help="code of a finding (default: list all)")
    explain.add_argument(
        "estimate", type=Path, nargs="?", help="estimate (.json) that has the finding"
    )


def explain(arguments: argparse.Namespace) -> None:
    """Print the meaning of a finding and its advice. With an estimate, print the finding's details."""
    types, code = _types(), arguments.code
    if code is None:
        for subject, codes in types.items():
            print(f"codes {subject}".rstrip() + ":", ", ".join(codes))
        return
    known = list(dict.fromkeys(name for codes in types.values() for name in codes))
    if code not in known:
        from jointid.joint.checks import suggestion

        raise InputError(
            f"there is no such finding; {suggestion(code, known)}", argument="code", value=code
        )
    subjects: Sequence[str] = list(types)
    if arguments.estimate is not None:
        subject, found = _findings_of(arguments.estimate)
        subjects = [subject]
        print(*_explained(code, found, arguments.estimate), "", sep="\n")
        if code not in types[subject]:  # causes of a residual exist only for a joint
            subjects = [_JOINT]
    for subject in subjects:
        if code in types[subject]:
            each = types[subject][code]
            print(f"{f'{code} {subject}'.rstrip()} ({each.severity}): {each.meaning}")
            print(f"  in general: {each.advice}")


def _types() -> dict[str, Types]:
    """Return all types of findings, by their subject."""
    from jointid.identification.warnings.registry import finding_types
    from jointid.robot.result.finding_types import TYPES as OF_ROBOTS
    from jointid.servo.finding_types import TYPES as OF_SERVOS

    return {_JOINT: finding_types(), _ROBOT: OF_ROBOTS, _SERVO: OF_SERVOS}


def _explained(code: str, found: Mapping[str, Sequence[Finding]], path: Path) -> list[str]:
    """Return the text of the findings with this code in a saved estimate."""
    from jointid.cli.wording import Wording
    from jointid.estimate.answers import explained

    lines: list[str] = []
    for joint, each in found.items():
        action = Wording("identify", saved=str(path), joint=joint).of_command
        mine = [line for one in each if one.code == code for line in explained(one, action)]
        lines += [*([f"joint {joint}"] if joint and mine else []), *mine]
    if not lines:
        codes = list(dict.fromkeys(one.code for each in found.values() for one in each))
        raise InputError(
            f"the estimate has no such finding; it has {', '.join(codes) or 'none'}",
            place=str(path),
        )
    return lines


def _findings_of(path: Path) -> tuple[str, dict[str, Sequence[Finding]]]:
    """Return the subject of a saved estimate, and its findings, by joint if it has several."""
    from jointid.base.schema import read_text
    from jointid.joints.document import KIND as JOINTS
    from jointid.joints.reading import load_estimate
    from jointid.robot.result.document import KIND as ROBOT
    from jointid.robot.result.result import RobotEstimate
    from jointid.servo.estimate import ServoEstimate
    from jointid.servo.reading_back import KIND as SERVO

    try:
        document = json.loads(read_text(path))
    except (ValueError, RecursionError):  # another reader reports the problem
        document = None
    kind = document.get("kind") if isinstance(document, dict) else None
    if kind == ROBOT:
        return _ROBOT, {"": RobotEstimate.load(path).findings}
    if kind == SERVO:
        return _SERVO, {"": ServoEstimate.load(path).findings}
    if kind == JOINTS and isinstance(document.get("joints"), dict):
        usable = [name for name, each in document["joints"].items() if _identified(each)]
        return _JOINT, {name: load_estimate(path, name).findings for name in usable}
    return _JOINT, {"": load_estimate(path, None).findings}


def _identified(joint: object) -> bool:
    return isinstance(joint, dict) and joint.get("estimate") is not None
