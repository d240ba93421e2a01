"""The declaration of a target: its name, file endings, and how a joint is written for it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from jointid.exports.subject import Subject


@dataclass(frozen=True, slots=True, kw_only=True)
class Existing:
    """A file that gets a joint's values."""

    content: bytes
    place: str  # the file's name, for errors
    joint: str  # name of the file's joint


@dataclass(frozen=True, slots=True, kw_only=True)
class Order:
    """The order to a target."""

    name: str
    approximate: bool = False  # whether the nearest may replace what the target cannot express
    into: Existing | None = None  # the file to edit; None: a new one


@dataclass(frozen=True, slots=True, kw_only=True)
class Target:
    """How a joint is written for one kind of consumer."""

    name: str
    endings: tuple[str, ...]  # of file names that choose this target, in lower case, with the dot
    meaning: str  # for help, e.g. "MuJoCo model"
    write: Callable[[Subject, Order], bytes]  # the file's content
    edits: bool = False  # whether it can set the values of a joint in an existing file
