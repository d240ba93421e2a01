"""Build and run the literal C++ transcription of the thesis's listing (`literal/genetic.cpp`)."""

from __future__ import annotations

import statistics
import subprocess
from pathlib import Path

import numpy as np
from store import Record

import jointid as jid

SOURCE = Path(__file__).resolve().parent / "literal" / "genetic.cpp"
POPULATION, GENERATIONS = 200, 1500
TIMED = 20  # number of run generations; the cost of a generation does not depend on its index


def measure(recording: jid.Recording, folder: Path, repeats: int) -> Record:
    """Return seconds per candidate and, in proportion, of 200 × 1500; medians."""
    r = recording
    folder.mkdir(parents=True, exist_ok=True)
    program, text = folder / "genetic", folder / "recording.txt"
    subprocess.run(
        ["c++", "-O2", "-std=c++20", "-o", str(program), str(SOURCE)], check=True, text=True
    )
    signals = (r.time, r.position, r.velocity, r.torque, r.sensor)
    np.savetxt(text, np.array(signals).T)
    each = []
    for seed in range(repeats):
        call = [str(program), str(text), str(POPULATION), str(TIMED), str(seed)]
        printed = subprocess.run(call, check=True, text=True, capture_output=True).stdout.split()
        each.append(float(printed[0]) / int(printed[1]))
    candidate = statistics.median(each)
    return {
        "kind": "literal",
        "candidate": candidate,
        "total": candidate * POPULATION * GENERATIONS,
        "runs": repeats,
        "generations": TIMED,
    }
