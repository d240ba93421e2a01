"""A host that wakes late: its samples keep the time at which they were taken, and nothing stops."""

from pathlib import Path

import pytest

import jointid as jid
from jointid.hardware.can.wire_time import bits_on_wire
from jointid.hardware.elmo.timing import SyncWatch

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "hardware" / "joint.toml"
BITRATE = 500_000.0
SYNC, COMMAND, POSITION = (bits_on_wire(length) / BITRATE for length in (0, 8, 6))


def test_the_example_stands_a_host_that_wakes_late(tmp_path: Path) -> None:
    """At most 0.8 ms late whenever it waits; behind a late command a SYNC waits for the bus."""
    path = tmp_path / "joint.toml"
    text = EXAMPLE.read_text(encoding="utf-8")
    text = text.replace("duration = 12.0 ", "duration = 2.0 ", 1)
    path.write_text(text.replace("[session.emulated] ", "[session.emulated]\njitter = 0.0008 #", 1))
    bench = jid.hardware.Bench.load(path)
    with jid.hardware.open_drive(bench, emulate=True) as drive:
        session = jid.hardware.Session(
            drive, bench.controller, bench.trajectory, bench.limits, options=bench.options
        )
        recording = session.run()
    assert recording is not None
    assert recording.time.size > 950


@pytest.mark.parametrize("stamped", [False, True])
def test_a_sync_waits_for_our_own_frames(stamped: bool) -> None:
    watch = SyncWatch(BITRATE, stamped=stamped)
    watch.own(1.0, 8)
    watch.sent(1.0001)
    assert watch.sampled == pytest.approx(1.0 + COMMAND + SYNC, abs=1e-12)
    watch.sent(1.1)  # the bus is quiet
    assert watch.sampled == pytest.approx(1.1 + SYNC, abs=1e-12)


def test_a_frame_that_began_with_the_sync_went_first() -> None:
    """It would have begun behind the SYNC otherwise."""
    watch = SyncWatch(BITRATE, stamped=True)
    watch.sent(1.0)
    watch.came(1.0 + 1e-7 + COMMAND, 8, answers=False)
    assert watch.sampled == pytest.approx(1.0 + 1e-7 + COMMAND + SYNC, abs=1e-12)
    watch.sent(2.0)
    watch.came(2.0 + SYNC + COMMAND, 8, answers=False)
    watch.came(2.0 + SYNC + COMMAND + POSITION, 6, answers=True)
    assert watch.sampled == pytest.approx(2.0 + SYNC, abs=1e-12)
