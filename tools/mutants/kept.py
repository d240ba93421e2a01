"""Verdicts of earlier runs. A changed line loses its verdict; a changed test requires another trial."""

from __future__ import annotations

import csv
import hashlib
from collections.abc import Sequence
from pathlib import Path

from mutants.catalogue import REPOSITORY, Mutant
from mutants.running import Verdict

VERDICTS = Path(__file__).resolve().parent / "verdicts"
_COLUMNS = ("mutant", "files", "date", "seconds", "first to fail")
_DIGITS = 12


class Kept:
    """Verdicts in one file per list, written after each trial, so that an interrupted run loses none.

    Parameters
    ----------
    folder : Path
        Folder of the files; a row that cannot be read counts as missing.
    mutants : sequence of Mutant
        All of the lists: verdicts of other mutants are removed when the next one is added.
    root : Path
        The sources.
    """

    def __init__(self, folder: Path, mutants: Sequence[Mutant], root: Path = REPOSITORY) -> None:
        self._folder = folder
        self._mutants = mutants
        self._root = root
        self._contents: dict[str, bytes] = {}
        self._rows: dict[Mutant, tuple[str, Verdict]] = {}
        named = {_name(each): each for each in mutants}
        for path in sorted(folder.glob("*.csv")):
            with path.open(encoding="utf-8", newline="") as stream:
                for row in csv.reader(stream):
                    if len(row) == len(_COLUMNS) and row[0] in named:
                        self._rows[named[row[0]]] = row[1], _verdict(named[row[0]], row)

    def find(self, mutants: Sequence[Mutant]) -> list[Verdict]:
        """Return the verdicts of unchanged lines, in the mutants' order."""
        return [self._rows[each][1] for each in mutants if each in self._rows]

    def current(self, mutants: Sequence[Mutant]) -> list[Verdict]:
        """Return those with an unchanged file and unchanged tests."""
        return [
            self._rows[each][1]
            for each in mutants
            if each in self._rows and self._rows[each][0] == self._files(each)
        ]

    def add(self, verdict: Verdict) -> None:
        """Store one more verdict."""
        room = verdict.mutant.room
        self._rows[verdict.mutant] = self._files(verdict.mutant), verdict
        self._folder.mkdir(parents=True, exist_ok=True)
        path = self._folder / f"{room}.csv"
        written = path.with_suffix(".new")
        with written.open("w", encoding="utf-8", newline="") as stream:
            table = csv.writer(stream, lineterminator="\n")
            table.writerow(_COLUMNS)
            for each in self._mutants:
                if each.room == room and each in self._rows:
                    files, of = self._rows[each]
                    table.writerow((_name(each), files, of.date, f"{of.seconds:.1f}", of.by))
        written.replace(path)

    def _files(self, mutant: Mutant) -> str:
        """Return a digest of the changed file, and of the tests that should notice."""
        seen = hashlib.sha256("\0".join((*mutant.checks, *mutant.tests)).encode())
        files = [mutant.path, *(name.partition("::")[0] for name in mutant.tests)]
        if mutant.checks:
            files += sorted(str(each) for each in (self._root / "cpp" / "tests").glob("*.cpp"))
        for file in files:
            seen.update(self._content(file))
        return seen.hexdigest()[:_DIGITS]

    def _content(self, file: str) -> bytes:
        if file not in self._contents:
            path = self._root / file
            files = sorted(path.rglob("test_*.py")) if path.is_dir() else [path]
            self._contents[file] = b"".join(each.read_bytes() for each in files)
        return self._contents[file]


def _name(mutant: Mutant) -> str:
    """Return a digest of the change, so that another text has no verdict."""
    parts = (mutant.room, mutant.path, mutant.line, mutant.was, mutant.becomes)
    return hashlib.sha256("\0".join(parts).encode()).hexdigest()[:_DIGITS]


def _verdict(mutant: Mutant, row: list[str]) -> Verdict:
    _, _, date, seconds, by = row
    return Verdict(mutant=mutant, killed=bool(by), by=by, seconds=float(seconds), date=date)
