"""The source folder for Sphinx: docs/, the notebooks, pages from outside docs/, and generated pages.

Nothing is written into docs/. A page is only written if it changed, so that Sphinx reads only changed pages again.
"""

from __future__ import annotations

import posixpath
import re
from collections.abc import Iterator
from pathlib import Path

from jointid.identification.warnings.registry import finding_types

ROOT = Path(__file__).resolve().parents[2]
# Pages from outside docs/, by their path in the repository and on the site.
ELSEWHERE = {
    "CHANGELOG.md": "changelog.md",
    "examples/README.md": "examples.md",
    "examples/data/README.md": "example_data.md",
}
# Files without a page of their own, and the page that replaces each.
INSTEAD = {
    "README.md": "index.md",
    "notebooks": "index.md#notebooks",
    "examples": "examples.md",
    "CITATION.cff": "reports.md#cite",
}
_LINK = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s]+)\)")
_CODE = re.compile(r"(^```.*?^```|^~~~.*?^~~~|`[^`\n]+`)", re.DOTALL | re.MULTILINE)
# Pages that exist only in the repository: on the site, a link to one of them is only its text.
_OFF_THE_SITE = ("docs/contributors/", "CONTRIBUTING.md", "SECURITY.md")
# Files of docs/ that are for Sphinx itself, or on no page.
_ENDINGS = (".md", ".png", ".svg", ".csv", ".css", ".js", ".html")


class Stage:
    """The source folder, and the files that this run has written."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._kept: set[Path] = set()

    def write(self, name: str, text: str) -> None:
        """Write a page."""
        self.write_bytes(name, text.encode())

    def write_bytes(self, name: str, content: bytes) -> None:
        """Write a file, unless it exists already."""
        path = self.folder / name
        self._kept.add(path)
        if path.is_file() and path.read_bytes() == content:
            return
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)

    def page(self, home: str, name: str) -> None:
        """Write a page of the repository, with its links changed to their targets on the site."""
        text = _without_missing((ROOT / home).read_text(encoding="utf-8"))
        self.write(name, self.relinked(text, home, name))

    def relinked(self, text: str, home: str, name: str) -> str:
        """Return a page's text with its links as on the site.

        Parameters
        ----------
        text : str
            The page.
        home, name : str
            Its place in the repository, and on the site.
        """
        parts = _CODE.split(text)
        # A link's text may contain code. So links are searched in the whole text, except within code.
        hidden = {f"\0{number}\0": part for number, part in enumerate(parts) if number % 2}
        shown = "".join(f"\0{i}\0" if i % 2 else part for i, part in enumerate(parts))

        def moved(found: re.Match[str]) -> str:
            picture, label, target = found.groups()
            if re.match(r"[a-z]+:|#", target):
                return found[0]
            code = hidden.get(label, label).strip("`")
            if target.endswith("findings.md") and code in finding_types():
                return f"[{label}]({posixpath.relpath('findings.md', posixpath.dirname(name) or '.')}#{code})"
            there = self._place(posixpath.normpath(posixpath.join(posixpath.dirname(home), target)))
            if there is None:
                return label
            return f"{picture}[{label}]({posixpath.relpath(there, posixpath.dirname(name) or '.')})"

        shown = _LINK.sub(moved, shown)
        for mark, part in hidden.items():
            shown = shown.replace(mark, part)
        return shown

    def _place(self, target: str) -> str | None:
        """Return a file's path on the site; None if it is not there (a folder or a contributors' page)."""
        path, hash_sign, anchor = target.partition("#")
        for known, there in (*INSTEAD.items(), *ELSEWHERE.items()):
            if target == known:
                return there
            if path == known:
                return there if known in INSTEAD else there + hash_sign + anchor
        if path.startswith(_OFF_THE_SITE):
            return None
        if path.startswith("docs/") and path.endswith(_ENDINGS):  # also generated pages
            return target.removeprefix("docs/")
        if path.startswith("notebooks/"):
            return target.replace("notebooks/", "tutorials/", 1)
        file = ROOT / path
        if not file.is_file():
            return None
        self.write_bytes(f"repository/{path}", file.read_bytes())
        return f"repository/{path}"

    def finish(self) -> bool:
        """Remove files that an earlier run wrote and this one did not; return whether there were any."""
        old = [path for path in self.folder.rglob("*") if path.is_file() and path not in self._kept]
        # Pictures of notebooks are written while they are read.
        old = [path for path in old if path.parent != self.folder / "tutorials" / "pictures"]
        for path in old:
            path.unlink()
        return bool(old)


def stage_documents(stage: Stage) -> None:
    """Write everything that no program generates."""
    for path in _documents():
        place = path.relative_to(ROOT / "docs").as_posix()
        if place == "findings.md":
            continue  # it gets pictures: findings_gallery
        if path.suffix == ".md":
            stage.page(f"docs/{place}", place)
        else:
            stage.write_bytes(place, path.read_bytes())
    for home, name in ELSEWHERE.items():
        stage.page(home, name)
    for path in sorted((ROOT / "notebooks").glob("*.ipynb")):
        for folder in ("tutorials", "as_it_is/notebooks"):  # as a page, and for download
            stage.write_bytes(f"{folder}/{path.name}", path.read_bytes())


def _without_missing(text: str) -> str:
    """Leave out lines "? title <page>" without a page yet; in the others, remove the question mark."""

    def kept(found: re.Match[str]) -> str:
        there = (ROOT / "docs" / f"{found[2]}.md").is_file()
        return f"{found[1]} <{found[2]}>\n" if there else ""

    return re.sub(r"^\? (.+) <([\w/]+)>\n", kept, text, flags=re.MULTILINE)


def _documents() -> Iterator[Path]:
    """Return the files of docs/ that go to the site unchanged."""
    for path in sorted((ROOT / "docs").rglob("*")):
        place = path.relative_to(ROOT).as_posix()
        if path.is_file() and path.suffix in _ENDINGS and not place.startswith(_OFF_THE_SITE):
            yield path
