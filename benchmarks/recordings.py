"""Folder of the example recordings; the package contains only those of `jointid demo`."""

from pathlib import Path

WELL_EXCITED = Path(__file__).resolve().parents[1] / "examples" / "data" / "well_excited.csv.gz"
