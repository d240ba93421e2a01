"""A bus opened for a session: the frames it needs, and one clear sentence when it cannot be opened."""

import sys
from pathlib import Path
from typing import Any
from unittest.mock import MagicMock

import can
import pytest

from jointid.base.errors import InputError
from jointid.hardware.bench.bus_options import BusOptions
from jointid.hardware.can import bus as bus_module
from jointid.hardware.can.bus import open_bus
from jointid.hardware.elmo.options import ElmoOptions
from jointid.hardware.elmo.torque_source import AnalogInput, SyncedConverter


def test_a_bus_carries_frames_and_is_shut_down() -> None:
    with (
        open_bus(interface="virtual", channel="carries") as bus,
        can.Bus("carries", interface="virtual") as other,
    ):
        other.send(can.Message(arbitration_id=0x4FF, data=b"abcd", is_extended_id=False))
        message = bus.recv(5.0)
        assert message is not None
        assert bytes(message.data) == b"abcd"
    with pytest.raises(can.CanOperationError):
        bus.recv(0.0)


def test_a_bus_is_shut_down_after_an_error_too() -> None:
    with (
        pytest.raises(ZeroDivisionError),
        open_bus(interface="virtual", channel="errs") as bus,
    ):
        raise ZeroDivisionError
    with pytest.raises(can.CanOperationError):
        bus.send(can.Message())


@pytest.mark.parametrize(
    ("options", "drives", "masters"),
    [
        (
            ElmoOptions(),
            {0x2FF, 0x4FF, 0x0FF, 0x77F, 0x5FF, 0x1C0},
            {0x000, 0x080, 0x701, 0x27F, 0x37F, 0x47F, 0x57F, 0x67F},
        ),
        (
            ElmoOptions(node=5, master=9, torque=SyncedConverter(identifier=0x123)),
            {0x285, 0x485, 0x085, 0x705, 0x585, 0x123},
            {0x000, 0x080, 0x709, 0x205, 0x305, 0x405, 0x505, 0x605},
        ),
        (
            ElmoOptions(
                node=5,
                torque=AnalogInput(),
                cob_command=0x3F0,
                cob_reply=0x4FE,
                cob_position=0x405,
            ),
            {0x4FE, 0x405, 0x085, 0x705, 0x585},
            {0x000, 0x080, 0x701, 0x205, 0x3F0, 0x505, 0x605},
        ),
    ],
)
def test_the_frames_a_session_needs(
    options: ElmoOptions, drives: set[int], masters: set[int]
) -> None:
    assert set(options.answering) == drives
    assert set(options.commanding) == masters
    assert set(options.received) == drives | masters


def network(folder: Path, flags: str) -> None:
    (folder / "can0").mkdir()
    (folder / "can0" / "flags").write_text(flags)


