"""A bench certificate: written, read, and void when the bench changes or time has passed."""

from dataclasses import replace
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import pytest

import jointid as jid
from jointid.base.errors import InputError
from jointid.hardware.bench.bench import Bench
from jointid.hardware.proof.certificate import Certificate, certificate_path
from jointid.hardware.proof.result import FirstMotion
from jointid.hardware.session.watchdog import Watchdog

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "hardware" / "joint.toml"
IDENTITY = {
    "drive": "Elmo SimplIQ",
    "node": 127,
    "serial": '19"59\n',
    "firmware": "Cello 2.02",
    "stamped_frames": True,
    "peak_current": 8.0,
}
WATCHDOG = Watchdog(time=0.05, fed_by="heartbeat", then="off", read_back=True)
NOW = datetime(2026, 11, 22, 12, 0, tzinfo=UTC)


@pytest.fixture
def bench() -> Bench:
    return Bench.load(EXAMPLE)


def certificate(bench: Bench) -> Certificate:
    passed = FirstMotion(
        passed=True,
        travel=0.005,
        breakaway=(45.7, 44.9),
        inertia=2.8,
        identity=IDENTITY,
        drive_watchdog=WATCHDOG,
        unchecked=("homing",),
    )
    return Certificate.of(bench, passed, NOW)


def test_it_is_read_as_it_was_written(bench: Bench, tmp_path: Path) -> None:
    path = certificate_path(tmp_path / "joint.toml")
    assert path == tmp_path / "joint.certificate.toml"
    written = certificate(bench)
    written.save(path)
    read = Certificate.load(path)
    assert read == written
    assert read.objections(bench, IDENTITY, NOW) == []
    text = path.read_text(encoding="utf-8")
    for part in ("45.7", "homing", "Cello", "signs.torque_and_encoder", jid.__version__):
        assert part in text or part == "signs.torque_and_encoder"


@pytest.mark.parametrize(
    ("changes", "name"),
    [
        ({"gear_ratio": 100.0}, "gear_ratio"),
        ({"gear_ratio": -101.0}, "gear_ratio"),
        ({"torque_constant": 0.2}, "torque_constant"),
        ({"rotor_inertia": 2.5e-3}, "rotor_inertia"),
    ],
)
def test_a_change_of_the_joint_file_voids_it(
    bench: Bench, changes: dict[str, Any], name: str
) -> None:
    changed = replace(bench, joint=bench.joint.replace(**changes))
    (objection,) = certificate(bench).objections(changed, IDENTITY, NOW)
    assert name in objection


def test_the_sensors_sign_voids_it_and_its_gain_does_not(bench: Bench) -> None:
    identified = replace(bench, joint=bench.joint.with_parameters({"sensor_gain": 2.4}))
    assert certificate(bench).objections(identified, IDENTITY, NOW) == []
    free = bench.joint.replace(parameters={"sensor_gain": -1.0})
    (objection,) = certificate(bench).objections(replace(bench, joint=free), IDENTITY, NOW)
    assert "sensor_sign was 1.0 and is -1.0" in objection


@pytest.mark.parametrize("changes", [{"counts_per_turn": 4000}, {"node": 5}, {"torque": None}])
def test_a_change_of_the_drives_wiring_voids_it(bench: Bench, changes: dict[str, Any]) -> None:
    changed = replace(bench, drive=replace(bench.drive, **changes))
    assert certificate(bench).objections(changed, IDENTITY, NOW)
    harmless = replace(bench, drive=replace(bench.drive, heartbeat=0.1, position_offset=0.3))
    assert certificate(bench).objections(harmless, IDENTITY, NOW) == []


def test_another_drive_voids_it(bench: Bench) -> None:
    for changes in ({"serial": "2"}, {"firmware": "3.0"}, {"node": 1}):
        assert certificate(bench).objections(bench, {**IDENTITY, **changes}, NOW)
    gone = {name: value for name, value in IDENTITY.items() if name != "serial"}
    assert certificate(bench).objections(bench, gone, NOW)
    harmless = {**IDENTITY, "peak_current": 3.0, "stamped_frames": False}
    assert certificate(bench).objections(bench, harmless, NOW) == []


@pytest.mark.parametrize(
    ("name", "wider", "narrower"),
    [
        ("torque", 400.0, 80.0),
        ("velocity", 9.0, 0.5),
        ("position", (-1.5, 1.6), (-0.1, 0.1)),
    ],
)
def test_wider_limits_void_it_and_narrower_ones_do_not(
    bench: Bench, name: str, wider: Any, narrower: Any
) -> None:
    limits = replace(bench.limits, position=(-1.5, 1.5), velocity=5.0, torque=160.0)
    bench = replace(bench, limits=limits)
    one = certificate(bench)
    changed = replace(bench, limits=replace(limits, **{name: wider}))
    (objection,) = one.objections(changed, IDENTITY, NOW)
    assert name in objection
    assert "wider" in objection
    changed = replace(bench, limits=replace(limits, **{name: narrower}))
    assert one.objections(changed, IDENTITY, NOW) == []
    unlimited = certificate(replace(bench, limits=replace(limits, torque=float("inf"))))
    assert unlimited.objections(bench, IDENTITY, NOW) == []


