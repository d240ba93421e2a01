"""Joints that break one assumption each, simulated side by side in NumPy; other code than the core's.

Each run is a random joint, a random motion and one broken assumption. Friction is set-valued at rest: a step that would
end on the other side of zero speed ends at rest.
"""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

import jointid as jid

Array = NDArray[np.float64]

PERIOD = 1e-3  # [s]
FINER = 5  # integration steps a sample
GEAR = 101.0

SENSOR = (
    *("clean", "load_friction", "drift_viscous", "drift_coulomb", "presliding"),
    *("exponent", "harmonic", "ripple", "delay", "disturbance", "other", "torque_constant"),
)
SENSORLESS = (
    *("clean", "gravity", "inertia_varies", "load_friction", "drift_viscous", "drift_coulomb"),
    *("presliding", "exponent", "harmonic", "delay", "disturbance", "other", "stribeck"),
)
NAMES = {
    "gravity": {"gravity"},
    "inertia_varies": {"inertia_varies"},
    "load_friction": {"load_friction"},
    "drift_viscous": {"drift"},
    "drift_coulomb": {"drift"},
    "presliding": {"presliding", "stribeck_exponent", "slow_motion"},
    "exponent": {"presliding", "stribeck_exponent", "slow_motion"},
    "stribeck": {"presliding", "stribeck_exponent", "slow_motion"},
    "harmonic": {"harmonic"},
    "ripple": {"ripple"},
    "delay": {"delay"},
    "disturbance": {"disturbance"},
    "other": {"other_signal"},
}


@dataclass
class Run:
    """A recording, the joint as its owner knows it, the model to identify with, and the truth."""

    plant: str
    recording: jid.Recording
    joint: jid.Joint
    model: str
    truth: dict[str, float]
    signals: dict[str, Array] = field(default_factory=dict)


