"""Access to functions of upper folders for lower folders, which may not import them.

The package's top module registers how to load each function; a lower folder loads it when needed.
"""

from collections.abc import Callable

_LOADERS: dict[str, Callable[[], Callable[..., object]]] = {}


def join(**loaders: Callable[[], Callable[..., object]]) -> None:
    """Register loaders of functions in upper folders, by the name that lower folders use."""
    _LOADERS.update(loaders)


def joined(name: str) -> Callable[..., object]:
    """Return the function of an upper folder that was registered under this name."""
    return _LOADERS[name]()
