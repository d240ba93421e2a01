"""Reason for the refusal of a bench: a code for programs, a sentence for people."""

from __future__ import annotations

REASONS = {
    "not_ready": "the drive or the joint is not ready",
    "moving": "the joint moves although nothing drives it",
    "moves_at_zero_torque": "the joint moves at zero torque as soon as the motor is on",
    "no_motion_up_to_torque_cap": "even the largest allowed torque did not move the joint",
    "current_does_not_follow": "the drive's current differs from the commanded current",
    "torque_and_encoder_disagree": "a positive torque makes the encoder count down",
    "moves_one_way": "the joint moves in one direction under torques of both signs",
    "torque_constant": "the torque does not match the current and the joint file's torque constant",
    "gear_ratio": "the gear ratio or the encoder's counts per revolution differ from the values in the joint file",
    "torque_constant_or_gear_ratio": "the torque constant or the gear ratio of the joint file is wrong",
    "inertia": "the joint's inertia differs from the inertia in the joint file",
    "sensor_sign": "the torque sensor shows the torque with the opposite sign",
    "encoder_stands": "the encoder does not count, although the joint is turned or must have moved",
    "sensor_moves_alone": "the torque sensor shows a motion or a blocked joint, but the encoder does not count",
    "does_not_stop": "the joint does not stop at zero torque",
    "too_far": "the joint went farther than a first motion allows",
    "too_fast": "the joint moved faster than a first motion allows",
    "control": "a small slow motion under control failed",
    "watchdog": "the drive did not switch its motor off when the host stopped sending",
    "too_long": "the motor was on for longer than a first motion allows",
    "user": "stopped by the user",
}
"""Codes of a refusal and their meanings. The kinds of a drive's faults, such as "bus", are codes, too."""


class RefusedBenchError(Exception):
    """The bench is refused.

    Parameters
    ----------
    reason : str
        One of `REASONS`, or the kind of a drive's fault.
    message : str
        Measured values, and parts of the bench to examine.
    """

    def __init__(self, reason: str, message: str) -> None:
        super().__init__(message)
        self.reason = reason
