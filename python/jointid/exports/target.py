"""The declaration of a target: name, file endings, and function that writes a joint."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from jointid.exports.subject import Subject


@dataclass(frozen=True, slots=True, kw_only=True)
class Existing:
    """An existing file to receive a joint's values."""

    content: bytes
    place: str  # the file's name, for errors
    joint: str  # name of the file's joint


@dataclass(frozen=True, slots=True, kw_only=True)
class Order:
    """The options of an export."""

    name: str
    approximate: bool = False  # allow the nearest friction that the target can represent
    into: Existing | None = None  # the file to edit; None: a new file


@dataclass(frozen=True, slots=True, kw_only=True)
class Target:
    """Description of one export target."""

    name: str
    endings: tuple[str, ...]  # file endings that choose this target, in lower case, with the dot
    meaning: str  # for help, e.g. "MuJoCo model"
    write: Callable[[Subject, Order], bytes]  # returns the file's content
    edits: bool = False  # whether it can set the values of a joint in an existing file
