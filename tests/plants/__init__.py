"""Mismatched joints, simulated in NumPy with many runs side by side; no code of the package's core.

`simulate` gives a `jid.Recording` for each run of a `Bench`: plants, motions, controllers and recorders whose
fields are a number for all runs, or an array with one value for each.
"""

from plants.law import Law
from plants.log import Log
from plants.motions import Motion, chirp, sines, thesis, trapezoids
from plants.plant import Plant
from plants.simulation import Bench, simulate

__all__ = [
    "Bench",
    "Law",
    "Log",
    "Motion",
    "Plant",
    "chirp",
    "simulate",
    "sines",
    "thesis",
    "trapezoids",
]
