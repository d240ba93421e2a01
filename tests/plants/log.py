"""What is measured and recorded, and how badly."""

from __future__ import annotations

from dataclasses import dataclass

from plants.columns import Columns, PerRun


@dataclass(frozen=True, kw_only=True)
class Log(Columns):
    """Sensors and recorder; every field is a number, or an array with one value for each run.

    A signal that is late by d shows at time t what was true at t - d.
    """

    every: PerRun = 1  # ticks between recorded samples; the torque is then the last command's
    # Torque sensor: link torque = gain * reading + offset.
    sensor: PerRun = 1.0  # 0: none
    gain: PerRun = 2.4
    offset: PerRun = 15.0
    sensor_noise: PerRun = 0.2  # at the sensor's input [N·m]
    ripple: PerRun = 0.0  # [N·m]
    ripple_order: PerRun = 202.0  # of the output's angle
    ripple_phase: PerRun = 0.0
    nonlinearity: PerRun = 0.0  # cubic, share of full_scale at full_scale
    full_scale: PerRun = 60.0  # [N·m]
    sensor_clip: PerRun = 0.0  # reading's limit as a torque [N·m]; 0: none
    sensor_delay: PerRun = 0.0  # [s]
    sensor_cutoff: PerRun = 0.0  # low-pass of first order [Hz]; 0: none
    # Drive's torque.
    torque_noise: PerRun = 0.0
    torque_delay: PerRun = 0.0
    # Position and velocity.
    counts: PerRun = 0.0  # encoder counts an output turn; 0: exact
    position_noise: PerRun = 0.0  # [rad]
    velocity: PerRun = 1.0  # 0: not recorded; 1: recorded
    differenced: PerRun = (
        0.0  # 1: by backward difference of the measured position over one command; 0: exact
    )
    velocity_cutoff: PerRun = 0.0  # low-pass of first order [Hz]; 0: none
    velocity_noise: PerRun = 0.0
    velocity_delay: PerRun = 0.0
    # Time stamps.
    stamp_jitter: PerRun = 0.0  # mean lateness of the stamp of an even sample [s], exponential
    sample_jitter: PerRun = (
        0.0  # standard deviation of the time at which a sample is truly taken [s]
    )
    jitter_known: PerRun = 1.0  # 1: the stamp is the true time of the sample; 0: stamps are even
    repeated: PerRun = 0.0  # share of rows whose signals repeat the row before
    dropped: PerRun = 0.0  # share of rows that are lost
