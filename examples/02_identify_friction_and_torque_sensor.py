"""Identify Stribeck friction and the gain and offset of a joint's torque sensor, all six from one recording.

The recording is simulated, so the truth is known and printed beside the estimate.
"""

from pathlib import Path

import jointid as jid

data = Path(__file__).parent / "data"
TRUTH = {
    "coulomb": 25.0,
    "static": 20.0,
    "stribeck": 100.0,
    "viscous": 20.0,
    "sensor_gain": 2.4,
    "sensor_offset": 15.0,
}


def main() -> jid.Estimate:
    recording = jid.load(data / "well_excited.csv.gz")
    estimate = jid.identify(recording, jid.thesis_joint())
    print(estimate.report())
    print()
    for name, truth in TRUTH.items():
        found = estimate.parameters[name]
        print(
            f"{name:14s} true {truth:7.2f}, found {found.value:9.4f} ± {found.stderr:.4f} {found.unit}"
        )
    return estimate


if __name__ == "__main__":
    main()
