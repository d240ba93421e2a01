"""The public names in groups, one page each: documented names first, with their docstrings."""

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
        """Return the page of the group."""
        lines = [f"# {self.title}", ""]
        lines += [self.text, ""] if self.text else []
        for name in self.first:
            lines += _section("##", name)
        if self.more:
            lines += ["## More", ""]
        for name in self.more:
            lines += _section("###", name)
        return "\n".join(lines)

    @property
    def first(self) -> tuple[str, ...]:
        """Return the names that are documented at the top of the package, and those of a module."""
        return tuple(name for name in self.names if name not in self.more)

    @property
    def more(self) -> tuple[str, ...]:
        """Return the names that are not at the top of the package: arguments and results of the others."""
        return tuple(name for name in self.names if _at_top(name) not in (None, *jid.__all__))


def _at_top(name: str) -> str | None:
    """Return the name in the package itself; None for a name of a module."""
    module, _, own = name.rpartition(".")
    return own if module == "jointid" else None


def _section(level: str, name: str) -> list[str]:
    title = f"{level} {name.removeprefix('jointid.')}"
    return [title, "", "```{eval-rst}", _directive(name), "```", ""]


def _directive(name: str) -> str:
    found = named(name)
    if inspect.isclass(found):
        # Fields and methods may belong to a class without a page.
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
    """Return the object with a full name."""
    found: object = jid
    for part in name.split(".")[1:]:
        found = getattr(found, part)
    return found


def _of(module: str, *names: str) -> tuple[str, ...]:
    return tuple(f"{module}.{name}" for name in names)


def _promised(module: str) -> tuple[str, ...]:
    """Return the public names of a module of the package."""
    return tuple(import_module(f"jointid.{module}").__all__)


# Verbs for one subject, under their names before there were verbs: for one version.
ALIASES = frozenset(
    {
        *("identify_joints", "identify_robot", "identify_servo"),
        *("compare_models", "compare_robot_models", "compare_servo_models"),
        *("load_robot", "load_runs", "design_excitation", "rollout"),
    }
)
_MODULES = ("commissioning", "hardware", "plot")
GROUPS = (
    Group(
        "recordings",
        "Recordings",
        _of(
            "jointid",
            "load",
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
            *("Bootstrap", "SelfTest", "Result", "Action", "InputError"),
        ),
    ),
    Group(
        "comparison",
        "Comparison and sweeps",
        _of(
            "jointid",
            "compare",
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
            *("Robot", "JointEstimates", "RobotEstimate", "RobotComparison"),
        ),
    ),
    Group(
        "servos",
        "Servos",
        _of(
            "jointid",
            "VoltageDrive",
            "PositionLoop",
            "ServoEstimate",
            "ServoComparison",
            "Rollout",
        ),
    ),
    Group("online", "While the joint runs", _of("jointid", "OnlineIdentifier", "OnlineEstimate")),
    Group(
        "motion",
        "Design of motions",
        _of(
            "jointid",
            "design",
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
        "Nothing here was tried on a real drive: read [is it safe?](../../safety.md) first.",
    ),
    Group(
        "commissioning",
        "Run, identify, run better",
        _of("jointid.commissioning", *_promised("commissioning")),
    ),
)


def public_names() -> set[str]:
    """Return every name that the package promises, with its module."""
    plain = {f"jointid.{name}" for name in jid._HOME_OF if name not in ALIASES}
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
            f"tools/documentation/public_names.py must list each name once: {', '.join(sorted(wrong))}"
        )
