"""The joints for which a motion is designed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.joint.checks import finite_number, suggestion
from jointid.joint.joint import Joint

Range = tuple[float, float]
Prior = Mapping[str, Range] | Sequence[Mapping[str, float]] | None

_AROUND = 0.3  # share of a value without bounds, on both sides
_SMALL = 0.1  # share of its range: a smaller value's error is relative to this


@dataclass(frozen=True, slots=True, kw_only=True)
class Ranges:
    """The assumed range of each free parameter."""

    nominal: Mapping[str, float]  # values of the joint in the middle
    ranges: Mapping[str, Range]
    # Values of joints listed by the user; empty: the ranges give the joints.
    drawn: tuple[Mapping[str, float], ...] = ()

    def scale(self, name: str, value: float) -> float:
        """Return the size that a parameter's error is relative to: its value, or a part of its range."""
        low, high = self.ranges[name]
        return max(abs(value), _SMALL * (high - low)) or 1.0

    def corners(self, count: int, seed: int) -> list[dict[str, float]]:
        """Return values of `count` joints at the ends of all ranges."""
        if self.drawn:
            return []
        high = np.random.default_rng(seed).random((count, len(self.ranges))) < 0.5
        ends = list(self.ranges.items())
        return [
            {name: ends_[int(up)] for (name, ends_), up in zip(ends, row, strict=True)}
            for row in high.tolist()
        ]

    def joints(self, count: int, seed: int) -> list[dict[str, float]]:
        """Return values of `count` joints: the nominal joint, then the cell centres of a Latin hypercube."""
        if self.drawn:
            return [dict(each) for each in self.drawn[: max(1, count)]]
        others = max(0, count - 1)
        random = np.random.default_rng(seed)
        found = [dict(self.nominal) for _ in range(count)]
        for name, (low, high) in self.ranges.items():
            shares = (random.permutation(others) + 0.5) / max(1, others)
            for joint, share in zip(found[1:], shares.tolist(), strict=True):
                joint[name] = low + (high - low) * share
        return found


def ranges_of(joint: Joint, names: Sequence[str], prior: Prior) -> Ranges:
    """Return the ranges of the free parameters `names`. Refuse parameters without a range, and list all of them."""
    if prior is not None and (not isinstance(prior, Mapping | Sequence) or isinstance(prior, str)):
        raise InputError(
            "a mapping from parameters to ranges, or a list of joints' values, is expected",
            argument="prior",
            value=prior,
        )
    if prior is not None and not isinstance(prior, Mapping):
        return _of_joints(names, prior)
    chosen = {} if prior is None else dict(prior)
    for name in chosen:
        if name not in names:
            raise InputError(
                f"this is not a free parameter; {suggestion(str(name), list(names))}",
                argument=str(name),
                place="prior",
            )
    ranges: dict[str, Range] = {}
    nominal: dict[str, float] = {}
    unknown: list[str] = []
    for name in names:
        parameter = joint.parameters.get(name)
        value = None if parameter is None else parameter.value
        bounds = (None, None) if parameter is None else (parameter.min, parameter.max)
        if name in chosen:
            ranges[name] = _range(name, chosen[name])
            value = None
        elif bounds[0] is not None and bounds[1] is not None:
            ranges[name] = (bounds[0], bounds[1])
        elif value:  # 30 % of 0 is not a range
            around = sorted((value * (1.0 - _AROUND), value * (1.0 + _AROUND)))
            ranges[name] = (
                around[0] if bounds[0] is None else max(around[0], bounds[0]),
                around[1] if bounds[1] is None else min(around[1], bounds[1]),
            )
        else:
            unknown.append(name)
            continue
        nominal[name] = 0.5 * sum(ranges[name]) if value is None else value
    if unknown:
        one = len(unknown) == 1
        raise InputError(
            f"the range of {'this parameter' if one else 'these parameters'} is unknown",
            argument=", ".join(unknown),
            place="joint",
            remedy=(
                f"give {'its' if one else 'their'} min and max in the joint",
                Action(
                    "call", {"prior": dict.fromkeys(unknown, ...)}, function="design_excitation"
                ),
            ),
        )
    return Ranges(nominal=nominal, ranges=ranges)


def with_room(joint: Joint, ranges: Mapping[str, Range]) -> Joint:
    """Return the joint with bounds that contain these ranges, even if they exceed the joint's own bounds."""
    table = dict(joint.parameters)
    for name, (low, high) in ranges.items():
        own = table.get(name)
        if own is not None:
            least = None if own.min is None else min(own.min, low)
            most = None if own.max is None else max(own.max, high)
            table[name] = replace(own, min=least, max=most)
    return joint.replace(parameters=table)


def _of_joints(names: Sequence[str], joints: Sequence[Mapping[str, float]]) -> Ranges:
    found = []
    for number, each in enumerate(joints):
        if not isinstance(each, Mapping) or set(each) < set(names):
            raise InputError(
                f"a value for each free parameter is expected: {', '.join(names)}",
                argument=f"prior[{number}]",
            )
        found.append({name: finite_number("prior", name, each[name]) for name in names})
    if not found:
        raise InputError("at least one joint is expected", argument="prior", value=[])
    ranges = {
        name: (min(each[name] for each in found), max(each[name] for each in found))
        for name in names
    }
    return Ranges(nominal=found[0], ranges=ranges, drawn=tuple(found))


def _range(name: str, bounds: object) -> Range:
    if not isinstance(bounds, list | tuple) or len(bounds) != 2:
        raise InputError(
            "a lowest and a highest value are expected", argument=name, value=bounds, place="prior"
        )
    low, high = (finite_number("prior", name, bound) for bound in bounds)
    if not low < high:
        raise InputError(
            "the first value must be below the second",
            argument=name,
            value=[low, high],
            place="prior",
        )
    return low, high
