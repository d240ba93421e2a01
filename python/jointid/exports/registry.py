"""The list of targets. A new target needs one file in this folder and one line in `MODULES`."""

from importlib import import_module
from pathlib import Path

from jointid.base.error_text import alternatives
from jointid.base.file_endings import ending_of
from jointid.exports.target import Target
from jointid.joint.checks import check_choice

# Each module defines `TARGET`; messages and help list them in this order.
MODULES = (
    "mujoco_model",
    "urdf_model",
    "c_header",
    "structured_text",
    "matlab_struct",
)

TARGETS: tuple[Target, ...] = tuple(
    import_module(f"jointid.exports.{module}").TARGET for module in MODULES
)


def endings_text() -> str:
    """Return the endings of all targets as alternatives in a sentence."""
    return alternatives([ending for target in TARGETS for ending in target.endings])


def target_of(path: Path, name: str | None) -> Target:
    """Return the target of this name, or the target of a file's ending."""
    if name is not None:
        check_choice("", "target", name, [target.name for target in TARGETS])
        return next(target for target in TARGETS if target.name == name)
    ending = ending_of(path, [ending for target in TARGETS for ending in target.endings])
    return next(target for target in TARGETS if ending in target.endings)
