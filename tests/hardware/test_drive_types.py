"""Drive types: found by name, nothing else names a make of drive, and hardware is independent of analysis."""

import io
import subprocess
import sys
from collections.abc import Iterator
from importlib.metadata import EntryPoint, EntryPoints
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from house_rules import _imported

import jointid as jid
from jointid.cli.command_line import main
from jointid.hardware.bench import drive_types
from jointid.hardware.bench.bench import DriveType, drive_type
from jointid.hardware.bench.drive_types import drive_type_names

PACKAGE = Path(jid.__file__).parent
EXAMPLE = Path(__file__).parents[2] / "examples" / "hardware" / "joint.toml"
# The make, its emulation, and the registry: nothing else knows of it.
AT_HOME = ("hardware/elmo/", "hardware/emulated/", "hardware/bench/drive_types.py")


def test_only_its_own_folder_names_a_make_of_drive() -> None:
    found = [
        place
        for path in sorted(PACKAGE.rglob("*.py*"))
        if path.suffix in {".py", ".pyi"}
        and not (place := path.relative_to(PACKAGE).as_posix()).startswith(AT_HOME)
        and "elmo" in path.read_text(encoding="utf-8").lower() + place.lower()
    ]
    assert found == []


def imports(module: Path) -> Iterator[Path]:
    """Modules of ours that a module imports, inside functions too."""
    name = ".".join(module.relative_to(PACKAGE).with_suffix("").parts)
    for _, target, _ in _imported(module.read_text(encoding="utf-8"), name, PACKAGE):
        first, *parts = target.split(".")
        inner = PACKAGE.joinpath(*parts)
        if first == "jointid" and parts:
            yield inner / "__init__.py" if inner.is_dir() else inner.with_suffix(".py")


def test_hardware_reaches_no_analysis() -> None:
    reached = set((PACKAGE / "hardware").rglob("*.py"))
    waiting = list(reached)
    while waiting:
        for path in imports(waiting.pop()):
            if path.is_file() and path not in reached:
                reached.add(path)
                waiting.append(path)
    folders = {path.relative_to(PACKAGE).parts[0] for path in reached}
    assert {"hardware", "joint", "recording", "simulation"} <= folders
    assert not folders & {"identification", "problem", "estimate", "comparison", "commissioning"}


def test_a_joint_file_that_names_no_type_means_the_first_one(tmp_path: Path) -> None:
    text = EXAMPLE.read_text(encoding="utf-8")
    assert 'type = "elmo"' in text
    older = tmp_path / "joint.toml"
    lines = [line for line in text.splitlines() if not line.startswith('type = "elmo"')]
    older.write_text("\n".join(lines), encoding="utf-8")
    bench, named = jid.hardware.Bench.load(older), jid.hardware.Bench.load(EXAMPLE)
    assert (bench.drive_type, bench.drive) == (named.drive_type, named.drive)
    assert bench.drive_type == drive_types.DEFAULT_TYPE == "elmo"


def installed(monkeypatch: pytest.MonkeyPatch, *entries: tuple[str, str]) -> None:
    """Let packages register these entry points."""

    def found(**wanted: Any) -> EntryPoints:
        all_of_them = EntryPoints(
            EntryPoint(name, value, drive_types.ENTRY_POINTS) for name, value in entries
        )
        return all_of_them.select(**wanted)

    monkeypatch.setattr(drive_types, "entry_points", found)


class Wheel(DriveType):
    """A drive type of this module."""


def test_an_installed_type_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    installed(monkeypatch, ("wheel", f"{__name__}:Wheel"))
    assert drive_type_names() == ("elmo", "wheel")
    assert isinstance(drive_type("wheel"), Wheel)


@pytest.mark.parametrize(
    ("entries", "name", "wording"),
    [
        ((), "elmos", "drive type is 'elmos': did you mean 'elmo'?"),
        (
            (("wheel", "no.such.module:X"),),
            "wheel",
            "no.such.module:X of an unknown package cannot be used",
        ),
        (
            (("wheel", "math:no"),),
            "wheel",
            "math:no of an unknown package cannot be used (AttributeError",
        ),
        (
            (("wheel", "math:pi"),),
            "wheel",
            "math:pi of an unknown package is a float, not a DriveType",
        ),
        ((), ["elmo"], "drive type is ['elmo']: a text is expected"),
        ((("wheel", "a:X"), ("wheel", "b:X")), "wheel", "by several packages: a:X, b:X"),
    ],
)
def test_a_type_that_cannot_be_had_is_refused(
    monkeypatch: pytest.MonkeyPatch, entries: tuple[tuple[str, str], ...], name: Any, wording: str
) -> None:
    installed(monkeypatch, *entries)
    with pytest.raises(jid.InputError) as refused:
        drive_type(name)
    assert wording in str(refused.value)
    assert refused.value.value == name


