"""Edit attributes of one XML element in place. Everything else keeps its bytes."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from xml.parsers import expat

from jointid.base.errors import InputError

MARK = "jointid:"
_PAIR = re.compile(rb"""(\s+)([^\s=/>]+)(\s*=\s*)("[^"]*"|'[^']*')""")


@dataclass(frozen=True, slots=True)
class Element:
    """One element of an XML text."""

    tag: str
    attributes: Mapping[str, str]
    path: tuple[str, ...]  # tags of the enclosing elements, outermost first
    start: int  # position of its start tag
    inner: int  # position after its start tag
    stop: int  # position of its end tag; `inner` for an element without one
    parent: int  # index of the enclosing element in the list of all; -1 for the root


def elements(content: bytes, place: str) -> list[Element]:
    """Return all elements of an XML text, in the order of their start tags."""
    try:
        readable = "\0" not in content.decode("utf-8")
    except UnicodeDecodeError:
        readable = False
    if not readable:
        raise InputError("text in UTF-8 is expected", place=place, remedy="save the file as UTF-8")
    found: list[Element] = []
    open_: list[int] = []
    parser = expat.ParserCreate()

    def begin(tag: str, attributes: dict[str, str]) -> None:
        start = parser.CurrentByteIndex
        if content[start : start + 1] != b"<":  # it is in the text of an entity
            raise InputError("elements in entities cannot be edited", place=place)
        path = tuple(found[each].tag for each in open_)
        end = tag_end(content, start)
        parent = open_[-1] if open_ else -1
        open_.append(len(found))
        found.append(Element(tag, attributes, path, start, end, end, parent))

    def end(tag: str) -> None:
        number = open_.pop()
        each = found[number]
        stop = max(parser.CurrentByteIndex, each.inner)
        if content[each.inner - 2 : each.inner] == b"/>":
            stop = each.inner
        found[number] = Element(
            tag, each.attributes, each.path, each.start, each.inner, stop, each.parent
        )

    parser.StartElementHandler = begin
    parser.EndElementHandler = end
    try:
        parser.Parse(content, True)
    except expat.ExpatError as error:
        reason = expat.ErrorString(error.code)
        raise InputError(f"not XML: {reason}", place=f"{place}, line {error.lineno}") from None
    return found


def tag_end(content: bytes, start: int) -> int:
    """Return the position after a start tag. An attribute's value may contain `>`."""
    quote = b""
    for at in range(start, len(content)):
        byte = content[at : at + 1]
        if quote:
            quote = b"" if byte == quote else quote
        elif byte in (b'"', b"'"):
            quote = byte
        elif byte == b">":
            return at + 1
    return len(content)


def with_attributes(content: bytes, element: Element, changes: Mapping[str, str]) -> bytes:
    """Return the text with some attributes of one element set. New attributes come last."""
    tag = content[element.start : element.inner]
    left = dict(changes)

    def replaced(found: re.Match[bytes]) -> bytes:
        name = found[2].decode()
        if name not in left:
            return found[0]
        return found[1] + found[2] + found[3] + attribute(left.pop(name)).encode()

    tag = _PAIR.sub(replaced, tag)
    closing = b"/>" if tag.endswith(b"/>") else b">"
    body = tag[: -len(closing)]
    kept = body.rstrip()
    added = b"".join(f" {name}={attribute(value)}".encode() for name, value in left.items())
    tag = kept + added + body[len(kept) :] + closing
    return content[: element.start] + tag + content[element.inner :]


def with_comment(content: bytes, element: Element, lines: Sequence[str]) -> bytes:
    """Return the text with a comment before an element. It replaces an earlier comment of ours."""
    before = content[: element.start]
    newline = b"\r\n" if b"\r\n" in content else b"\n"
    indent = re.search(rb"[ \t]*\Z", before)
    space = indent[0] if indent else b""
    before = before[: len(before) - len(space)]
    earlier = re.search(rb"[ \t]*<!-- " + MARK.encode() + rb"(?:(?!-->).)*-->\r?\n\Z", before, re.S)
    if earlier:
        before = before[: earlier.start()]
    text = comment(lines, space.decode()).replace("\n", newline.decode()).encode()
    return before + space + text + newline + space + content[element.start :]


def comment(lines: Sequence[str], indent: str = "") -> str:
    """Return an XML comment. Two dashes would end it, so they are separated."""
    safe = [re.sub(r"-(?=-)", "- ", _characters(line)).rstrip("-") for line in lines]
    return f"<!-- {MARK} " + f"\n{indent}     ".join(safe) + " -->"


def _characters(text: str) -> str:
    """Return text without characters that XML does not allow."""
    return "".join(c for c in text if c in "\t" or (c >= " " and not "\ud800" <= c <= "\udfff"))


def attribute(value: str) -> str:
    """Return an attribute's value with quotes."""
    from xml.sax.saxutils import (
        quoteattr,  # imports the standard library's network clients, so only when a file is written
    )

    return quoteattr(_characters(value))


def text(value: str) -> str:
    """Return text between tags."""
    from xml.sax.saxutils import escape

    return escape(_characters(value))


def only(
    found: Sequence[Element],
    name: str,
    is_joint: Callable[[Element], bool],
    place: str,
    suggestion: Callable[[str, list[str]], str],
) -> Element:
    """Return the only joint with a name."""
    joints = [each for each in found if is_joint(each)]
    named = [each for each in joints if each.attributes.get("name") == name]
    if len(named) == 1:
        return named[0]
    if named:
        raise InputError(
            "several joints have this name", argument="joint_name", value=name, place=place
        )
    known = [each.attributes["name"] for each in joints if each.attributes.get("name")]
    says = suggestion(name, known) if known else "no joint in this file has a name"
    includes = any(each.tag in ("include", "xacro:include") for each in found)
    also = "; files that this file includes are not searched" if includes else ""
    raise InputError(
        f"there is no such joint; {says}{also}", argument="joint_name", value=name, place=place
    )
