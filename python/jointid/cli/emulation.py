"""Command `emulate`: an emulated bench on a bus, for a session in another program."""

from __future__ import annotations

import argparse
import sys
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

from jointid.base.errors import InputError
from jointid.cli.arguments import decimal, whole_seed


def add_emulate(emulate: argparse.ArgumentParser) -> None:
    """Add the command's grammar."""
    emulate.epilog = (
        "examples:\n"
        "  jointid emulate joint.toml --interface socketcan --channel vcan0\n"
        "  jointid emulate joint.toml --interface udp_multicast --channel 239.74.163.2 --duration 60\n"
        "the joint file needs a table [session.emulated]; the emulation runs in real time until Ctrl-C"
    )
    emulate.add_argument("joint", type=Path, help="joint file (.toml) with [session.emulated]")
    emulate.add_argument(
        "--interface", help="python-can's name of the interface; default: from the joint file"
    )
    emulate.add_argument("--channel", help="channel of the interface; default: from the joint file")
    emulate.add_argument(
        "--duration", type=decimal, help="duration of the emulation [s]; default: until Ctrl-C"
    )
    emulate.add_argument(
        "--seed", type=whole_seed, default=0, help="seed of the sensor's noise (default 0)"
    )
    emulate.add_argument(
        "--json",
        action="store_true",
        help="print each event of the drive (state, motor, failure) as a line of JSON",
    )
    emulate.add_argument(
        "--rest",
        type=decimal,
        default=0.0,
        help="interval between two wake-ups [s], for a slow machine; frames can be late by this interval (default 0)",
    )


def emulate(arguments: argparse.Namespace) -> int:
    """Put an emulated bench on a bus."""
    import math
    import time

    from jointid.hardware.bench.bench import Bench
    from jointid.hardware.bench.opened_drive import emulated_devices
    from jointid.hardware.can.bus import open_bus
    from jointid.hardware.emulated.journal import Journal
    from jointid.hardware.emulated.thread import EmulatorThread
    from jointid.hardware.emulated.wire import bitrate_to_emulate

    bench = Bench.load(arguments.joint)
    duration = math.inf if arguments.duration is None else arguments.duration
    if not duration > 0.0:
        raise InputError("more than 0 s is expected", argument="duration", value=duration)
    if not 0.0 <= arguments.rest <= 0.02:
        raise InputError("0 to 0.02 s is expected", argument="rest", value=arguments.rest)
    interface = arguments.interface or bench.bus.interface
    channel = arguments.channel or bench.bus.channel
    _check_reached(interface, arguments.joint)
    place = replace(bench.bus, interface=interface, channel=channel)
    devices: tuple[Any, ...] = emulated_devices(bench, arguments.seed)
    bitrate = bitrate_to_emulate(interface, channel, float(place.bitrate))
    journal = None
    if arguments.json:
        if not hasattr(devices[0], "condition"):
            raise InputError(
                f"the emulated drive of the type {bench.drive_type!r} reports no events",
                argument="json",
            )
        journal = Journal(devices[0], sys.stdout)
        devices = (*devices, journal)
    with (
        open_bus(**asdict(place)) as bus,
        EmulatorThread(
            bus,
            *devices,
            bitrate=bitrate,
            watch=journal,
            rest=arguments.rest,
            data_bitrate=place.data_bitrate,
        ) as emulator,
    ):
        said = f"emulated drive ({bench.drive_type}) on {interface} {channel}; Ctrl-C ends it"
        print(said, file=sys.stderr if arguments.json else sys.stdout, flush=True)
        end = time.monotonic() + duration
        while emulator.running and time.monotonic() < end:
            time.sleep(min(0.05, max(0.0, end - time.monotonic())))
    return 0


def _check_reached(interface: str, joint: Path) -> None:
    """Refuse a bus that no other program can reach."""
    if interface == "virtual":
        raise InputError(
            "python-can's virtual bus exists only inside this process, so no session can reach the drive",
            argument="interface",
            value=interface,
            remedy=f"jointid emulate {joint} --interface udp_multicast --channel 239.74.163.2",
        )
