"""Remedies for a finding or an error, as data: each interface words them, and a program can apply them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from types import MappingProxyType
from typing import Any, Literal, get_args

from jointid.base.values import dataclass

Kind = Literal["call", "record", "inspect"]


@dataclass(frozen=True, slots=True)
class Action:
    """One remedy.

    Parameters
    ----------
    kind : {"call", "record", "inspect"}
        "call": repeat the call with other arguments; a program can do this. "record": record another motion;
        `function`, if set, designs the motion. "inspect": check the hardware, the logger or the file.
    arguments : mapping of str to object
        Arguments to change in a call, by name, e.g. ``{"model": "stribeck"}``,
        ``{"columns": {"velocity": None}}``, ``{"parameters": {"viscous": 12.0}}``. Default: none.
        `parameters` changes only the stated fields of the stated parameters; None removes a field. `columns`,
        `units` and `scale` change only the stated signals of a call of `load`. Any other argument replaces the
        call's argument.
    text : str
        Motion to record, or thing to inspect, as a phrase. For a call: its purpose, if needed. The phrase fits a
        function call and a command line. Default: empty.
    function : str
        Function to call: "identify" (default), "load", "compare_models", "sweep", "simulate",
        "design_excitation" or "Joint" (arguments are then fields of the joint). For "record": "next_motion" if this
        method of the estimate designs the motion with these arguments, or "identify" without a design.

    Examples
    --------
    >>> str(Action("call", {"columns": {"velocity": None}}, function="load"))
    "load with columns={'velocity': None}"
    >>> str(Action("record", text="slow motion through zero speed"))
    'record slow motion through zero speed'
    >>> str(Action("record", {"duration": 6.0}, "slow motion", "next_motion"))
    'record slow motion, designed by jid.design(estimate, duration=6.0)'
    """

    kind: Kind
    arguments: Mapping[str, Any] = field(default_factory=dict)
    text: str = ""
    function: str = "identify"

    def __post_init__(self) -> None:
        if self.kind not in get_args(Kind):
            raise ValueError(f"an action is one of {', '.join(get_args(Kind))}, got {self.kind!r}")
        if self.kind == "call" and not self.arguments:
            raise ValueError("an action of kind 'call' needs arguments")
        object.__setattr__(self, "arguments", MappingProxyType(dict(self.arguments)))

    @property
    def designs(self) -> bool:
        """Whether the action records a motion that the estimate can design."""
        return self.kind == "record" and self.function == "next_motion"

    def __str__(self) -> str:
        """Return the action as text for a Python prompt."""
        shown = ", ".join(f"{name}={_written(value)}" for name, value in self.arguments.items())
        if self.kind != "call":
            stated = f"estimate, {shown}" if shown else "estimate"
            by = f", designed by jid.design({stated})" * self.designs
            return f"{self.kind} {self.text}{by}".rstrip()
        purpose = f" ({self.text})" if self.text else ""
        return f"{_VERB.get(self.function, self.function)} with {shown}{purpose}"

    def __reduce__(self) -> tuple[Any, ...]:
        # A read-only mapping cannot be pickled.
        return type(self), (self.kind, dict(self.arguments), self.text, self.function)


_VERB = {
    "compare_models": "compare",
    "compare_robot_models": "compare",
    "compare_servo_models": "compare",
    "design_excitation": "design",
    "identify_joints": "identify",
    "identify_robot": "identify",
    "load_robot": "load",
    "load_runs": "load",
    "Joint": "set the joint",
}


def _written(value: object) -> str:
    """Return a value as Python text; an ellipsis stands for a value that only the user knows."""
    if value is ...:
        return "..."
    if isinstance(value, Mapping):
        inside = ", ".join(f"{key!r}: {_written(entry)}" for key, entry in value.items())
        return f"{{{inside}}}"
    if isinstance(value, list) and ... in value:
        return f"[{', '.join(map(_written, value))}]"
    return repr(value)
