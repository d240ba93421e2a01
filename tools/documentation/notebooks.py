"""Notebooks as pages with their stored outputs; nothing is run again.

A notebook becomes Markdown for MyST: its text unchanged, its code as blocks, its printed output as text, and its
pictures as files. Tables in HTML stay HTML.
"""

from __future__ import annotations

import base64
import hashlib
import json
import re
from pathlib import Path
from typing import Any

from docutils import nodes
from myst_parser.parsers.sphinx_ import MystParser
from sphinx.application import Sphinx

_TERMINAL = re.compile(r"\x1b\[[0-9;]*m")
_REPOSITORY = re.compile(r"`docs/(\w+\.md)`")


def markdown_of(notebook: dict[str, Any], folder: Path, name: str) -> str:
    """Return a notebook as Markdown.

    Parameters
    ----------
    notebook : dict
        As JSON holds it, format 4.
    folder : pathlib.Path
        Where its pictures are put.
    name : str
        Its file, as a link for download.
    """
    parts = []
    for cell in notebook["cells"]:
        source = "".join(cell["source"])
        if cell["cell_type"] == "markdown":
            # A page of the repository becomes a page next to this folder.
            parts.append(_REPOSITORY.sub(r"[\1](../\1)", source))
            continue
        parts.append(_block("python", source))
        parts += [_shown(output, folder) for output in cell["outputs"]]
    title, _, rest = "\n\n".join(filter(None, parts)).partition("\n")
    download = f'<p><a href="../notebooks/{name}" download>Download this notebook</a></p>'
    return f"{title}\n\n{_block('{raw} html', download)}\n{rest}\n"


def _block(kind: str, text: str) -> str:
    fence = "`" * max(3, 1 + max(map(len, re.findall(r"`+", text)), default=0))
    return f"{fence}{kind}\n{text.rstrip()}\n{fence}"


def _shown(output: dict[str, Any], folder: Path) -> str:
    """Return one output of a cell, in the richest form that a page can show."""
    if output["output_type"] == "stream":
        return _block(
            "{code-block} text\n:class: shown", _TERMINAL.sub("", "".join(output["text"]))
        )
    data = {kind: "".join(text) for kind, text in output.get("data", {}).items()}
    if "image/png" in data:
        content = base64.b64decode(data["image/png"])
        path = folder / f"{hashlib.sha256(content).hexdigest()[:16]}.png"
        if not path.exists():
            folder.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)
        return f"![What this code draws]({folder.name}/{path.name})"
    if "text/html" in data:
        return _block("{raw} html", f'<div class="shown-html">{data["text/html"]}</div>')
    return _block("{code-block} text\n:class: shown", data.get("text/plain", ""))


class NotebookParser(MystParser):
    """Parser of a notebook, which becomes Markdown."""

    supported = ("notebook",)

    def parse(self, inputstring: str, document: nodes.document) -> None:
        """Read one notebook."""
        page = Path(document["source"])
        text = markdown_of(json.loads(inputstring), page.parent / "pictures", page.name)
        super().parse(text, document)


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the parser for .ipynb files."""
    app.setup_extension("myst_parser")
    app.add_source_suffix(".ipynb", "notebook")
    app.add_source_parser(NotebookParser)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
