"""The page of measured results has each study's part as the study writes it, and nothing else."""

import re
import shlex
import sys
from importlib import import_module

import pytest
from documents import ROOT, blocks, read

pytest.importorskip("pinocchio")
pytest.importorskip("scipy")

sys.path.insert(0, str(ROOT / "benchmarks"))
from measured_page import PAGE, Part, placed

FILES = [*(ROOT / "benchmarks").rglob("*.py"), *(ROOT / "tools" / "mutants").glob("*.py")]
WRITERS = sorted(path for path in FILES if re.search(r"= Part\($", path.read_text("utf-8"), re.M))
TEXT = PAGE.read_text(encoding="utf-8")


def parts() -> list[Part]:
    """Of all studies."""
    names = [
        path.stem if path.parent.name == "benchmarks" else f"{path.parent.name}.{path.stem}"
        for path in WRITERS
    ]
    found = {id(each): each for name in names for each in vars(import_module(name)).values()}
    return [each for each in found.values() if isinstance(each, Part)]


def written_as(text: str) -> str:
    """What a text becomes when its facts are filled in, as a regular expression."""
    return ".+?".join(map(re.escape, re.split(r"\{\w+(?::[^}]*)?\}", text)))


@pytest.mark.parametrize("part", parts(), ids=lambda part: part.title)
def test_a_part_stands_on_the_page_as_its_study_writes_it(part: Part) -> None:
    block = re.search(
        rf"^### {re.escape(part.title)}\n\n(.*?)(?=^##|\Z)", TEXT, re.DOTALL | re.MULTILINE
    )
    assert block
    asked, *rest = block[1].strip().split("\n\n")
    asked = " ".join(asked.split())
    when = r"( \*\d{4}-\d\d-\d\d, commit [0-9a-f]{8}(-dirty)?\*)?"
    assert re.fullmatch(written_as(part.asked) + when, asked)
    if part.header:
        head, _, *rows = rest.pop(0).splitlines()
        assert head == f"| {' | '.join(part.header)} |"
        assert rows
        assert {row.count("|") for row in rows} == {len(part.header) + 1}
    assert len(rest) == bool(part.reading)
    assert not rest or re.fullmatch(written_as(part.reading), " ".join(rest[0].split()))


def test_every_part_of_the_page_has_its_study() -> None:
    headings = re.findall(r"^### (.*)$", TEXT, re.MULTILINE)
    assert sorted(headings) == sorted(part.title for part in parts())


def test_a_part_replaces_itself_alone() -> None:
    part = Part(title="B", asked="How many? {n} runs.", header=("a", "b"), reading="Few.")
    page = "# M\n\n### A\n\nx\n\n### B\n\nold\n\n## C\n\n### D\n\ny\n"
    new = part.text([("1", 2)], "today", n=3)
    assert new == "### B\n\nHow many? 3 runs. *today*\n\n| a | b |\n|---|---|\n| 1 | 2 |\n\nFew.\n"
    assert placed(page, new) == page.replace("### B\n\nold\n", new)
    assert placed(placed(page, new), new) == placed(page, new)
    last = Part(title="D", asked="z").text(())
    assert placed(page, last) == page.replace("y\n", "z\n")
    with pytest.raises(ValueError, match="'### E' 0 times"):
        placed(page, Part(title="E", asked="").text(()))
    with pytest.raises(ValueError, match="1 cells below 2 columns"):
        part.text([("1",)], n=3)


def test_the_page_on_measuring_names_each_program_and_its_options() -> None:
    how = read("docs/contributors/measuring.md")
    makefile = read("Makefile")
    for path in (ROOT / "benchmarks").glob("*.py"):
        text = path.read_text("utf-8")
        if "argparse" in text and re.search(r"publish(_all)?\(", text):
            assert f"`{path.name}`" in how, path.name
            by_hand = path.stem in ("design_study", "servo_study")
            assert (f"benchmarks/{path.name}" in makefile) != by_hand, path.name
    (block,) = blocks(how, "sh")
    for line in block.splitlines():
        _, program, *words = shlex.split(line, comments=True)
        options = [word for word in words if word.startswith("--")]
        assert options
        assert all(f'"{option}"' in read(program) for option in options)
