"""Whatever goes wrong, the session stops for the right reason, and the motor is off a few cycles later."""

import math
import sys
from pathlib import Path

import numpy as np
import pytest

import jointid as jid

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "benchmarks"))
from fault_cases import (
    ANSWER,
    BEGIN,
    CASES,
    COMMAND,
    OFF,
    PERIOD,
    POSITION,
    REPLY,
    ZERO,
    Case,
    EmulatedSession,
    outcome,
)
from fault_matrix import row

from jointid.hardware import SessionStoppedError
from jointid.hardware.emulated.faults import DRIVE_FAILURES, BusFault
from jointid.hardware.session.braking import BRAKED
from jointid.hardware.session.limits import SessionLimits

WATCHDOG = 0.05  # [s], of the drive, and the step it is looked at in
LOOK = 0.5e-3


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_fault_stops_the_session_and_the_motor(case: Case, tmp_path: Path) -> None:
    found = outcome(case, tmp_path / "run.csv")
    stop, bench = found.stop, found.bench
    assert stop.limit == case.stop
    assert case.says in stop.message
    assert stop.phase == "run"
    assert 0.0 <= found.detected <= case.detected
    # The last commands to the drive: no torque, then motor off; soon, and asked for.
    sent = bench.bus.assignments()
    assert [data for _, data in sent[-2:]] == [ZERO, OFF]
    braked = found.recording.metadata.get("braked")
    took = 0.0 if braked is None else braked["time"]
    assert (braked is not None) <= (stop.limit in BRAKED)
    assert {data for when, data in sent if when > stop.moment + took} <= {ZERO, OFF}
    assert 0.0 <= found.commanded_off - took <= 3 * PERIOD
    if braked is not None:  # slower than before, and soon
        assert took < 0.15
        assert braked["left"] < braked["velocity"]
    assert not bench.elmo.motor_on
    assert bench.elmo.current == 0.0
    slowest = 4 * PERIOD if case.reachable else WATCHDOG + LOOK
    assert found.motor_off - took <= slowest
    assert stop.motor_off is case.heard
    # What was recorded is there, and says why it ends.
    assert found.recording.metadata["stopped"] == stop.to_dict()
    assert found.recording.metadata["motor_off"] is case.heard
    kept = jid.load(tmp_path / "run.csv")
    assert len(kept) == len(found.recording)
    assert np.array_equal(kept.position, found.recording.position)
    assert kept.time[-1] - kept.time[0] <= stop.time + PERIOD
    assert stop.limit in row(case.name, found)


def test_every_limit_has_a_case_and_a_line_in_the_documentation(repo: Path) -> None:
    stops = {case.stop for case in CASES}
    limits = set(SessionLimits.__slots__) - {"watchdog_travel"}  # refuses, and stops nothing
    assert limits <= stops
    assert stops - limits == {
        *("stale_position", "drive_fault", "heartbeat_lost", "host_heartbeat_lost"),
        *("bus", "sensor", "user", "error", "torque_sign", "foreign_master", "command_echo"),
    }
    page = (repo / "docs" / "safety.md").read_text(encoding="utf-8")
    table = page.partition("\n## Stops\n")[2].partition("\n## ")[0]
    wording = {line.split("`")[1] for line in table.splitlines() if line.startswith("| `")}
    assert wording - {"stop.limit", "watchdog_travel"} == stops | {"recording"}


@pytest.mark.parametrize("kind", sorted(set(DRIVE_FAILURES) - {"host heartbeat lost"}))
def test_a_failure_of_the_drive_is_explained(kind: str) -> None:
    case = Case(
        name=kind, stop="drive_fault", script=lambda b: b.at(BEGIN, lambda: b.elmo.fail(kind))
    )
    stop = outcome(case).stop
    assert stop.limit == "drive_fault"
    assert "; the drive reports: " in stop.message
    assert "unknown" not in stop.message


@pytest.mark.parametrize(
    "fault",
    [
        BusFault(kind="duplicate", start=BEGIN, identifier=POSITION),
        BusFault(kind="duplicate", start=BEGIN, identifier=COMMAND),
        BusFault(kind="delay", start=BEGIN, identifier=POSITION, delay=0.2e-3),
        BusFault(kind="delay", start=BEGIN, identifier=COMMAND, delay=0.2e-3),
        BusFault(kind="drop", start=BEGIN, stop=BEGIN + 4 * PERIOD, identifier=REPLY),
        BusFault(kind="drop", start=BEGIN, stop=BEGIN + 4 * PERIOD, identifier=COMMAND),
    ],
    ids=lambda fault: f"{fault.kind} {fault.identifier}",
)
def test_a_tolerable_fault_does_not_stop_a_session(fault: BusFault) -> None:
    bench = EmulatedSession((fault,))
    recording = bench.session().run()
    assert recording is not None
    assert recording.reference is not None
    assert np.abs(recording.position - recording.reference).max() < 0.01
    assert recording.metadata["stop"] is None
    assert recording.metadata["motor_off"] is True
    assert not bench.elmo.motor_on


def test_a_run_whose_motor_was_not_seen_off_is_no_success() -> None:
    faults = tuple(
        BusFault(kind="drop", start=math.inf, identifier=identifier)
        for identifier in (REPLY, ANSWER)
    )
    bench = EmulatedSession(faults)

    def watch(phase: str, when: float, *_: object) -> None:
        if phase == "run" and when > 2.0 - 1.5 * PERIOD:
            for fault in faults:
                fault.start = bench.bus.now()

    bench.observer = watch
    with pytest.raises(
        SessionStoppedError, match="the run has ended, but the motor is not off"
    ) as found:
        bench.session().run()
    assert (found.value.stop.limit, found.value.stop.motor_off) == ("drive_fault", False)
    assert found.value.recording is not None
    assert not bench.elmo.motor_on


def test_watchdog_of_the_drive_is_disarmed_when_all_is_over() -> None:
    bench = EmulatedSession()
    bench.session().run()
    bench.bus.sleep_until(bench.bus.now() + 1.0)
    assert bench.elmo.failure == 0
    assert bench.elmo.objects.consumer_time == 0.0
    bench.session().run()  # and it starts again


def test_watchdog_stays_armed_when_the_motor_was_not_seen_off() -> None:
    case = next(case for case in CASES if case.name == "bus off")
    assert outcome(case).bench.elmo.objects.consumer_time == WATCHDOG


def test_cases_are_bit_identical_each_time() -> None:
    case = next(case for case in CASES if case.name == "first two switchings-off are lost")
    once, again = outcome(case), outcome(case)
    assert once.stop == again.stop
    assert once.bench.bus.tried == again.bench.bus.tried
    assert np.array_equal(once.recording.position, again.recording.position)


def test_drive_stops_by_itself_when_the_host_is_killed() -> None:
    bench = EmulatedSession()

    class Killed(BaseException):
        pass

    def watch(*_: object) -> None:
        if bench.bus.now() >= BEGIN:
            raise Killed

    bench.observer = watch
    bench.drive.disable = lambda: None  # type: ignore[method-assign,assignment,return-value]
    bench.drive.close = lambda: None  # type: ignore[method-assign]
    with pytest.raises(Killed):
        bench.session().run()
    killed = bench.bus.now()
    assert bench.elmo.motor_on
    bench.bus.sleep_until(killed + WATCHDOG - 2 * PERIOD)
    assert bench.elmo.motor_on
    bench.bus.sleep_until(killed + WATCHDOG + LOOK + PERIOD)  # the last heartbeat was on its way
    assert not bench.elmo.motor_on
    assert bench.elmo.failure == 0x800
