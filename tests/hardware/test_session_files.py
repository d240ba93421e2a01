"""Session files: how they end: complete, truncated anywhere, or on a full disk."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import jointid as jid
from jointid.hardware import Bench, EmulatedBus, Session, emulated_devices
from jointid.hardware.elmo import ElmoDrive
from jointid.hardware.session.session import SessionStoppedError

EXAMPLE = Path(__file__).parents[2] / "examples" / "hardware" / "joint.toml"


def ran(output: Path) -> jid.Recording:
    """A short session on an emulated drive."""
    bench = replace(Bench.load(EXAMPLE), trajectory=jid.Trajectory.sine(0.1, 1.0, duration=0.2))
    with EmulatedBus(*emulated_devices(bench, seed=1)) as bus:
        drive = ElmoDrive(bus, bench.joint, bench.drive)
        recording = Session(
            drive,
            bench.controller,
            bench.trajectory,
            bench.limits,
            options=bench.options,
            output=output,
        ).run()
    assert recording is not None
    return recording


@pytest.fixture(scope="module")
def session(tmp_path_factory: pytest.TempPathFactory) -> tuple[jid.Recording, Path]:
    path = tmp_path_factory.mktemp("session") / "run.csv"
    return ran(path), path


def test_a_whole_file_gives_the_sessions_recording(session: tuple[jid.Recording, Path]) -> None:
    recording, path = session
    loaded = jid.load(path)
    for name in recording.signals:
        assert np.array_equal(getattr(loaded, name), getattr(recording, name)), name
    assert loaded.metadata["stop"] is None
    assert loaded.metadata["timing"] == recording.metadata["timing"]
    assert "truncated" not in loaded.metadata


@settings(
    max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(share=st.floats(0.0, 1.0, exclude_max=True))
def test_a_truncated_file_gives_a_prefix_or_a_clear_error(
    session: tuple[jid.Recording, Path], tmp_path: Path, share: float
) -> None:
    recording, path = session
    content = path.read_bytes()
    torn = tmp_path / "torn.csv"
    kept = content[: int(share * len(content))]
    torn.write_bytes(kept)
    rows = min(kept.count(b"\n") - 3, len(recording.time))
    if rows < 8:  # the least that a recording holds
        with pytest.raises(jid.InputError, match=r"torn\.csv"):
            jid.load(torn)
        return
    loaded = jid.load(torn)
    assert loaded.metadata["truncated"] is True
    for name in ("time", "position", "torque", "sensor", "reference", "current"):
        assert np.array_equal(getattr(loaded, name), getattr(recording, name)[:rows]), name


def test_only_a_sessions_file_may_be_truncated(
    session: tuple[jid.Recording, Path], tmp_path: Path
) -> None:
    recording, _ = session
    other = tmp_path / "other.csv"
    recording.save(other)
    assert jid.load(other).metadata == recording.metadata
    other.write_bytes(other.read_bytes()[:-40])
    with pytest.raises(jid.InputError):
        jid.load(other)


def test_a_disk_that_takes_nothing_stops_the_session(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object) -> bytes:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("jointid.hardware.session.recorder._line", full)
    with pytest.raises(SessionStoppedError, match="cannot be written: No space left") as caught:
        ran(tmp_path / "run.csv")
    assert caught.value.stop.limit == "recording"
