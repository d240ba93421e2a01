"""Ctrl-C while `jointid` and `python -m jointid` are still importing."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

# As numpy does: what stops its import becomes a page about a bad install.
SLOW = """import time
try:
    print("importing", flush=True)
    time.sleep(60.0)
except BaseException:
    raise ImportError("a bad install")
"""
SCRIPT = "import sys\nfrom jointid.cli import main\nsys.exit(main())\n"


def interrupted(folder: Path, *command: str) -> tuple[int, str]:
    """Exit code and standard error of a program that gets Ctrl-C during its imports."""
    slow = folder / "slow" / "numpy"
    slow.mkdir(parents=True)
    (slow / "__init__.py").write_text(SLOW, encoding="utf-8")
    path = os.pathsep.join(filter(None, (str(slow.parent), os.environ.get("PYTHONPATH"))))
    with subprocess.Popen(
        [sys.executable, *command],
        env={**os.environ, "PYTHONPATH": path},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        cwd=folder,
    ) as program:
        assert program.stdout is not None
        assert program.stdout.readline() == "importing\n"
        program.send_signal(signal.SIGINT)
        _, said = program.communicate(timeout=30.0)
    return program.returncode, said


@pytest.mark.skipif(sys.platform == "win32", reason="no SIGINT for one program")
def test_the_command_line_ends_in_one_line(tmp_path: Path) -> None:
    script = tmp_path / "jointid"  # as an installer writes it
    script.write_text(SCRIPT, encoding="utf-8")
    for folder, command in (("script", [str(script)]), ("module", ["-m", "jointid"])):
        assert interrupted(tmp_path / folder, *command, "info", "run.csv") == (
            130,
            "jointid: interrupted\n",
        )


@pytest.mark.skipif(sys.platform == "win32", reason="no SIGINT for one program")
def test_a_program_that_imports_jointid_keeps_its_interruption(tmp_path: Path) -> None:
    program = tmp_path / "mine.py"
    program.write_text("import jointid\njointid.identify\n", encoding="utf-8")
    code, said = interrupted(tmp_path / "mine", str(program))
    assert code == 1
    assert "a bad install" in said
