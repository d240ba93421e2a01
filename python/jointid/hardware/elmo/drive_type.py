"""The drive type "elmo": read options from a joint file, open or emulate the drive, decode its frame log."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from jointid.base.errors import InputError
from jointid.hardware.bench.bench import Bench, DriveType
from jointid.hardware.bench.bus_options import BusOptions
from jointid.hardware.can.bus import open_bus
from jointid.hardware.elmo.drive import ElmoDrive
from jointid.hardware.elmo.emulated_bench import ElmoEmulation, elmo_devices, elmo_emulation
from jointid.hardware.elmo.logged_cycles import CycleReader
from jointid.hardware.elmo.options import ElmoOptions
from jointid.hardware.elmo.recorded_options import elmo_options_document, elmo_options_of
from jointid.hardware.elmo.timing import command_latency
from jointid.hardware.elmo.torque_source import read_torque_source
from jointid.hardware.emulated.bus import EmulatedBus

if TYPE_CHECKING:
    from jointid.hardware.bench.table import Table
    from jointid.hardware.can.frame_log import LoggedFrame
    from jointid.hardware.emulated.device import Device
    from jointid.hardware.session.cycle import LoggedCycle
    from jointid.joint.joint import Joint

_WIRING = ("node", "counts_per_turn", "torque")


class ElmoType(DriveType):
    """An Elmo SimplIQ drive on CANopen. `[session.torque]` describes the torque sensor."""

    tables = ("torque",)

    def options(self, session: Table, bus: BusOptions) -> ElmoOptions:
        """Return the options of `[session.drive]` and `[session.torque]`."""
        return (
            session.table("drive")
            .without("type")
            .make(
                ElmoOptions,
                torque=read_torque_source(session.table("torque")),
                bitrate=float(bus.bitrate),
            )
        )

    @contextmanager
    def open(self, bench: Bench) -> Iterator[ElmoDrive]:
        """Yield the drive on the bench's CAN bus."""
        bus = bench.bus
        with open_bus(
            interface=bus.interface,
            channel=bus.channel,
            bitrate=bus.bitrate,
            identifiers=bench.drive.received,
            fd=bus.fd,
            data_bitrate=bus.data_bitrate,
        ) as opened:
            yield ElmoDrive(opened, bench.joint, bench.drive)

    def address(self, bench: Bench) -> str:
        """Return bus and node."""
        return f"{bench.bus.interface} {bench.bus.channel}, node {bench.drive.node}"

    @contextmanager
    def emulate(self, bench: Bench, seed: int) -> Iterator[ElmoDrive]:
        """Yield the drive on an emulated bus with its own clock."""
        emulation = elmo_emulation(bench)
        with EmulatedBus(
            *elmo_devices(bench, seed),
            bitrate=float(bench.bus.bitrate),
            clock_drift=emulation.clock_drift,
            jitter=emulation.jitter,
            seed=seed,
        ) as emulated:
            yield ElmoDrive(emulated, bench.joint, bench.drive)

    def emulation(self, table: Table) -> ElmoEmulation:
        """Return how the emulated drive handles a command."""
        return table.make(ElmoEmulation)

    def devices(self, bench: Bench, seed: int) -> tuple[Device, ...]:
        """Return the drive, and the torque sensor's converter if the bench has one."""
        return elmo_devices(bench, seed)

    def metadata(self, options: ElmoOptions) -> dict[str, Any]:
        """Return the options as JSON types."""
        return elmo_options_document(options)

    def wiring(self, options: ElmoOptions) -> dict[str, Any]:
        """Return node, encoder counts, and how the torque sensor is read and scaled."""
        document = elmo_options_document(options)
        return {name: document[name] for name in _WIRING if name in document}

    def recorded_options(self, metadata: Mapping[str, Any]) -> ElmoOptions:
        """Return the options in a recording's metadata."""
        return elmo_options_of(metadata)

    def decode(
        self,
        frames: Iterable[LoggedFrame],
        joint: Joint,
        options: ElmoOptions,
        identity: Mapping[str, Any],
    ) -> Sequence[LoggedCycle]:
        """Return the cycles. Each has a SYNC, its answers, a command and our heartbeat."""
        if joint.torque_constant is None:
            raise InputError(
                "missing; without a torque constant, the recorded commands are only currents",
                argument="torque_constant",
            )
        reader = CycleReader(
            joint,
            options,
            stamped=identity.get("stamped_frames", True),
            rated_current=identity.get("continuous_current", math.nan),
        )
        reader.read(frames)
        return reader.cycles

    def command_latency(self, options: ElmoOptions) -> float:
        """Return the time of a command on the bus and in the drive's queue [s]."""
        return command_latency(options)
