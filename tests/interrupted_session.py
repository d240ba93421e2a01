"""A session in a program of its own, which waits in one of its phases until it is asked to continue.

Run with the name of the phase; prints "ready" there, waits for a line, and prints as JSON how it ended.
"""

import json
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "benchmarks"))
from fault_cases import EmulatedSession

from jointid.hardware.session.session import SessionStoppedError


def wait() -> None:
    """Let the parent do what it wants to."""
    print("ready", flush=True)  # noqa: T201
    sys.stdin.readline()


def main(phase: str) -> None:
    """Run one."""
    bench = EmulatedSession()
    waited = False

    def watch(now: str, time: float, *_: object) -> None:
        nonlocal waited
        last = phase == "end" and time > bench.trajectory.duration - 0.003
        if not waited and (now == phase or last) and (now != "run" or time > 0.1):
            waited = True
            wait()

    bench.observer = watch
    if phase == "check":
        bench.bus.at(0.005, wait)
    wording: dict[str, object] = {"stop": None}
    try:
        bench.session().run()
    except SessionStoppedError as error:
        wording = {"stop": error.stop.to_dict(), "rows": len(error.recording or ())}
        ended = {} if error.recording is None else error.recording.metadata
        wording["braked"] = ended.get("braked")
    wording["last"] = [data.hex() for _, data in bench.bus.assignments()[-2:]]
    wording["after"] = bench.bus.now()
    wording["switchings"] = bench.elmo.switchings
    bench.bus.shutdown()
    print(json.dumps(wording), flush=True)  # noqa: T201


if __name__ == "__main__":
    main(sys.argv[1])
