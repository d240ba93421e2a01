"""Correction of a robot's facts as one action: the lines of a file and their new text."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from math import degrees
from pathlib import Path
from typing import Any

from jointid.base.advice import Action
from jointid.cli.values import behind_option, in_joint_file

_OPTIONS = {"gear_ratios": "--gear-ratio", "torque_constants": "--torque-constant"}
_NEW_FILE = "robot.toml"
_BARE = r"[A-Za-z0-9_-]+"
_HEADER = r"\s*\["


def words_of_facts(action: Action, file: str) -> str:
    """Return the change in the file of `--facts`; if the command has no such file, the file to write.

    Parameters
    ----------
    action : Action
        Call of `Robot.from_urdf`.
    file : str
        File of `--facts`. Default: the command has none.
    """
    lines = _lines_of(file)
    acts = [
        _act(file, lines, key, value)
        for name, fact in action.arguments.items()
        for key, value in _entries(name, fact, lines)
    ]
    purpose = f" ({action.text})" if action.text else ""
    options = [
        f"{_OPTIONS[name]} {behind_option(fact)}"
        for name, fact in action.arguments.items()
        if name in _OPTIONS
    ]
    by_option = ""
    if len(options) == len(action.arguments):
        by_option = f"identify with {' '.join(options)}{purpose}; or "
    if not file:
        return f"{by_option}write {' and '.join(acts)} in {_NEW_FILE}, and add --facts {_NEW_FILE}{purpose}"
    return f"{by_option}{' and '.join(acts)}{purpose}"


def _lines_of(file: str) -> list[str]:
    if not file:
        return []
    try:
        return Path(file).read_text(encoding="utf-8-sig").splitlines()
    except (OSError, UnicodeDecodeError):  # the file was readable a moment ago
        return []


def _entries(name: str, fact: Any, lines: list[str]) -> Iterator[tuple[str, str]]:
    """Yield each key with its value in TOML; zero offsets in degrees if the file has them in degrees."""
    if name == "zero_offsets" and _span(lines, "zero_offsets_deg"):
        yield "zero_offsets_deg", in_joint_file([round(degrees(each), 4) for each in fact])
    elif isinstance(fact, Mapping):
        rows = (f"{_key(k)} = {{ {_inline(row)} }}" for k, row in fact.items())
        yield name, f"{{ {', '.join(rows)} }}" if fact else "{}"
    else:
        yield name, "..." if fact is ... else in_joint_file(fact)


def _inline(row: Mapping[str, Any]) -> str:
    return ", ".join(f"{_key(key)} = {in_joint_file(value)}" for key, value in row.items())


def _key(name: str) -> str:
    return name if re.fullmatch(_BARE, name) else json.dumps(name, ensure_ascii=False)


def _act(file: str, lines: list[str], key: str, value: str) -> str:
    line = f"{key} = {value}"
    if not file:
        return line
    span = _span(lines, key)
    if span is not None:
        return f"change {_numbers(span)} of {file} to {line}"
    tables = _tables(lines, key)
    if tables:
        return f"delete {' and '.join(map(_numbers, tables))} of {file} and write {line} as the first line of this file"
    return f"write {line} as the first line of {file}"


def _span(lines: list[str], key: str) -> range | None:
    """Return the lines of a key before all tables."""
    for number, line in enumerate(lines):
        if re.match(_HEADER, line):
            return None
        if re.match(rf"\s*{key}\s*=", line):
            stop = number + 1
            while stop < len(lines) and _open("\n".join(lines[number:stop])):
                stop += 1
            return range(number, stop)
    return None


def _open(text: str) -> bool:
    """Return whether a list continues in the next line."""
    bare = re.sub(r"#.*", "", text)
    return bare.count("[") > bare.count("]")


def _tables(lines: list[str], key: str) -> list[range]:
    """Return the lines of a key's tables, e.g. [couplings.joint_6], and of its dotted entries."""
    found: list[range] = []
    inside = False
    for number, line in enumerate(lines):
        header = bool(re.match(_HEADER, line))
        if header:
            inside = bool(re.match(rf"\s*\[\s*{key}\s*[.\]]", line))
        dotted = bool(re.match(rf"\s*{key}\s*\.", line))
        if (inside or dotted) and line.strip():
            if found and found[-1].stop == number:
                found[-1] = range(found[-1].start, number + 1)
            else:
                found.append(range(number, number + 1))
    return found


def _numbers(span: range) -> str:
    first, last = span.start + 1, span.stop
    return f"line {first}" if first == last else f"lines {first}-{last}"
