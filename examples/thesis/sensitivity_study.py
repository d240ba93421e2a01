"""Figures 4-2 to 4-7: what an error of 10 % in each parameter does, and at which speeds."""

import math

import numpy as np
from gallery import Gallery, titled
from scenario import TRUTH, hanging_joint

import jointid as jid

ORDER = ("coulomb", "static", "stribeck", "viscous", "sensor_offset", "sensor_gain")
READING = 5.0


def torque(values: dict[str, float], speed: float) -> float:
    """The drive's at constant speed and sensor reading (4-20 without acceleration)."""
    static = values["static"] * math.exp(-values["stribeck"] * speed**2)
    sensed = values["sensor_gain"] * READING + values["sensor_offset"]
    return values["coulomb"] + static + values["viscous"] * speed + sensed


def change(name: str, speed: float) -> float:
    """Of that torque, for the parameter 10 % larger [N·m]."""
    return torque({**TRUTH, name: 1.1 * TRUTH[name]}, speed) - torque(TRUTH, speed)


def draw(gallery: Gallery) -> None:
    """Draw the six."""
    joint = hanging_joint().with_parameters(TRUTH)
    speeds = np.linspace(0.0, 0.6, 601)
    with gallery.picture("4-2_to_4-7_sensitivity", 3, 2, size=(9.2, 9.0)) as panels:
        for number, (axes, name) in enumerate(zip(panels, ORDER, strict=True), start=2):
            jid.plot.sensitivity(joint, name, axes, reading=READING)
            titled(axes, f"4-{number}")
            moved = np.abs([change(name, float(speed)) for speed in speeds])
            gallery.note(f"4-{number}", f"{name} +10 %: at 0.01 rad/s", moved[10], "N·m")
            gallery.note(f"4-{number}", f"{name} +10 %: at 0.6 rad/s", moved[-1], "N·m")
            gallery.note(f"4-{number}", f"{name} +10 %: at 0.1 rad/s", moved[100], "N·m")
            if np.ptp(moved) > 1e-6:
                most = speeds[int(np.argmax(moved))]
                gallery.note(f"4-{number}", f"{name}: most at", most, "rad/s")
