"""The formats of a report: one file for each, listed here by the ending of a file's name."""

from pathlib import Path

from jointid.base.errors import InputError

RENDERERS = {
    ".html": "html_page",
    ".htm": "html_page",
    ".md": "markdown",
    ".txt": "plain_text",
}
"""Ending → file; its `render` turns a `Page` into text."""


def ending_of_page(argument: str, path: Path) -> str:
    """Return the ending of a page's file name.

    Raises
    ------
    InputError
        There is no such format; lists those that there are.
    """
    ending = path.suffix.lower()
    if ending not in RENDERERS:
        known = ", ".join(RENDERERS)
        raise InputError(f"a report ends in one of {known}", argument=argument, value=path)
    return ending
