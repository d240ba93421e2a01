"""The folder of inputs with their right values that is shared beside the repository; it does not ship."""

import os
from pathlib import Path

import pytest

_BESIDE = Path(__file__).resolve().parents[2] / "shared" / "cases"


def case(name: str) -> Path:
    """Return a case's folder, or skip the test; ``JOINTID_CASES`` names the folder of all."""
    folder = Path(os.environ.get("JOINTID_CASES") or _BESIDE) / name
    if not folder.is_dir():
        pytest.skip(f"the case {name} does not come with the repository")
    return folder
