"""Time until Ctrl-C ends `identify` on a long recording: a child identifies, a parent interrupts.

The signal is sent after shares of the whole call's time. Both processes read the same monotonic clock.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
from store import Record

SAMPLES = 3_600_000
SHARES = np.linspace(0.02, 0.98, 25)


def interrupted(samples: int) -> Record:
    """Return latencies [s] over the call, and the number of calls that ended before the signal."""
    call = [sys.executable, str(Path(__file__).resolve()), str(samples)]
    with subprocess.Popen(
        call, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1
    ) as child:
        assert child.stdin is not None
        assert child.stdout is not None
        whole = float(child.stdout.readline())
        latencies = []
        for share in SHARES:
            child.stdin.write("go\n")
            assert child.stdout.readline() == "begin\n"
            time.sleep(share * whole)
            sent = time.monotonic()
            os.kill(child.pid, signal.SIGINT)
            answer = child.stdout.readline().split()
            if answer[0] == "interrupted":
                latencies.append(float(answer[1]) - sent)
        child.stdin.close()
        child.wait()
    return {
        "kind": "interruption",
        "samples": samples,
        "seconds": whole,
        "worst": max(latencies),
        "median": float(np.median(latencies)),
        "interrupted": len(latencies),
        "signals": len(SHARES),
    }


def child(samples: int) -> None:
    """Identify on demand until the input ends; report whether a call was interrupted or complete."""
    from long_recording import long_recording

    import jointid as jid

    signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background job ignores it
    joint = jid.thesis_joint()
    recording = long_recording(samples)
    jid.identify(recording, joint)
    began = time.monotonic()
    jid.identify(recording, joint)
    print(time.monotonic() - began, flush=True)
    while sys.stdin.readline():
        what = "interrupted"
        try:
            print("begin", flush=True)
            jid.identify(recording, joint)
            what = "over"
            time.sleep(60.0)  # the signal is on its way
        except KeyboardInterrupt:
            print(what, time.monotonic(), flush=True)


if __name__ == "__main__":
    child(int(sys.argv[1]))
