"""Parts of messages: a short reason from another library's error, alternatives, text for a terminal."""

import re
from collections.abc import Sequence

# Control characters, line and paragraph ends, marks of text direction, surrogates.
_UNFIT = re.compile("[\x00-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069\ud800-\udfff]")


def reason_of(error: BaseException) -> str:
    """Return the first sentence of an error's text on one line, or its type if it has no text."""
    text = " ".join(str(error).split()).partition(". ")[0]
    return text[:120].rstrip(". ") or type(error).__name__


def alternatives(names: Sequence[str]) -> str:
    """Return names as alternatives in a sentence.

    Examples
    --------
    >>> alternatives((".csv", ".npz", ".mat"))
    '.csv, .npz or .mat'
    """
    *others, last = names
    return f"{', '.join(others)} or {last}" if others else last


def printable(text: str) -> str:
    """Return text without control characters, because a file's labels could send them to a terminal."""
    return "".join(c if c == "\n" or c.isprintable() else "\ufffd" for c in text)


def on_one_line(text: str) -> str:
    r"""Return text with escaped control characters and line ends, which names in a file may contain.

    Examples
    --------
    >>> on_one_line("topic /a\nb")
    'topic /a\\nb'
    """
    return _UNFIT.sub(lambda found: repr(found[0])[1:-1], text)


def joint_phrase(name: str) -> str:
    """Return the phrase for a joint: "joint 3", or only the name if it contains "joint"."""
    return name if "joint" in name.lower() else f"joint {name}"