def test_socketcan_gets_a_filter_for_each_identifier(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    network(tmp_path, "0x40081\n")
    monkeypatch.setattr(bus_module, "_NETWORKS", tmp_path)
    opened: dict[str, object] = {}

    class Opened:
        def __init__(self, channel: str, **settings: object) -> None:
            opened.update(settings, channel=channel)

        def shutdown(self) -> None:
            opened["shut"] = True

    monkeypatch.setattr(can, "Bus", Opened)
    with open_bus(identifiers=ElmoOptions(node=3).received):
        assert "shut" not in opened
    # Another master's frames must come through: the kernel does not give us our own.
    assert {0x000, 0x080, 0x303, 0x603, 0x701} < set(ElmoOptions(node=3).received)
    filters = [
        {"can_id": identifier, "can_mask": 0x7FF, "extended": False}
        for identifier in sorted(ElmoOptions(node=3).received)
    ]
    assert opened == {
        "channel": "can0",
        "interface": "socketcan",
        "can_filters": filters,
        "shut": True,
    }


def test_long_identifiers_and_can_fd_are_asked_for(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    network(tmp_path, "0x1")
    monkeypatch.setattr(bus_module, "_NETWORKS", tmp_path)
    opened: list[dict[str, Any]] = []

    def open_it(_channel: str, **settings: Any) -> MagicMock:
        opened.append(settings)
        return MagicMock()

    monkeypatch.setattr(can, "Bus", open_it)
    rates = {"fd": True, "bitrate": 1_000_000, "data_bitrate": 5_000_000}
    for interface in ("socketcan", "virtual", "udp_multicast", "pcan", "vector"):
        with open_bus(interface=interface, identifiers=(0x101, 0x8001), **rates):  # type: ignore[arg-type]
            pass
    with open_bus(identifiers=(0x101,), extended=True):
        pass
    every = 0x1FFFFFFF
    assert opened[0]["can_filters"] == [
        {"can_id": 0x101, "can_mask": 0x7FF, "extended": False},
        {"can_id": 0x8001, "can_mask": every, "extended": True},
    ]
    assert opened[-1]["can_filters"] == [{"can_id": 0x101, "can_mask": every, "extended": True}]
    assert [settings.get("fd") for settings in opened] == [True, None, True, None, True, None]
    assert opened[1]["protocol"] == can.CanProtocol.CAN_FD
    assert opened[3]["timing"].data_bitrate == opened[4]["data_bitrate"] == 5_000_000
    assert opened[3]["timing"].nom_bitrate == 1_000_000


def test_a_network_without_can_fd_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    network(tmp_path, "0x1")
    (tmp_path / "can0" / "mtu").write_text("16\n")
    monkeypatch.setattr(bus_module, "_NETWORKS", tmp_path)
    rates = {"fd": True, "bitrate": 1_000_000, "data_bitrate": 5_000_000}
    with pytest.raises(
        InputError, match=r"CAN FD is not enabled on this network; .*`sudo ip link set can0 mtu 72`"
    ):
        open_bus(**rates).__enter__()  # type: ignore[arg-type]
    (tmp_path / "can0" / "device").mkdir()
    up = "can0 down && sudo ip link set can0 up type can bitrate 1000000 dbitrate 5000000 fd on`"
    with pytest.raises(InputError, match=up):
        open_bus(**rates).__enter__()  # type: ignore[arg-type]


def test_frames_of_can_fd_pass_between_two_buses() -> None:
    places = {"interface": "virtual", "channel": "fd", "fd": True}
    sent = can.Message(arbitration_id=0x8001, data=bytes(24), is_fd=True)
    with open_bus(**places) as here, open_bus(**places) as there:  # type: ignore[arg-type]
        here.send(sent)
        found = there.recv(5.0)
    assert found is not None
    assert found.equals(sent, timestamp_delta=None, check_channel=False, check_direction=False)


def test_a_misspelt_interface_is_refused_without_a_bus() -> None:
    with pytest.raises(InputError, match="interface is 'sockercan': did you mean 'socketcan'"):
        BusOptions(interface="sockercan")
    assert BusOptions(interface="pcan", fd=True, data_bitrate=2_000_000).fd


def test_without_msgpack_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("can.interfaces.udp_multicast.utils.msgpack", None)
    with (
        pytest.raises(InputError, match="needs msgpack for this interface; pip install msgpack"),
        open_bus(interface="udp_multicast", channel="239.74.163.2"),
    ):
        pass


@pytest.mark.parametrize(
    ("settings", "wording"),
    [
        (
            {"interface": "emulated"},
            "interface is 'emulated': python-can has no such interface; for an emulated bench use an EmulatedBus",
        ),
        (
            {"interface": "sockercan"},
            "interface is 'sockercan': did you mean 'socketcan'",
        ),
        (
            {"interface": "virtual", "data_bitrate": 5_000_000},
            "data_bitrate is 5000000: classic CAN \\(fd = false\\) has no .*; state fd = true for CAN FD",
        ),
        (
            {"interface": "virtual", "fd": True, "data_bitrate": 250_000},
            "data_bitrate is 250000: a value from 500000 \\(bitrate\\) to 8000000 bit/s is expected",
        ),
        ({"interface": "virtual", "channel": ""}, "channel is '': missing"),
        ({"interface": "virtual", "channel": None}, "channel is None: missing"),
        ({"bitrate": 500}, "bitrate is 500: 10 000 to 1 000 000 bit/s is expected"),
        (
            {"interface": "ixxat", "channel": "x"},
            "interface 'ixxat': channel is 'x': it cannot be opened",
        ),
    ],
)
def test_what_cannot_be_opened_is_refused_in_one_sentence(
    settings: dict[str, object], wording: str
) -> None:
    with pytest.raises(InputError, match=wording) as refused, open_bus(**settings):  # type: ignore[arg-type]
        pass
    assert "\n" not in str(refused.value)


def test_a_network_that_is_not_there_or_down_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(bus_module, "_NETWORKS", tmp_path)
    with pytest.raises(InputError, match="channel is 'can0': there is no such network"), open_bus():
        pass
    network(tmp_path, "0x40080\n")
    with (
        pytest.raises(
            InputError, match=r"down; .*`sudo ip link set can0 up type can bitrate 250000`"
        ),
        open_bus(bitrate=250_000),
    ):
        pass


@pytest.mark.parametrize(
    ("error", "wording"),
    [
        (
            OSError(97, "Address family not supported by protocol"),
            "the kernel has no CAN",
        ),
        (OSError(19, "No such device"), "there is no such channel"),
        (PermissionError(13, "Permission denied"), "access denied"),
        (can.CanInitializationError("no adapter\nfound"), "it cannot be opened: no adapter found"),
    ],
)
def test_the_systems_words_become_a_sentence(
    error: Exception, wording: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    network(tmp_path, "0x1\n")
    monkeypatch.setattr(bus_module, "_NETWORKS", tmp_path)

    def refuse(*_: object, **__: object) -> None:
        raise error

    monkeypatch.setattr(can, "Bus", refuse)
    with pytest.raises(InputError, match=wording) as refused, open_bus():
        pass
    assert "\n" not in str(refused.value)
    assert refused.value.__cause__ is error


def test_without_python_can_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "can", None)
    with pytest.raises(InputError, match="pip install python-can"), open_bus():
        pass
