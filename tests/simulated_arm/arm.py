"""The arm: links of a URDF, rotors, and friction wherever it arises."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
JOINTS = 7
URDF = Path(__file__).with_name("seven_joints.urdf")
# What a joint of this size has, at the joint: [N·m], [N·m·s/rad], [kg·m²].
_COULOMB = np.array([9.0, 10.0, 7.0, 7.0, 4.0, 2.5, 2.2])
_VISCOUS = np.array([12.0, 13.0, 9.0, 8.0, 5.0, 3.0, 2.6])
_ROTOR = np.array([1.3, 1.3, 0.8, 0.8, 0.4, 0.25, 0.25])


@dataclass(frozen=True, kw_only=True)
class Source:
    """Friction and a rotor that turn with `speed` · v: 1 for the joint itself, several for a coupled motor.

    Friction is (coulomb + static exp(-stribeck s²)) sgn s + viscous s + offset at the speed s, and any value between
    the two signs at standstill.
    """

    speed: tuple[float, ...]
    coulomb: float = 0.0
    static: float = 0.0
    stribeck: float = 100.0
    viscous: float = 0.0
    offset: float = 0.0
    rotor_inertia: float = 0.0


@dataclass(frozen=True, kw_only=True)
class Arm:
    """Links, sources of friction, and how motors turn with joints.

    Attributes
    ----------
    model : pinocchio.Model
    sources : tuple of Source
    couplings : ndarray, shape (joints, joints)
        Motors' speeds from joints' speeds; friction does not depend on it, only what is recorded at the motors.
    """

    model: Any
    sources: tuple[Source, ...]
    couplings: Array

    @property
    def joints(self) -> int:
        return int(self.model.nv)

    @property
    def speeds(self) -> Array:
        """Speeds of the sources from speeds of the joints, (sources, joints)."""
        return np.array([source.speed for source in self.sources])

    def values(self, name: str) -> Array:
        """One field of all sources."""
        return np.array([getattr(source, name) for source in self.sources])

    def with_link_scaled(self, link: int, factor: float) -> Self:
        """The arm with all inertial parameters of one link (1 is the first that moves) multiplied."""
        import pinocchio

        model = pinocchio.Model(self.model)
        was = model.inertias[link]
        model.inertias[link] = pinocchio.Inertia(was.mass * factor, was.lever, was.inertia * factor)
        return replace(self, model=model)


def arm_of(sources: Sequence[Source], couplings: Array | None = None, urdf: Path = URDF) -> Arm:
    """The arm of a URDF."""
    import pinocchio

    model = pinocchio.buildModelFromUrdf(str(urdf))
    turns = np.eye(model.nv) if couplings is None else np.asarray(couplings, dtype=float)
    return Arm(model=model, sources=tuple(sources), couplings=turns)


def random_arm(seed: int, *, coupled: bool = False, stribeck: bool = True) -> Arm:
    """Friction and rotors about those of a light arm.

    With `coupled`, motors are recorded behind gears, motor 7 turns with joints 6 and 7, and has friction of its own.
    """
    rng = np.random.default_rng([seed, 7])
    coulomb = _COULOMB * rng.uniform(0.7, 1.3, JOINTS)
    sources = [
        Source(
            speed=tuple(np.eye(JOINTS)[j].tolist()),
            coulomb=coulomb[j],
            static=coulomb[j] * rng.uniform(0.2, 0.6) * stribeck,
            stribeck=rng.uniform(50.0, 300.0),
            viscous=_VISCOUS[j] * rng.uniform(0.7, 1.3),
            offset=coulomb[j] * rng.uniform(-0.1, 0.1),
            rotor_inertia=_ROTOR[j] * rng.uniform(0.7, 1.3),
        )
        for j in range(JOINTS)
    ]
    if not coupled:
        return arm_of(sources)
    ratios = np.array([100.0, 100.0, 100.0, -100.0, 80.0, 80.0, 60.0])
    couplings = np.diag(ratios)
    couplings[6, 5] = 60.0
    motor = Source(
        speed=(0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0),
        coulomb=1.5 * rng.uniform(0.7, 1.3),
        viscous=1.5 * rng.uniform(0.7, 1.3),
        rotor_inertia=sources[6].rotor_inertia,
    )
    return arm_of([*sources[:6], replace(sources[6], rotor_inertia=0.0), motor], couplings)
