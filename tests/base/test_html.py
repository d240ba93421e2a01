"""A page is built of elements, and nothing else gets in."""

import pytest

from jointid.base.html import Html, element, page, table


def test_texts_and_attributes_are_escaped() -> None:
    assert str(element("p", "<b>", alt="'\">")) == '<p alt="&#x27;&quot;&gt;">&lt;b&gt;</p>'
    assert str(element("p", element("b", "a & b"))) == "<p><b>a &amp; b</b></p>"
    assert "<i>" not in str(table([["<i>", element("th", "<i>")]], head=["<i>"], class_="<i>"))
    whole = page("<i>", "p { color: #222; }", "<i>")
    assert whole.startswith("<!doctype html>")
    assert "<i>" not in whole


def test_characters_that_no_document_holds_are_replaced() -> None:
    """A page is written as UTF-8 and read by strict parsers, whatever a file's name holds."""
    made = str(element("p", "a\x00b\udce9c\ufffe\n\td é", class_="\x1b[31m"))
    assert made == '<p class="\ufffd[31m">a\ufffdb\ufffdc\ufffd\n\td é</p>'
    assert made.encode()


def test_markup_in_a_text_is_no_markup() -> None:
    class Text(str):
        """A text that claims to be markup."""

        _markup = "<script>"

    assert str(element("p", Text("<script>"))) == "<p>&lt;script&gt;</p>"
    assert str(element("p", f"{element('b', 'x')}")) == "<p>&lt;b&gt;x&lt;/b&gt;</p>"
    with pytest.raises(TypeError, match="element"):
        Html()


@pytest.mark.parametrize("tag", ["script", "p onclick", "iframe", "SCRIPT"])
def test_other_elements_are_refused(tag: str) -> None:
    with pytest.raises(ValueError, match="no element"):
        element(tag)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("onclick", "alert(1)"),
        ("src", "http://a.b/c.png"),
        ("src", "data:text/html;base64,AA=="),
        ("href", "javascript:alert(1)"),
        ("href", "#a b"),
    ],
)
def test_other_attributes_are_refused(name: str, value: str) -> None:
    with pytest.raises(ValueError, match="no attribute"):
        element("img", **{name: value})
