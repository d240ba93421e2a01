"""What `make` builds and installs: once, after a change alone, in place after `make develop`; or a wheel."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest
from documents import ROOT

pytestmark = pytest.mark.skipif(shutil.which("make") is None, reason="make is not installed")
STAMPS = (
    ".venv/.created",
    ".venv/.test-tools",
    ".venv/.lint-tools",
    ".venv/.installed",
    ".venv/.tested",
    "build/tools/.made",
)
SOURCES = (
    "cpp/base/pool.cpp",
    "python/jointid/joint.py",
    "examples/data/log.csv",
    "tools/stub.py",
    "CMakeLists.txt",
    "pyproject.toml",
    "README.md",
    "LICENSE",
)
OLD, NEW = 1_000_000_000, 2_000_000_000  # seconds; younger than any file here, older than any


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    """A checkout of few files, with a complete environment."""
    shutil.copy(ROOT / "Makefile", tmp_path)
    for name in SOURCES:
        change(tmp_path, name, OLD)
    for stamp in STAMPS:
        (tmp_path / stamp).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / stamp).touch()
    return tmp_path


def change(tree: Path, name: str, seconds: int = NEW) -> None:
    path = tree / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.touch()
    os.utime(path, (seconds, seconds))


def installations(tree: Path, *arguments: str) -> list[str]:
    """The installations of the package that make would run for targets."""
    return [line for line in commands(tree, *arguments) if line.startswith("tools/install.sh")]


def commands(tree: Path, *arguments: str) -> list[str]:
    """What make would run for targets."""
    inherited = {name: text for name, text in os.environ.items() if not name.startswith("MAKE")}
    run = subprocess.run(
        ["make", "--dry-run", *arguments],
        cwd=tree,
        env=inherited,
        capture_output=True,
        text=True,
        timeout=60,
        check=True,
    )
    return [line.strip() for line in run.stdout.splitlines()]


@pytest.mark.parametrize("target", ["lint", "test", "demo"])
def test_nothing_is_installed_anew_without_a_change(tree: Path, target: str) -> None:
    assert installations(tree, target) == []


@pytest.mark.parametrize("name", SOURCES)
def test_a_change_is_built_once(tree: Path, name: str) -> None:
    change(tree, name)
    assert installations(tree, "test") == ["tools/install.sh checks"]
    assert installations(tree, "demo") == ["tools/install.sh"]
    assert installations(tree, "lint") == ["tools/install.sh"]


@pytest.mark.parametrize("name", ["python/jointid/_core.pyi", "python/jointid/_core.so"])
def test_what_a_build_leaves_is_no_change(tree: Path, name: str) -> None:
    change(tree, name)
    assert installations(tree, "test", "demo") == []


@pytest.mark.parametrize("target", ["lint", "demo"])
def test_an_installation_in_place_is_renewed(tree: Path, target: str) -> None:
    change(tree, ".venv/.editable")
    change(tree, "dist/jointid-0.1.0-cp311-cp311-linux_x86_64.whl")  # does not replace it
    assert installations(tree, target) == ["tools/install.sh"]
    assert installations(tree, "test") == ["tools/install.sh checks"]


def test_a_wheel_that_is_newer_than_all_sources_needs_no_compiler(tree: Path) -> None:
    wheel = "dist/jointid-0.1.0-cp311-cp311-linux_x86_64.whl"
    change(tree, wheel, NEW)
    assert installations(tree, "demo") == []  # what is installed is newer than its sources
    (tree / ".venv/.installed").unlink()
    assert installations(tree, "demo") == [f"tools/install.sh {wheel}"]
    change(tree, "cpp/base/pool.cpp", NEW + 1)
    assert installations(tree, "demo") == ["tools/install.sh"]
    assert installations(tree, "demo", "WHEEL=a.whl") == ["tools/install.sh a.whl only"]


def test_the_core_is_checked_as_it_was_built(tree: Path) -> None:
    ran = commands(tree, "test")
    assert "build/package/core_check" in ran
    assert not [line for line in ran if "core_checks.sh" in line or "pip install" in line]
    assert ran[-1].endswith('-m "not slow"')


def test_all_tests_are_in_two_lanes(tree: Path) -> None:
    ran = [line for line in commands(tree, "test-all") if " -m pytest" in line]
    assert [line.partition("-m pytest ")[2] for line in ran] == [
        '--numprocesses auto --dist loadfile -m "not slow"',
        "tests/canlab",
        "--numprocesses auto --dist loadfile -m slow --ignore tests/canlab",
    ]
    assert "JOINTID_REQUIRE_VCAN=1" in ran[1]
    assert "JOINTID_REQUIRE_BROWSER=1" in ran[2]
