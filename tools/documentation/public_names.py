"""The public names, in groups: a page each, with what their docstrings say."""

from __future__ import annotations

import inspect
from dataclasses import dataclass
from importlib import import_module

import jointid as jid


@dataclass(frozen=True)
class Group:
    """Names that are read together."""

    file: str
    title: str
    names: tuple[str, ...]
    text: str = ""

    def page(self) -> str:
        """The page of the group."""
        lines = [f"# {self.title}", ""]
        lines += [self.text, ""] if self.text else []
        for name in self.names:
            lines += [
                f"## {name.removeprefix('jointid.')}",
                "",
                "```{eval-rst}",
                _directive(name),
                "```",
                "",
            ]
        return "\n".join(lines)


def _directive(name: str) -> str:
    found = named(name)
    if inspect.isclass(found):
        # Fields and methods may stand in a class that has no page.
        foreign = [each.__name__ for each in found.__mro__ if not _is_ours(each)]
        options = ["   :members:", f"   :inherited-members: {', '.join(foreign)}"]
        if issubclass(found, Exception):
            options.append("   :undoc-members:")
        return "\n".join([f".. autoclass:: {name}", *options])
    if callable(found):
        return f".. autofunction:: {name}"
    return f".. autodata:: {name}\n   :no-value:"


def _is_ours(kind: type) -> bool:
    return kind.__module__.startswith("jointid.")


def named(name: str) -> object:
    """Return what a full name stands for."""
    found: object = jid
    for part in name.split(".")[1:]:
        found = getattr(found, part)
    return found


def _of(module: str, *names: str) -> tuple[str, ...]:
    return tuple(f"{module}.{name}" for name in names)


def _promised(module: str) -> tuple[str, ...]:
    """The public names of a module of the package."""
    return tuple(import_module(f"jointid.{module}").__all__)


_MODULES = ("commissioning", "hardware", "plot")
GROUPS = (
    Group(
        "recordings",
        "Recordings",
        _of(
            "jointid",
            "load",
            "load_runs",
            "load_robot",
            "Recording",
            "RobotRecording",
            "SimulatedRecording",
            "Truth",
        ),
    ),
    Group(
        "joints",
        "Joints and models",
        _of(
            "jointid",
            "Joint",
            "Model",
            "Parameter",
            "Link",
            "Limits",
            "demo",
            "Demonstration",
            "thesis_joint",
        ),
    ),
    Group(
        "identification",
        "Identification",
        _of(
            "jointid",
            *(
                "identify",
                "Search",
                "GaOptions",
                "WindowOptions",
                "Generation",
                "Estimate",
                "Selection",
            ),
            *("Bootstrap", "SelfTest", "Action", "InputError"),
        ),
    ),
    Group(
        "comparison",
        "Comparison and sweeps",
        _of(
            "jointid",
            "compare_models",
            "Comparison",
            "sweep",
            "Study",
            "StudyStep",
            "StudyBrokenError",
            "StudyInterruptedError",
        ),
    ),
    Group(
        "robots",
        "Several joints, whole robots",
        _of(
            "jointid",
            *("identify_joints", "JointEstimates", "Robot", "identify_robot", "RobotEstimate"),
            *("compare_robot_models", "RobotComparison"),
        ),
    ),
    Group(
        "servos",
        "Servos",
        _of(
            "jointid",
            "identify_servo",
            "compare_servo_models",
            "ServoComparison",
            "ServoEstimate",
            "VoltageDrive",
            "PositionLoop",
            "rollout",
            "Rollout",
        ),
    ),
    Group("online", "While the joint runs", _of("jointid", "OnlineIdentifier", "OnlineEstimate")),
    Group(
        "motion",
        "Design of motions",
        _of(
            "jointid",
            "design_excitation",
            "Design",
            "DesignSearch",
            "DesignProgress",
            "Known",
            "MotionLimits",
            "load_design",
        ),
    ),
    Group(
        "simulation",
        "Simulation and controllers",
        _of(
            "jointid",
            *(
                "simulate",
                "simulate_batch",
                "SimulatedBatch",
                "Scenario",
                "Trajectory",
                "Sensors",
                "Bristle",
            ),
            *(
                "control_estimates",
                "Pd",
                "Pid",
                "CompensatedPid",
                "AdaptiveRobust",
                "LugreObserver",
                "OpenLoop",
            ),
        ),
    ),
    Group("exports", "Reports and exports", _of("jointid", "save_report", "export")),
    Group(
        "plots",
        "Pictures",
        _of("jointid.plot", *_promised("plot")),
        "Matplotlib axes in and out, units on the axes.",
    ),
    Group(
        "hardware",
        "Hardware sessions",
        _of("jointid.hardware", *_promised("hardware")),
        "Nothing here was tried on a real drive: read [a session on a real joint](../../hardware.md) first.",
    ),
    Group(
        "commissioning",
        "Run, identify, run better",
        _of("jointid.commissioning", *_promised("commissioning")),
    ),
)


def public_names() -> set[str]:
    """Every name that the package promises, with its module."""
    plain = {f"jointid.{name}" for name in jid.__all__ if name not in (*_MODULES, "__version__")}
    for module in _MODULES:
        plain |= set(_of(f"jointid.{module}", *_promised(module)))
    return plain


def check_groups() -> None:
    """Check that each public name is in one group.

    Raises
    ------
    LookupError
        Names the missing ones, and those that are gone.
    """
    listed = [name for group in GROUPS for name in group.names]
    wrong = public_names() ^ set(listed) | {name for name in listed if listed.count(name) > 1}
    if wrong:
        raise LookupError(
            f"tools/documentation/public_names.py does not list once: {', '.join(sorted(wrong))}"
        )
