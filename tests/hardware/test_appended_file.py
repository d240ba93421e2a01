"""A file that is only appended to: it is new, every byte arrives, and a sync that fails is not forgotten."""

from __future__ import annotations

import os
import time
from pathlib import Path

import pytest

from jointid.hardware.session import recorder
from jointid.hardware.session.appended_file import AppendedFile, Syncing


def test_a_file_that_is_there_is_not_appended_to(tmp_path: Path) -> None:
    path = tmp_path / "run.csv"
    path.write_text("mine")
    with pytest.raises(FileExistsError):
        AppendedFile(path)
    assert path.read_text() == "mine"


@pytest.mark.parametrize("name", ["run.csv", "run.log"])
def test_a_file_that_another_program_makes_meanwhile_is_left_alone(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """After the check of the name and before the file is made."""
    monkeypatch.setattr(recorder, "check_output", lambda _: (tmp_path / name).write_text("mine"))
    with pytest.raises(FileExistsError):
        recorder.Recorder(tmp_path / "run.csv", {})
    assert [each.read_text() for each in tmp_path.iterdir()] == ["mine"]


def test_what_the_system_takes_in_pieces_arrives_whole(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write = os.write
    monkeypatch.setattr(os, "write", lambda file, block: write(file, block[:3]))
    file = AppendedFile(tmp_path / "run.csv")
    file.append(b"0123456789\n")
    file.append(b"next\n")
    file.close()
    assert file.path.read_bytes() == b"0123456789\nnext\n"


def test_a_sync_that_fails_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(_: int) -> None:
        raise OSError("bad disk")

    monkeypatch.setattr(os, "fsync", broken)
    file = AppendedFile(tmp_path / "run.csv")
    syncing = Syncing([file], 1e-3)
    end = time.monotonic() + 5.0
    while syncing.failure is None and time.monotonic() < end:
        time.sleep(1e-3)
    syncing.close()
    file.close()
    assert str(syncing.failure) == "bad disk"
