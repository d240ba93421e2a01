"""Read one joint's estimate from a file, also from a file of several joints."""

from __future__ import annotations

import json
from pathlib import Path

from jointid.base.advice import Action
from jointid.base.error_text import joint_phrase
from jointid.base.errors import InputError
from jointid.base.schema import read_text
from jointid.estimate.estimate import Estimate
from jointid.joints.document import KIND
from jointid.recording.wide.joint_names import joint_named


def load_estimate(path: Path, joint: str | None = None) -> Estimate:
    """Return the estimate in a .json file, or that of one joint in a file of several.

    Parameters
    ----------
    path : Path
        File from `Estimate.save` or `JointEstimates.save`.
    joint : str, optional
        Name or number of the joint. Default: the only one in the file.

    Raises
    ------
    InputError
        The file holds no estimate or no such joint, or several joints and none is named, or the joint failed.
    """
    try:
        document = json.loads(read_text(path))
    except (ValueError, RecursionError):
        return Estimate.load(path)  # raises the right error
    joints = document.get("joints") if isinstance(document, dict) else None
    if not isinstance(joints, dict) or document.get("kind") != KIND:
        if joint is not None:
            raise InputError(f"{path} holds one joint's estimate", argument="joints", value=joint)
        return Estimate.load(path)
    if joint is None:
        if len(joints) != 1:
            first = next(iter(joints), "1")
            raise InputError(
                f"the file holds the estimates of {len(joints)} joints ({', '.join(joints)}), but one joint is "
                "expected",
                place=str(path),
                remedy=Action("call", {"joint": first}, "or another joint", "load"),
            )
        joint = next(iter(joints))
    try:
        name = joint_named(joint, list(joints), "", "joints", "load")
    except InputError as error:  # about the argument, not about a place in the file
        raise InputError(
            f"{error.reason} in {path}",
            argument=error.argument,
            value=error.value,
            remedy=error.remedy,
        ) from None
    found = joints[name]
    estimate = found.get("estimate") if isinstance(found, dict) else None
    if estimate is None:
        reason = found.get("error") if isinstance(found, dict) else None
        raise InputError(
            f"{joint_phrase(name)} was not identified: {reason or 'no reason'}", place=str(path)
        )
    try:
        return Estimate.from_json(json.dumps(estimate))
    except InputError as error:
        raise error.at(f"{path}: {joint_phrase(name)}") from error
