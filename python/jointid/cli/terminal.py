"""Text that fits a terminal: lines break between words, and wide tables become several tables.

Output to a file or a pipe does not change, because programs read it.
"""

from __future__ import annotations

import atexit
import os
import re
import sys
from collections.abc import Iterator, Sequence
from typing import Any, TextIO

_NARROWEST = 30  # columns; on a narrower terminal no line is broken
_GAP = "  "  # between two columns of a table
_LABEL = 26  # largest length of a label before a text in its own column
_MARKUP = re.compile(r"\033\[[0-9;?]*[A-Za-z]")
_RULE = re.compile(r"-+(?:  -+)+")
# An option stays with its value, so that advice can be pasted. A number stays with its error and its unit.
_WORD = re.compile(
    r"--[a-z][a-z-]*[ ](?:'[^']*'|(?!--)[^\s]+)"
    r"|\(?(?:\S+ ± )?[±+−-]?\d\S*(?: (?:%|ms|s|m|rad|deg|Hz|kg|N|kg·m²|N·m|rad/s)(?![^\s,;:.)])[,;:.)]*)?"
    r"|\S+"
)
_NOTE = re.compile(r" {3,}\(.*\)$")  # after an example
# But not "jointid identify: ..." and "jointid estimate — ...", which are sentences and titles.
_COMMAND = re.compile(r"(?:next: |# )?jointid [a-z][a-z-]*(?![a-z:-]| —)|(?:\w+=\S+ )?pip install ")


def fit_streams() -> None:
    """Fit printed text to the terminal, if standard output or standard error is one."""
    for name in ("stdout", "stderr"):
        stream = getattr(sys, name)
        if stream is not None and not isinstance(stream, Fitted) and stream.isatty():
            fitted = Fitted(stream)
            setattr(sys, name, fitted)
            atexit.register(fitted.flush)


def columns_of(stream: Any) -> int:
    """Return the width of a stream's terminal, or the variable COLUMNS; 0 without both."""
    try:
        return int(os.environ.get("COLUMNS", 0)) or os.get_terminal_size(stream.fileno()).columns
    except (OSError, ValueError, AttributeError):
        return 0


class Fitted:
    """Stream of a terminal that breaks lines wider than the terminal.

    Parameters
    ----------
    stream : text file
    """

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream
        self._begun = ""  # a line that is not complete
        self._held: list[str] = []  # lines that may be a table

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)

    def write(self, text: str) -> int:
        """Write complete lines so that they fit. Text that moves the cursor, such as a progress bar, is not changed."""
        if "\r" in text or "\033[K" in text:
            self.flush()
            self._stream.write(text)
            return len(text)
        *lines, self._begun = (self._begun + text).split("\n")
        for line in lines:
            self._take(line)
        return len(text)

    def writelines(self, lines: Sequence[str]) -> None:
        """Write several texts in order."""
        for line in lines:
            self.write(line)

    def flush(self) -> None:
        """Write the held lines."""
        self._release()
        if self._begun:
            self._stream.write(self._begun)
            self._begun = ""
        self._stream.flush()

    def _take(self, line: str) -> None:
        if len(self._held) == 1 and not _RULE.fullmatch(line):
            self._release()
        if len(self._held) > 1 and not _is_row(line, self._held[1]):
            self._release()
        if self._held or _GAP in line.strip():  # possibly the header of a table
            self._held.append(line)
        else:
            self._put([line])

    def _release(self) -> None:
        held, self._held = self._held, []
        self._put(held)

    def _put(self, lines: Sequence[str]) -> None:
        width = columns_of(self._stream)
        table = len(lines) > 1
        for line in _table(lines, width) if table else lines:
            for part in broken(line, width):
                self._stream.write(f"{part}\n")


def broken(line: str, width: int) -> Iterator[str]:
    """Yield a line in parts that fit. A word longer than a line is not broken.

    Further parts are below the text, after its label or mark. A command continues with a backslash, as in a shell.

    Parameters
    ----------
    line : str
    width : int
        Width of the terminal.
    """
    if width < _NARROWEST or _length(line) <= width:
        yield line
        return
    note = _NOTE.search(line)
    if note is not None and _COMMAND.match(line.strip()):
        yield from broken(line[: note.start()], width)
        yield from broken(" " * _indent(line) + note[0].strip(), width)
        return
    indent = _indent(line)
    command = _COMMAND.match(line.strip()) is not None
    room = width - 2 * command  # for the backslash
    part = line[: len(line) - len(line.lstrip())]
    begun = False
    position = len(part)
    for word in _WORD.finditer(line, position):
        blank = line[position : word.start()]
        if begun and _length(part + blank + word[0]) > room:
            yield f"{part} \\" if command else part
            part, blank = " " * indent, ""
        part += blank + word[0]
        position, begun = word.end(), True
    yield part


def _indent(line: str) -> int:
    """Return the indentation of the further parts of a line."""
    lead = len(line) - len(line.lstrip())
    label = re.match(r"\s*\S+(?: \S+){0,3}?\s{2,}(?=\S)", line)
    if label is not None and label.end() <= _LABEL + lead:
        return label.end()
    return lead + (4 if _COMMAND.match(line.strip()) else 2)


def _length(text: str) -> int:
    return len(_MARKUP.sub("", text))


def _spans(rule: str) -> list[tuple[int, int]]:
    return [found.span() for found in re.finditer("-+", rule)]


def _is_row(line: str, rule: str) -> bool:
    """Return whether a line below a table's rule fits its columns."""
    gaps = [line[end : end + len(_GAP)] for _, end in _spans(rule)[:-1]]
    return bool(line.strip()) and not "".join(gaps).strip()


def _table(lines: Sequence[str], width: int) -> Iterator[str]:
    """Yield a table. A table that is too wide becomes several, each with the first column, without empty columns."""
    spans = _spans(lines[1])
    if width < _NARROWEST or max(map(_length, lines)) <= width:
        yield from lines
        return
    ends = [end for _, end in spans[:-1]] + [max(map(len, lines))]
    cells = [
        [line[start:end].rstrip() for (start, _), end in zip(spans, ends, strict=True)]
        for line in lines
    ]
    filled = [k for k in range(len(spans)) if k == 0 or any(row[k].strip() for row in cells[2:])]
    cells = [[row[k] for k in filled] for row in cells]
    sizes = [max(len(row[k]) for row in cells) for k in range(len(filled))]
    for number, group in enumerate(_groups(sizes, width)):
        if number:
            yield ""
        for row in cells:
            yield from _row([row[k] for k in group], [sizes[k] for k in group], width)


def _groups(sizes: Sequence[int], width: int) -> Iterator[list[int]]:
    """Yield the columns of each table: the first one in all, then the number that fits."""
    group = [0]
    for k in range(1, len(sizes)):
        if len(group) > 1 and sum(sizes[j] + len(_GAP) for j in group) + sizes[k] > width:
            yield group
            group = [0]
        group.append(k)
    yield group


def _row(cells: Sequence[str], sizes: Sequence[int], width: int) -> Iterator[str]:
    """Yield a row. A last cell that is too wide continues below itself."""
    padded = [cell.ljust(size) for cell, size in zip(cells[:-1], sizes[:-1], strict=True)]
    head = _GAP.join([*padded, ""])
    room = width - len(head)
    if set(cells[-1]) == {"-"}:
        yield head + cells[-1][: max(room, 1)]
        return
    for number, part in enumerate(broken(cells[-1], room)):
        yield ((head if number == 0 else " " * len(head)) + part.strip()).rstrip()
