"""Print pip constraints: the oldest versions that pyproject.toml allows, or only its own upper limits.

Usage: python tools/constraints.py --bound oldest
"""

import argparse
import re
import tomllib
from pathlib import Path

_PROJECT = Path(__file__).resolve().parents[1] / "pyproject.toml"
_OLDEST = re.compile(r"^([A-Za-z0-9_.-]+)>=([0-9.]+)")


def oldest(project: Path = _PROJECT) -> list[str]:
    """Return ``name==version`` of each dependency at its lower limit, optional ones included.

    Parameters
    ----------
    project : Path
        A pyproject.toml.

    Raises
    ------
    ValueError
        A dependency without a lower limit.
    """
    table = tomllib.loads(project.read_text(encoding="utf-8"))["project"]
    wanted = [*table["dependencies"]]
    for extra in table["optional-dependencies"].values():
        wanted += extra
    lines = []
    for each in wanted:
        found = _OLDEST.match(each)
        if found is None:
            raise ValueError(f"{each!r} has no lower limit: write name>=version")
        lines.append(f"{found[1]}=={found[2]}")
    return lines


def main() -> None:
    """Print the constraints."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--bound", choices=("oldest", "newest"), required=True)
    if parser.parse_args().bound == "oldest":
        print("\n".join(oldest()))


if __name__ == "__main__":
    main()
