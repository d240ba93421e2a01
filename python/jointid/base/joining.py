"""Functions of upper rooms for lower ones, which may not import them: the package's face joins them.

The face says how to load them, and a lower room loads them when it needs them.
"""

from collections.abc import Callable

_LOADERS: dict[str, Callable[[], Callable[..., object]]] = {}


def join(**loaders: Callable[[], Callable[..., object]]) -> None:
    """Say how functions of upper rooms are loaded, by the name that the rooms below know."""
    _LOADERS.update(loaders)


def joined(name: str) -> Callable[..., object]:
    """Return the function of an upper room that was joined under this name."""
    return _LOADERS[name]()
