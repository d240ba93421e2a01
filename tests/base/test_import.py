"""`import jointid` is quick: it brings numpy and the extension, and nothing else."""

import json
import subprocess
import sys

import pytest

SCRIPT = """
import json, sys
before = set(sys.modules)
import jointid
print(json.dumps(sorted(set(sys.modules) - before)))
"""


@pytest.fixture(scope="module")
def loaded() -> list[str]:
    """Names of the modules that `import jointid` loads into a fresh interpreter."""
    command = [sys.executable, "-W", "error", "-c", SCRIPT]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
    modules: list[str] = json.loads(run.stdout)
    return modules


def test_import_loads_the_extension(loaded: list[str]) -> None:
    assert {"jointid", "jointid._core", "numpy"} <= set(loaded)


@pytest.mark.parametrize("package", ["scipy", "matplotlib", "can", "canopen", "pandas", "tomlkit"])
def test_import_leaves_out(package: str, loaded: list[str]) -> None:
    assert package not in {name.partition(".")[0] for name in loaded}


def test_import_loads_numpy_and_nothing_else_from_outside(loaded: list[str]) -> None:
    roots = {name.partition(".")[0] for name in loaded} - sys.stdlib_module_names
    # The compiled modules of numpy leave their runtime's own entries.
    assert {root for root in roots if "cython" not in root} == {"jointid", "numpy"}


def test_hardware_is_not_loaded(loaded: list[str]) -> None:
    assert not [name for name in loaded if name.startswith("jointid.hardware")]
