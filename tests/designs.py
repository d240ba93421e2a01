"""A design made by hand: what `design_excitation` returns, without its search."""

from pathlib import Path
from typing import Any

from closed_loop import TRUTH, thesis_joint

import jointid as jid
from jointid.excitation.design import Design
from jointid.excitation.design_fields import COMPLETE
from jointid.excitation.expected_error import ExpectedError
from jointid.excitation.motion_limits import MotionLimits
from jointid.simulation.peaks import Peaks

JOINT = thesis_joint().with_parameters(TRUTH)
RELATIVE = {"coulomb": 0.0007, "static": 0.0021, "stribeck": 0.0018, "viscous": 0.0006}
RELATIVE |= {"sensor_gain": 0.0024, "sensor_offset": 0.0011}
UNITS = {"coulomb": "N·m", "static": "N·m", "stribeck": "s²/rad²", "viscous": "N·m·s/rad"}
UNITS |= {"sensor_gain": "N·m/unit", "sensor_offset": "N·m"}

BELIEVED = """coulomb = { value = 20.0, min = 10.0, max = 40.0 }
static = { value = 15.0, min = 10.0, max = 40.0 }
stribeck = { value = 150.0, min = 50.0, max = 200.0 }
viscous = { value = 15.0, min = 10.0, max = 30.0 }
sensor_gain = { value = 2.0, min = 1.5, max = 3.0 }
sensor_offset = { value = 0.0, min = -20.0, max = 20.0 }
"""
_EXAMPLE = Path(__file__).resolve().parents[1] / "examples" / "hardware" / "joint.toml"


def bench_text() -> str:
    """The example's bench file, with a narrower belief, and with a motion that is to be designed."""
    text = _EXAMPLE.read_text(encoding="utf-8").replace("ripple = [2] ", "ripple = []", 1)
    for begin, end, new in (
        ("coulomb = {", "[limits]", f"{BELIEVED}\n"),
        ('form = "thesis"', "[session.controller]", 'file = "motion.toml"\n\n'),
    ):
        text = text[: text.index(begin)] + new + text[text.index(end) :]
    return text


def motion(duration: float = 6.0) -> jid.Trajectory:
    """Some sines."""
    return jid.Trajectory.sines(
        amplitude=(0.55, 0.2, 0.1),
        frequency=(1.1, 2.9, 6.3),
        phase=(0.3, 1.2, -0.4),
        offset=0.05,
        fade=0.6,
        duration=duration,
    )


def designed(**changes: Any) -> Design:
    """A design, with some fields changed."""
    values: dict[str, Any] = {
        "status": COMPLETE,
        "trajectory": motion(),
        "duration": 6.0,
        "joint": JOINT,
        "controller": jid.AdaptiveRobust(**jid.control_estimates(JOINT)),
        "sensors": jid.Sensors(torque_noise=0.5),
        "limits": MotionLimits(position=(-1.0, 1.0), velocity=3.4, torque=160.0, sensor_range=60.0),
        "peaks": Peaks(
            position=(-0.7, 0.9),
            velocity=3.38,
            acceleration=14.0,
            torque=120.0,
            sensor_torque=30.0,
        ),
        "parameters": {
            name: ExpectedError(
                name=name,
                unit=UNITS[name],
                value=TRUTH[name],
                stderr=share * abs(TRUTH[name]),
                relative=share,
                worst=1.5 * share,
            )
            for name, share in RELATIVE.items()
        },
        "reference": {name: 6.0 * share for name, share in RELATIVE.items()},
        "criterion": "worst",
        "joints": 8,
        "evaluations": 4000,
        "seed": 3,
        "weakest": "sensor_gain",
        "limited_by": "the velocity is at its limit",
    }
    return Design(**values | changes)
