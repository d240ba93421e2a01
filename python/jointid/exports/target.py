"""What a target declares: its name, endings, and how a subject is written for it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from jointid.exports.subject import Subject


@dataclass(frozen=True, slots=True, kw_only=True)
class Existing:
    """A file that gets a joint's values.

    Attributes
    ----------
    content : bytes
    place : str
        Its name, for errors.
    joint : str
        Name of its joint.
    """

    content: bytes
    place: str
    joint: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Order:
    """What is asked of a target.

    Attributes
    ----------
    name : str
        What the file calls the joint, as far as the target's language allows.
    approximate : bool
        Whether what the target cannot express may be replaced by the nearest it can.
    into : Existing or None
        The file to edit; None: a new one.
    """

    name: str
    approximate: bool = False
    into: Existing | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Target:
    """How a joint is written for one kind of consumer.

    Attributes
    ----------
    name : str
    endings : tuple of str
        Endings of file names that choose this target, in lower case, with the dot.
    meaning : str
        For help, e.g. "MuJoCo model".
    write : callable
        Takes a `Subject` and an `Order`, returns the file's content; raises `InputError` for what cannot be
        expressed.
    edits : bool
        Whether it can set the values of a joint in an existing file.
    """

    name: str
    endings: tuple[str, ...]
    meaning: str
    write: Callable[[Subject, Order], bytes]
    edits: bool = False
