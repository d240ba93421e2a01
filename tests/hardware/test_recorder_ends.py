"""What a recorder says at its end: that it could not write, and that its velocity is derived."""

from pathlib import Path

import pytest

import jointid as jid
from jointid.hardware.session.appended_file import AppendedFile
from jointid.hardware.session.recorder import Recorder


def recorded(path: Path) -> Recorder:
    recorder = Recorder(path, {})
    for number in range(10):
        recorder.sample((1e-3 * number, 0.1 * number, 1.0, 2.0, 0.0, 0.5, 0.0))
    return recorder


def test_what_could_not_be_written_is_raised(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(self: AppendedFile, block: bytes) -> None:
        raise OSError("no space")

    recorder = Recorder(tmp_path / "run.csv", {})
    monkeypatch.setattr(AppendedFile, "append", full)
    with pytest.raises(OSError, match="no space"):
        recorder.close()


def test_a_failure_to_close_is_raised_and_the_other_file_is_closed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Some network file systems say only then that the user's quota is used up."""
    closed = []
    close = AppendedFile.close

    def quota(self: AppendedFile) -> None:
        close(self)
        closed.append(self.path.suffix)
        if self.path.suffix == ".log":
            raise OSError("quota")

    recorder = recorded(tmp_path / "run.csv")
    monkeypatch.setattr(AppendedFile, "close", quota)
    with pytest.raises(OSError, match="quota"):
        recorder.close()
    assert sorted(closed) == [".csv", ".log"]
    assert len(jid.load(tmp_path / "run.csv").time) == 10


def test_a_session_s_velocity_is_derived(tmp_path: Path) -> None:
    recorded(tmp_path / "run.csv").close()
    first = (tmp_path / "run.csv").read_text().splitlines()[0]
    assert '"velocity_derived": true' in first
    assert jid.load(tmp_path / "run.csv").velocity_derived
