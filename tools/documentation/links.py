"""Check that each link of the built site leads to a page and a place on it, and that no other host is used."""

from __future__ import annotations

from collections.abc import Iterator
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

_LOADING = {
    ("link", "href"),
    ("script", "src"),
    ("img", "src"),
    ("source", "src"),
    ("iframe", "src"),
}


class Page(HTMLParser):
    """The links of a page, the names of its places, and the files that it loads."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.links: list[str] = []
        self.loaded: list[str] = []
        self.places: set[str] = set()
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Keep the links, loaded files and names of an element."""
        for name, value in attrs:
            if name in ("id", "name") and value:
                self.places.add(value)
            if name in ("href", "src") and value:
                (self.loaded if (tag, name) in _LOADING else self.links).append(value)


def pages_of(site: Path) -> dict[Path, Page]:
    """Return every page of a site by its path within the site."""
    return {
        path.relative_to(site): Page(path.read_text(encoding="utf-8"))
        for path in sorted(site.rglob("*.html"))
    }


def broken(site: Path) -> Iterator[str]:
    """Yield the faults of a site's links, one sentence each."""
    pages = pages_of(site)
    for page, found in pages.items():
        for target in found.loaded:
            if urlsplit(target).scheme not in ("", "data") or urlsplit(target).netloc:
                yield f"{page} loads {target} from another host"
        for target in (*found.links, *found.loaded):
            parts = urlsplit(target)
            if parts.scheme or parts.netloc:
                continue
            path = (site / page).parent / unquote(parts.path) if parts.path else site / page
            if parts.path.startswith("/") or not path.is_file():
                yield f"{page} links to {target}, which is not there"
                continue
            there = pages.get(path.resolve().relative_to(site.resolve()))
            if parts.fragment and there and unquote(parts.fragment) not in there.places:
                yield f"{page} links to {target}, a place that is not on that page"
