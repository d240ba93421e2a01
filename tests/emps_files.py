"""EMPS, a recording whose authors publish it without a licence: it does not ship, and is read where the user has it."""

import os
import shutil
from pathlib import Path

import numpy as np

PLACE = "JOINTID_EMPS"
"""Environment variable that names the folder of `DATA_EMPS.mat`."""

MATLAB = "DATA_EMPS.mat"
TABLE = "emps_train.csv.gz"
WITHOUT_EMPS = f"EMPS states no licence and does not ship: {PLACE} may name the folder of its authors' {MATLAB}"
_NEWTONS_A_VOLT = 35.150652


def folder_of_emps(repository: Path) -> Path | None:
    """Return the folder of EMPS; None without one.

    Parameters
    ----------
    repository : Path
        Where the environment names no folder, ``../shared/data/emps`` is looked at.

    Raises
    ------
    FileNotFoundError
        The environment names a folder that lacks the file: no reason to skip.
    """
    if named := os.environ.get(PLACE):
        folder = Path(named).expanduser()
        if not (folder / MATLAB).is_file():
            raise FileNotFoundError(f"{PLACE} is {named!r}, and there is no {MATLAB} in it")
        return folder
    folder = repository.parent / "shared" / "data" / "emps"
    return folder if (folder / MATLAB).is_file() else None


def with_table(folder: Path, target: Path) -> Path:
    """Return the target, with the file of MATLAB and a table of its signals.

    Parameters
    ----------
    folder : Path
        It holds ``DATA_EMPS.mat``.
    target : Path
        An empty folder.
    """
    from scipy.io import loadmat

    shutil.copy(folder / MATLAB, target)
    found = loadmat(folder / MATLAB)
    time, reference, position, volts = (found[name].ravel() for name in ("t", "qg", "qm", "vir"))
    np.savetxt(
        target / TABLE,
        np.column_stack((time, reference, position, volts, _NEWTONS_A_VOLT * volts)),
        fmt=("%.6f", *["%.17g"] * 3, "%.10g"),
        delimiter=",",
        header="time_s,position_ref_m,position_m,motor_voltage_V,motor_force_N",
        comments="",
    )
    return target
