"""The mutants' tool: a place that is gone is an error, and verdicts, page and switched sources are what they say."""

import dataclasses
import os
import shutil
import subprocess
import sys
from contextlib import nullcontext
from pathlib import Path

import pytest

TOOLS = Path(__file__).resolve().parents[2] / "tools"
sys.path.insert(0, str(TOOLS))

from measured_page import PAGE  # noqa: E402
from mutants.catalogue import Mutant, MutantError, check_places, read  # noqa: E402
from mutants.kept import VERDICTS, Kept  # noqa: E402
from mutants.page import complaints, summary, written  # noqa: E402
from mutants.running import Verdict  # noqa: E402
from mutants.switched_sources import SWITCH, switched  # noqa: E402

_UNITS = "python/jointid/recording/units.py"
_TESTS = "tests/recording/test_units.py"


def listed(folder: Path, *mutants: str) -> Path:
    """A folder with one list."""
    lists = folder / "lists"
    lists.mkdir()
    rows = ",\n".join(mutants)
    text = f"[[file]]\npath = '{_UNITS}'\ntests = ['{_TESTS}']\nmutants = [\n{rows}\n]\n"
    (lists / "room.toml").write_text(text)
    return lists


def verdict(of: Mutant, by: str = "test") -> Verdict:
    return Verdict(mutant=of, killed=bool(by), by=by, seconds=1.0, date="2026-11-23")


def mutant(number: int, line: str, was: str, becomes: str, justified: str = "") -> Mutant:
    return Mutant(
        number=number,
        room="core",
        path="cpp/toy.cpp",
        line=line,
        was=was,
        becomes=becomes,
        checks=("",),
        justified=justified,
    )


def test_every_mutant_has_its_place() -> None:
    mutants = read()
    check_places(mutants)
    assert len(mutants) >= 200
    assert {each.room for each in mutants} == {
        *("causes", "core", "findings", "inference", "units", "codec", "guard", "recorder"),
    }


def test_a_verdict_is_kept_until_its_line_changes(tmp_path: Path) -> None:
    files = ("part.py", "test_part.py", "cpp/tests/check_part.cpp")
    for name in files:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text("x = 1\n")
    one, other, later = (
        dataclasses.replace(
            mutant(k, "x", "x", "yzw"[k]), path="part.py", tests=("test_part.py::a",)
        )
        for k in range(3)
    )
    folder = tmp_path / "verdicts"

    def kept(*mutants: Mutant) -> Kept:
        return Kept(folder, mutants, tmp_path)

    killed, survived = verdict(one), verdict(other, by="")
    kept(one).add(killed)
    kept(one, other).add(survived)
    assert kept(other, one).find([one, other]) == [killed, survived]
    moved = dataclasses.replace(one, number=7)
    assert kept(later, moved).find([moved, later]) == [dataclasses.replace(killed, mutant=moved)]
    for name in files:  # the next run tries it again
        (tmp_path / name).write_text("x = 2\n")
        assert kept(one).find([one])
        assert not kept(one).current([one])
        (tmp_path / name).write_text("x = 1\n")
        assert kept(one).current([one])
    kept(one, later).add(verdict(later))
    assert len((folder / "core.csv").read_text().splitlines()) == 3  # that of `other` is gone
    (folder / "core.csv").write_text("<<<<<<< torn\n")
    assert not kept(one).find([one])


@pytest.mark.parametrize(
    ("row", "said"),
    [
        ("{ was = 'no such text', becomes = '' }", "the line `no such text` is no longer there"),
        ("{ was = 'factor', becomes = '' }", "the line `factor` stands there"),
        (
            "{ line = '_TURN = 2.0', was = '3.0', becomes = '' }",
            "the part `3.0` is no longer there",
        ),
        ("{ was = '_TURN = 2.0' }", "has no becomes"),
        ("{ was = '_TURN = 2.0', becomes = '', killed = true }", "unknown field 'killed'"),
        ("{ was = '_TURN = 2.0', becomes = '_TURN = 2.0' }", "changes one line"),
    ],
)
def test_a_wrong_list_is_told(row: str, said: str, tmp_path: Path) -> None:
    with pytest.raises(MutantError, match=said.replace("(", r"\(")):
        check_places(read(listed(tmp_path, row)))


