"""A robot's estimate in JSON's types: complete enough to use it and to draw its report page again."""

from __future__ import annotations

from typing import Any

from jointid.estimate.json import documents_of, plain
from jointid.robot.links.robot import Robot
from jointid.robot.result.record import RobotEstimateRecord
from jointid.robot.result.verdict import judged_robot

SCHEMA = 2
"""Version 2 contains links, joints and windows, to restore the estimate. An infinite number is the text "inf"."""
KIND = "jointid robot"


def document_of(estimate: RobotEstimateRecord) -> dict[str, Any]:
    """Return the estimate in JSON types."""
    document: dict[str, Any] = {
        "schema": SCHEMA,
        "kind": KIND,
        "name": estimate.robot.name,
        "seconds": estimate.seconds,
        "inertia": estimate.inertia,
        "consistent": estimate.consistent,
        "impossible_by": plain(estimate.impossible_by),
        "relative_residual": plain(estimate.relative_residual),
        "within": plain(estimate.within),
        "condition": plain(estimate.condition),
        "joints": {
            name: {
                "model": joint.model,
                "parameters": plain(joint.parameters),
                "residuals": plain(joint.residuals),
                "windows": plain(joint.windows) if joint.windows.start.size else None,
            }
            for name, joint in estimate.joints.items()
        },
        "base_parameters": [plain(p) for p in estimate.base_parameters.values()],
        "inertial": plain(estimate.inertial),
        "free": list(estimate.free),
        "covariance": plain(estimate.covariance),
        "robot": robot_document(estimate.robot),
        "cross_check": plain(estimate.cross_check),
        "findings": documents_of(estimate.findings),
        "verdict": judged_robot(estimate).document(),
        "settings": plain(estimate.settings),
    }
    return document


def robot_document(robot: Robot) -> dict[str, Any]:
    """Return a robot's links, joints and motors in JSON types."""
    tree = robot.tree
    return {
        "joints": [
            {
                "name": name,
                "parent": tree.parents[k],
                "kind": "prismatic" if tree.prismatic[k] else "revolute",
                "rotation": plain(tree.rotations[k]),
                "translation": plain(tree.translations[k]),
                "axis": plain(tree.axes[k]),
                "inertial": plain(tree.inertias[k]),
                "rotor_inertia": robot.rotor_inertias[k],
            }
            for k, name in enumerate(robot.names)
        ],
        "gravity": plain(tree.gravity),
        "couplings": plain(robot.couplings),
        "gear_ratios": plain(robot.gear_ratios),
        "zero_offsets": plain(robot.zero_offsets),
        "torque_scales": plain(robot.torque_scales),
        "directions": plain(robot.directions),
        "side": robot.side,
        **({} if robot.drive is None else {"drive": robot.drive.document()}),
        **(
            {}
            if robot.torque_constants is None
            else {"torque_constants": plain(robot.torque_constants)}
        ),
    }