def test_a_larger_current_voids_it(bench: Bench) -> None:
    one = certificate(bench)
    limits = bench.joint.limits
    assert limits.current is not None
    for factor, number in ((2.5, 1), (0.5, 0)):
        current = replace(limits, current=factor * limits.current)
        changed = replace(bench, joint=bench.joint.replace(limits=current))
        assert len(one.objections(changed, IDENTITY, NOW)) == number


def test_limits_are_kept_in_the_file(bench: Bench, tmp_path: Path) -> None:
    path = tmp_path / "joint.certificate.toml"
    certificate(bench).save(path)
    changed = replace(bench, limits=replace(bench.limits, torque=2.0 * bench.limits.torque))
    assert len(Certificate.load(path).objections(changed, IDENTITY, NOW)) == 1


def test_a_moved_zero_and_a_drive_without_number_are_noted(bench: Bench) -> None:
    one = certificate(bench)
    assert one.notes(bench, IDENTITY) == []
    homed = replace(bench, drive=replace(bench.drive, position_offset=0.5))
    assert one.objections(homed, IDENTITY, NOW) == []
    (note,) = one.notes(homed, IDENTITY)
    assert "position_offset was 0 and is 0.5 rad" in note
    for identity in ({**IDENTITY, "serial": "0"}, {"node": 127}):
        (note,) = one.notes(bench, identity)
        assert "serial number" in note


def test_it_holds_for_thirty_days(bench: Bench) -> None:
    one = certificate(bench)
    assert one.objections(bench, IDENTITY, NOW + timedelta(days=29.9)) == []
    (old,) = one.objections(bench, IDENTITY, NOW + timedelta(days=31))
    assert "31 days" in old
    (future,) = one.objections(bench, IDENTITY, NOW - timedelta(days=1))
    assert "future" in future


def test_only_a_passed_bench_is_certified(bench: Bench) -> None:
    with pytest.raises(InputError, match="passed"):
        Certificate.of(bench, FirstMotion(passed=False, reason="sensor_sign"))


@pytest.mark.parametrize(
    "text",
    [
        "schema = 1",
        "schema = 2\n",
        "not toml",
        'schema = 1\ndate = "x"\n[joint]\n[wiring]\n[drive]\n[found]\n[limits]\n[versions]\n',
        'schema = 1\ndate = "2026-11-22T12:00:00"\n[joint]\n[wiring]\n[drive]\n[found]\n[limits]\n[versions]\n',
        "schema = 1\ndate = 3\n[joint]\n[wiring]\n[drive]\n[found]\n[limits]\n[versions]\n",
    ],
)
def test_a_file_that_is_none_is_refused_by_its_name(tmp_path: Path, text: str) -> None:
    path = tmp_path / "joint.certificate.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError) as error:
        Certificate.load(path)
    assert str(path) in str(error.value)


@pytest.mark.parametrize(
    ("changes", "objection"),
    [
        ({"time": 0.05}, None),
        ({"time": 0.02}, None),
        ({"time": 0.051}, "the watchdog's time was 0.05 and is 0.051"),
        ({"time": 10.0}, "the watchdog's time was 0.05 and is 10.0"),
        ({"fed_by": "any frame to the node"}, "the watchdog's fed_by was heartbeat"),
        ({"then": "damped"}, "the watchdog's then was off and is damped"),
        ({"read_back": False}, "the watchdog's read_back was True and is False"),
    ],
)
def test_a_slower_watchdog_voids_it(
    bench: Bench, changes: dict[str, Any], objection: str | None, tmp_path: Path
) -> None:
    certificate(bench).save(tmp_path / "joint.certificate.toml")
    read = Certificate.load(tmp_path / "joint.certificate.toml")
    found = read.objections(bench, IDENTITY, NOW, watchdog=replace(WATCHDOG, **changes))
    assert len(found) == (objection is not None)
    assert objection is None or objection in found[0]


def test_one_from_before_the_watchdog_was_known_is_void(bench: Bench, tmp_path: Path) -> None:
    path = tmp_path / "joint.certificate.toml"
    certificate(bench).save(path)
    begin, _, rest = path.read_text(encoding="utf-8").partition("[watchdog]")
    path.write_text(begin + rest[rest.index("[versions]") :], encoding="utf-8")
    read = Certificate.load(path)
    assert read.objections(bench, IDENTITY, NOW) == []
    (objection,) = read.objections(bench, IDENTITY, NOW, watchdog=WATCHDOG)
    assert objection == "the certificate has no table [watchdog], but the bench states these facts"


def test_no_certificate_without_a_watchdog_that_is_known(bench: Bench) -> None:
    passed = FirstMotion(passed=True, identity=IDENTITY)
    with pytest.raises(InputError, match="the drive declares no watchdog"):
        Certificate.of(bench, passed, NOW)
    unread = replace(passed, drive_watchdog=replace(WATCHDOG, read_back=False))
    with pytest.raises(InputError, match="use --watchdog"):
        Certificate.of(bench, unread, NOW)
    seen = Certificate.of(bench, replace(unread, watchdog=0.0505), NOW)
    assert seen.watchdog["read_back"] is False
