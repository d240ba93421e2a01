"""The lists of mutants, and the place of each in the current sources."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

REPOSITORY = Path(__file__).resolve().parents[2]
LISTS = Path(__file__).resolve().parent / "lists"
_OF_A_FILE = {"path", "checks", "tests", "mutants"}
_OF_A_MUTANT = {"line", "was", "becomes", "checks", "tests", "justified", "named"}
_BRACKETS = (("(", ")"), ("[", "]"), ("{", "}"))
_OF_TWO_SIDES = ("/", "%", "<", ">", "=", "|", "^", "?", ":")


class MutantError(Exception):
    """A list that cannot be used."""


@dataclass(frozen=True, kw_only=True)
class Mutant:
    """One change of one line.

    Attributes
    ----------
    number : int
        Counted from 1 over all lists; 0 is the unchanged program.
    room : str
        Name of the list.
    path : str
        File, from the root of the repository.
    line : str
        Text that occurs once in the file, on one line.
    was, becomes : str
        Part of that text, which occurs once in it, and its replacement.
    checks : tuple of str
        Parts of the names of the core's checks that should notice (C++ only).
    tests : tuple of str
        pytest's names of the tests that should notice.
    justified : str
        Reason why no test can or must notice; empty if one does.
    named : bool
        Whether it survived the first trial by hand (issue 17).
    """

    number: int
    room: str
    path: str
    line: str
    was: str
    becomes: str
    checks: tuple[str, ...] = ()
    tests: tuple[str, ...] = ()
    justified: str = ""
    named: bool = field(default=False, compare=False)

    @property
    def is_python(self) -> bool:
        """Whether the source file itself is replaced. In C++ a switch chooses at run time."""
        return self.path.endswith(".py")

    def __str__(self) -> str:
        return f"{self.path}: `{self.was}` becomes `{self.becomes}`"

    def place(self, text: str) -> tuple[int, int]:
        """Return the begin and end of `was` in the file's text.

        Raises
        ------
        MutantError
            If the line or the part is missing, or occurs more than once.
        """
        _once(text, self.line, f"the mutant of {self.path}", "line", self.line)
        begin = text.index(self.line)
        _once(
            self.line, self.was, f"the mutant of {self.path}, line `{self.line}`", "part", self.was
        )
        begin += self.line.index(self.was)
        return begin, begin + len(self.was)

    def applied(self, text: str) -> str:
        """Return the file's text with the change."""
        begin, end = self.place(text)
        return text[:begin] + self.becomes + text[end:]


def _once(text: str, part: str, whose: str, what: str, shown: str) -> None:
    found = text.count(part)
    if found != 1:
        state = "is no longer there" if found == 0 else f"stands there {found} times"
        raise MutantError(f"{whose}: the {what} `{shown}` {state}; update the list")


def read(folder: Path = LISTS) -> list[Mutant]:
    """Return all mutants of all lists, in the order of the lists' names.

    Raises
    ------
    MutantError
        If an entry has an unknown or a missing field, or nothing to notice it.
    """
    mutants: list[Mutant] = []
    for path in sorted(folder.glob("*.toml")):
        for entry in tomllib.loads(path.read_text(encoding="utf-8"))["file"]:
            _known(entry, _OF_A_FILE, path)
            for each in entry["mutants"]:
                mutants.append(_made(len(mutants) + 1, path, entry, each))
    again = {(each.path, each.line, each.was, each.becomes) for each in mutants}
    if len(again) != len(mutants):
        raise MutantError("the same mutant is twice in the lists")
    return mutants


def _made(number: int, path: Path, entry: dict[str, Any], each: dict[str, Any]) -> Mutant:
    _known(each, _OF_A_MUTANT, path)
    if missing := {"was", "becomes"} - set(each):
        raise MutantError(f"{path.name}: a mutant of {entry['path']} has no {min(missing)}: {each}")
    line = each.get("line", each["was"])
    if "\n" in line or each["was"] == each["becomes"]:
        raise MutantError(f"{path.name}: a mutant changes one line: {each}")
    if not entry["path"].endswith(".py") and not (_whole(each["was"]) and _whole(each["becomes"])):
        raise MutantError(f"{path.name}: no expression or statement of its own: {each}")
    checks, tests = ([*each.get(key, ()), *entry.get(key, ())] for key in ("checks", "tests"))
    if not checks and not tests:
        raise MutantError(f"{path.name}: no check or test is named for {each}")
    return Mutant(
        number=number,
        room=path.stem,
        path=entry["path"],
        line=line,
        was=each["was"],
        becomes=each["becomes"],
        checks=tuple(dict.fromkeys(checks)),
        tests=tuple(dict.fromkeys(tests)),
        justified=each.get("justified", ""),
        named=each.get("named", False),
    )


def _whole(text: str) -> bool:
    """Whether C++ allows brackets around it. This is checked at once; the compiler would need minutes."""
    closed = all(text.count(opening) == text.count(closing) for opening, closing in _BRACKETS)
    return closed and not text.startswith(_OF_TWO_SIDES)


def _known(entry: dict[str, Any], fields: set[str], path: Path) -> None:
    if unknown := set(entry) - fields:
        raise MutantError(f"{path.name}: unknown field {min(unknown)!r} in {entry}")


def check_places(mutants: list[Mutant], root: Path = REPOSITORY) -> None:
    """Check that every mutant's text is in its place.

    Raises
    ------
    MutantError
        Names all mutants that are not.
    """
    lost = []
    for each in mutants:
        try:
            each.place((root / each.path).read_text(encoding="utf-8"))
        except (MutantError, OSError) as error:
            lost.append(str(error))
    if lost:
        raise MutantError("\n".join(lost))
