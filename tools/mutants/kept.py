"""Verdicts of earlier runs: they hold while the mutated file and what should notice stay the same."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path

from mutants.catalogue import REPOSITORY, Mutant
from mutants.running import Verdict


class Kept:
    """Verdicts in a file, which is written after each, so that an interrupted run loses none.

    Parameters
    ----------
    path : Path
        The file; one that is not there, or is not JSON, holds nothing.
    root : Path
        The sources.
    """

    def __init__(self, path: Path, root: Path = REPOSITORY) -> None:
        self._path = path
        self._root = root
        self._contents: dict[str, bytes] = {}
        try:
            self._rows = dict(json.loads(path.read_text(encoding="utf-8")))
        except (OSError, ValueError):
            self._rows = {}

    def find(self, mutants: list[Mutant]) -> list[Verdict]:
        """The verdicts that still hold, in the mutants' order."""
        found = []
        for each in mutants:
            row = self._rows.get(self._fingerprint(each))
            if row is not None:
                found.append(Verdict(mutant=each, **row))
        return found

    def add(self, verdict: Verdict) -> None:
        """Keep one more."""
        row = {"killed": verdict.killed, "by": verdict.by, "seconds": verdict.seconds}
        self._rows[self._fingerprint(verdict.mutant)] = row
        self._path.parent.mkdir(parents=True, exist_ok=True)
        written = self._path.with_suffix(".new")
        written.write_text(json.dumps(self._rows, indent=0), encoding="utf-8")
        written.replace(self._path)

    def _fingerprint(self, mutant: Mutant) -> str:
        parts = [mutant.path, mutant.line, mutant.was, mutant.becomes, *mutant.checks]
        seen = hashlib.sha256("\0".join((*parts, *mutant.tests)).encode())
        files = [mutant.path, *(name.partition("::")[0] for name in mutant.tests)]
        if mutant.checks:
            files += sorted(str(each) for each in (self._root / "cpp" / "tests").glob("*.cpp"))
        for file in files:
            seen.update(self._content(file))
        return seen.hexdigest()

    def _content(self, file: str) -> bytes:
        if file not in self._contents:
            path = self._root / file
            files = sorted(path.rglob("test_*.py")) if path.is_dir() else [path]
            self._contents[file] = b"".join(each.read_bytes() for each in files)
        return self._contents[file]
