"""The long run: so many cases for each reader, in batches, each in a process of its own, the quick readers first.

Every batch is a line of the log: reader, first case, cases, failures, seconds of the processor. A run that was ended
goes on where its log ends, and what was done counts. What kills a batch (a crash, a sanitizer) is known with its case.

    python -m fuzz LOG [--cases 1000000] [--first 0] [--minutes 75] [--processes 1] [--only READER]
"""

import argparse
import json
import mmap
import resource
import struct
import subprocess
import sys
import threading
import time
import warnings
from pathlib import Path
from tempfile import NamedTemporaryFile
from typing import Any

_FIRST, _BATCH = 5_000, 50_000  # a short one of each reader says how long it takes
_LONGEST = 4 * 3600  # [s] of a batch
_SHOWN = 20  # failures of a batch
_SAID = 4000  # characters of what a process said that was ended


def _batch(name: str, start: int, count: int, progress: str) -> None:
    """In a process of its own: try, and say what is wrong."""
    from fuzz.trying import faults

    warnings.simplefilter("ignore")
    warnings.simplefilter("error", RuntimeWarning)  # of NumPy: what is said is said of the file
    with Path(progress).open("r+b") as file, mmap.mmap(file.fileno(), 8) as shared:
        wrong = faults(name, start, count, lambda case: struct.pack_into("q", shared, 0, case))
    spent = resource.getrusage(resource.RUSAGE_SELF)
    found = {"cases": count, "failures": len(wrong), "wrong": wrong[:_SHOWN]}
    sys.stdout.write(json.dumps(found | {"seconds": spent.ru_utime + spent.ru_stime}) + "\n")


def _tried(name: str, start: int, count: int) -> dict[str, Any]:
    with NamedTemporaryFile() as progress:
        progress.write(struct.pack("q", start))
        progress.flush()
        command = [sys.executable, "-m", "fuzz", "--batch", name, str(start), str(count)]
        done = subprocess.run(
            [*command, progress.name],
            cwd=Path(__file__).resolve().parents[1],
            capture_output=True,
            text=True,
            timeout=_LONGEST,
            check=False,
        )
        (case,) = struct.unpack("q", Path(progress.name).read_bytes())
    if done.returncode == 0:
        found: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
        return found
    said = done.stderr  # a sanitizer names the place first, Python last
    if len(said) > _SAID:
        said = f"{said[: _SAID // 2]} ... {said[-_SAID // 2 :]}"
    said = f"case {case}: ends the process ({done.returncode}): {said}"
    return {"cases": case - start + 1, "failures": 1, "wrong": [said], "seconds": 0.0}


class _Log:
    """What was done, and what is to be done next; several threads ask.

    Parameters
    ----------
    path : Path
    names : sequence of str
        Readers.
    cases, first : int
        Of each reader: how many, and the number of the first one.
    """

    def __init__(self, path: Path, names: list[str], cases: int, first: int) -> None:
        self._path, self._names, self._cases, self._first = path, names, cases, first
        text = path.read_text(encoding="utf-8") if path.exists() else ""
        every = [json.loads(line) for line in text.splitlines()]
        self.lines = [line for line in every if line["first"] == first and line["reader"] in names]
        self._given = {name: self.spent(name)[0] for name in names}
        self._lock = threading.Lock()

    def spent(self, name: str) -> tuple[int, int, float]:
        """Cases and failures of a reader, and seconds a case."""
        own = [line for line in self.lines if line["reader"] == name]
        cases = sum(line["cases"] for line in own)
        seconds = sum(line["seconds"] for line in own)
        return cases, sum(line["failures"] for line in own), seconds / max(cases, 1)

    def next(self) -> tuple[str, int, int] | None:
        """Return reader, first case and number of cases: a few of each, then those who are done soonest."""
        with self._lock:
            left = [
                (given >= _FIRST, (self._cases - given) * self.spent(name)[2], name)
                for name, given in self._given.items()
                if given < self._cases
            ]
            if not left:
                return None
            known, _, name = min(left)
            given = self._given[name]
            count = min(_BATCH if known else _FIRST, self._cases - given)
            self._given[name] += count
            return name, self._first + given, count

    def add(self, name: str, start: int, count: int, found: dict[str, Any]) -> None:
        """Keep what a batch found; what it left is tried in another one."""
        with self._lock:
            self._given[name] -= count - found["cases"]
            line = {"reader": name, "first": self._first, "start": start, **found}
            self.lines.append(line)
            with self._path.open("a", encoding="utf-8") as file:
                file.write(json.dumps(line) + "\n")

    def report(self) -> str:
        """Cases, failures and rate of each reader, and the failures."""
        said = []
        for name in self._names:
            cases, failed, each = self.spent(name)
            rate = f", {1.0 / each:.0f} a second of the processor" if each else ""
            said.append(f"{name}: {cases:,} cases, {failed} failures{rate}")
        said += [f"{line['reader']}, {wrong}" for line in self.lines for wrong in line["wrong"]]
        return "\n".join(said) + "\n"


def main() -> int:
    """Run until all is done, or the time is up."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("log", type=Path)
    parser.add_argument("--cases", type=int, default=1_000_000)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--minutes", type=float, default=1e6)
    parser.add_argument("--processes", type=int, default=1)
    parser.add_argument("--only", action="append")
    arguments = parser.parse_args()
    from fuzz.seeds import readers

    names = arguments.only or list(readers())
    log = _Log(arguments.log, names, arguments.cases, arguments.first)
    end = time.monotonic() + 60.0 * arguments.minutes

    def work() -> None:
        while time.monotonic() < end and (batch := log.next()) is not None:
            log.add(*batch, _tried(*batch))

    threads = [threading.Thread(target=work) for _ in range(arguments.processes)]
    for each in threads:
        each.start()
    for each in threads:
        each.join()
    sys.stdout.write(log.report())
    return 1 if any(line["failures"] for line in log.lines) else 0


if __name__ == "__main__":
    if sys.argv[1:2] == ["--batch"]:
        _batch(sys.argv[2], int(sys.argv[3]), int(sys.argv[4]), sys.argv[5])
    else:
        sys.exit(main())
