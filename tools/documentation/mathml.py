"""Formulas as MathML, which every browser draws without loading a program or a font."""

from __future__ import annotations

from typing import Any, cast

from docutils import nodes
from docutils.utils.math import MathError
from docutils.utils.math.latex2mathml import tex2mathml
from sphinx.application import Sphinx
from sphinx.errors import ExtensionError


def mathml(formula: str, *, display: bool = False) -> str:
    """Return a formula of TeX as MathML.

    Raises
    ------
    sphinx.errors.ExtensionError
        The formula has something that is not translated.
    """
    try:
        return cast("str", tex2mathml(formula, as_block=display))
    except (MathError, SyntaxError) as error:
        raise ExtensionError(f"no MathML for {formula!r}: {error}") from None


def _inline(writer: Any, node: nodes.math) -> None:
    writer.body.append(mathml(node.astext()))
    raise nodes.SkipNode


def _display(writer: Any, node: nodes.math_block) -> None:
    # A formula that is wider than a phone has its own scroll bar.
    writer.body.append(f'<div class="formula">{mathml(node.astext(), display=True)}</div>')
    raise nodes.SkipNode


def setup(app: Sphinx) -> dict[str, bool]:
    """Register MathML as Sphinx's format of formulas."""
    app.add_html_math_renderer("mathml", (_inline, None), (_display, None))
    app.config.html_math_renderer = "mathml"
    return {"parallel_read_safe": True, "parallel_write_safe": True}
