"""The bench for which a motion was designed, and differences from another bench."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import field, fields
from typing import Any

from jointid.base.error_text import printable
from jointid.base.values import dataclass
from jointid.joint.joint import Joint
from jointid.joint.link import Link
from jointid.simulation.arguments import Controller, law_name
from jointid.simulation.trajectory import Trajectory

_SAME = 0.01  # relative difference that is ignored: printed values are rounded
_SHOWN = 4  # number of differences shown; the others are counted
_FACTS = ("kind", "gear_ratio", "torque_constant", "known_inertia", "sensor", "model")
_OF_FEEDBACK = ("sensor_gain", "sensor_offset")  # a controller without feedback does not use them
_NAMES = {"known_inertia": "inertia"}


@dataclass(frozen=True, slots=True, kw_only=True)
class DesignedFor:
    """The joint, the controller and the period that a motion was designed for."""

    source: str  # the file of the motion, for messages
    trajectory: Trajectory
    joint: Joint  # the nominal one
    controller: Controller
    control_period: float  # [s]
    # Ranges of the parameters of joints that keep the limits; empty: unknown.
    believed: Mapping[str, tuple[float, float]] = field(default_factory=dict, hash=False)

    def warning(
        self,
        trajectory: Trajectory,
        joint: Joint | None,
        controller: Controller,
        control_period: float,
    ) -> str:
        """Return one sentence that names how a bench differs; empty for the design's bench or another motion."""
        if trajectory != self.trajectory:
            return ""
        found = [*self._joints(joint), *self._laws(controller)]
        if not _same(self.control_period, control_period):
            found.append(_said("period", self.control_period, control_period, " s"))
        if not found:
            return ""
        more = f", and {len(found) - _SHOWN} more" if len(found) > _SHOWN else ""
        return printable(
            f"{self.source} was designed for {', '.join(found[:_SHOWN])}{more}: its reached values and expected "
            "errors are unknown for this bench; design the motion again for this bench"
        )

    def _joints(self, joint: Joint | None) -> Iterator[str]:
        """Yield the differences of a joint: its facts, its link, and values outside the assumed ranges."""
        if joint is None:
            return
        for name in _FACTS:
            then, now = getattr(self.joint, name), getattr(joint, name)
            if not _same(then, now):
                yield _said(_NAMES.get(name, name), then, now)
        if (self.joint.link is None) != (joint.link is None):
            yield f"a joint {_linked(self.joint)} (here {_linked(joint)})"
        elif self.joint.link is not None and joint.link is not None:
            for each in fields(Link):
                then, now = getattr(self.joint.link, each.name), getattr(joint.link, each.name)
                if not _same(then, now):
                    yield _said(f"link {each.name}", then, now)
        for name, (low, high) in self.believed.items():
            parameter = joint.parameters.get(name)
            value = None if parameter is None else parameter.value
            room = _SAME * max(abs(low), abs(high))
            if value is not None and not low - room <= value <= high + room:
                yield f"{name} from {low:.4g} to {high:.4g} (here {value:.4g})"

    def _laws(self, controller: Controller) -> Iterator[str]:
        """Yield the differences of a controller: its law, or its assumptions and gains."""
        if type(controller) is not type(self.controller):
            yield _said("the law", law_name(self.controller), law_name(controller))
            return
        here: Mapping[str, Any] = controller.asdict()
        there: Mapping[str, Any] = self.controller.asdict()
        fed_back = here.get("torque_feedback") or there.get("torque_feedback")
        first = True
        for name, then in there.items():
            unused = name in _OF_FEEDBACK and not fed_back
            if not unused and not _same(then, here[name]):
                yield _said(f"the controller's {name}" if first else name, then, here[name])
                first = False


def _same(then: Any, now: Any) -> bool:
    if isinstance(then, float) and isinstance(now, float):
        return then == now or abs(then - now) <= _SAME * max(abs(then), abs(now))
    return bool(then == now)


def _said(name: str, then: Any, now: Any, unit: str = "") -> str:
    return f"{name.replace('_', ' ')} {_shown(then)}{unit} (here {_shown(now)}{unit})"


def _shown(value: Any) -> str:
    if value is None:
        return "not stated"
    if isinstance(value, bool):
        return "on" if value else "off"
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def _linked(joint: Joint) -> str:
    return "without a link" if joint.link is None else "with a link"
