"""Whole arms: the classical way to identify one, TX40's log, and how both ways predict what they have not seen."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tests"))  # simulated_arm
