"""A robot's links and friction as a simulated mechanism: mass matrix, bias, directions of dry friction."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from jointid.base.errors import InputError
from jointid.robot.links.link_tree import LinkTree
from jointid.robot.links.models import LOAD
from jointid.robot.links.parameters import MOTOR_TERMS, VISCOUS
from jointid.robot.result.friction import joint_friction
from jointid.robot.result.record import RobotEstimateRecord

Array = NDArray[np.float64]

_ROTOR, _OFFSET = "rotor_inertia", "torque_offset"


@dataclass(frozen=True, slots=True, eq=False)
class Arm:
    """The simulated mechanism.

    Attributes
    ----------
    model, data : pinocchio.Model, pinocchio.Data
    rotors : ndarray, shape (n, n)
        Inertia of the motors at the joints.
    estimate : RobotEstimateRecord or None
        Estimate of the friction; None: no friction.
    """

    model: Any
    data: Any
    rotors: Array
    estimate: RobotEstimateRecord | None

    @classmethod
    def of(cls, estimate: RobotEstimateRecord) -> Arm:
        """Return the arm with identified values.

        Raises
        ------
        InputError
            The identified inertias are not physically consistent.
        """
        if estimate.consistent is False and estimate.inertia == "free":
            raise InputError(
                "no bodies can have these inertias, so the robot cannot be simulated",
                argument="subject",
                remedy="identify with inertia='scaled'",
            )
        values = [joint.parameters.get(_ROTOR) for joint in estimate.joints.values()]
        stated = estimate.robot.rotor_inertias
        rotors = [
            own.value if own is not None else (known or 0.0)
            for own, known in zip(values, stated, strict=True)
        ]
        inertial = np.asarray(estimate.inertial).reshape(-1, 10)
        return cls._made(estimate, inertial, np.array(rotors), estimate)

    @classmethod
    def nominal(cls, estimate: RobotEstimateRecord) -> Arm:
        """Return the arm of the URDF, without friction and with the stated rotor inertias."""
        stated = [known or 0.0 for known in estimate.robot.rotor_inertias]
        return cls._made(estimate, estimate.robot.tree.inertias, np.array(stated), None)

    @classmethod
    def _made(
        cls,
        estimate: RobotEstimateRecord,
        inertial: Array,
        rotors: Array,
        friction: RobotEstimateRecord | None,
    ) -> Arm:
        model = _mechanism(estimate.robot.tree, inertial)
        couplings = estimate.robot.couplings
        return cls(model, model.createData(), couplings.T @ (rotors[:, None] * couplings), friction)

    def mass(self, position: Array) -> Array:
        """Return the mass matrix, including the motors."""
        import pinocchio

        upper = np.triu(pinocchio.crba(self.model, self.data, position))
        return np.asarray(upper + np.triu(upper, 1).T + self.rotors)

    def bias(self, position: Array, velocity: Array) -> Array:
        """Return the torque of gravity, of Coriolis and centrifugal forces, and the offsets."""
        import pinocchio

        torque = np.array(pinocchio.nle(self.model, self.data, position, velocity))
        return torque + self._offsets

    @property
    def _offsets(self) -> Array:
        return self._values(_OFFSET)

    def _values(self, name: str) -> Array:
        """Return a parameter of all joints, 0 if a joint has none."""
        if self.estimate is None:
            return np.zeros(self.model.nv)
        found = (joint.parameters.get(name) for joint in self.estimate.joints.values())
        return np.array([0.0 if each is None else each.value for each in found])

    def friction_under_load(self, position: Array, velocity: Array, acceleration: Array) -> Array:
        """Return the friction that the torque of the links adds."""
        import pinocchio

        share = self._values(LOAD.name)
        if not share.any():
            return share
        links = pinocchio.rnea(self.model, self.data, position, velocity, acceleration)
        return np.asarray(share * np.abs(links))

    def friction_rows(self) -> Array:
        """Return the directions in which friction acts: the joints, and the motors that turn with several."""
        eye = np.eye(self.model.nv)
        if self.estimate is None:
            return eye[:0]
        robot = self.estimate.robot
        return np.vstack([eye, robot.couplings[robot.coupled]])

    def friction_sizes(self, velocity: Array, under_load: Array) -> Array:
        """Return the largest friction in each direction, at these speeds and loads of the joints."""
        if self.estimate is None:
            return np.zeros(0)
        robot, joints = self.estimate.robot, list(self.estimate.joints.values())
        ways = np.where(velocity < 0.0, -1.0, 1.0)
        speeds = np.where(velocity == 0.0, 1e-9, np.abs(velocity)) * ways
        own = np.array(
            [float(joint_friction(joint, speeds[k : k + 1])[0]) for k, joint in enumerate(joints)]
        )
        motors = robot.couplings @ velocity
        at_motors = np.zeros(robot.n)
        for name, term in MOTOR_TERMS.items():
            values = self._values(name)
            if term.basis == VISCOUS.basis:
                # The viscous friction of a joint contains what the motors add at its speed.
                own = own - (robot.couplings**2).T @ values * velocity
                at_motors = at_motors + values * np.abs(motors)
            else:
                at_motors = at_motors + values
        return np.asarray(
            np.maximum(np.concatenate([own * ways + under_load, at_motors[robot.coupled]]), 0.0)
        )


def _mechanism(tree: LinkTree, inertial: Array) -> Any:
    """Return the links as a pinocchio model."""
    import pinocchio

    model = pinocchio.Model()
    model.gravity.linear = tree.gravity
    places: list[int] = []
    for k, name in enumerate(tree.names):
        kind = (
            pinocchio.JointModelPrismaticUnaligned
            if tree.prismatic[k]
            else pinocchio.JointModelRevoluteUnaligned
        )
        parent = places[tree.parents[k]] if tree.parents[k] >= 0 else 0
        frame = pinocchio.SE3(tree.rotations[k], tree.translations[k])
        places.append(model.addJoint(parent, kind(tree.axes[k]), frame, name))
        body = pinocchio.Inertia.FromDynamicParameters(inertial[k])
        model.appendBodyToJoint(places[-1], body, pinocchio.SE3.Identity())
    return model
