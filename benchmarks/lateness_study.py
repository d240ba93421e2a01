"""Effects of late frames, lost frames, a drifting clock and a late host on the estimates.

    python benchmarks/lateness_study.py --runs 10

Each run is a session of 12 s on the emulated drive. In 0.3 % of the cycles a frame of any kind is 1.5 ms late, and in
0.1 % a frame is lost. The estimate is compared with the estimate of the same run without disturbances.
"""

from __future__ import annotations

import argparse
import math
import sys
from typing import Any

import numpy as np
from fault_cases import joint

import jointid as jid
from jointid.hardware.elmo.drive import ElmoDrive
from jointid.hardware.elmo.emulated_converter import EmulatedConverter
from jointid.hardware.elmo.emulated_drive import EmulatedElmo
from jointid.hardware.emulated.bus import EmulatedBus
from jointid.hardware.emulated.faults import BusFault
from jointid.hardware.session.limits import SessionLimits
from jointid.hardware.session.session import Session, SessionOptions, SessionStoppedError
from jointid.simulation.stepped import stepped_joint

PERIOD, DURATION, BEGIN = (
    2e-3,
    12.0,
    1.0,
)  # [s]; frames are disturbed from BEGIN on, in the time of the bus
LATE, LOST, DELAY = 0.003, 0.001, 1.5e-3
FRAMES = (0x4FF, 0x1C0, 0x080, 0x37F, 0x701, 0x2FF)
CLOSE = (
    0.01  # largest relative difference of a close value; two standard errors also count as close
)
QUIET = {
    "clock drifts by 100 ppm": {"clock_drift": 1e-4},
    "host wakes up to 0.3 ms late": {"jitter": 3e-4},
    "both": {"clock_drift": 1e-4, "jitter": 3e-4},
}


def faults(seed: int) -> tuple[BusFault, ...]:
    """Return faults of single frames: each is late or lost, of one kind, in one cycle."""
    drawn = np.random.default_rng(seed)
    made = []
    for cycle in range(round((DURATION + 1.0) / PERIOD)):
        chance = drawn.random()
        if chance >= LATE + LOST:
            continue
        begin = BEGIN + cycle * PERIOD
        made.append(
            BusFault(
                kind="delay" if chance < LATE else "drop",
                identifier=int(drawn.choice(FRAMES)),
                start=begin,
                stop=begin + PERIOD,
                delay=DELAY,
            )
        )
    return tuple(made)


def session(number: int, **wire: Any) -> jid.Recording:
    """Return the recording of one run on an emulated bus."""
    true = joint()
    moved = stepped_joint(true, sensors=jid.Sensors(torque_noise=0.5), period=PERIOD, seed=number)
    elmo = EmulatedElmo(moved)
    law = jid.AdaptiveRobust(**jid.control_estimates(true)).replace(friction_velocity="reference")
    motion = jid.Trajectory.thesis(math.radians(60.0), cycle=6.0, duration=DURATION)
    with EmulatedBus(elmo, EmulatedConverter(elmo), **wire) as bus:
        run = Session(
            *(ElmoDrive(bus, true), law, motion, SessionLimits.of(true)),
            options=SessionOptions(period=PERIOD, settle=0.05),
        )
        recording = run.run()
    assert recording is not None
    return recording


def estimate(recording: jid.Recording) -> jid.Estimate:
    """Identify with the separable search, which takes 0.1 s."""
    return jid.identify(recording, joint(), search="separable")


def compared(expected: jid.Estimate, found: jid.Estimate) -> tuple[float, str, bool]:
    """Return the largest relative difference, its parameter's name, and whether all values are close."""
    worst, name, close = 0.0, "", True
    for each, parameter in expected.parameters.items():
        if parameter.stderr is None:
            continue
        away = abs(found.parameters[each].value - parameter.value)
        share = away / abs(parameter.value)
        close = close and away <= max(CLOSE * abs(parameter.value), 2.0 * parameter.stderr)
        if share > worst:
            worst, name = share, each
    return worst, name, close


def main() -> int:
    """Print the tables; return 1 if a run was stopped or an estimate is not close."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=10)
    runs = parser.parse_args().runs
    done = True
    say = sys.stdout.write
    say("run  late or lost  left out  largest difference\n")
    for seed in range(runs):
        expected = estimate(session(seed))
        try:
            recording = session(seed, faults=faults(seed))
        except SessionStoppedError as error:
            say(f"{seed:3d}  {error}\n")
            done = False
            continue
        worst, name, close = compared(expected, estimate(recording))
        lost = recording.metadata["timing"]["lost"]
        left_out = len(recording.doubtful)
        say(
            f"{seed:3d}  {lost:12d}  {left_out:8d}  {100 * worst:.2f} % ({name}){'' if close else ' NOT CLOSE'}\n"
        )
        done = done and close
        for text, wire in QUIET.items():
            worst, name, _ = compared(expected, estimate(session(seed, seed=seed, **wire)))
            say(
                f"     {text}: {100 * worst:.2f} % ({name}){'' if worst <= CLOSE else ' NOT CLOSE'}\n"
            )
            done = done and worst <= CLOSE
    return 0 if done else 1


if __name__ == "__main__":
    sys.exit(main())
