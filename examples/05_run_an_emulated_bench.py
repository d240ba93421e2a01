"""Run a joint through its drive over CAN, identify it, run it again better; the drive is emulated."""

from pathlib import Path

import jointid as jid
from jointid.commissioning import bench_drive, commission
from jointid.hardware import Bench, Session

BENCH = Path(__file__).parent / "hardware" / "joint.toml"


def main() -> jid.Estimate:
    bench = Bench.load(BENCH)
    # With emulate=False the same lines move a real joint: read docs/hardware.md first.
    with bench_drive(bench, emulate=True) as drive:
        session = Session(
            drive, bench.controller, bench.trajectory, bench.limits, options=bench.options
        )
        session.run(dry_run=True)  # motor off; raises when something speaks against a start
        print("nothing speaks against a start")

    ring = commission(bench, cycles=1, emulate=True, callback=print)
    print(ring.report())
    return ring.estimates[-1]


if __name__ == "__main__":
    main()
