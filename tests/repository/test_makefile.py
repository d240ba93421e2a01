"""`make lint` and `make test` keep the editable install of `make develop`, and renew it when they must."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest
from documents import ROOT

pytestmark = pytest.mark.skipif(shutil.which("make") is None, reason="make is not installed")
STAMPS = (
    ".venv/.created",
    ".venv/.build-tools",
    ".venv/.test-tools",
    ".venv/.lint-tools",
    ".venv/.installed",
    ".venv/.strict",
    "dist/.wheel",
)
OLD, NEW = 1_000_000_000, 2_000_000_000  # seconds; younger than any file here, older than any


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    """A checkout of few files, whose environment is complete and installed in the ordinary way."""
    shutil.copy(ROOT / "Makefile", tmp_path)
    for name in ("cpp/base/pool.cpp", "python/jointid/joint.py", "pyproject.toml", "README.md"):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
        os.utime(path, (OLD, OLD))
    for stamp in STAMPS:
        (tmp_path / stamp).parent.mkdir(exist_ok=True)
        (tmp_path / stamp).touch()
    return tmp_path


def develop(tree: Path) -> None:
    """Leave what `make develop` leaves."""
    (tree / ".venv" / ".editable").write_text("python/jointid/joint.py\n", encoding="utf-8")


def installations(tree: Path, *targets: str, **environment: str) -> list[str]:
    """The installations of the package that make would run for targets."""
    return [line for line in commands(tree, *targets, **environment) if "pip install" in line]


def commands(tree: Path, *targets: str, **environment: str) -> list[str]:
    """What make would run for targets."""
    inherited = {name: text for name, text in os.environ.items() if not name.startswith("MAKE")}
    inherited.pop("CI", None)
    run = subprocess.run(
        ["make", "--dry-run", *targets],
        cwd=tree,
        env={**inherited, **environment},
        capture_output=True,
        text=True,
        timeout=60,
        check=True,
    )
    return run.stdout.splitlines()


def change(tree: Path, name: str) -> None:
    path = tree / name
    path.touch()
    os.utime(path, (NEW, NEW))


@pytest.mark.parametrize("target", ["lint", "pytest", "demo"])
def test_nothing_is_installed_anew_without_a_change(tree: Path, target: str) -> None:
    assert installations(tree, target) == []
    develop(tree)
    assert installations(tree, target) == []
    assert installations(tree, target, CI="true") == []


@pytest.mark.parametrize("target", ["lint", "pytest"])
def test_an_edited_module_is_used_in_place(tree: Path, target: str) -> None:
    change(tree, "python/jointid/joint.py")
    (line,) = installations(tree, target)
    assert " -e " not in line
    develop(tree)
    assert installations(tree, target) == []


@pytest.mark.parametrize("target", ["lint", "pytest"])
@pytest.mark.parametrize("name", ["cpp/base/pool.cpp", "python/jointid/link.py"])
def test_compiled_sources_and_new_modules_are_installed_in_place_again(
    tree: Path, target: str, name: str
) -> None:
    develop(tree)
    change(tree, name)
    (line,) = installations(tree, target)
    assert line.endswith(" -e .")


def test_a_removed_module_is_installed_in_place_again(tree: Path) -> None:
    develop(tree)
    (tree / "python/jointid/joint.py").unlink()
    (line,) = installations(tree, "lint")
    assert line.endswith(" -e .")


def test_ci_builds_once_what_it_tests_and_ships(tree: Path) -> None:
    change(tree, "cpp/base/pool.cpp")
    ran = commands(tree, "lint", "check-sdist", "check-plain", "pytest", CI="true")
    (built,) = [line for line in ran if " -m build " in line]
    assert "JOINTID_WARNINGS_AS_ERRORS=ON" in built
    assert "--sdist" not in built  # both, the wheel from the sdist
    assert "JOINTID_BUILD_CHECKS=ON" in built  # the plain checks link what ships
    assert sum("core_checks.sh plain" in line for line in ran) == 1
    tested, proven = [line for line in ran if "pip install" in line]
    assert tested.endswith(" dist/jointid-*.whl")
    assert proven.endswith(" dist/jointid-*.whl")
    assert "sdist-venv" in proven


def test_a_build_by_hand_builds_no_checks(tree: Path) -> None:
    change(tree, "cpp/base/pool.cpp")
    (built,) = [line for line in commands(tree, "check-sdist") if " -m build " in line]
    assert "JOINTID_BUILD_CHECKS" not in built
    assert not [line for line in commands(tree, "check-plain") if " -m build " in line]
