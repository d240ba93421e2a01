"""Motion from a recording of a robot: positions, velocities and torques of its joints, and which samples are usable."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.advice import Action
from jointid.base.error_text import joint_phrase
from jointid.base.errors import InputError
from jointid.recording.recording import Recording
from jointid.recording.sides import MOTOR
from jointid.recording.wide.robot_recording import RobotRecording
from jointid.robot.links.position_drive import facts_of_drive
from jointid.robot.links.robot import Robot
from jointid.robot.motion.driven import Driven, is_held
from jointid.robot.motion.given_velocity import in_time, integrated, noise_of
from jointid.robot.motion.noisy_samples import quiet_velocity
from jointid.robot.motion.reversals import away_from_reversals

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

_UNKNOWNS = 6  # assumed number of unknowns in a joint's balance, for the length of its windows
_STILL = 8.0  # standard deviations that the smoothed velocity of a short standstill can reach
_COARSE = 0.015  # [s], between samples: with longer steps, the blur at a reversal matters


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Motion:
    """Motion and torque of a robot's joints, all at the joints; rows are joints, in the robot's order: (n, samples)."""

    time: Array  # (samples,) [s]
    position: Array
    velocity: Array
    torque: Array
    velocity_noise: Array  # (n,), usual standard deviation of each velocity
    # positions of the motors, divided by their gear ratios, counted from their own zero
    motor_position: Array
    motor_velocity: Array  # the same
    # (n, samples - 1): True if the joint moves between two samples, without a gap. An interval in which noise may hide
    # a short standstill does not count as moving, because friction has any value there.
    moving: Flags
    motor_moving: Flags  # the same for the motors
    # (n,), duration of a window that is suitable for the noise of each velocity [s]
    noise_window: Array
    at_motor: bool  # True if positions were recorded at the motors
    # True if a torque holds from its sample to the next one, as a command does; otherwise it is interpolated linearly
    torque_held: bool = False
    # parts of the torque from wanted positions; None: the torque was recorded
    driven: Driven | None = None
    # (n, samples), torque per gain of the joints with an identified gain; None: there are no such joints
    of_unit_gain: Array | None = None

    @classmethod
    def of(
        cls,
        recording: RobotRecording,
        robot: Robot,
        min_speed: Array,
        mask_standstill: bool = True,
        recorded: Collection[int] = (),
    ) -> Motion:
        """Return the motion of a recording. Below its `min_speed` [rad/s or m/s] a joint's friction is not used.

        Velocities are derived from positions, except of the joints `recorded`.
        """
        coupling = robot.couplings
        position, torque, at_motor = signals_of(recording, robot)
        found = [_derived(recording, row, robot.names[k]) for k, row in enumerate(position)]
        noise = np.array([each.derived.noise for each in found])
        velocity = np.array(
            [quiet_velocity(each.velocity, own) for each, own in zip(found, noise, strict=True)]
        )
        if recorded:
            rows = recorded_velocity(recording, robot, at_motor)
            for joint in recorded if rows is not None else ():
                assert rows is not None
                velocity[joint] = in_time(rows[joint], found[joint])
                noise[joint] = noise_of(rows[joint], found[joint])
                position[joint] = integrated(velocity[joint], found[joint])
        if at_motor:
            back = np.linalg.inv(coupling)
            own, own_noise = (position, velocity), noise
            position, velocity = back @ position, back @ velocity
            noise = np.sqrt((back * back) @ (noise * noise))
        else:
            own = (coupling @ position, coupling @ velocity)
            own_noise = np.sqrt((coupling * coupling) @ (noise * noise))
        if robot.zero_offsets is not None:
            position = position + np.array(robot.zero_offsets)[:, None]
        masked = _Mask(
            time=recording.time,
            gaps=[gap.index for gap in found[0].gaps],
            standstill=mask_standstill,
        )
        signals = zip(position, velocity, torque, min_speed, strict=True)
        joints = [masked.core(*row) for row in signals]
        of_joints = np.array([masked.moving(each) for each in joints])
        of_motors = of_joints.copy()
        for k in np.flatnonzero(robot.coupled):
            of_motors[k] = masked.moving(masked.core(own[0][k], own[1][k], torque[k], min_speed[k]))
        if mask_standstill:
            of_joints &= _fast(velocity, noise)
            of_motors &= _fast(own[1], own_noise)
        coarse = float(np.median(np.diff(recording.time))) > _COARSE
        if mask_standstill and (coarse or robot.drive is not None):
            of_joints = away_from_reversals(of_joints, velocity)
            of_motors = away_from_reversals(of_motors, own[1])
        return cls(
            time=recording.time,
            position=position,
            velocity=velocity,
            torque=torque,
            velocity_noise=np.median(noise, axis=1),
            motor_position=own[0],
            motor_velocity=own[1],
            moving=of_joints,
            motor_moving=of_motors,
            at_motor=at_motor,
            torque_held=is_held(recording, robot),
            driven=_driven(recording, robot),
            of_unit_gain=_of_unit_gain(recording, robot),
            noise_window=np.array([masked.noise_window(each) for each in joints]),
        )

    def torque_late_by(self, delay: Array) -> Array:
        """Return the torques, (n, samples), with further delays removed; with a drive, its command is delayed [s]."""
        if self.driven is not None:
            return self.driven.torque(delay)
        late = [
            np.interp(self.time + each, self.time, row)
            for each, row in zip(delay, self.torque, strict=True)
        ]
        return np.array(late)


def _fast(velocity: Array, noise: Array) -> Flags:
    """Return intervals that certainly contain no short standstill hidden by noise; friction has any value there."""
    fast = np.abs(velocity) >= _STILL * noise
    return np.asarray(fast[:, 1:] & fast[:, :-1])


def recorded_velocity(recording: RobotRecording, robot: Robot, at_motor: bool) -> Array | None:
    """Return recorded velocities, a row for each joint, for motors divided by gear ratios; None if one is missing."""
    columns = robot.columns_of(recording)
    velocity = recording.velocity
    if velocity is None or recording.velocity_derived or np.isnan(velocity[:, columns]).any():
        return None
    way = np.array(robot.directions or (1.0,) * robot.n)
    found = way[:, None] * velocity[:, columns].T
    if at_motor:
        found = found / _ratios(recording, robot, columns)[:, None]
    return np.ascontiguousarray(found)


def part_of(recording: RobotRecording, first: int, end: int) -> RobotRecording:
    """Return some samples of a recording."""
    if first == 0 and end == recording.samples:
        return recording
    fields = recording.fields()
    for signal in recording.signals:
        fields[signal] = fields[signal][first:end]
    fields["extra"] = {}
    return RobotRecording(**fields)


def signals_of(recording: RobotRecording, robot: Robot) -> tuple[Array, Array, bool]:
    """Return positions and torques, one row for each joint, and whether the positions are those of the motors.

    Torques are at the joints. Positions of motors are divided by the gear ratios.
    """
    columns = robot.columns_of(recording)
    way = np.array(robot.directions or (1.0,) * robot.n)
    factor = way * np.array(robot.torque_scales or (1.0,) * robot.n)
    position = np.ascontiguousarray(way[:, None] * recording.position[:, columns].T)
    at_motor = (robot.side or recording.side) == MOTOR
    driven = _driven(recording, robot)
    if driven is not None:
        if at_motor:
            position = position / _ratios(recording, robot, columns)[:, None]
        return position, driven.torque(), at_motor
    torque, motor_torque = recording.torque, recording.motor_torque
    if at_motor and torque is not None:
        torque, motor_torque = None, torque
    by_current = torque is None and motor_torque is None
    if by_current:
        motor_torque = _of_currents(recording, robot, columns)
    geared = robot.gear_ratios is not None or recording.gear_ratio is not None or not by_current
    needed = at_motor or (
        torque is None and geared
    )  # without a gear, a joint's constant may be that of the motor
    ratios = _ratios(recording, robot, columns) if needed else np.ones(robot.n)
    recorded = torque if torque is not None else motor_torque
    assert recorded is not None
    # Before couplings, because they spread a missing torque of one joint over all joints.
    present = np.all(np.isfinite(recorded[:, columns]), axis=0)
    if not present.all():
        raise InputError(
            f"{robot.names[int(np.argmin(present))]} has no torque",
            place=recording.name,
            remedy="name only joints that have a torque",
        )
    if torque is not None:
        joint_torque = factor[:, None] * torque[:, columns].T
    else:
        joint_torque = robot.couplings.T @ (recorded[:, columns].T * (factor * ratios)[:, None])
    return (position / ratios[:, None] if at_motor else position), joint_torque, at_motor


def _driven(recording: RobotRecording, robot: Robot) -> Driven | None:
    """Return the torques of a position drive from wanted positions, at the joints."""
    if robot.drive is None:
        return None
    columns = robot.columns_of(recording)
    factor = np.array(robot.directions or (1.0,) * robot.n)
    factor = factor * np.array(robot.torque_scales or (1.0,) * robot.n)
    if (robot.side or recording.side) == MOTOR:
        factor = factor * _ratios(recording, robot, columns)
    return Driven.of(recording, robot.drive, columns, factor)


def ratios_of_positions(recording: RobotRecording, robot: Robot) -> Array:
    """Return recorded positions per position of the joints, signed; without couplings."""
    directions = np.array(robot.directions or (1.0,) * robot.n)
    if (robot.side or recording.side) != MOTOR:
        return directions
    return np.asarray(directions * _ratios(recording, robot, robot.columns_of(recording)))


def _of_unit_gain(recording: RobotRecording, robot: Robot) -> Array | None:
    if robot.drive is None or not robot.drive.free:
        return None
    unit = _driven(recording, replace(robot, drive=robot.drive.of_unit_gain()))
    assert unit is not None
    return unit.torque()


def _of_currents(recording: RobotRecording, robot: Robot, columns: list[int]) -> Array:
    """Return the motors' torques of a recording that has currents only."""
    if recording.current is None:
        raise InputError(
            "the recording has no torque",
            place=recording.name,
            remedy=() if recording.reference is None else facts_of_drive(robot.names),
        )
    if robot.torque_constants is None:
        names = ", ".join(robot.names)
        raise InputError(
            f"the recording has currents and no torque; one torque constant for each of {names} is needed [N·m/A]",
            argument="torque_constants",
            remedy=Action(
                "call", {"torque_constants": [...] * robot.n}, function="Robot.from_urdf"
            ),
        )
    found = np.full(recording.current.shape, np.nan)
    found[:, columns] = recording.current[:, columns] * np.array(robot.torque_constants)
    return found


