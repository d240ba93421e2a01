"""A misspelt name is an error of types, for mypy and for pyright; what is right is none."""

import os
import re
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

import jointid as jid

SAMPLE = Path(__file__).with_name("misspelt_names.txt")
# basedpyright is pyright with a Node of its own: pyright's package downloads one when it is first called.
COMMANDS = {
    "mypy": ["-m", "mypy", "--no-incremental", "--no-error-summary", "--hide-error-context"],
    "basedpyright": ["-m", "basedpyright", "--level", "error", "--pythonpath", sys.executable],
}


@pytest.mark.slow
@pytest.mark.parametrize("checker", COMMANDS)
def test_misspelt_names(checker: str, tmp_path: Path) -> None:
    if find_spec(checker) is None:
        pytest.skip(f"{checker} is not installed; `make lint` installs it")
    program = tmp_path / "program.py"
    program.write_text(SAMPLE.read_text(encoding="utf-8"), encoding="utf-8")
    source = str(Path(jid.__file__).parents[1])
    # mypy refuses site-packages in its path, and finds what is installed by itself.
    where = {} if "site-packages" in source else {"MYPYPATH": source}
    done = subprocess.run(
        [sys.executable, *COMMANDS[checker], program.name],
        capture_output=True,
        text=True,
        cwd=tmp_path,
        env=os.environ | {"PYTHONPATH": os.pathsep.join([source, *sys.path])} | where,
        check=False,
    )
    found = {int(line) for line in re.findall(r"program\.py:(\d+):.*\berror\b", done.stdout)}
    lines = program.read_text(encoding="utf-8").splitlines()
    wrong = {number for number, line in enumerate(lines, 1) if line.endswith("# wrong")}
    assert len(wrong) > 10
    assert found == wrong, done.stdout + done.stderr
