"""Whatever stands anywhere in a file that is read back: one sentence that names the file, or no harm."""

import ast
import os
import sys
from collections.abc import Iterator
from functools import cache
from importlib.metadata import entry_points
from pathlib import Path
from tempfile import TemporaryDirectory
from types import FrameType

import pytest
from read_back.example import Example
from read_back.registry import EXAMPLES, OTHERS

import jointid as jid
from jointid.hardware.bench import drive_types

_PACKAGE = Path(jid.__file__).resolve().parent
_LONGEST = 600  # characters of a sentence
# Each value at every place takes minutes: `make fuzz`. Else each place has a quarter of them, in turn.
_EVERY = 1 if os.environ.get("JOINTID_READ_BACK") == "all" else 4


@cache
def example(name: str) -> Example:
    """Made once."""
    return EXAMPLES[name]()


@pytest.fixture
def folder(monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """In memory, where there is such a place, since thousands of files are written; plug-ins are looked up once."""
    installed = entry_points(group=drive_types.ENTRY_POINTS)
    monkeypatch.setattr(
        drive_types,
        "entry_points",
        lambda **name: installed.select(**{k: v for k, v in name.items() if k != "group"}),
    )
    memory = Path("/dev/shm")
    with TemporaryDirectory(dir=memory if memory.is_dir() else None) as name:
        yield Path(name)


def written(example: Example, folder: Path, text: str) -> Path:
    """The file, with those beside it."""
    for other, content in example.beside.items():
        (folder / other).write_bytes(content)
    path = folder / example.name
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize("name", EXAMPLES)
def test_every_reader_reads_its_example(name: str, folder: Path) -> None:
    """Without a change it is valid, and the readers that the table names are those that run."""
    read = example(name)
    path = written(read, folder, read.text())
    seen: set[str] = set()

    def note(frame: FrameType, event: str, _: object) -> None:
        if event == "call":
            seen.add(frame.f_code.co_filename)

    sys.setprofile(note)
    try:
        read.use(path)
    finally:
        sys.setprofile(None)
    for module in read.modules:
        assert str(_PACKAGE / f"{module.replace('.', '/')}.py") in seen, module


@pytest.mark.filterwarnings("ignore:.*(overflow|invalid value|divide by zero):RuntimeWarning")
@pytest.mark.parametrize("every", [8 * _EVERY, pytest.param(_EVERY, marks=pytest.mark.slow)])
@pytest.mark.parametrize("name", EXAMPLES)
def test_any_value_anywhere_is_one_sentence_or_harmless(
    name: str, every: int, folder: Path
) -> None:
    read = example(name)
    wrong = []
    for line, place, value in read.changes(every=every):
        said = fault(read, written(read, folder, read.text(line, place, value)))
        if said:
            wrong.append(f"line {line}, {place} = {value[:40]}: {said}")
    assert not wrong, f"{len(wrong)} faults\n" + "\n".join(wrong[:30])


def fault(read: Example, path: Path) -> str:
    """What is wrong with how a file is read; nothing if it is refused in one sentence that names it, or accepted."""
    try:
        read.use(path)
    except jid.InputError as error:
        sentence = str(error)
        if "\n" in sentence or not 10 < len(sentence) < _LONGEST or path.stem not in sentence:
            return f"no sentence that names the file: {sentence[:_LONGEST]}"
    except Exception as error:
        return f"{type(error).__name__}: {error}"
    return ""


_DECODERS = {"loads", "read_text", "read_bytes", "read_json", "read_toml", "from_bytes", "File"}


def _reads(call: ast.Call) -> bool:
    """Whether a call reads a file, or decodes a text of one."""
    name = call.func.attr if isinstance(call.func, ast.Attribute) else getattr(call.func, "id", "")
    of = getattr(call.func.value, "id", "") if isinstance(call.func, ast.Attribute) else ""
    if name == "open" and isinstance(call.func, ast.Attribute) and of not in ("os", "reader"):
        mode = call.args[0] if call.args else ast.Constant("r")
        return isinstance(mode, ast.Constant) and not set(str(mode.value)) & set("wax+")
    return name in _DECODERS and of != "int" and (name != "loads" or bool(of))


def test_every_reader_is_in_the_table() -> None:
    """Whoever adds a file that is read back adds a valid example of it."""
    pytest.importorskip("pinocchio")  # without it there are no examples of robots
    reading = {
        ".".join(path.relative_to(_PACKAGE).with_suffix("").parts)
        for path in _PACKAGE.rglob("*.py")
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Call) and _reads(node)
    }
    shown = {module for name in EXAMPLES for module in example(name).modules}
    assert reading - shown - OTHERS.keys() == set()
    assert OTHERS.keys() - reading == set()
