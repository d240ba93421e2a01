"""Identify the friction of a real industrial robot's joint from its log.

Joint 1 of a KUKA KR300 turns about the vertical, so gravity does not act on it. The log holds the torque on the motor
side; the joint file says the gear ratio.
"""

from pathlib import Path

import jointid as jid

data = Path(__file__).parent / "data"


def main() -> jid.Estimate:
    recording = jid.load(data / "kr300_joint1.csv.gz")
    joint = jid.Joint.load(data / "kr300_joint1.toml")
    estimate = jid.identify(recording, joint)
    print(estimate.report())
    return estimate


if __name__ == "__main__":
    main()
