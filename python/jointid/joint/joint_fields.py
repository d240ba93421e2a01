"""The fields of a joint, and quantities that follow from them."""

import math
from collections.abc import Mapping
from dataclasses import field

from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.joint.link import GravityCoefficients, Limits, Link
from jointid.joint.model import Model
from jointid.joint.parameters import Parameter
from jointid.joint.tolerances import Tolerances
from jointid.joint.voltage_drive import VoltageDrive
from jointid.recording.signals import Kind, TorqueHold


@dataclass(frozen=True, kw_only=True, repr=False)
class JointFields:
    """Fields of a `Joint`, which checks them."""

    name: str = ""
    kind: Kind = "revolute"
    inertia: float | None = None
    rotor_inertia: float | None = None
    gear_ratio: float = 1.0
    torque_constant: float | None = None
    torque_hold: TorqueHold | None = None
    sensor: bool = False
    model: Model = field(default_factory=Model)
    torque_offset: bool | None = None
    link: Link | None = None
    parameters: Mapping[str, Parameter] = field(default_factory=dict, hash=False)
    limits: Limits = field(default_factory=Limits)
    tolerances: Tolerances = field(default_factory=Tolerances)
    voltage: VoltageDrive | None = None

    @property
    def owner(self) -> str:
        """Name of the joint in messages."""
        return f"joint '{self.name}'" if self.name else "joint"

    @property
    def facts(self) -> dict[str, float | None]:
        """Values that may have a tolerance, by the tolerance's name; None if not known."""
        link = self.link
        return {
            "torque_constant": self.torque_constant,
            "gear_ratio": self.gear_ratio,
            "inertia": self.inertia,
            "rotor_inertia": self.rotor_inertia,
            "mass": None if link is None else link.mass,
            "centre_of_mass": None if link is None else link.centre_of_mass,
            "link_inertia": None if link is None else link.inertia,
        }

    @property
    def reflected_inertia(self) -> float | None:
        """Inertia of the drive at the output [kg·m²], or mass [kg]; None if not known."""
        if self.inertia is not None or self.rotor_inertia is None:
            return self.inertia
        return self.gear_ratio * self.gear_ratio * self.rotor_inertia

    @property
    def link_inertia(self) -> float:
        """Inertia of the link about the joint's axis [kg·m²], or its mass [kg]; 0 without a link.

        A link without a stated inertia is a point mass.
        """
        if self.link is None:
            return 0.0
        if self.kind == "prismatic":
            return self.link.mass
        if self.link.inertia is not None:
            return self.link.inertia
        return self.link.mass * self.link.centre_of_mass * self.link.centre_of_mass

    @property
    def known_inertia(self) -> float | None:
        """Inertia that the drive's torque accelerates [kg·m²], or mass [kg]; None if not known.

        With a torque sensor, this is the drive's inertia. Without a sensor, it is the sum of the drive's and the
        link's inertia.
        """
        drive = self.reflected_inertia
        return drive if drive is None or self.sensor else drive + self.link_inertia

    @property
    def gravity_coefficients(self) -> GravityCoefficients:
        """Return the coefficients of the link's gravity torque, mass · gravity · centre_of_mass · cos(q + angle).

        Raises
        ------
        InputError
            The joint has no link.
        """
        if self.link is None:
            raise InputError(
                "the torque of gravity needs a link",
                argument="link",
                place=self.owner,
                remedy="give the link's mass and centre_of_mass",
            )
        weight = self.link.mass * self.link.gravity * self.link.centre_of_mass
        return GravityCoefficients(
            cos=weight * math.cos(self.link.angle), sin=0.0 - weight * math.sin(self.link.angle)
        )