@pytest.mark.parametrize(
    ("was", "becomes", "refused"),
    [
        ("(a + b", "(a", True),
        ("/ 3.0", "/ 2.0", True),
        ("3.0", "2.0", False),
        ("x = 1;", "", False),
    ],
)
def test_what_cpp_cannot_switch_is_told(
    was: str, becomes: str, refused: bool, tmp_path: Path
) -> None:
    lists = listed(tmp_path, f"{{ was = '{was}', becomes = '{becomes}' }}")
    written_for = (lists / "room.toml").read_text()
    (lists / "room.toml").write_text(written_for.replace(_UNITS, "cpp/part.cpp"))
    with pytest.raises(MutantError, match="of its own") if refused else nullcontext():
        read(lists)


def test_a_justified_survivor_passes_and_is_counted_on_the_page() -> None:
    texts = [f"x = {k};" for k in range(11)]
    verdicts = [
        verdict(
            mutant(k, text, str(k), "y", "the same" if k == 10 else ""), "test" if k < 10 else ""
        )
        for k, text in enumerate(texts)
    ]
    assert complaints(verdicts) == []
    assert summary(verdicts) == "11 mutants: 10 killed, 1 justified, 0 survived"
    page = written(verdicts[1:], [each.mutant for each in verdicts])
    assert "| core | 11 | 9 | 1 | 0 | 1 | 2026-11-23 |" in page


def test_the_page_is_of_these_lists() -> None:
    """A run writes it: after a list has changed there must be another."""
    mutants = read()
    verdicts = Kept(VERDICTS, mutants).find(mutants)
    assert written(verdicts, mutants) in PAGE.read_text("utf-8")
    assert complaints(verdicts) == []


TOY = """#include <cstdio>
constexpr double kLimit = 2.0;
int answer(double x) {
  int count = 0;
  count += 5;
  for (int i = 0; i < 3; ++i) count += x > kLimit ? 10 * (i + 1) : 1;
  return count;
}
int main() { std::printf("%d %d\\n", answer(1.0), answer(3.0)); }
"""
_LOOP = "count += x > kLimit ? 10 * (i + 1) : 1;"


@pytest.mark.skipif(shutil.which("g++") is None, reason="needs a C++ compiler")
def test_all_mutants_of_a_source_are_in_one_program(tmp_path: Path) -> None:
    mutants = [
        mutant(1, "constexpr double kLimit = 2.0;", "2.0", "0.5"),
        mutant(2, "constexpr double kLimit = 2.0;", "2.0", "5.0"),
        mutant(3, "count += 5;", "count += 5;", ""),
        mutant(4, "i < 3", "i < 3", "i < 2"),
        mutant(5, _LOOP, "10 * (i + 1)", "0"),
        mutant(6, _LOOP, "i + 1", "i"),  # within another
    ]
    text = switched(TOY, mutants)
    assert text.splitlines()[1] == "#line 1"
    (tmp_path / "toy.cpp").write_text(text)
    (tmp_path / "switch.cpp").write_text(SWITCH)
    program = tmp_path / "toy"
    sources = [tmp_path / "toy.cpp", tmp_path / "switch.cpp"]
    subprocess.run(["g++", "-std=c++20", "-Wall", "-Werror", "-o", program, *sources], check=True)
    said = []
    for number in range(7):
        inside = os.environ | {"JOINTID_MUTANT": str(number)}
        done = subprocess.run([program], capture_output=True, text=True, env=inside, check=True)
        said.append(done.stdout.strip())
    assert said == ["8 65", "65 65", "8 8", "3 60", "7 35", "8 5", "8 35"]


def test_mutants_that_overlap_are_refused() -> None:
    crossing = [mutant(1, _LOOP, "x > kLimit ? 10", "x"), mutant(2, _LOOP, "10 * (i + 1)", "1")]
    with pytest.raises(MutantError, match="overlap"):
        switched(TOY, crossing)
