"""Free parameters of an identification, as the columns of its torque balance."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from jointid import _core
from jointid.base.errors import InputError
from jointid.identification.prepared import prepare
from jointid.joint.checks import suggestion
from jointid.joint.joint import Joint
from jointid.problem.constant_torque import undivided
from jointid.problem.settings import Settings
from jointid.recording.recording import Recording


@dataclass(frozen=True, slots=True, kw_only=True)
class Request:
    """The parameters that an identification leaves free, and those that a motion is designed for."""

    names: tuple[str, ...]  # the free parameters
    wanted: tuple[str, ...]  # subset of the names for which the motion is designed
    terms: tuple[str, ...]  # keys of the balance's terms
    gear_ratio: float

    def columns(self, values: Mapping[str, float]) -> list[_core.BalanceColumn]:
        """Return the column of each free parameter for a joint with these values."""
        found: dict[str, _core.BalanceColumn] = {}
        for key in self.terms:
            term = _core.term(key)
            # The shape of a load friction is its coefficient.
            own = () if term.needs_load else term.shapes
            shapes = [float(values[name]) for name in own]
            frequency = _order(key) * (abs(self.gear_ratio) if key.startswith("ripple") else 1.0)
            if term.name in self.names:
                found[term.name] = _core.BalanceColumn(key=key, frequency=frequency, shapes=shapes)
            for number, name in enumerate(own):
                if name in self.names:
                    found[name] = _core.BalanceColumn(
                        key=key, shape=number, coefficient=float(values[term.name]), shapes=shapes
                    )
        return [found[name] for name in self.names]


def request_of(joint: Joint, wanted: Sequence[str] | None) -> Request:
    """Return the free parameters of an identification of this joint; refuse own terms and unknown names."""
    if joint.model.resolved.terms:
        raise InputError(
            "a motion cannot be designed for own terms: their signals are not simulated",
            argument="terms",
            value=str(joint.model),
            place="joint.model",
        )
    prepared = prepare((_template(joint),), joint, Settings.of({"shift": {}, "min_speed": 0.0}))
    domain = prepared.domain
    names = tuple(name for name in domain.names if not domain.fixed(name))
    # No motion separates an offset from the friction of the two directions, so the offset is fixed.
    groups = undivided(names)
    together = {name for group in groups for name in group.change}
    names = tuple(name for name in names if name not in {group.offset for group in groups})
    chosen = tuple(n for n in names if n not in together) if wanted is None else tuple(wanted)
    for name in chosen:
        if name in together:
            raise InputError(
                f"no motion separates this parameter from {', '.join(sorted(together - {name}))}",
                argument="parameters",
                value=name,
                remedy="fix one of these parameters in the joint",
            )
        if name not in names:
            raise InputError(
                f"the identification has no free parameter of this name; {suggestion(name, list(names))}",
                argument="parameters",
                value=name,
            )
    if not chosen:
        raise InputError("at least one parameter is expected", argument="parameters", value=[])
    return Request(
        names=names,
        wanted=chosen,
        terms=prepared.problem.choice.terms,
        gear_ratio=joint.gear_ratio,
    )


def _order(key: str) -> float:
    """Return the order of a harmonic's key, such as 2 for "ripple_sin_2"; 1 for others."""
    try:
        return float(key.rpartition("_")[2])
    except ValueError:
        return 1.0


def _template(joint: Joint) -> Recording:
    """Return a motion that is used only for the terms of its balance."""
    time = np.arange(4000) * 1e-3
    position = np.sin(2.0 * np.pi * 0.5 * time) + 0.2 * np.sin(2.0 * np.pi * 1.3 * time)
    velocity = np.gradient(position, time)
    torque = 2.0 * np.sign(velocity) + velocity + np.cos(position) + np.gradient(velocity, time)
    return Recording(
        time=time,
        position=position,
        velocity=velocity,
        torque=torque,
        sensor=np.cos(position) + 0.3 * np.gradient(velocity, time) if joint.sensor else None,
        kind=joint.kind,
    )
