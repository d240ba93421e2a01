"""The object dictionary of an emulated CANopen device, with the refusals that CiA 301 requires."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

# Abort codes (CiA 301, table of SDO abort codes).
NOT_READABLE, NOT_WRITABLE = 0x06010001, 0x06010002
NO_OBJECT, NO_SUBINDEX = 0x06020000, 0x06090011
NOT_MAPPABLE, TOO_MUCH_MAPPED = 0x06040041, 0x06040042
TOO_LONG, TOO_SHORT = 0x06070012, 0x06070013
OUT_OF_RANGE = 0x06090030
NOT_STORED, WRONG_STATE, NOTHING_THERE = 0x08000020, 0x08000022, 0x08000024

Value = int | bytes
Read = Callable[[], Value]
Write = Callable[[int], None]
WriteBytes = Callable[[bytes], None]


class AccessError(Exception):
    """An access to an object that is refused.

    Parameters
    ----------
    code : int
        Code of the SDO abort.
    """

    def __init__(self, code: int) -> None:
        super().__init__(f"abort {code:08X}h")
        self.code = code


@dataclass(frozen=True, slots=True, kw_only=True)
class Entry:
    """One object or sub-index.

    Attributes
    ----------
    size : int
        Number of bytes; 0: any length, as for texts.
    signed : bool
    read : callable, optional
        Returns the value. Default: it cannot be read.
    write : callable, optional
        Takes a number and raises `AccessError` if it is not accepted. Default: it cannot be written.
    write_bytes : callable, optional
        The same for a value that is not a number.
    sent, received : bool
        Whether it can be mapped into a PDO that the device sends or receives.
    """

    size: int
    signed: bool = False
    read: Read | None = None
    write: Write | None = None
    write_bytes: WriteBytes | None = None
    sent: bool = False
    received: bool = False


class ObjectDictionary:
    """Objects by index and sub-index."""

    def __init__(self) -> None:
        self._entries: dict[tuple[int, int], Entry] = {}
        self._indices: set[int] = set()
        self._stored: dict[tuple[int, int], int] = {}
        self._defaults: dict[tuple[int, int], int] = {}

    def add(self, index: int, subindex: int, entry: Entry) -> None:
        """Add an object."""
        self._entries[index, subindex] = entry
        self._indices.add(index)

    def constant(self, index: int, subindex: int, size: int, value: int) -> None:
        """Add a number that never changes."""
        self.add(index, subindex, Entry(size=size, read=lambda: value))

    def variable(
        self,
        index: int,
        subindex: int,
        size: int,
        default: int = 0,
        *,
        signed: bool = False,
        check: Write | None = None,
    ) -> None:
        """Add a number that is stored and returns to its default at a reset.

        Parameters
        ----------
        index, subindex, size, default : int
        signed : bool
        check : callable, optional
            Raises `AccessError` for a value that is not accepted.
        """
        key = index, subindex
        self._defaults[key] = self._stored[key] = default

        def write(value: int) -> None:
            if check is not None:
                check(value)
            self._stored[key] = value

        entry = Entry(size=size, signed=signed, read=lambda: self._stored[key], write=write)
        self.add(index, subindex, entry)

    def reset(self) -> None:
        """Give all variables their defaults."""
        self._stored.update(self._defaults)

    def value(self, index: int, subindex: int) -> int:
        """Return a variable."""
        return self._stored[index, subindex]

    def entry(self, index: int, subindex: int) -> Entry:
        """Return an object.

        Raises
        ------
        AccessError
            The object does not exist.
        """
        found = self._entries.get((index, subindex))
        if found is None:
            raise AccessError(NO_SUBINDEX if index in self._indices else NO_OBJECT)
        return found

    def read(self, index: int, subindex: int) -> bytes:
        """Return an object's bytes.

        Raises
        ------
        AccessError
        """
        entry = self.entry(index, subindex)
        if entry.read is None:
            raise AccessError(NOT_READABLE)
        value = entry.read()
        return value if isinstance(value, bytes) else packed(value, entry.size)

    def write(self, index: int, subindex: int, given: bytes) -> None:
        """Write an object's bytes.

        Raises
        ------
        AccessError
        """
        entry = self.entry(index, subindex)
        if entry.write is None and entry.write_bytes is None:
            raise AccessError(NOT_WRITABLE)
        if entry.size and len(given) != entry.size:
            raise AccessError(TOO_LONG if len(given) > entry.size else TOO_SHORT)
        if entry.write_bytes is not None:
            entry.write_bytes(given)
        elif entry.write is not None:
            entry.write(int.from_bytes(given, "little", signed=entry.signed))


def packed(value: int, size: int) -> bytes:
    """Return a number's lowest bytes, little-endian. A number that is too large wraps."""
    return (value & (1 << 8 * size) - 1).to_bytes(size, "little")


def within(lowest: int, highest: int) -> Write:
    """Return a check of a number's range."""

    def check(value: int) -> None:
        if not lowest <= value <= highest:
            raise AccessError(OUT_OF_RANGE)

    return check


def one_of(*allowed: int) -> Write:
    """Return a check that a number is one of the allowed values."""

    def check(value: int) -> None:
        if value not in allowed:
            raise AccessError(OUT_OF_RANGE)

    return check
