"""The formats of a report: one file for each, listed here by the ending of a file's name."""

RENDERERS = {
    ".html": "html_page",
    ".htm": "html_page",
    ".md": "markdown",
    ".txt": "plain_text",
}
"""Ending → file; its `render` turns a `Page` into text."""
