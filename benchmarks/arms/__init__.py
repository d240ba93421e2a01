"""Whole arms: the classical method of identification, TX40's log, and the predictions of both methods."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tests"))  # simulated_arm
