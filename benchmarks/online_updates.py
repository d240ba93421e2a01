"""Time of an update of the online identifier, in a process of its own; prints JSON.

    python benchmarks/online_updates.py

A minute and a half of samples at 1 kHz in blocks of 50, window 30 s. An update's time begins when the block that
completes it is passed, and ends with the wait for the update.
"""

import json
import statistics
import time

from long_recording import long_recording

import jointid as jid

WINDOW = 30.0  # [s]
BLOCK = 50  # samples
DURATION = 90.0  # [s] of samples; those after the first window count as steady


def main() -> None:
    """Run and print."""
    recording = long_recording(int(DURATION / 1e-3))
    signals = {
        name: getattr(recording, name)
        for name in ("time", "position", "velocity", "torque", "sensor")
    }
    times: list[float] = []
    updates: list[float] = []
    last = None
    with jid.OnlineIdentifier(jid.thesis_joint(), window=WINDOW) as identifier:
        for begin in range(0, recording.time.size, BLOCK):
            block = {name: values[begin : begin + BLOCK] for name, values in signals.items()}
            began = time.perf_counter()
            identifier.feed(**block)
            found = identifier.wait()
            spent = time.perf_counter() - began
            if found is not last and found is not None:
                times.append(float(block["time"][-1]))
                updates.append(spent)
                last = found
    steady = [u for t, u in zip(times, updates, strict=True) if t > WINDOW + 1.0]
    measured = {
        "first": updates[0],
        "filling": max(updates[1 : len(updates) - len(steady)]),
        "median": statistics.median(steady),
        "worst": max(steady),
        "updates": len(steady),
    }
    print(json.dumps(measured))


if __name__ == "__main__":
    main()
