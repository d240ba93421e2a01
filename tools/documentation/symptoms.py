"""What a person sees of each finding, and the picture that shows it best."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from documentation.pictures import (
    Drawing,
    friction,
    over_time,
    rate,
    residual_over,
    samples,
    steps,
    windows,
)
from jointid.identification.causes.families import FAMILIES


@dataclass(frozen=True)
class Symptom:
    """What is seen, and a picture of it; without one, the case's file is shown."""

    seen: str
    picture: Drawing | None = None


_RATE = {"start": 1.0, "stop": 1.12}
# By code. Of a cause without words of its own, what its misfit shows.
SYMPTOMS: Mapping[str, Symptom] = {
    family.name: Symptom(f"The residual is no noise: {family.meaning}.", windows)
    for family in FAMILIES
} | {
    "stopped": Symptom(
        "The search ended before the penalty had settled; another seed gives other values.", windows
    ),
    "cross_check": Symptom(
        "A plain least squares on the recorded signals gives other values than the report's table.",
        friction,
    ),
    "no_friction": Symptom(
        "The joint moves without friction: the torque is measured behind it.", friction
    ),
    "reversed_sign": Symptom(
        "Friction seems to push the joint: it falls where the speed grows. Values end on their bounds.",
        friction,
    ),
    "implausible_units": Symptom(
        "The joint seems to turn tens of radians, or as fast as no joint does.",
        over_time(
            "position", "velocity", caption="Degrees, read as radians: ±60 rad at 190 rad/s."
        ),
    ),
    "velocity_mismatch": Symptom(
        "The velocity column is smaller or larger than the slope of the position.",
        rate(
            caption="The recorded velocity is 0.8 times the position's rate.", start=0.0, stop=3.0
        ),
    ),
    "signal_lag": Symptom(
        "One signal follows the others late, and was left as it is.",
        rate(caption="The velocity follows the position's rate 3 ms late.", **_RATE),
    ),
    "delay_removed": Symptom(
        "One signal followed the others late, and was shifted before the identification.",
        rate(
            caption="The velocity follows the position's rate 3 ms late, as a filter makes it.",
            **_RATE,
        ),
    ),
    "wrong_scale": Symptom(
        "All values are too large or too small by one factor, and a known inertia does not fit.",
        windows,
    ),
    "constant_signal": Symptom(
        "A signal stays at one value while the joint moves.",
        over_time(
            "sensor",
            "velocity",
            caption="From 4 s to 6 s the sensor's reading is frozen: a broken cable.",
        ),
    ),
    "torque_saturated": Symptom(
        "The torque has flat tops: the controller asks for more than the log shows.",
        over_time("torque", caption="The torque rests on its limit."),
    ),
    "sensor_clipped": Symptom(
        "The sensor's reading has flat tops.",
        over_time("sensor", caption="The reading rests on the end of the sensor's range."),
    ),
    "spikes": Symptom(
        "A single sample lies far off.",
        over_time("sensor", caption="One sample at 7 s is 60 units off.", start=6.0, stop=8.0),
    ),
    "jumps": Symptom(
        "The position leaps from one sample to the next.",
        over_time("position", caption="At 5 s the position falls by 1 rad: an index was lost."),
    ),
    "repeated_samples": Symptom(
        "Stairs: a sample repeats the one before while the joint moves.",
        samples("sensor", caption="Every fifth reading is a copy.", start=1.0, stop=1.04),
    ),
    "time_jitter": Symptom(
        "The steps between time stamps scatter, though the samples were taken evenly.",
        steps(caption="Steps of 1 ms on average; the stamps scatter by a fifth of that."),
    ),
    "noisy_velocity": Symptom(
        "The velocity is a broad band instead of a line; the inertia comes out too small.",
        rate(caption="Noise of 0.03 rad/s on the velocity.", start=1.0, stop=1.5),
    ),
    "noisy_signal": Symptom("The coefficient of an extra signal comes out too small.", windows),
    "load_scale": Symptom(
        "With load friction, all values can be scaled by one factor and fit as well.", friction
    ),
    "model_too_rich": Symptom(
        "The static excess has a large error, or its shape ends on a bound: the map shows no peak near rest.",
        friction,
    ),
    "at_bound": Symptom(
        "A value equals the bound that it was given; the line misses the points.", friction
    ),
    "undetermined": Symptom(
        "The line fits, but the band is wide: other values would fit as well.", friction
    ),
    "undivided_offset": Symptom(
        "Offset and the two directions' Coulomb frictions have infinite intervals.", friction
    ),
    "ripple": Symptom(
        "The residual swings many times a turn.",
        over_time(
            "sensor",
            caption="A ripple of two periods a turn of the motor, here 202 a turn of the joint.",
            start=0.6,
            stop=1.4,
        ),
    ),
    "gravity": Symptom(
        "The residual depends on the angle of the joint.",
        residual_over(
            "position",
            caption="The residual is a sine of the angle: a weight that the model lacks.",
        ),
    ),
    "inertia_varies": Symptom(
        "The residual is largest where the joint accelerates far from its middle.",
        residual_over("position", caption="What an inertia that changes with the pose leaves."),
    ),
    "load_friction": Symptom(
        "Friction is larger where the joint carries more.",
        residual_over("load", caption="Residual in the direction of motion, over the load."),
    ),
    "slow_motion": Symptom(
        "The residual has peaks at each reversal.",
        residual_over(
            "velocity",
            caption="The model of Coulomb and viscous friction lacks the peak near rest.",
        ),
    ),
    "smooth_friction": Symptom(
        "Friction falls towards rest, where the line goes on to its constant part.",
        residual_over(
            "velocity",
            caption="The residual opposes the friction near rest: dry friction rises with the speed.",
        ),
    ),
    "presliding": Symptom(
        "Friction builds up over the first way after a reversal.",
        residual_over(
            "velocity",
            caption="Loops near rest: the friction depends on the way since the reversal.",
        ),
    ),
    "stribeck_exponent": Symptom(
        "The friction falls with the speed in another way than the model's line.",
        residual_over(
            "velocity", caption="What a decay with exponent 1 instead of 2 leaves near rest."
        ),
    ),
    "drift": Symptom("The residual grows or shrinks during the recording.", windows),
    "harmonic": Symptom(
        "The residual is a wave over the joint's angle.",
        residual_over("position", caption="A torque of three waves a turn."),
    ),
    "delay": Symptom(
        "The residual follows the acceleration: a signal is late against the others.",
        rate(caption="The velocity follows the position's rate 3 ms late.", **_RATE),
    ),
    "other_signal": Symptom("The residual follows something else, here the temperature.", windows),
    "disturbance": Symptom(
        "The residual is large for a moment: something touched the joint.", windows
    ),
    "asymmetry": Symptom("The two directions have different friction.", friction),
    "other_run": Symptom(
        "The recordings do not fit together: what is left of one is no noise, and that of the others opposes it.",
        windows,
    ),
    "offset": Symptom(
        "The friction of one direction is larger by as much as that of the other is smaller.",
        friction,
    ),
    "poor_fit": Symptom(
        "The line does not follow the points: the torque is hardly explained.", windows
    ),
    "structured_residual": Symptom(
        "The residual is small, but it is no noise: neighbours resemble each other.", windows
    ),
    "standing": Symptom(
        "The joint stands still for a large part of the recording.",
        over_time("velocity", caption="A standstill of eight seconds."),
    ),
    "hardly_moves": Symptom(
        "The position has a few steps of the encoder only.",
        samples(
            "position",
            caption="The whole motion is twenty steps of the encoder.",
            start=0.0,
            stop=0.7,
        ),
    ),
    "few_windows": Symptom("The recording is short, or its windows are long.", windows),
    "gaps": Symptom(
        "A stretch of time is missing.",
        samples("velocity", caption="From 5 s to 5.4 s nothing was recorded.", start=4.9, stop=5.5),
    ),
    "late_samples": Symptom(
        "A session reports cycles that came late, or commands without an answer.",
        over_time(
            "velocity", caption="Some of these samples came three cycles late; no window uses them."
        ),
    ),
    "motor_side": Symptom(
        "Friction and inertia are as small as a motor's: the square of the gear ratio is missing.",
        friction,
    ),
    "torque_side": Symptom(
        "Friction and inertia are smaller by the gear ratio than they should be, though the velocity is read right.",
        friction,
    ),
    "long_shift": Symptom(
        "A delay was stated that is longer than a filter or a bus makes one; the torque no longer fits the motion.",
        windows,
    ),
    "assumed_units": Symptom("A header has no unit."),
    "left_out": Symptom("A column of the file is not used."),
    "interpolated": Symptom("One channel has fewer samples than the others."),
    "unwrapped": Symptom(
        "The angle jumps by a turn, again and again.",
        over_time(
            "position", caption="The angle starts again at 0; the identification unwraps it."
        ),
    ),
    "unsigned_torque": Symptom(
        "The torque touches zero and turns back: its sign was not recorded.",
        samples(
            "torque",
            caption="It is never negative, in whichever direction the joint moves.",
            start=1.0,
            stop=4.0,
        ),
    ),
    "held_torque": Symptom(
        "The torque is a command: it stays for a sample what it was set to.",
        samples(
            "torque",
            caption="Between two samples the drive has the earlier one.",
            start=1.0,
            stop=1.3,
        ),
    ),
    "held_rows": Symptom(
        "Rows repeat the row before, again and again.",
        samples("velocity", caption="Every fifth row is a copy.", start=3.0, stop=3.05),
    ),
    "message_log": Symptom("A channel ends before the others, or messages come twice or late."),
}
