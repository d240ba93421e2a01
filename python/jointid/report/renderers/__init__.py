"""The formats of a report, one file for each, by file ending."""

from pathlib import Path

from jointid.base.errors import InputError

RENDERERS = {
    ".html": "html_page",
    ".htm": "html_page",
    ".md": "markdown",
    ".txt": "plain_text",
}
"""File for each ending; its `render` converts a `Page` to text."""


def ending_of_page(argument: str, path: Path) -> str:
    """Return the ending of a page's file name.

    Raises
    ------
    InputError
        The format does not exist. The message lists the formats.
    """
    ending = path.suffix.lower()
    if ending not in RENDERERS:
        known = ", ".join(RENDERERS)
        raise InputError(
            f"the file of a report ends in one of {known}", argument=argument, value=path
        )
    return ending
