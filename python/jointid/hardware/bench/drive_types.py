"""Drive types: what a make of drive supplies, and the registry that finds one by its name."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from contextlib import AbstractContextManager
from importlib import import_module
from importlib.metadata import EntryPoint, entry_points
from typing import TYPE_CHECKING, Any

from jointid.base.errors import InputError
from jointid.joint.checks import suggestion

if TYPE_CHECKING:
    from jointid.hardware.bench.bench import Bench, BusOptions
    from jointid.hardware.bench.table import Table
    from jointid.hardware.can.frame_log import LoggedFrame
    from jointid.hardware.emulated.device import Device
    from jointid.hardware.session.cycle import LoggedCycle
    from jointid.hardware.session.drive import Drive
    from jointid.joint.joint import Joint

ENTRY_POINTS = "jointid.drives"
"""Group of entry points by which an installed package registers its drive types."""

DEFAULT_TYPE = "elmo"
"""Type of a joint file or recording that names none: both are older than drive types."""

# Found without an installed entry point, and loaded only when used.
_BUILT_IN = {"elmo": "jointid.hardware.elmo.drive_type:ElmoType"}


class DriveType:
    """The adapter of a make of drive; a subclass, registered by an entry point, is all that a drive needs.

    Only `options`, `open` and `emulate` must be written; `tests/third_party_drive` is an example.

    Attributes
    ----------
    tables : tuple of str
        Tables under `[session]` that `options` reads besides `[session.drive]`. Default: none.

    Examples
    --------
    In the `pyproject.toml` of the package that brings the drive::

        [project.entry-points."jointid.drives"]
        acme = "acme_drive:AcmeType"
    """

    tables: tuple[str, ...] = ()

    def options(self, session: Table, bus: BusOptions) -> Any:
        """Return the drive's options, a frozen dataclass, from the joint file.

        Parameters
        ----------
        session : Table
            The table `[session]`; `session.table("drive").without("type").make(Options)` reads the fields of
            a dataclass from `[session.drive]`, with types, unknown keys and places checked.
        bus : BusOptions
            From `[session.bus]`.

        Raises
        ------
        InputError
            A key is unknown or its value cannot be used.
        """
        raise NotImplementedError

    def open(self, bench: Bench) -> AbstractContextManager[Drive]:
        """Return a context manager that yields the real drive and closes its bus at the end.

        Raises
        ------
        InputError
            The bus cannot be opened.
        """
        raise NotImplementedError

    def address(self, bench: Bench) -> str:
        """Return where the real drive is, shown before a joint moves. Default: its options."""
        return str(bench.drive)

    def emulate(self, bench: Bench, seed: int) -> AbstractContextManager[Drive]:
        """Return a context manager that yields an emulated drive on virtual time.

        Parameters
        ----------
        bench : Bench
        seed : int
            Of the emulated noise.

        Raises
        ------
        InputError
            The bench does not describe an emulated joint.
        """
        raise NotImplementedError

    def emulation(self, table: Table) -> Any:
        """Return options of the emulated drive from those keys of `[session.emulated]` that are its own.

        Default: there are none, and any key raises InputError.
        """
        table.check_names(())
        return None

    def devices(self, bench: Bench, seed: int) -> tuple[Device, ...]:
        """Return emulated devices for a CAN bus that other programs use; default: raises InputError."""
        del seed
        raise InputError(
            "this type of drive cannot be emulated on a CAN bus",
            argument="type",
            value=bench.drive_type,
            place="[session.drive]",
        )

    def metadata(self, options: Any) -> Mapping[str, Any]:
        """Return the options as JSON's types, to be kept in each recording as "drive_options".

        A drive that is opened by this type returns ``{"drive_type": name, "drive_options": …}`` from its own
        `metadata`. Default: the fields of the dataclass.
        """
        from jointid.hardware.session.metadata import plain

        found: Mapping[str, Any] = plain(options)
        return found

    def wiring(self, options: Any) -> Mapping[str, Any]:
        """Return those options that decide about signs and scales: a bench certificate is void when one changes.

        Default: all of them.
        """
        return self.metadata(options)

    def recorded_options(self, metadata: Mapping[str, Any]) -> Any:
        """Return the options that `metadata` wrote; the default ones when a recording has none.

        Default: raises InputError, so that a frame log cannot be replayed.

        Raises
        ------
        InputError
            They are not those of this type.
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
        """Return the control cycles that a session's frame log holds, in order.

        Default: raises InputError.

        Parameters
        ----------
        frames : iterable of LoggedFrame
            What the drive gave to its `tap`, and other nodes' frames in logs of other programs.
        joint : Joint
        options : object
        identity : mapping
            What `Drive.identity` returned in that session; empty when it is not known.

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
            "this type of drive decodes no frame log", argument="drive", value=type(self).__name__
        )


def drive_type_names() -> tuple[str, ...]:
    """Return the names of all drive types that are built in or installed."""
    return tuple(sorted({*_BUILT_IN, *entry_points(group=ENTRY_POINTS).names}))


def drive_type(name: str) -> DriveType:
    """Return the adapter of a drive type.

    Raises
    ------
    InputError
        No text, no such type, several packages that register it, one that registers a built-in name, or an
        entry point that cannot be used: `__cause__` is what its package raised.
    """
    if not isinstance(name, str):
        raise _refused(name, "a text is expected")
    found: tuple[EntryPoint, ...] = tuple(entry_points(group=ENTRY_POINTS, name=name))
    if name in _BUILT_IN:
        if found:
            raise _refused(name, f"registered by {_origin(found[0])}, but built in; rename it")
        module, _, kind = _BUILT_IN[name].partition(":")
        made: DriveType = getattr(import_module(module), kind)()
        return made
    if not found:
        names = suggestion(name, drive_type_names())
        raise _refused(name, f"{names}; a package registers more of them as entry points")
    if len({entry.value for entry in found}) > 1:
        values = ", ".join(sorted(entry.value for entry in found))
        raise _refused(name, f"registered by several packages: {values}")
    return _loaded(name, found[0])


def _loaded(name: str, entry: EntryPoint) -> DriveType:
    """Return the adapter that a package supplies; whatever it raises is no bug of this program."""
    try:
        loaded = entry.load()
        adapter = loaded() if isinstance(loaded, type) else loaded
    except Exception as error:
        raise _refused(
            name,
            f"the entry point {entry.value} of {_origin(entry)} cannot be used "
            f"({type(error).__name__}: {error})",
        ) from error
    if not isinstance(adapter, DriveType):
        raise _refused(
            name,
            f"the entry point {entry.value} of {_origin(entry)} is not a DriveType but a {type(adapter).__name__}",
        )
    return adapter


def _origin(entry: EntryPoint) -> str:
    """The package that brings an entry point."""
    return "an unknown package" if entry.dist is None else f"the package {entry.dist.name}"


def _refused(name: object, reason: str) -> InputError:
    return InputError(reason, argument="drive type", value=name)
