"""Adding a file format takes one new file and one line of a list; all that names formats follows."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from recording_files import GOOD, lines, refusal, written

import jointid
from jointid.recording.readers import registry
from jointid.recording.readers.csv_reader import CsvTable
from jointid.recording.readers.loading import load
from jointid.recording.readers.reader import Reader

PACKAGE = Path(jointid.__file__).parent
REGISTRY = Path("recording", "readers", "registry.py")

# The new file: text whose cells are separated by "|".
BAR_READER = '''"""Reading .bar files: text whose cells are separated by |."""

import tempfile
from pathlib import Path

from jointid.recording.readers.csv_reader import CsvTable
from jointid.recording.readers.reader import Reader


def opened(path: Path) -> CsvTable:
    with tempfile.TemporaryDirectory() as folder:
        text = Path(folder, "run.csv")
        text.write_text(path.read_text().replace("|", ","))
        return CsvTable(text)


READER = Reader(endings=(".bar", ".pipe"), open=opened)
'''


def run(package: Path, *command: str) -> str:
    # Without `site` no editable install can put its own package before this one.
    places = os.pathsep.join([str(package.parent), *sys.path])
    done = subprocess.run(
        [sys.executable, "-S", *command],
        env={**os.environ, "PYTHONPATH": places, "COLUMNS": "200"},
        cwd=package.parent,
        capture_output=True,
        text=True,
        check=False,
    )
    return done.stdout + done.stderr


@pytest.mark.slow
def test_one_file_and_one_line_add_a_format(tmp_path: Path) -> None:
    package = tmp_path / "jointid"
    shutil.copytree(PACKAGE, package, ignore=shutil.ignore_patterns("__pycache__"))
    for core in Path(jointid._core.__file__).parent.glob("_core*.so"):  # an editable install's
        shutil.copy(core, package)
    (package / REGISTRY.parent / "bar_reader.py").write_text(BAR_READER, encoding="utf-8")
    before = (package / REGISTRY).read_text(encoding="utf-8")
    last = f'    "{registry.MODULES[-1]}",\n'
    after = before.replace(last, f'{last}    "bar_reader",\n')
    assert len(after.splitlines()) == len(before.splitlines()) + 1
    (package / REGISTRY).write_text(after, encoding="utf-8")
    for name in ("run.bar", "run.pipe"):
        written(tmp_path / name, "\n".join(GOOD).replace(",", "|"))
    written(tmp_path / "run.xyz", GOOD)

    script = "import jointid, sys; print(jointid.__file__); print(len(jointid.load(sys.argv[1])))"
    for name in ("run.bar", "run.pipe"):
        assert run(package, "-c", script, name).split() == [str(package / "__init__.py"), "10"]
    listed = f"{', '.join([*registry.endings(), '.bar'])} or .pipe"
    assert listed in run(package, "-c", script, "run.xyz")
    for command in ("identify", "info", "compare", "sweep"):
        assert listed in run(package, "-m", "jointid", command, "--help"), command


def test_every_reader_is_in_the_list() -> None:
    files = {path.stem for path in (PACKAGE / REGISTRY.parent).glob("*_reader.py")}
    assert files == set(registry.MODULES)
    assert len(tuple(registry.readers())) == len(registry.MODULES)


def test_no_two_readers_claim_an_ending() -> None:
    """The first reader that reads an ending is taken, and those behind it are not imported."""
    endings = registry.endings()
    assert len(set(endings)) == len(endings)
    both = [(one, other) for one in registry.readers() for other in registry.readers()]
    for one, other in both:
        assert one.endings == other.endings or not [
            each for each in one.endings if each.endswith(other.endings)
        ]
    assert all(re.fullmatch(r"(\.[a-z0-9]+)+", ending) for ending in registry.endings())


def test_an_ending_without_a_reader_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It is not read as text, although it holds text."""
    path = written(tmp_path / "run.parquet", GOOD)
    left = tuple(each for each in registry.MODULES if each != "parquet_reader")
    monkeypatch.setattr(registry, "MODULES", left)
    assert refusal(path) == (
        f"{path}: a file name that ends in .csv, .csv.gz, .txt, .tsv, .log, .dat, .npz, .mat, .mcap, "
        ".bag, .db3, .h5, .hdf5, .json or .wpilog is expected"
    )


def test_a_missing_package_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def without(path: Path) -> CsvTable:
        raise ModuleNotFoundError(name="asammdf.blocks")

    reader = Reader(endings=(".mf4",), open=without, package="asammdf")
    monkeypatch.setattr(registry, "readers", lambda: iter([reader]))
    path = written(tmp_path / "run.mf4", lines("t,q"))
    assert refusal(path) == (
        f"{path}: reading .mf4 files needs asammdf, which is not installed; "
        "pip install asammdf or save the file as .csv"
    )


def test_another_failed_import_is_a_bug_not_bad_input(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(path: Path) -> CsvTable:
        raise ModuleNotFoundError(name="jointid.recording.csv")

    for package in ("", "asammdf"):
        reader = Reader(endings=(".mf4",), open=broken, package=package)
        monkeypatch.setattr(registry, "readers", lambda reader=reader: iter([reader]))
        with pytest.raises(ModuleNotFoundError):
            load(written(tmp_path / "run.mf4", lines("t,q")))
