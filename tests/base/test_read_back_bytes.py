"""A search's checkpoint with any number in it replaced and a right checksum: refused, or gone on with."""

import struct
from pathlib import Path

import numpy as np
import pytest

import jointid as jid
from jointid.cli.demonstration import data_folder
from jointid.identification.search.run import _read_state

_VALUES = (
    *(struct.pack("<d", value) for value in (np.nan, np.inf, -np.inf, 1e308, -1.0, 0.5)),
    *(struct.pack("<Q", value) for value in (0, 1, 2**31, 2**63, 2**64 - 1)),
)


def checksum(body: bytes) -> bytes:
    """FNV-1a, as the core writes it."""
    found = 14695981039346656037
    for byte in body:
        found = (found ^ byte) * 1099511628211 % 2**64
    return struct.pack("<Q", found)


@pytest.fixture(scope="module")
def checkpoint(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    path = tmp_path_factory.mktemp("search") / "state"
    run = jid.load(data_folder() / "kr300_joint1.csv.gz")
    joint = jid.Joint.load(data_folder() / "kr300_joint1.toml")
    ga = jid.GaOptions(population=6, generations=2)
    search = jid.Search(ga=ga, checkpoint=path)
    jid.identify(run, joint, model="stribeck", windows=12, search=search)
    return path.read_bytes()


def test_the_checksum_is_the_cores(checkpoint: bytes) -> None:
    assert checksum(checkpoint[:-8]) == checkpoint[-8:]


def test_any_number_of_a_checkpoint(checkpoint: bytes, tmp_path: Path) -> None:
    path = tmp_path / "state"
    start = checkpoint.index(b"\n") + 1
    refused = accepted = 0
    for place in range(start, len(checkpoint) - 8, 4):
        value = _VALUES[place // 4 % len(_VALUES)]
        body = checkpoint[:place] + value + checkpoint[place + 8 : -8]
        path.write_bytes(body + checksum(body))
        try:
            state = _read_state(path)
        except jid.InputError as error:
            refused += error.place == str(path)
            continue
        accepted += 1
        assert np.isfinite(state.best).all()
        assert state.penalty > -np.inf
        assert not np.isnan(state.penalties).any()
    assert refused > 20
    assert accepted > 20


def test_a_checkpoint_that_is_cut_off(checkpoint: bytes, tmp_path: Path) -> None:
    path = tmp_path / "state"
    for length in range(0, len(checkpoint), 7):
        path.write_bytes(checkpoint[:length])
        with pytest.raises(jid.InputError, match="state"):
            _read_state(path)