def simulate(plants: list[str], *, sensor: bool, seed: int, duration: float = 12.0) -> list[Run]:
    """One run for each name in `plants`."""
    rng = np.random.default_rng(seed)
    runs = len(plants)
    names = np.array(plants)

    def where(name: str, value: object, other: float = 0.0) -> Array:
        return np.where(names == name, value, other)

    uniform = rng.uniform
    inertia = uniform(1.5, 4.0, runs)
    link_inertia = uniform(0.15, 0.5, runs)
    gravity = uniform(5.0, 12.0, runs)  # of the link
    coulomb, static = uniform(15.0, 35.0, runs), uniform(8.0, 25.0, runs)
    stribeck, viscous = uniform(50.0, 200.0, runs), uniform(10.0, 35.0, runs)
    gain, offset = uniform(1.5, 3.0, runs), uniform(-15.0, 15.0, runs)
    noise = 0.2
    sized = uniform(0.3, 2.0, runs)
    loaded = where("load_friction", uniform(0.03, 0.2, runs))
    of_viscous = where("drift_viscous", -0.3)
    of_coulomb = where("drift_coulomb", uniform(0.1, 0.3, runs) * rng.choice([-1.0, 1.0], runs))
    bristles = names == "presliding"
    exponential = names == "exponent"
    third = where("harmonic", sized)
    varying = where("inertia_varies", uniform(0.15, 0.4, runs) * inertia)
    varying_at = uniform(0.0, 6.28, runs)
    bump, bump_at = where("disturbance", uniform(5.0, 15.0, runs)), uniform(0.2, 0.8, runs)
    other, other_rate = where("other", uniform(2.0, 6.0, runs)), uniform(2.0, 7.0, runs)
    rippled = where("ripple", uniform(1.0, 3.0, runs))
    if sensor:
        static = static + 0.0
    else:
        # Horizontal, unless gravity is what the model lacks, or a load that the model has.
        upright = (names == "gravity") | (names == "load_friction")
        inertia, link_inertia = inertia + link_inertia, np.zeros(runs)
        gravity = np.where(upright, uniform(5.0, 40.0, runs), 0.0)
        static = np.where(np.isin(names, ["presliding", "exponent", "stribeck"]), static, 0.0)
    bent = 1e5 * np.ones(runs)
    damped = 0.3 * np.sqrt(bent * (inertia + link_inertia))

    amplitude = np.radians(uniform(40.0, 75.0, runs))
    rate = 2.0 * np.pi / uniform(2.0, 4.0, runs)
    kind = rng.integers(0, 2, runs)
    phases, shares = uniform(0.0, 6.28, (4, runs)), uniform(0.3, 1.0, (4, runs))
    shares /= shares.sum(axis=0)

    def reference(t: float) -> tuple[Array, Array, Array]:
        a, s = rate * t, amplitude / 1.3
        one = (
            s * (np.sin(a) - 0.5 * np.sin(2 * a)),
            s * rate * (np.cos(a) - np.cos(2 * a)),
            s * rate**2 * (2 * np.sin(2 * a) - np.sin(a)),
        )
        many = [np.zeros(runs), np.zeros(runs), np.zeros(runs)]
        fade = min(t / 1.0, 1.0)
        for k in range(4):
            w = rate * (0.5, 1.0, 1.7, 2.9)[k]
            share = amplitude * shares[k] * fade
            many[0] += share * np.sin(w * t + phases[k])
            many[1] += share * w * np.cos(w * t + phases[k])
            many[2] -= share * w**2 * np.sin(w * t + phases[k])
        pair = zip(one, many, strict=True)
        first, second, third_ = (np.where(kind == 0, x, y) for x, y in pair)
        return first, second, third_

    samples = round(duration / PERIOD)
    step = PERIOD / FINER
    mass = inertia + link_inertia
    q, v, z, acceleration = (np.zeros(runs) for _ in range(4))
    q = reference(0.0)[0]
    log = np.empty((5, samples, runs))
    guess = uniform(0.6, 0.9, runs)
    for k in range(samples):
        t = k * PERIOD
        progress = t / duration
        link = link_inertia * acceleration + gravity * np.sin(q)
        load = link
        sensed = link + rng.normal(0.0, noise, runs) + rippled * np.sin(2.0 * GEAR * q)
        wanted, wanted_speed, wanted_acceleration = reference(t)
        error, error_rate = q - wanted, v - wanted_speed
        pulled = wanted_acceleration - 40.0 * (2.0 * error_rate + 40.0 * error)
        smooth = np.tanh(wanted_speed / 0.01)
        torque = guess * (inertia * pulled + viscous * wanted_speed + coulomb * smooth) + link
        torque = np.clip(torque, -200.0, 200.0)
        axis = np.cos(other_rate * t + phases[0])
        measured = torque + (0.0 if sensor else rng.normal(0.0, noise, runs))
        log[:, k] = q, v, measured, (sensed - offset) / gain, axis
        fade = np.exp(-(((progress - bump_at) * duration / 0.15) ** 2))
        outside = bump * fade + other * axis
        fc, b = coulomb * (1.0 + of_coulomb * progress), viscous * (1.0 + of_viscous * progress)
        for _ in range(FINER):
            middle = q + 0.5 * step * v
            speed = v + 0.5 * step * acceleration
            decay = np.where(
                exponential,
                np.exp(-np.abs(speed) * np.sqrt(stribeck)),
                np.exp(-stribeck * speed**2),
            )
            slope = -varying * np.sin(middle + varying_at)
            whole = mass + varying * np.cos(middle + varying_at)
            drive = torque - gravity * np.sin(middle) - third * np.sin(3.0 * middle) + outside
            drive -= 0.5 * slope * v**2
            dry = fc + static * decay + loaded * np.abs(load)
            free = (whole - 0.5 * step * b) * v + step * drive
            held = np.where(v == 0.0, fc + static + loaded * np.abs(load), dry)
            after = np.sign(free) * np.maximum(np.abs(free) - step * held, 0.0)
            after /= whole + 0.5 * step * b
            after = np.where(v * after < 0.0, 0.0, after)
            if bristles.any():
                # LuGre, the bristles' state exactly over a step at the old speed, the rest implicitly.
                level = fc + static * np.exp(-stribeck * v**2)
                still = np.abs(v) < 1e-12
                ratio = bent * np.abs(v) / level
                shrink = np.exp(-ratio * step)
                ahead = np.where(
                    still, z + v * step, z * shrink + np.sign(v) * level / bent * (1.0 - shrink)
                )
                bent_rate = (ahead - z) / step
                force = bent * 0.5 * (z + ahead) + damped * bent_rate
                bristled = (whole * v + step * (drive - force - 0.5 * b * v)) / (
                    whole + 0.5 * step * b
                )
                after = np.where(bristles, bristled, after)
                z = np.where(bristles, ahead, z)
            acceleration = (after - v) / step
            q, v = q + 0.5 * step * (v + after), after
    time = np.arange(samples) * PERIOD
    results = []
    for i in range(runs):
        torque = log[2, :, i].copy()
        if names[i] == "delay":
            torque[2:] = torque[:-2].copy()
        if names[i] == "torque_constant":
            torque *= 1.05
        truth = {"coulomb": coulomb[i], "viscous": viscous[i], "inertia": inertia[i]}
        if sensor:
            truth |= {"sensor_gain": gain[i], "sensor_offset": offset[i]}
        model = "coulomb_viscous"
        if sensor or names[i] in ("presliding", "exponent"):
            truth |= {"static": static[i], "stribeck": stribeck[i]}
            model = "stribeck"
        if not sensor and names[i] == "load_friction":
            truth["gravity_sin"] = gravity[i]
            model += ":gravity=free"
        recording = jid.Recording(
            time=time,
            position=log[0, :, i],
            velocity=log[1, :, i],
            torque=torque,
            sensor=log[3, :, i] if sensor else None,
            torque_hold="zoh",
        )
        values = {} if not sensor else {"inertia": float(inertia[i])}
        joint = jid.Joint(gear_ratio=GEAR, sensor=sensor, model=jid.Model.parse(model), **values)
        carried = {"axis 2 velocity": log[4, :, i]} if names[i] == "other" else {}
        results.append(Run(plants[i], recording, joint, model, truth, carried))
    return results
