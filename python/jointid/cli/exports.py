"""Command `export`."""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from jointid.base.errors import InputError
from jointid.cli.outputs import check_folder
from jointid.cli.robot import saved_robot

if TYPE_CHECKING:
    from jointid.robot.result.result import RobotEstimate


def add_export(export: argparse.ArgumentParser) -> None:
    """Add the command's grammar."""
    from jointid.exports.registry import TARGETS, endings_text

    kinds = ", ".join(f"{'/'.join(each.endings)} ({each.meaning})" for each in TARGETS)
    export.epilog = (
        "examples:\n"
        "  jointid export estimate.json --to joint_friction.h\n"
        "  jointid export joint.toml --to joint.st\n"
        "  jointid export estimate.json --to arm.xml --into arm.xml --joint-name shoulder --approximate\n"
        "the written file states the standard errors of an estimate (.json); a joint file has no standard errors"
    )
    export.add_argument(
        "source",
        type=Path,
        help="estimate (.json) of a joint or of a robot, or joint file (.toml) with parameter values",
    )
    export.add_argument("--to", type=Path, required=True, help=f"file to write: {kinds}")
    export.add_argument(
        "--target",
        metavar="NAME",
        help=f"target, if the file's ending ({endings_text()}) does not choose the target: "
        + ", ".join(each.name for each in TARGETS),
    )
    export.add_argument(
        "--joints",
        metavar="JOINT",
        help="joint to use, if the file has the estimates of several joints",
    )
    export.add_argument(
        "--into",
        type=Path,
        help="MuJoCo or URDF file to edit: only the values of this joint change; --to may be the same file",
    )
    export.add_argument(
        "--joint-name", help="name of the joint in --into (default: the joint's own name)"
    )
    export.add_argument(
        "--approximate",
        action="store_true",
        help="for a target with only Coulomb and viscous friction: write the nearest friction of this form, and state "
        "the difference in the file",
    )
    export.add_argument(
        "--inertia",
        action="store_true",
        help="for a robot: also write the identified inertia of its links",
    )
    export.add_argument(
        "--speed",
        type=float,
        help="largest speed [rad/s or m/s] of tables and of --approximate (default: as recorded)",
    )
    export.add_argument("--json", action="store_true", help="print the outcome as JSON")


def export(arguments: argparse.Namespace) -> None:
    """Write a joint for another program."""
    from jointid.estimate.estimate import Estimate
    from jointid.exports import exporting
    from jointid.exports.registry import target_of
    from jointid.joint.joint import Joint
    from jointid.joints.reading import load_estimate

    target_of(arguments.to, arguments.target)
    check_folder("path", arguments.to)
    source: Path = arguments.source
    if source.suffix.lower() != ".json" and arguments.joints is not None:
        raise InputError(
            "a joint file holds only one joint",
            argument="joints",
            value=arguments.joints,
            place=str(source),
        )
    value: Estimate | Joint | RobotEstimate
    robot = saved_robot(source)
    if robot is not None:
        value = robot
    elif source.suffix.lower() == ".json":
        value = load_estimate(source, arguments.joints)
    else:
        value = Joint.load(source)
    findings = () if isinstance(value, Joint) else value.findings
    blocking = [each for each in findings if each.severity == "blocking"]
    if blocking:  # identify does not write such a joint file either: a controller would use it
        raise InputError(
            f"the finding {blocking[0].code} is blocking: the values of this estimate cannot be used",
            place=str(source),
            remedy="see the estimate's report",
        )
    path = exporting.export(
        value,
        arguments.to,
        target=arguments.target,
        into=arguments.into,
        joint_name=arguments.joint_name,
        approximate=arguments.approximate,
        inertia=arguments.inertia,
        speed=arguments.speed,
    )
    warnings = [each.code for each in findings if each.severity == "warning"]
    if arguments.json:
        outcome = {"path": str(path), "warnings": warnings}
        print(json.dumps(outcome, indent=1, ensure_ascii=False))
        return
    print(f"exported: {path}")
    if warnings:
        print(f"with the estimate's warnings: {', '.join(warnings)}", file=sys.stderr)
