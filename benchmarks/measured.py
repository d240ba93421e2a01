"""The page of measured results, for the studies; `tools/measured_page.py` writes it."""

import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "tools"))

from measured_page import Part, commit, publish, table

__all__ = ["Part", "commit", "publish", "table"]
