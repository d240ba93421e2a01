"""Run under the failing library: a scenario of writing, once for each call and each fault, in a process of its own.

Says for which faults a file is torn, something acknowledged is lost, or no sentence was said. The last fault of a
scenario is a loss of power behind its end.
"""

import ctypes
import os
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from types import FrameType

import jointid as jid
from jointid.base import files, pictures
from jointid.hardware.session import appended_file
from write_faults import commands, sessions
from write_faults.faults import NONE, POWER, Fault, faults_at
from write_faults.savers import SAVERS
from write_faults.scenario import Scenario

_AFTER = -1  # the power fails behind the end
_FEW = 10
_PACKAGE = Path(jid.__file__).parent
SCENARIOS = SAVERS | commands.SCENARIOS
_WRITING = {
    each.__code__
    for each in (files.write_whole, files.write_new, files.make_folder, files.open_locked)
} | {files.new_beside.__code__, appended_file.AppendedFile.__init__.__code__}
_WRITING |= {pictures.write_picture.__code__}


class Outcome:
    """Of a scenario that ran once.

    Attributes
    ----------
    calls : int
        How many it made.
    injected : bool
        Whether the fault came.
    wrong : str
        What is wrong with what it left; "" if nothing is.
    writers : set of str
        Without a fault: the modules that asked for files, as `base.files`.
    """

    def __init__(self) -> None:
        self.calls, self.injected, self.wrong = 0, False, ""
        self.writers: set[str] = set()


def _act(scenario: Scenario, folder: Path, writing: int) -> str:
    """What became of it: "0" done, "1" a sentence, "2" none."""
    try:
        scenario.act(folder, lambda: os.write(writing, b"+"))
    except (OSError, jid.InputError, commands.CommandError) as error:
        return "1" if "\n" not in str(error) and str(error) else "2"
    except BaseException as error:
        os.write(2, f"{error!r}\n".encode())
        return "2"
    return "0"


def _noting(found: set[str]) -> None:
    """Note from now on which modules call what writes."""

    def note(frame: FrameType, event: str, _: object) -> None:
        caller = frame.f_back
        if event == "call" and frame.f_code in _WRITING and caller is not None:
            place = Path(caller.f_code.co_filename)
            if place.is_relative_to(_PACKAGE):
                found.add(".".join(place.relative_to(_PACKAGE).with_suffix("").parts))

    threading.setprofile(note)
    sys.setprofile(note)


def _child(
    scenario: Scenario, folder: Path, writing: int, call: int, fault: Fault, library: ctypes.CDLL
) -> None:
    library.arm(os.fsencode(folder), ctypes.c_long(max(call, 0)), fault.number, fault.lasting)
    writers: set[str] = set()
    if fault is NONE:
        _noting(writers)
    said = _act(scenario, folder, writing)
    sys.setprofile(None)
    calls, failed = library.counted(), library.failed()
    if call == _AFTER:
        library.lose()
    os.write(writing, f" {said} {calls} {failed} {','.join(sorted(writers))}".encode())
    os._exit(0)


def faulted(name: str, call: int, fault: Fault, library: ctypes.CDLL) -> Outcome:
    """Run a scenario with a fault at its n-th call."""
    scenario = SCENARIOS[name]
    outcome = Outcome()
    with TemporaryDirectory() as place:
        folder = Path(place).resolve() / "files"
        folder.mkdir()
        scenario.prepare(folder)
        reading, writing = os.pipe()
        child = os.fork()
        if child == 0:
            _child(scenario, folder, writing, call, fault, library)
        os.close(writing)
        with os.fdopen(reading) as stream:
            acknowledged, *rest = stream.read().split(" ")
        _, status = os.waitpid(child, 0)
        code = os.waitstatus_to_exitcode(status)
        powerless = code == sessions.POWERLESS
        known = len(acknowledged)
        if powerless and not scenario.synced and call != _AFTER:
            known = min(known, scenario.before)
        wrong = scenario.judge(folder, known)
        if powerless:
            outcome.injected = True
        elif code or len(rest) < 3 or rest[0] == "2":
            wrong = wrong or f"no sentence, exit code {code}"
        else:
            outcome.calls, outcome.injected = int(rest[1]), rest[2] != "0"
            outcome.writers = set(rest[3].split(",")) - {""}
            if rest[0] != "0" and (fault.harmless or fault is NONE):
                wrong = wrong or "fails although nothing has happened"
        left = [str(each) for each in folder.rglob(".*")]
        if left and not powerless and not (fault.lasting and outcome.injected):
            wrong = wrong or f"left behind: {left}"
        outcome.wrong = wrong
    return outcome


def _chosen(total: int, most: int) -> list[int]:
    """All calls, or about `most` of them: the first, the last, and some between; of many, more at both ends."""
    if not 0 < most < total:
        return list(range(1, total + 1))
    spread = {1 + (total - 1) * k // max(most - 1, 1) for k in range(most)}
    if most > _FEW:
        ends = most // 3
        between = {ends + (total - 2 * ends) * k // ends for k in range(1, ends + 1)}
        spread = {*range(1, ends + 1), *between, *range(total - ends + 1, total + 1)}
    return sorted(spread)


def tried(name: str, most: int, library: ctypes.CDLL, *, all_of_them: bool) -> Iterator[str]:
    """Yield what is wrong; then the modules that write; then how many faults came."""
    if name == "session":
        count, said = sessions.interrupted(library, all_of_them=all_of_them)
        yield from said
        yield "hardware.session.recorder"
        yield f"{count} faults"
        return
    # Twice: a first run of a command may make what later ones find.
    first, whole = (faulted(name, 0, NONE, library) for _ in range(2))
    if whole.wrong:
        yield whole.wrong
    pairs = [
        (call, fault)
        for call in _chosen(whole.calls, most)
        for fault in faults_at(call, all_of_them=all_of_them)
    ]
    injected = 0
    for call, fault in [*pairs, (_AFTER, POWER)]:
        outcome = faulted(name, call, fault, library)
        injected += outcome.injected
        if outcome.wrong:
            yield f"call {call} of {whole.calls}, {fault.name}: {outcome.wrong}"
    yield " ".join(sorted(first.writers | whole.writers))
    yield f"{injected} faults"


def main(path: str) -> None:
    """Read lines of name, number of calls (0: all) and "all" or "some" faults; an empty line ends each answer."""
    library = ctypes.CDLL(path)
    for line in sys.stdin:
        name, most, which = line.rstrip("\n").split("\t")
        for said in tried(name, int(most), library, all_of_them=which == "all"):
            sys.stdout.write(said.replace("\n", " ") + "\n")
        sys.stdout.write("\n")
        sys.stdout.flush()


if __name__ == "__main__":
    main(*sys.argv[1:])
