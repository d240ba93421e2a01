"""Format of a make of drive: its options, and its frames in a log."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from jointid.base.errors import InputError

if TYPE_CHECKING:
    from jointid.hardware.bench.bus_options import BusOptions
    from jointid.hardware.bench.table import Table
    from jointid.hardware.can.frame_log import LoggedFrame
    from jointid.hardware.session.cycle import LoggedCycle
    from jointid.joint.joint import Joint


class DriveFormat:
    """Part of a `DriveType` that needs no bench."""

    tables: tuple[str, ...] = ()

    def options(self, session: Table, bus: BusOptions) -> Any:
        """Return the drive's options from the joint file, as a frozen dataclass.

        Parameters
        ----------
        session : Table
            The table `[session]`. `session.table("drive").without("type").make(Options)` reads the fields of a
            dataclass from `[session.drive]`. It checks types and unknown keys, and its errors name the place in the
            file.
        bus : BusOptions
            Options from `[session.bus]`.

        Raises
        ------
        InputError
            A key is unknown or its value cannot be used.
        """
        raise NotImplementedError

    def emulation(self, table: Table) -> Any:
        """Return the options of the emulated drive from its own keys of `[session.emulated]`.

        Default: no options; any key raises InputError.
        """
        table.check_names(())
        return None

    def metadata(self, options: Any) -> Mapping[str, Any]:
        """Return the options in JSON types. Each recording keeps these options as "drive_options".

        The method `metadata` of an opened drive returns ``{"drive_type": name, "drive_options": …}``. Default: the
        fields of the dataclass.
        """
        from jointid.hardware.session.metadata import plain

        found: Mapping[str, Any] = plain(options)
        return found

    def wiring(self, options: Any) -> Mapping[str, Any]:
        """Return the options that set signs and scales. If one of them changes, the bench certificate is not valid.

        Default: all options.
        """
        return self.metadata(options)

    def recorded_options(self, metadata: Mapping[str, Any]) -> Any:
        """Return the options in a recording's metadata, or the default options if it has none.

        Default: raises InputError, so that a frame log cannot be replayed.

        Raises
        ------
        InputError
            The options do not belong to this type.
        """
        del metadata
        raise self._no_replay()

    def decode(
        self,
        frames: Iterable[LoggedFrame],
        joint: Joint,
        options: Any,
        identity: Mapping[str, Any],
    ) -> Sequence[LoggedCycle]:
        """Return the control cycles in a session's frame log, in order.

        Default: raises InputError.

        Parameters
        ----------
        frames : iterable of LoggedFrame
            Frames that the drive passed to its `tap`. Logs of other programs also contain frames of other nodes.
        joint : Joint
        options : object
        identity : mapping
            Result of `Drive.identity` in the logged session; empty if it is not known.

        Raises
        ------
        InputError
            Frames are missing.
        """
        del frames, joint, options, identity
        raise self._no_replay()

    def command_latency(self, options: Any) -> float:
        """Return the time from sending a command until the drive acts on it [s]. Default: 0."""
        del options
        return 0.0

    def _no_replay(self) -> InputError:
        return InputError(
            "this type of drive cannot decode a frame log",
            argument="drive",
            value=type(self).__name__,
        )
