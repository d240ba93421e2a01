"""Readers of a .csv of a million rows and six columns: time, throughput, and other features. Markdown.

Each reader gives the columns as NumPy doubles; they are timed in turn, and the table shows medians. `jid.load` does
more: headers, units, checks of the signals, gaps.
"""

import argparse
import importlib.util
import statistics
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

import jointid as jid


def written(folder: Path, rows: int) -> Path:
    """Write the file."""
    rng = np.random.default_rng(0)
    walks = np.cumsum(rng.normal(size=(rows, 5)), axis=0) * 1e-3
    path = folder / "million.csv"
    with path.open("w", encoding="ascii") as file:
        file.write("time_s,position_rad,velocity_rad_s,torque_Nm,sensor_raw,temperature_degC\n")
        np.savetxt(file, np.column_stack([np.arange(rows) * 1e-3, walks]), "%.9g", delimiter=",")
    return path


def readers(path: Path) -> dict[str, Callable[[], object]]:
    """Return the readers by name, as far as installed."""
    found: dict[str, Callable[[], object]] = {
        "the file's bytes alone": path.read_bytes,
        "numpy.loadtxt, stream": lambda: np.loadtxt(path, delimiter=",", skiprows=1, comments=None),
        "numpy.loadtxt, lines": lambda: np.loadtxt(
            path.read_text(encoding="ascii").split("\n")[1:], delimiter=",", comments=None
        ),
        "jid.load": lambda: jid.load(path),
    }
    if importlib.util.find_spec("pandas"):
        import pandas as pd

        found["pandas, C engine"] = lambda: pd.read_csv(path).to_numpy()
    if importlib.util.find_spec("pyarrow"):
        from pyarrow import csv

        found["pyarrow.csv"] = lambda: [c.to_numpy() for c in csv.read_csv(path).columns]
    if importlib.util.find_spec("polars"):
        import polars  # type: ignore[import-not-found,unused-ignore]

        found["polars"] = lambda: polars.read_csv(path).to_numpy()
    return found


def main(rows: int, runs: int) -> None:
    """Time the readers in turn, and print."""
    with tempfile.TemporaryDirectory() as folder:
        path = written(Path(folder), rows)
        megabytes = path.stat().st_size / 1e6
        found = readers(path)
        seconds: dict[str, list[float]] = {name: [] for name in found}
        for _ in range(runs):
            for name, read in found.items():
                began = time.perf_counter()
                read()
                seconds[name].append(time.perf_counter() - began)
        print(f"{rows} rows, {megabytes:.0f} MB\n")
        print("| reader | median [s] | MB/s |\n|---|---|---|")
        for name, values in sorted(seconds.items(), key=lambda pair: statistics.median(pair[1])):
            median = statistics.median(values)
            print(f"| {name} | {median:.3f} | {megabytes / median:.0f} |")


if __name__ == "__main__":
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--rows", type=int, default=1_000_000)
    arguments.add_argument("--runs", type=int, default=7)
    main(arguments.parse_args().rows, arguments.parse_args().runs)
