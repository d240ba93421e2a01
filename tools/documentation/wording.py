"""Wording of the generated pages: sentences, docstrings as Markdown, types in TOML's terms, definitions."""

from __future__ import annotations

import re


def sentence(text: str) -> str:
    """Return a text with a capital letter and a full stop."""
    text = " ".join(text.split())
    return f"{text[:1].upper()}{text[1:]}{'' if text.endswith('.') else '.'}"


def escaped(text: str) -> str:
    """Return a text in which Markdown's special characters have no meaning."""
    return re.sub(r"([*_|<>\[\]])", r"\\\1", text)


def markdown(text: str) -> str:
    """Return a docstring's text in Markdown: `` for code, ` for names."""
    parts = re.split(r"(``.+?``|`.+?`)", text)
    return "".join(
        f"`{part.strip('`')}`" if i % 2 else escaped(part) for i, part in enumerate(parts)
    )


def kind_in_toml(kind: str) -> str:
    """Return a docstring's type in TOML's terms."""
    words = {"float": "number", "str": "text", "bool": "true or false", "int": "whole number"}
    words |= {"mapping of text to text": "table of texts", "tuple of number": "list of numbers"}
    words |= {"tuple of whole number": "list of whole numbers"}
    words |= {"collection of number": "list of numbers", "collection of text": "list of texts"}
    plain = kind.replace(", optional", "")
    for word, said in words.items():
        plain = re.sub(rf"\b{word}\b", said, plain)
    return plain


def definition(key: str, kind: str, text: str) -> list[str]:
    """Return a key of a file, its type and its meaning as lines of Markdown."""
    return [f"`{key}` ({escaped(kind)})", f": {text}", ""]
