"""Registry that finds drive types by name."""

from __future__ import annotations

from importlib import import_module
from importlib.metadata import EntryPoint, entry_points
from typing import TypeVar

from jointid.base.errors import InputError
from jointid.joint.checks import suggestion

T = TypeVar("T")

ENTRY_POINTS = "jointid.drives"
"""Group of entry points by which an installed package registers its drive types."""

DEFAULT_TYPE = "elmo"
"""Drive type if a joint file or recording names none, because it is older than drive types."""

# Available without an installed entry point, and loaded only when used.
_BUILT_IN = {"elmo": "jointid.hardware.elmo.drive_type:ElmoType"}


def drive_type_names() -> tuple[str, ...]:
    """Return the names of all built-in and installed drive types."""
    return tuple(sorted({*_BUILT_IN, *entry_points(group=ENTRY_POINTS).names}))


def adapter_of(name: str, kind: type[T]) -> T:
    """Return the adapter of a drive type as `kind`, the class that the caller needs; see `drive_type`."""
    if not isinstance(name, str):
        raise _refused(name, "a text is expected")
    found: tuple[EntryPoint, ...] = tuple(entry_points(group=ENTRY_POINTS, name=name))
    if name in _BUILT_IN:
        if found:
            raise _refused(
                name,
                f"{_origin(found[0])} registers this name, but jointid has a built-in type of this name; rename the "
                "registered type",
            )
        module, _, built_in = _BUILT_IN[name].partition(":")
        made: T = getattr(import_module(module), built_in)()
        return made
    if not found:
        names = suggestion(name, drive_type_names())
        raise _refused(name, f"{names}; other packages can register more types as entry points")
    if len({entry.value for entry in found}) > 1:
        values = ", ".join(sorted(entry.value for entry in found))
        raise _refused(name, f"registered by several packages: {values}")
    return _loaded(name, found[0], kind)


def _loaded(name: str, entry: EntryPoint, kind: type[T]) -> T:
    """Return the adapter that a package supplies. An exception in it is not a bug of this program."""
    try:
        loaded = entry.load()
        adapter = loaded() if isinstance(loaded, type) else loaded
    except Exception as error:
        raise _refused(
            name,
            f"the entry point {entry.value} of {_origin(entry)} cannot be used "
            f"({type(error).__name__}: {error})",
        ) from error
    if not isinstance(adapter, kind):
        raise _refused(
            name,
            f"the entry point {entry.value} of {_origin(entry)} is a {type(adapter).__name__}, not a DriveType",
        )
    return adapter


def _origin(entry: EntryPoint) -> str:
    """Return the package of an entry point."""
    return "an unknown package" if entry.dist is None else f"the package {entry.dist.name}"


def _refused(name: object, reason: str) -> InputError:
    return InputError(reason, argument="drive type", value=name)
