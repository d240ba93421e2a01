"""Recordings from open files and buffers are those of the files."""

import gzip
import io
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import jointid as jid


@pytest.fixture
def run(tmp_path: Path) -> jid.Recording:
    time = np.arange(200) / 100
    made = jid.Recording(
        time=time, position=np.sin(3 * time), torque=np.cos(3 * time), name="saved"
    )
    for ending in (".csv", ".csv.gz", ".npz"):
        made.save(tmp_path / f"run{ending}")
    return made


@pytest.mark.parametrize("ending", [".csv", ".csv.gz", ".npz"])
def test_bytes(ending: str, run: jid.Recording, tmp_path: Path) -> None:
    """The first bytes tell the format of a buffer, its name that of a file."""
    content = (tmp_path / f"run{ending}").read_bytes()
    assert jid.load(io.BytesIO(content)).fingerprint == run.fingerprint
    with (tmp_path / f"run{ending}").open("rb") as file:
        assert jid.load(path=file).name == "saved"


def test_text(run: jid.Recording, tmp_path: Path) -> None:
    text = (tmp_path / "run.csv").read_text(encoding="utf-8")
    assert jid.load(io.StringIO(text)).fingerprint == run.fingerprint
    with (tmp_path / "run.csv").open(encoding="utf-8") as file:
        assert jid.load(file).fingerprint == run.fingerprint
    with gzip.open(tmp_path / "run.csv.gz", "rt", encoding="utf-8") as unpacked:
        assert jid.load(io.StringIO(unpacked.read())).fingerprint == run.fingerprint


def test_options_and_the_other_functions() -> None:
    text = "t,enc,effort,lap\n" + "".join(
        f"{k % 50 / 50},{k % 7},2,{k // 50}\n" for k in range(100)
    )
    columns: Any = {"position": "enc"}
    first, second = jid.load_runs(io.StringIO(text), by="lap", columns=columns)
    assert (len(first), second.name) == (50, "recording lap=1")
    assert (
        jid.load(io.StringIO(text), columns=columns, where={"lap": 1}, name="mine").name == "mine"
    )
    arm = "t,q1,q2,tau1,tau2\n" + "".join(f"{k / 50},{k % 7},{k % 5},1,2\n" for k in range(50))
    assert jid.load_robot(io.StringIO(arm)).names == ("1", "2")


def test_errors_name_no_folder_that_nobody_knows() -> None:
    with pytest.raises(jid.InputError) as caught:
        jid.load(io.StringIO("time_s,position_rad\n0,0\n1,oops\n"))
    assert caught.value.place.startswith("recording.csv, line 3")

    class Odd:
        def read(self) -> int:
            return 3

    with pytest.raises(jid.InputError, match="open for reading"):
        jid.load(Odd())  # type: ignore[call-overload]
