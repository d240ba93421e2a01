"""HTML built from elements, so that no text can reach a page unescaped.

An `Html` cannot be made from a string of markup. Only `element` and `page` make it, and both escape every text.
"""

from __future__ import annotations

import re

_TAGS = frozenset(
    (
        *("html", "head", "meta", "title", "style", "body", "section", "footer", "div", "span"),
        *("main", "details", "summary"),
        *(
            "h1",
            "h2",
            "h3",
            "h4",
            "p",
            "br",
            "b",
            "em",
            "strong",
            "small",
            "sub",
            "sup",
            "code",
            "pre",
            "a",
        ),
        *("figure", "figcaption", "img", "table", "caption", "thead", "tbody", "tr", "th", "td"),
        *("ul", "ol", "li", "svg", "path", "text", "desc"),
    )
)
_EMPTY = frozenset(("br", "img", "meta"))
_ATTRIBUTES = frozenset(
    (
        *("alt", "charset", "class", "colspan", "content", "href", "id", "lang", "name", "src"),
        *("d", "role", "viewBox", "x", "y", "scope", "tabindex", "aria-label", "data-label"),
    )
)
# A page needs no other file: pictures are embedded, links stay on the page.
_SAFE = {
    "src": re.compile(r"data:image/png;base64,[A-Za-z0-9+/=]*"),
    "href": re.compile(r"#[\w-]*"),
    "d": re.compile(r"[MlHhVvz0-9 -]*"),
}
# Not allowed in a document: control characters, surrogates, noncharacters.
_UNFIT = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\ud800-\udfff\ufffe\uffff]")


class Html:
    """A fragment of a page; only `element` and `page` make it."""

    __slots__ = ("_markup",)

    def __init__(self) -> None:
        raise TypeError("only element() makes an Html, because element() escapes its arguments")

    def __str__(self) -> str:
        """The markup."""
        return self._markup

    _markup: str


def element(tag: str, *children: Html | str, **attributes: str) -> Html:
    """Return one element of a page.

    Parameters
    ----------
    tag : str
        Name of the element; only elements of reports are allowed.
    *children : Html or str
        Content of the element; texts are escaped.
    **attributes : str
        Attributes with escaped values. A trailing underscore of a name is dropped (`class_`); any other underscore is a
        hyphen. `src` takes a picture as data, `href` a place on the same page.

    Returns
    -------
    Html

    Examples
    --------
    >>> str(element("p", "a < b", class_="note"))
    '<p class="note">a &lt; b</p>'
    """
    if tag not in _TAGS:
        raise ValueError(f"no element '{tag}' in a report")
    opened = tag
    for key, value in attributes.items():
        name = key.removesuffix("_").replace("_", "-")
        if name not in _ATTRIBUTES or (name in _SAFE and not _SAFE[name].fullmatch(value)):
            raise ValueError(f"no attribute {name}='{value[:40]}' in a report")
        opened += f' {name}="{_escaped(value)}"'
    if tag in _EMPTY:
        return _made(f"<{opened}>")
    return _made(f"<{opened}>{''.join(map(_inside, children))}</{tag}>")


def table(
    rows: list[list[Html | str]], *, head: list[str] | None = None, class_: str = "jointid"
) -> Html:
    """Return a table with a head and rows of cells; a text becomes a cell."""
    lines = [element("tr", *map(_cell, row)) for row in rows]
    parts = [element("tbody", *lines)]
    if head is not None:
        parts.insert(0, element("thead", element("tr", *(element("th", name) for name in head))))
    return element("table", *parts, class_=class_)


def page(title: str, style: str, *body: Html | str) -> str:
    """Return a whole page that needs no other file.

    Parameters
    ----------
    title : str
    style : str
        CSS, without any of the characters that HTML escapes.
    *body : Html or str
    """
    head = element(
        "head",
        element("meta", charset="utf-8"),
        element("meta", name="viewport", content="width=device-width, initial-scale=1"),
        element("title", title),
        element("style", style),
    )
    return f"<!doctype html>{element('html', head, element('body', *body), lang='en')}"


def _cell(child: Html | str) -> Html:
    already = isinstance(child, Html) and str(child).startswith(("<td", "<th"))
    return child if already and isinstance(child, Html) else element("td", child)


def _inside(child: Html | str) -> str:
    # Any other value, even a number, is escaped as text.
    return child._markup if type(child) is Html else _escaped(str(child))


def _escaped(text: str) -> str:
    return escape(text if text.isprintable() else _UNFIT.sub("\ufffd", text))


def escape(text: str) -> str:
    """Return a text with markup characters escaped.

    It replaces `html.escape`, because the import of that module takes a millisecond.
    """
    text = text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")
    return text.replace('"', "&quot;").replace("'", "&#x27;")


def _made(markup: str) -> Html:
    made = object.__new__(Html)
    made._markup = markup
    return made
