"""The workflow for other systems, which no run here tries: it serves pyproject.toml, and publishes what it tested."""

import re
import runpy
import tomllib
from pathlib import Path
from typing import Any

import pytest

yaml = pytest.importorskip("yaml")


@pytest.fixture
def jobs(repo: Path) -> dict[str, Any]:
    found = yaml.safe_load((repo / ".github/workflows/ci.yml").read_text(encoding="utf-8"))
    jobs: dict[str, Any] = found["jobs"]
    return jobs


@pytest.fixture
def project(repo: Path) -> dict[str, Any]:
    return tomllib.loads((repo / "pyproject.toml").read_text(encoding="utf-8"))


def test_it_tries_each_python_on_each_system(jobs: dict[str, Any], project: dict[str, Any]) -> None:
    matrix = jobs["tests"]["strategy"]["matrix"]
    built = [name.strip("cp*-") for name in project["tool"]["cibuildwheel"]["build"]]
    assert [version.replace(".", "") for version in matrix["python"]] == built
    assert project["project"]["requires-python"] == f">={matrix['python'][0]}"
    assert {name.partition("-")[0] for name in matrix["os"]} == {"ubuntu", "macos", "windows"}
    assert {name.partition("-")[0] for name in jobs["wheels"]["strategy"]["matrix"]["os"]} == {
        *("ubuntu", "macos", "windows")
    }


def test_nothing_untested_is_published(jobs: dict[str, Any]) -> None:
    publish = jobs["publish"]
    assert set(publish["needs"]) == set(jobs) - {"publish"}
    assert publish["if"] == "startsWith(github.ref, 'refs/tags/v')"
    assert publish["permissions"] == {"id-token": "write"}
    others = [job for name, job in jobs.items() if name != "publish"]
    assert not any("permissions" in job or "environment" in job for job in others)


def test_what_it_runs_is_here(repo: Path, jobs: dict[str, Any]) -> None:
    steps = [step["run"] for job in jobs.values() for step in job["steps"] if "run" in step]
    targets = re.findall(r"^make ([a-z-]+)$", "\n".join(steps), re.M)
    makefile = (repo / "Makefile").read_text(encoding="utf-8")
    assert targets
    assert all(re.search(rf"^{target}:", makefile, re.M) for target in targets)
    scripts = re.findall(r"python (tools/\S+)", "\n".join(steps))
    assert scripts == ["tools/constraints.py"]
    assert all((repo / script).is_file() for script in scripts)


def test_the_oldest_dependencies_are_the_limits(repo: Path, tmp_path: Path) -> None:
    oldest = runpy.run_path(str(repo / "tools" / "constraints.py"))["oldest"]
    lines = oldest()
    assert "numpy==2.0" in lines
    assert "rosbags==0.11" in lines
    file = tmp_path / "pyproject.toml"
    file.write_text('[project]\ndependencies = ["numpy"]\noptional-dependencies = {}\n')
    with pytest.raises(ValueError, match="'numpy' has no lower limit"):
        oldest(file)


def test_one_version_everywhere(repo: Path, project: dict[str, Any]) -> None:
    version = project["project"]["version"]
    citation = yaml.safe_load((repo / "CITATION.cff").read_text(encoding="utf-8"))
    assert citation["version"] == version
    changes = (repo / "CHANGELOG.md").read_text(encoding="utf-8")
    newest = re.search(r"^## (\S+)", changes, re.M)
    assert newest is not None
    assert newest[1] == version