def _ratios(recording: RobotRecording, robot: Robot, columns: list[int]) -> Array:
    if robot.gear_ratios is not None:
        return np.array(robot.gear_ratios)
    if recording.gear_ratio is not None:
        return np.array([recording.gear_ratio[column] for column in columns])
    names = ", ".join(robot.names)
    raise InputError(
        f"the recording is on the motor side; a gear ratio (motor angle per joint angle) is needed for each of {names}",
        argument="gear_ratios",
        remedy=Action("call", {"gear_ratios": [...] * robot.n}, function="Robot.from_urdf"),
    )


def _derived(recording: RobotRecording, position: Array, name: str) -> Recording:
    """Return one row of positions as a recording, to derive its velocity from them."""
    try:
        return Recording(time=recording.time, position=position, torque=np.zeros(position.size))
    except InputError as error:
        raise error.at(joint_phrase(name)) from None


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Mask:
    """The mask of one joint's identification, for each joint and motor."""

    time: Array
    gaps: list[int]
    standstill: bool

    def core(
        self, position: Array, velocity: Array, torque: Array, min_speed: float
    ) -> _core.Recording:
        return _core.Recording(
            time=self.time,
            position=np.ascontiguousarray(position),
            velocity=np.ascontiguousarray(velocity),
            torque=np.ascontiguousarray(torque),
            sensor=None,
            torque_hold=_core.Hold.linear,
            gap_after=self.gaps,
            min_speed=float(min_speed),
        )

    def moving(self, recording: _core.Recording) -> Flags:
        try:
            return np.asarray(_core.usable_intervals(recording, self.standstill), dtype=bool)
        except InputError:  # it never moves: the others may
            return np.zeros(self.time.size - 1, dtype=bool)

    def noise_window(self, recording: _core.Recording) -> float:
        try:
            return _core.window_duration(recording, _UNKNOWNS, self.standstill)
        except InputError:
            return 0.0
