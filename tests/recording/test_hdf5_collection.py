"""Garbage is not collected while an HDF5 file is open: it would delete the error that h5py reads."""

import gc
import sys
from collections.abc import Iterator
from pathlib import Path
from types import FrameType

import numpy as np
import pytest

import jointid as jid
from jointid.recording.hierarchies.hdf5_file import opened

h5py = pytest.importorskip("h5py", reason="HDF5 logs need the extra 'hdf5'")


@pytest.fixture
def path(tmp_path: Path) -> Path:
    path = tmp_path / "log.h5"
    with h5py.File(path, "w") as file:
        for name in ("time", "position", "velocity"):
            file[name] = np.arange(50.0)
    return path


@pytest.fixture
def often() -> Iterator[None]:
    before = gc.get_threshold()
    gc.set_threshold(1)
    try:
        yield
    finally:
        gc.set_threshold(*before)
        gc.enable()


def _functions(frame: FrameType | None) -> Iterator[str]:
    while frame is not None:
        yield frame.f_code.co_name
        frame = frame.f_back


@pytest.mark.usefixtures("often")
def test_no_collection_starts_while_a_log_is_read(path: Path) -> None:
    reading = {"vectors_of", "values_of", "take"}
    during: list[str] = []
    count = 0

    def note(phase: str, _: dict[str, int]) -> None:
        nonlocal count
        count += 1
        if phase == "start":
            during.extend(reading & set(_functions(sys._getframe())))

    gc.callbacks.append(note)
    try:
        jid.load(path, units={"time": "s", "position": "rad"})
    finally:
        gc.callbacks.remove(note)
    assert count > 0
    assert during == []


def test_no_collection_starts_while_a_file_is_recognised(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    collecting = []
    recognise = h5py.is_hdf5

    def noted(file: Path) -> object:
        collecting.append(gc.isenabled())
        return recognise(file)

    monkeypatch.setattr(h5py, "is_hdf5", noted)
    jid.load(path, units={"time": "s", "position": "rad"})
    assert set(collecting) == {False}


def test_collection_goes_on_when_the_last_file_is_closed(path: Path) -> None:
    with opened(path):
        assert not gc.isenabled()
        with opened(path):
            pass
        assert not gc.isenabled()
    assert gc.isenabled()


def test_collection_goes_on_after_damage(path: Path) -> None:
    with pytest.raises(jid.InputError, match="damaged"), opened(path) as file:
        file["missing"]
    assert gc.isenabled()


def test_collection_stays_off_where_it_was(path: Path) -> None:
    gc.disable()
    try:
        with opened(path):
            pass
        assert not gc.isenabled()
    finally:
        gc.enable()
