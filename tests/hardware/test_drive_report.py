"""What a drive says about itself before it is switched on: identity, limits, watchdog, state."""

import json
import math
import struct

import pytest
from session_bench import JOINT, PERIOD, devices, session

import jointid as jid
from jointid.hardware import DriveFaultError, DriveReport, Reported
from jointid.hardware.can.canopen_frames import SdoAbortError
from jointid.hardware.can.sdo_upload import upload
from jointid.hardware.elmo.drive import ElmoDrive
from jointid.hardware.elmo.emulated_drive import ElmoSettings, EmulatedElmo
from jointid.hardware.elmo.options import ElmoOptions
from jointid.hardware.emulated.bus import EmulatedBus


def bench(settings: ElmoSettings | None = None) -> tuple[EmulatedElmo, ElmoDrive]:
    elmo, converter = devices()
    if settings is not None:
        elmo.settings = settings
    bus = EmulatedBus(elmo, converter)
    drive = ElmoDrive(bus, JOINT, ElmoOptions(master=9))
    drive.connect(PERIOD)
    return elmo, drive


def test_a_report_names_identity_limits_watchdog_and_state() -> None:
    elmo, drive = bench()
    elmo.count_offset = 8080  # a hundredth of a turn
    report = drive.report()
    assert report.drive == "Elmo SimplIQ, node 127, commanded by node 9"
    found = {each.meaning: each.value for each in report.identity}
    assert found["vendor"] == "0x9A"
    assert found["serial"] == report.serial == str(elmo.settings.serial)
    assert str(found["firmware"]).startswith("Cello")
    for name in ("PL[1]", "PL[2]", "CL[1]", "CL[3]", "HL[2]", "LL[2]", "XM[1]", "6075h", "6076h"):
        assert report.value(name) is not None, name
    assert report.value("PL[1]") == 8.0
    assert report.value("HL[2]") == -report.value("LL[2]")  # type: ignore[operator]
    assert report.value("PL[9]") is None
    assert report.value("1016h:1") == "00090032h"
    assert report.value("6007h") == 2
    assert report.differences == ()
    assert report.motor_on is False
    assert report.trouble == ""
    assert report.position == pytest.approx(2.0 * math.pi / 100.0, abs=1e-4)
    assert report.velocity == 0.0
    assert abs(report.reading) < 20.0
    assert report.supply == 48.0
    assert report.temperature == 30.0
    kept = json.loads(json.dumps(report.to_dict()))
    assert kept["supply"] == 48.0
    assert len(kept["watchdog"]) == 5


def test_a_report_changes_nothing() -> None:
    elmo, drive = bench()
    before = (elmo.objects.value(0x6007, 0), elmo.motor_on, elmo.unit_mode, elmo.state)
    sent: list[bytes] = []
    drive.tap = lambda _when, identifier, payload, own: (
        sent.append(payload) if own and identifier in (0x37F, 0x67F) else None
    )
    drive.report()
    assert before == (elmo.objects.value(0x6007, 0), elmo.motor_on, elmo.unit_mode, elmo.state)
    assert sent
    for payload in sent:  # a question has four bytes, a read begins with 40 or 60
        assert len(payload) == 4 or payload[0] & 0xE0 in (0x40, 0x60)


def test_what_is_not_as_a_session_needs_it_is_named() -> None:
    elmo, drive = bench(ElmoSettings(rated_current=4.0))
    elmo.objects.write(0x6007, 0, b"\x00\x00")  # another program's doing
    elmo.failure = 0x4
    report = drive.report()
    assert [each.name for each in report.differences] == ["6075h", "6007h"]
    assert str(report.differences[0]).endswith("torque 6077h: 4000 mA; expected: 8000 mA")
    assert report.trouble == "the drive has shut its motor down earlier: feedback lost"


def test_a_joint_that_moves_shows() -> None:
    elmo, drive = bench()
    elmo.speed = lambda: 80800  # type: ignore[method-assign]
    assert drive.report().velocity == pytest.approx(0.2 * math.pi)


def test_a_silent_drive_has_no_report() -> None:
    elmo, drive = bench()
    elmo.state = "stopped"
    with pytest.raises(DriveFaultError, match=r"SYNC|stopped"):
        drive.report()


def test_a_value_with_its_unit_and_a_missing_one() -> None:
    assert str(Reported(name="PL[1]", meaning="peak", value=8.0, unit="A")) == "PL[1] peak: 8 A"
    missing = Reported(name="TI[1]", meaning="warm", value=None, unit="°C", expected=3)
    assert str(missing) == "TI[1] warm: no answer; expected: 3 °C"
    near = Reported(name="CL[1]", meaning="", value=8.0001, expected=8.0)
    assert not near.differs
    assert Reported(name="CL[1]", meaning="", value=8.1, expected=8.0).differs
    assert DriveReport(drive="none").to_dict()["supply"] is None


def test_a_recording_keeps_the_drives_own_limits() -> None:
    recording = session(EmulatedBus(*devices())).run()
    assert isinstance(recording, jid.Recording)
    limits = recording.metadata["drive"]["limits"]
    assert limits["PL[1]"] == 8.0
    assert limits["HL[2]"] == 10**9
    assert recording.metadata["drive"]["serial"]


# An object of any length.


class Server:
    """Answers with these frames in turn."""

    def __init__(self, *answers: bytes) -> None:
        self.answers, self.requests = list(answers), list[bytes]()

    def __call__(self, request: bytes) -> bytes:
        self.requests.append(request)
        return self.answers.pop(0)


HEAD = struct.pack("<HB", 0x100A, 0)


def test_an_object_in_segments() -> None:
    server = Server(
        b"\x41" + HEAD + struct.pack("<I", 10),
        b"\x00" + b"0123456",
        b"\x19" + b"789" + bytes(4),  # toggled, four bytes unused, the last
    )
    assert upload(server, 0x100A, 0) == b"0123456789"
    assert [request[0] for request in server.requests] == [0x40, 0x60, 0x70]


def test_an_expedited_object() -> None:
    assert upload(Server(b"\x4b" + HEAD + b"ab\0\0"), 0x100A, 0) == b"ab"
    assert upload(Server(b"\x42" + HEAD + b"abcd"), 0x100A, 0) == b"abcd"


@pytest.mark.parametrize(
    ("answers", "says"),
    [
        ((b"\x41" + struct.pack("<HBI", 0x1008, 0, 4),), "object 100Ah:0 is answered by"),
        ((b"\x60" + HEAD + bytes(4),), "is answered by 60"),
        ((b"\x41" + HEAD + bytes(4), b"\x10" + bytes(7)), "begins with an invalid byte, 10"),
        ((b"\x41" + HEAD + bytes(4), b"\x60" + bytes(7)), "begins with an invalid byte, 60"),
        ((b"\x41" + HEAD + bytes(4), b"\x01\0"), "has 2 bytes"),
        (
            (b"\x41" + HEAD + bytes(4), *300 * (bytes(8), b"\x10" + bytes(7))),
            "the last segment of object",
        ),
    ],
)
def test_answers_that_are_none_to_it(answers: tuple[bytes, ...], says: str) -> None:
    with pytest.raises(jid.InputError, match=says):
        upload(Server(*answers), 0x100A, 0)


def test_a_refused_object() -> None:
    with pytest.raises(SdoAbortError, match="the object does not exist"):
        upload(Server(b"\x80" + HEAD + struct.pack("<I", 0x06020000)), 0x100A, 0)
