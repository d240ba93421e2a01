"""The symptom of each finding for a person, and the picture that shows it best."""

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
    """The symptom, and a picture of it; without a picture, the case's file is shown."""

    seen: str
    picture: Drawing | None = None


_RATE = {"start": 1.0, "stop": 1.12}
# By code. A cause without its own text is described by its residual.
SYMPTOMS: Mapping[str, Symptom] = {
    family.name: Symptom(f"The residual is not noise: {family.meaning}.", windows)
    for family in FAMILIES
} | {
    "stopped": Symptom(
        "The search ended before it converged; another seed gives other values.", windows
    ),
    "cross_check": Symptom(
        "A plain least squares on the recorded signals gives other values than the report.",
        friction,
    ),
    "no_friction": Symptom(
        "The joint seems to move without friction: the torque was measured at the link.", friction
    ),
    "reversed_sign": Symptom(
        "Friction seems to push the joint: it falls as the speed grows. Values end on their bounds.",
        friction,
    ),
    "implausible_units": Symptom(
        "The joint seems to turn by tens of radians, or faster than any joint.",
        over_time(
            "position", "velocity", caption="Degrees, read as radians: ±60 rad at 190 rad/s."
        ),
    ),
    "velocity_mismatch": Symptom(
        "The velocity column is smaller or larger than the slope of the position.",
        rate(
            caption="The recorded velocity is 0.8 times the position's derivative.",
            start=0.0,
            stop=3.0,
        ),
    ),
    "signal_lag": Symptom(
        "One signal lags the others, and was not shifted.",
        rate(caption="The velocity lags the position's derivative by 3 ms.", **_RATE),
    ),
    "delay_removed": Symptom(
        "One signal lagged the others, and was shifted before the identification.",
        rate(
            caption="The velocity lags the position's derivative by 3 ms, as after a filter.",
            **_RATE,
        ),
    ),
    "wrong_scale": Symptom(
        "All values are too large or too small by one factor, and a known inertia does not fit.",
        windows,
    ),
    "constant_signal": Symptom(
        "A signal keeps one value while the joint moves.",
        over_time(
            "sensor",
            "velocity",
            caption="From 4 s to 6 s the sensor's reading is frozen: a broken cable.",
        ),
    ),
    "torque_saturated": Symptom(
        "The torque has flat tops: the controller requested more torque than the log shows.",
        over_time("torque", caption="The torque is at its limit."),
    ),
    "sensor_clipped": Symptom(
        "The sensor's reading has flat tops.",
        over_time("sensor", caption="The reading is at the end of the sensor's range."),
    ),
    "spikes": Symptom(
        "A single sample lies far from its neighbours.",
        over_time("sensor", caption="One sample at 7 s is 60 units off.", start=6.0, stop=8.0),
    ),
    "jumps": Symptom(
        "The position leaps from one sample to the next.",
        over_time(
            "position", caption="At 5 s the position falls by 1 rad: the encoder lost its index."
        ),
    ),
    "repeated_samples": Symptom(
        "The signal has stairs: samples repeat the previous sample while the joint moves.",
        samples("sensor", caption="Every fifth reading is a copy.", start=1.0, stop=1.04),
    ),
    "time_jitter": Symptom(
        "The steps between time stamps scatter, although the samples were evenly spaced.",
        steps(caption="Steps of 1 ms on average; the time stamps scatter by a fifth of 1 ms."),
    ),
    "noisy_velocity": Symptom(
        "The velocity is a broad band instead of a line. The identified inertia is too small.",
        rate(caption="Noise of 0.03 rad/s on the velocity.", start=1.0, stop=1.5),
    ),
    "noisy_signal": Symptom("The identified coefficient of an extra signal is too small.", windows),
    "load_scale": Symptom(
        "With load friction, all values multiplied by one factor fit as well.", friction
    ),
    "model_too_rich": Symptom(
        "Static friction has a large error, or its shape ends on a bound. The map shows no peak near rest.",
        friction,
    ),
    "at_bound": Symptom("A value equals its bound; the line does not fit the points.", friction),
    "undetermined": Symptom(
        "The line fits, but the band is wide: other values would fit as well.", friction
    ),
    "undivided_offset": Symptom(
        "The offset and the Coulomb friction of each direction have infinite intervals.", friction
    ),
    "ripple": Symptom(
        "The residual oscillates many times per revolution.",
        over_time(
            "sensor",
            caption="A ripple of two periods per motor revolution: here 202 per joint revolution.",
            start=0.6,
            stop=1.4,
        ),
    ),
    "gravity": Symptom(
        "The residual depends on the angle of the joint.",
        residual_over(
            "position",
            caption="The residual is a sine of the angle: gravity that the model lacks.",
        ),
    ),
    "inertia_varies": Symptom(
        "The residual is largest where the joint accelerates far from its middle position.",
        residual_over(
            "position", caption="The residual of an inertia that changes with the angle."
        ),
    ),
    "load_friction": Symptom(
        "Friction is larger where the load is larger.",
        residual_over("load", caption="The residual in the direction of motion, over the load."),
    ),
    "slow_motion": Symptom(
        "The residual has peaks at each reversal.",
        residual_over(
            "velocity",
            caption="A model of Coulomb and viscous friction lacks the peak near rest.",
        ),
    ),
    "smooth_friction": Symptom(
        "Near rest friction falls towards zero; the model's line stays constant there.",
        residual_over(
            "velocity",
            caption="Near rest the residual opposes the friction: dry friction rises smoothly with speed.",
        ),
    ),
    "presliding": Symptom(
        "Friction builds up during the first motion after a reversal.",
        residual_over(
            "velocity",
            caption="Loops near rest: friction depends on the distance since the reversal.",
        ),
    ),
    "stribeck_exponent": Symptom(
        "Friction falls with speed along another curve than the model's.",
        residual_over(
            "velocity", caption="The residual near rest of a decay with exponent 1 instead of 2."
        ),
    ),
    "drift": Symptom("The residual grows or shrinks during the recording.", windows),
    "harmonic": Symptom(
        "The residual is a wave over the joint angle.",
        residual_over("position", caption="A torque of three periods per revolution."),
    ),
    "delay": Symptom(
        "The residual follows the acceleration: a signal lags the others.",
        rate(caption="The velocity lags the position's derivative by 3 ms.", **_RATE),
    ),
    "other_signal": Symptom("The residual follows another signal, here the temperature.", windows),
    "disturbance": Symptom(
        "The residual is large for a moment: something touched the joint.", windows
    ),
    "asymmetry": Symptom("The two directions have different friction.", friction),
    "other_run": Symptom(
        "The recordings do not fit together: their residuals are not noise and have opposite signs.",
        windows,
    ),
    "offset": Symptom(
        "Friction is larger in one direction and, by the same amount, smaller in the other.",
        friction,
    ),
    "poor_fit": Symptom(
        "The line does not follow the points: the model explains little of the torque.", windows
    ),
    "structured_residual": Symptom(
        "The residual is small, but not noise: neighbouring windows are alike.", windows
    ),
    "standing": Symptom(
        "The joint stands still for a large part of the recording.",
        over_time("velocity", caption="A standstill of eight seconds."),
    ),
    "hardly_moves": Symptom(
        "The position has only a few encoder counts.",
        samples(
            "position",
            caption="The whole motion is twenty encoder counts.",
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
        "A session reports late cycles, or commands without an answer.",
        over_time(
            "velocity", caption="Some of these samples came three cycles late; no window uses them."
        ),
    ),
    "motor_side": Symptom(
        "Friction and inertia are as small as a motor's: the square of the gear ratio is missing.",
        friction,
    ),
    "torque_side": Symptom(
        "Friction and inertia are too small by the gear ratio, although the velocity is right.",
        friction,
    ),
    "long_shift": Symptom(
        "The stated delay is longer than any filter's or bus's. The torque no longer fits the motion.",
        windows,
    ),
    "assumed_units": Symptom("A header has no unit."),
    "left_out": Symptom("A column of the file is not used."),
    "interpolated": Symptom("One channel has fewer samples than the others."),
    "unwrapped": Symptom(
        "The angle jumps by one revolution, again and again.",
        over_time(
            "position", caption="The angle starts again at 0; the identification unwraps it."
        ),
    ),
    "unsigned_torque": Symptom(
        "The torque touches zero and turns back: its sign was not recorded.",
        samples(
            "torque",
            caption="The torque is never negative, in both directions of motion.",
            start=1.0,
            stop=4.0,
        ),
    ),
    "held_torque": Symptom(
        "The torque is a command: it keeps its value for one sample period.",
        samples(
            "torque",
            caption="Between two samples the drive applies the earlier value.",
            start=1.0,
            stop=1.3,
        ),
    ),
    "held_rows": Symptom(
        "Rows repeat the previous row, again and again.",
        samples("velocity", caption="Every fifth row is a copy.", start=3.0, stop=3.05),
    ),
    "message_log": Symptom("A channel ends before the others, or messages are repeated or late."),
}
