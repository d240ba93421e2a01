"""The ring, without a bench: run a joint on wrong estimates, identify it, run it again on what was found."""

import math
from dataclasses import replace

import jointid as jid

TRUE_PARAMETERS = {
    "coulomb": 25.0,
    "static": 20.0,
    "stribeck": 100.0,
    "viscous": 20.0,
    "sensor_gain": 2.4,
    "sensor_offset": 15.0,
}
FIRST_GUESS = {
    "coulomb": 10.0,
    "static": 20.0,
    "stribeck": 200.0,
    "viscous": 10.0,
    "sensor_gain": 1.0,
    "sensor_offset": 0.0,
}


def make_joint() -> jid.Joint:
    """The thesis's joint; its link hangs down where the position is zero."""
    joint = jid.thesis_joint()
    assert joint.link is not None
    return joint.replace(link=replace(joint.link, angle=-math.pi / 2.0))


def main() -> jid.Estimate:
    unknown = make_joint()  # what a user knows: drive, link, bounds
    true = unknown.with_parameters(TRUE_PARAMETERS)  # what only the simulator knows
    trajectory = jid.Trajectory.thesis(math.radians(60.0), cycle=3.0, duration=12.0)
    sensors = jid.Sensors(torque_noise=0.5)

    first_guess = unknown.with_parameters(FIRST_GUESS)
    before = jid.AdaptiveRobust(**jid.control_estimates(first_guess))
    recording = jid.simulate(true, before, trajectory, sensors=sensors)
    estimate = jid.identify(recording, unknown)
    print(estimate.report())

    after = before.replace(**jid.control_estimates(estimate.joint))
    ideal = before.replace(**jid.control_estimates(true))
    runs = jid.simulate_batch(true, [before, after, ideal], trajectory, sensors=sensors)
    print("\nRMS tracking error after the first sixth of the run:")
    for name, error in zip(("first guess", "identified", "true"), runs.error, strict=True):
        print(f"  {name:12} {error:.2e} rad")
    print(f"parameters known only to the simulator: {dict(recording.truth)}")
    return estimate


if __name__ == "__main__":
    main()
