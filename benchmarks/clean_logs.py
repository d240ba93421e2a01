"""Logs without a fault, for `faulty_logs.py --clean`: false warnings, coverage, and cross-checks that disagree."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from foreign_joints import Draw, Table
from log_plans import SI, Log, Plan, log_of

MODELS = ("coulomb", "coulomb_viscous", "stribeck", "asymmetric")
CLEAN_RATES = (10, 4, 1)


@dataclass(frozen=True, kw_only=True)
class Clean:
    """A plan of a log without a fault, by its category in the table."""

    model: str
    sensor: bool
    every: int
    plan: Plan = field(repr=False)

    @property
    def name(self) -> str:
        """Name of the row in the table."""
        return f"{self.model}, {'sensor, ' if self.sensor else ''}{1000 // self.every} Hz"


def clean(draw: Draw, number: int) -> Clean:
    """Return one of the 24 kinds of clean logs: four models, with and without a sensor, three rates."""
    model, sensor = MODELS[number % 4], bool(number // 4 % 2)
    every = CLEAN_RATES[number // 8 % 3]
    motions = [draw.motion(draw.scale(0.5, 1.5))]
    drawn = draw.joint(
        *(motions, every),
        gravity=sensor or None,
        stribeck=model == "stribeck",
        held=draw.chance(0.5),
    )
    plant = dict(drawn.plant)
    lean = 0.0
    if model == "coulomb":
        plant["viscous"] = 0.0
    if model == "asymmetric":
        lean = draw.between(0.05, 0.3) * draw.one((-1.0, 1.0))
        plant["asymmetry"], plant["viscous_asymmetry"] = lean, draw.between(-0.3, 0.3)
        plant["constant"] = 0.0  # nothing separates it from the tilt
    if sensor:
        plant["link_inertia"] = plant["inertia"] * draw.between(0.1, 0.5)
        plant["constant"] = 0.0
    drawn = replace(drawn, plant=plant)
    gain, offset = draw.between(1.0, 4.0), draw.between(-0.5, 0.5) * plant["coulomb"]

    def write(runs: list[Table]) -> Log:
        table = draw.sampled(runs[0], drawn)
        text = {"stribeck": "stribeck", "asymmetric": "coulomb_viscous:asymmetric"}
        words = text.get(model, "coulomb_viscous")
        truth = dict(drawn.truth)
        if model == "asymmetric":
            for name in ("coulomb", "viscous"):
                share = plant["asymmetry"] if name == "coulomb" else plant["viscous_asymmetry"]
                truth[f"{name}_positive"] = truth[name] * (1.0 + share)
                truth[f"{name}_negative"] = truth[name] * (1.0 - share)
        options = ["--model", words if sensor or not plant["gravity"] else f"{words}:gravity=free"]
        form = SI
        if sensor:
            options += ["--inertia", f"{plant['inertia']:.8g}"]
            table["sensor"] = (table["link"] - offset) / gain
            table["torque"] = runs[0]["torque"][:: drawn.every]
            form = replace(SI, headers={**SI.headers, "sensor": "sensor"})
            for name in ("inertia", "gravity_cos", "gravity_sin", "torque_offset"):
                del truth[name]
            truth |= {"sensor_gain": gain, "sensor_offset": offset}
        return log_of(draw, [table], drawn, form=form, options=tuple(options), truth=truth)

    return Clean(model=model, sensor=sensor, every=every, plan=Plan(drawn=drawn, write=write))
