"""A copy of the repository with all mutants in its core, and a copy of the package for each worker."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

from mutants import switched_sources
from mutants.catalogue import REPOSITORY, Mutant, MutantError


def built_core(folder: Path, mutants: list[Mutant], jobs: int) -> tuple[Path, Path]:
    """Build the switched core: its extension and its checks.

    Parameters
    ----------
    folder : Path
        For sources and objects, which stay: a second build compiles only changes.
    mutants : list of Mutant
        The mutants in C++.
    jobs : int
        Number of compilers in parallel.

    Raises
    ------
    MutantError
        If it does not compile. Contains the compiler's errors.
    """
    sources, objects = folder / "sources", folder / "objects"
    made = folder / "made"
    shutil.rmtree(made, ignore_errors=True)
    made.mkdir(parents=True)
    shutil.copytree(REPOSITORY / "cpp", made / "cpp")
    shutil.copy2(REPOSITORY / "CMakeLists.txt", made)
    (made / "examples" / "data").mkdir(parents=True)
    switched_sources.write(made, mutants)
    _keep_times(made, sources)
    environment = os.environ | {
        "PATH": os.pathsep.join((str(Path(sys.executable).parent), os.environ["PATH"]))
    }
    setup: list[str | Path] = [
        "cmake",
        "-S",
        sources,
        "-B",
        objects,
        "-G",
        "Ninja",
        "-DJOINTID_BUILD_CHECKS=ON",
    ]
    setup += ["-DCMAKE_BUILD_TYPE=Release", f"-DPython_EXECUTABLE={sys.executable}"]
    setup += [f"-Dpybind11_DIR={_pybind11()}", f"-DSKBUILD_PROJECT_VERSION={_version()}"]
    setup.append(
        "-DJOINTID_BUILD_EXTENSION=ON"
    )  # together with the checks, so that the core is compiled once
    build: list[str | Path] = ["cmake", "--build", objects, "--parallel", str(jobs)]
    build += ["--", "-k", "0"]  # show all errors at once
    for command in (setup, build):
        done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
        if done.returncode:
            wrong = [line for line in done.stdout.splitlines() if "error" in line]
            raise MutantError("\n".join((done.stderr[-2000:], *(wrong or [done.stdout[-3000:]]))))
    (extension,) = objects.glob("_core*.so")
    return extension, objects / "core_check"


def _version() -> str:
    text = (REPOSITORY / "pyproject.toml").read_text(encoding="utf-8")
    return str(tomllib.loads(text)["project"]["version"])


def _pybind11() -> str:
    command = [sys.executable, "-m", "pybind11", "--cmakedir"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        raise MutantError("pybind11 is needed to compile: run it by `make mutants`")
    return done.stdout.strip()


def _keep_times(made: Path, sources: Path) -> None:
    """Update a copy, without touching unchanged files, so that they need no compiler."""
    wanted = {path.relative_to(made) for path in made.rglob("*") if path.is_file()}
    for path in sources.rglob("*") if sources.exists() else ():
        if path.is_file() and path.relative_to(sources) not in wanted:
            path.unlink()
    for each in wanted:
        old, new = sources / each, made / each
        if not old.exists() or old.read_bytes() != new.read_bytes():
            old.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(new, old)
    shutil.rmtree(made)
    (sources / "examples" / "data").mkdir(parents=True, exist_ok=True)


def package(folder: Path, extension: Path) -> Path:
    """Make a copy of the package with that core, in which one worker may change a file.

    The data of examples are next to an installed package, and are copied, too.
    """
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(
        REPOSITORY / "python" / "jointid", folder / "jointid", ignore=shutil.ignore_patterns("*.so")
    )
    shutil.copy2(extension, folder / "jointid" / installed_core().name)
    shutil.copytree(
        REPOSITORY / "examples" / "data", folder / "jointid" / "data", dirs_exist_ok=True
    )
    return folder


def installed_core() -> Path:
    """Return the installed extension, or the one in the checkout."""
    script = "import jointid._core as core; print(core.__file__)"
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=False, cwd="/"
    )
    if done.returncode:
        raise MutantError(f"jointid must be installed: {done.stderr.strip().splitlines()[-1]}")
    return Path(done.stdout.strip())
