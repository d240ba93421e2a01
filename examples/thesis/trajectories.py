"""Figures 5-1, 5-2 and 6-5 to 6-7: the desired motion."""

import math

import numpy as np
from gallery import Gallery, titled
from scenario import CYCLE, bench_motion, wide_motion

import jointid as jid


def draw(gallery: Gallery) -> None:
    """Draw position and velocity of chapter 5; position, velocity and acceleration of chapter 6."""
    with gallery.picture("5-1_5-2_trajectory", 1, 2) as (position, velocity):
        for axes, what in ((position, "position"), (velocity, "velocity")):
            for label, motion in (
                ("60°, cycle 3 s (ours)", wide_motion()),
                ("20°, cycle 6 s (its DSP)", jid.Trajectory.thesis()),
            ):
                jid.plot.trajectory(motion, what, axes, label=label)
        titled(position, "5-1")
        titled(velocity, "5-2")
    motion = bench_motion()
    with gallery.picture("6-5_to_6-7_trajectory", 1, 3, size=(11.0, 2.9)) as panels:
        for number, (axes, what) in enumerate(
            zip(panels, ("position", "velocity", "acceleration"), strict=True), start=5
        ):
            titled(jid.plot.trajectory(motion, what, axes), f"6-{number}: A = 4°")
    time = np.linspace(0.0, CYCLE, 20001)
    position_now, velocity_now, acceleration_now = motion.sample(time)
    gallery.note("6-5", "largest angle", math.degrees(np.abs(position_now).max()), "°", "4")
    gallery.note("6-6", "largest speed", np.abs(velocity_now).max(), "rad/s")
    gallery.note("6-7", "largest acceleration", np.abs(acceleration_now).max(), "rad/s²")
    gallery.note("6-6", "speed at the start", velocity_now[0], "rad/s", "0")
    slow = float(np.exp(-100.0 * np.abs(velocity_now).max() ** 2))
    gallery.note("6-6", "least exp(−100 v²): static and Coulomb look alike", slow)
