"""The page of measured results, docs/contributors/measured.md: each study writes its own parts of it."""

from __future__ import annotations

import datetime
import re
import subprocess
import textwrap
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "contributors" / "measured.md"


@dataclass(frozen=True, kw_only=True)
class Part:
    """One heading of the page with its table. Names in braces are facts of the run.

    Attributes
    ----------
    title : str
        The heading. The part reaches to the next one.
    asked : str
        The question, above the table.
    header : tuple of str
        The table's columns; empty: there is no table.
    reading : str
        The explanation below the table.
    """

    title: str
    asked: str
    header: tuple[str, ...] = ()
    reading: str = ""

    def text(self, rows: Iterable[Sequence[object]], when: str = "", **facts: object) -> str:
        """Return the part; `when` is the date and version of its figures."""
        asked = self.asked.format(**facts) + (f" *{when}*" if when else "")
        blocks = [f"### {self.title}", _filled(asked)]
        if self.header:
            blocks.append(table(self.header, rows))
        if self.reading:
            blocks.append(_filled(self.reading.format(**facts)))
        return "\n\n".join(blocks) + "\n"


def _filled(text: str) -> str:
    return textwrap.fill(text, 120, break_long_words=False, break_on_hyphens=False)


def table(header: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """Return a table in Markdown; each row has one cell per column."""
    head, *lines = (f"| {' | '.join(map(str, row))} |" for row in _even(header, rows))
    return "\n".join([head, f"|{'---|' * len(header)}", *lines])


def _even(header: Sequence[str], rows: Iterable[Sequence[object]]) -> Iterator[Sequence[object]]:
    """Return the header, and the rows padded to its length."""
    yield header
    for row in rows:
        if len(row) != len(header):
            raise ValueError(f"{len(row)} cells below {len(header)} columns: {row}")
        yield row


def placed(page: str, text: str) -> str:
    """Return the page with a part in place of the one with the same heading."""
    heading = text.partition("\n")[0]
    old = re.compile(rf"^{re.escape(heading)}\n.*?(?=^##|\Z)", re.DOTALL | re.MULTILINE)
    new, count = old.subn(lambda _: text + "\n", page)
    if count != 1:
        raise ValueError(f"{PAGE.name} has the heading {heading!r} {count} times")
    return new.rstrip("\n") + "\n"


def publish(part: Part, rows: Iterable[Sequence[object]], *, write: bool, **facts: object) -> None:
    """Print a part, and write it into the page if requested."""
    text = part.text(rows, f"{datetime.date.today()}, commit {commit()}", **facts)
    print(text, flush=True)
    if write:
        write_part(text)


def write_part(text: str) -> None:
    """Write a part into the page."""
    PAGE.write_text(placed(PAGE.read_text(encoding="utf-8"), text), encoding="utf-8")


def commit() -> str:
    """Return the commit, with "-dirty" if files other than the page differ from it; "unknown" without a repository."""
    others = ("--", ".", f":(exclude){PAGE.relative_to(ROOT).as_posix()}")
    try:
        short = _git("rev-parse", "--short=8", "HEAD")
        changed = _git("status", "--porcelain", "--untracked-files=no", *others)
    except (OSError, subprocess.CalledProcessError):
        return "unknown"
    return f"{short}-dirty" if changed else short


def _git(*arguments: str) -> str:
    run = subprocess.run(["git", *arguments], check=True, text=True, capture_output=True, cwd=ROOT)
    return run.stdout.strip()
