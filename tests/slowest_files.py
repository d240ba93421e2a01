"""What CI's time goes into: the phases before pytest, and the slowest files of tests."""

import os
from collections import Counter
from collections.abc import Iterable
from pathlib import Path

PHASES = "JOINTID_CI_PHASES"
"""Environment variable that names the file in which `.ci/run` keeps what its phases took."""


FIRST = (
    "repository/test_mutants.py",
    "hardware/test_first_motion.py",
    "estimate/test_saved_estimates.py",
    "cli/test_terminal.py",
    "fuzz/test_fuzz.py",
    "base/test_write_faults.py",
    "robot/test_wrong_facts.py",
    "robot/test_seven_joints.py",
    "repository/test_documents.py",
    "identification/test_sample_fit.py",
    "identification/test_obeyed_advice.py",
    "cli/test_wrong_command_lines.py",
    "comparison/test_load_friction.py",
    "commissioning/test_commissioning.py",
    "repository/test_docstring_examples.py",
    "study/test_sweep.py",
    "base/test_read_back.py",
    "robot/test_saved_robots.py",
    "hardware/test_session_soak.py",
    "identification/test_causes.py",
    "design/test_designing.py",
    "identification/test_compressed.py",
)
"""Files of tests that take 15 s or more, longest first: one that starts last would be waited for alone."""


def place_of(path: Path, tests: Path) -> int:
    """Return when a file starts among several processes: a smaller number starts earlier.

    Parameters
    ----------
    path : Path
    tests : Path
        The folder of all tests.
    """
    name = path.relative_to(tests).as_posix() if path.is_relative_to(tests) else ""
    return FIRST.index(name) if name in FIRST else len(FIRST)


def slowest_files(durations: Iterable[tuple[str, float]], count: int = 10) -> list[str]:
    """Return lines of a table: seconds and file, the slowest first.

    Parameters
    ----------
    durations : iterable of (str, float)
        A test's name, ``file::test``, and the seconds of one of its parts.
    count : int, default 10
        How many files.
    """
    sums: Counter[str] = Counter()
    for name, seconds in durations:
        sums[name.partition("::")[0]] += seconds  # type: ignore[assignment]  # a Counter adds floats
    return [f"{seconds:6.0f} s  {file}" for file, seconds in sums.most_common(count)]


def phases() -> list[str]:
    """Return the lines of CI's earlier phases; none outside CI."""
    path = os.environ.get(PHASES)
    return Path(path).read_text(encoding="utf-8").splitlines() if path else []
