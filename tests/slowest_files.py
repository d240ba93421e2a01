"""What CI's time goes into: the phases before pytest, and the slowest files of tests."""

import os
from collections import Counter
from collections.abc import Iterable
from pathlib import Path

PHASES = "JOINTID_CI_PHASES"
"""Environment variable that names the file in which `.ci/run` keeps what its phases took."""


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
