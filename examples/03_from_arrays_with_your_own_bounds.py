"""Start from NumPy arrays, fix what is known, bound the rest, and keep the result in a joint file."""

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

import jointid as jid

TRUE_INERTIA, TRUE_COULOMB, TRUE_VISCOUS = 0.8, 3.0, 5.0


def make_recording() -> jid.Recording:
    """A joint that is driven along a known motion; the torque is what its model asks for, plus noise."""
    time = np.arange(0.0, 10.0, 1e-3)
    rate = np.array([1.3, 2.9, 5.1])
    size = np.array([0.6, 0.3, 0.1])
    phase = np.outer(time, rate)
    position = np.sin(phase) @ size
    velocity = np.cos(phase) @ (size * rate)
    acceleration = -np.sin(phase) @ (size * rate**2)
    torque = (
        TRUE_INERTIA * acceleration + TRUE_COULOMB * np.sign(velocity) + TRUE_VISCOUS * velocity
    )
    noise = np.random.default_rng(1).normal(0.0, 0.3, time.size)
    return jid.Recording(time=time, position=position, torque=torque + noise, name="bench run")


def main() -> jid.Estimate:
    joint = jid.Joint(
        name="bench joint",
        inertia=TRUE_INERTIA,
        parameters={
            "coulomb": jid.Parameter(name="coulomb", min=0.0, max=20.0),
            "viscous": jid.Parameter(name="viscous", min=0.0, max=20.0),
        },
    )
    estimate = jid.identify(make_recording(), joint, parameters={"torque_offset": 0.0})
    print(estimate.report())
    with TemporaryDirectory() as folder:
        path = Path(folder) / "bench.toml"
        estimate.save(path)
        print(path.read_text())
        again = jid.Joint.load(path)
    print("friction at 0.5 rad/s:", estimate.friction(0.5).torque[0], "N·m")
    print("kept in the joint file:", again.parameters["viscous"].value, "N·m·s/rad")
    return estimate


if __name__ == "__main__":
    main()