def test_a_type_without_a_decoder_is_refused_by_replay(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    installed(monkeypatch, ("wheel", f"{__name__}:Wheel"))
    (tmp_path / "run.log").write_text("")
    with pytest.raises(
        jid.InputError, match=r"run\.log: drive is 'Wheel': this type of drive cannot dec"
    ):
        jid.hardware.replay(tmp_path / "run.log", jid.Joint(name="any"), drive="wheel", period=0.1)


class BrokenType(DriveType):
    """A drive type that cannot be made."""

    def __init__(self) -> None:
        raise RuntimeError("no licence")


def package(site: Path, monkeypatch: pytest.MonkeyPatch, entry: str) -> None:
    """Leave what an installed package leaves that registers a drive type."""
    about = site / "wheel_drive-1.0.dist-info"
    about.mkdir(parents=True)
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: wheel-drive\nVersion: 1.0\n")
    (about / "entry_points.txt").write_text(f"[jointid.drives]\n{entry}\n")
    monkeypatch.syspath_prepend(str(site))


def test_whatever_a_package_raises_names_the_package(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    package(tmp_path / "site", monkeypatch, f"wheel = {__name__}:BrokenType")
    with pytest.raises(jid.InputError) as refused:
        drive_type("wheel")
    assert refused.value.reason == (
        f"the entry point {__name__}:BrokenType of the package wheel-drive cannot be used "
        "(RuntimeError: no licence)"
    )
    assert isinstance(refused.value.__cause__, RuntimeError)


def test_a_package_that_raises_when_it_is_imported_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    site = tmp_path / "site"
    package(site, monkeypatch, "wheel = wheel_drive:WheelType")
    (site / "wheel_drive.py").write_text("1 / 0\n")
    with pytest.raises(jid.InputError, match=r"wheel-drive cannot be used \(ZeroDivisionError"):
        drive_type("wheel")


def test_a_package_that_registers_a_built_in_name_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    package(tmp_path / "site", monkeypatch, f"elmo = {__name__}:Wheel")
    wording = (
        "the package wheel-drive registers this name, but jointid has a built-in type of this name"
    )
    with pytest.raises(jid.InputError, match=wording):
        drive_type("elmo")
    with pytest.raises(jid.InputError, match=wording):
        jid.hardware.Bench.load(EXAMPLE)


@pytest.mark.parametrize("kind", [["elmo"], {"name": "elmo"}, 3])
def test_a_recording_whose_type_is_no_text_is_refused(tmp_path: Path, kind: object) -> None:
    time = np.arange(20) * 2e-3
    session = jid.Recording(
        time=time, position=time, torque=time, metadata={"drive_type": kind, "control_period": 2e-3}
    )
    (tmp_path / "run.log").write_text("")
    with pytest.raises(jid.InputError, match=r"drive type is .*: a text is expected"):
        jid.hardware.replay(tmp_path / "run.log", jid.Joint(name="any"), recording=session)


def test_a_type_in_a_joint_file_that_is_no_text_is_refused(tmp_path: Path) -> None:
    text = EXAMPLE.read_text(encoding="utf-8")
    path = tmp_path / "joint.toml"
    path.write_text(text.replace('type = "elmo"', 'type = ["elmo"]'), encoding="utf-8")
    with pytest.raises(jid.InputError) as refused:
        jid.hardware.Bench.load(path)
    assert (refused.value.argument, refused.value.reason) == ("type", "a text is expected")


def test_the_address_of_a_drive_is_shown_before_a_joint_moves(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    # The bus is opened before anybody is asked, so it must be there.
    path = tmp_path / "joint.toml"
    text = EXAMPLE.read_text(encoding="utf-8")
    path.write_text(text.replace('"socketcan"', '"virtual"'), encoding="utf-8")
    monkeypatch.setattr("sys.stdin", io.StringIO(""))
    assert main(["run", str(path), "--force"]) == 3
    asked = capsys.readouterr().err
    assert "will move between -1.4 and 1.4 rad with up to 160 N·m, about " in asked
    assert "(virtual can0, node 127)" in asked


def test_hardware_loads_no_make_of_drive() -> None:
    code = "import sys, jointid.hardware; print([n for n in sys.modules if 'hardware.elmo' in n])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_an_unknown_type_in_a_joint_file_has_its_place(tmp_path: Path) -> None:
    text = EXAMPLE.read_text(encoding="utf-8")
    path = tmp_path / "joint.toml"
    path.write_text(text.replace('type = "elmo"', 'type = "elmu"'), encoding="utf-8")
    with pytest.raises(jid.InputError) as refused:
        jid.hardware.Bench.load(path)
    error = refused.value
    assert (error.argument, error.value) == ("type", "elmu")
    assert error.place == f"{path}: [session.drive]"
    assert "did you mean 'elmo'?" in error.reason


def test_the_documentation_has_each_member_of_a_type() -> None:
    text = (EXAMPLE.parents[2] / "docs" / "hardware.md").read_text(encoding="utf-8")
    section = text.partition("### Registering a drive type")[2]
    for member in (name for name in vars(DriveType) if not name.startswith("_")):
        assert f"| `{member}" in section, member
