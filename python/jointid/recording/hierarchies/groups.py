"""Repeated groups of an HDF5 file (episodes or runs), and the choice of one."""

from collections.abc import Sequence

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.recording.headers import ALIASES, parsed
from jointid.recording.hierarchies.datasets import Vector
from jointid.recording.signals import closest

_SHOWN = 8


def chosen_vectors(place: str, vectors: Sequence[Vector], group: str | None) -> list[Vector]:
    """Return the vectors of one recording.

    Parameters
    ----------
    place : str
        The file, for messages.
    vectors : sequence of Vector
        All vectors of the file.
    group : str or None
        Path of a group. None: the file holds only one recording.

    Raises
    ------
    InputError
        There is no such group, or several hold the same datasets, each with its own time.
    """
    groups = _groups(vectors)
    if group is not None:
        wanted = group.strip("/").replace(".", "/") if "/" not in group else group.strip("/")
        wanted = group.strip("/") if group.strip("/") in groups else wanted
        if wanted not in groups:
            close = closest(group, groups)
            raise InputError(
                "no such group",
                argument="group",
                value=group,
                place=place,
                remedy=f"did you mean {close!r}" if close else f"groups are {_listed(groups)}",
            )
        vectors = [v for v in vectors if _inside(v, wanted) or _above(v, wanted)]
    repeated = _repeated(vectors)
    if repeated:
        raise InputError(
            f"{len(repeated)} groups hold the same datasets: {_listed(repeated)}",
            place=place,
            remedy=tuple(
                Action("call", {"group": name}, function="load") for name in repeated[:_SHOWN]
            ),
        )
    return list(vectors)


def _repeated(vectors: Sequence[Vector]) -> list[str]:
    """Return the groups with the same datasets, such as a time and a position in each."""
    times: dict[str, list[str]] = {}
    for vector in vectors:
        if ALIASES.get(parsed(vector.last)[0]) == "time":
            times.setdefault(vector.last, []).append(vector.group)
    alike = max(times.values(), key=len, default=[])
    if len(alike) < 2:
        return []
    return _branches(alike) if len(set(alike)) > 1 else list(dict.fromkeys(alike))


def _branches(groups: Sequence[str]) -> list[str]:
    """Return the part of each path up to the first difference: the episode, not the group of its observations."""
    parts = [group.split("/") if group else [] for group in groups]
    shared = 0
    while all(len(p) > shared for p in parts) and len({p[shared] for p in parts}) == 1:
        shared += 1
    return list(dict.fromkeys("/".join(part[: shared + 1]) for part in parts))


def _groups(vectors: Sequence[Vector]) -> list[str]:
    found: dict[str, None] = {}
    for vector in vectors:
        parts = vector.path.split("/")
        for length in range(1, len(parts) + (1 if vector.field else 0)):
            found["/".join(parts[:length])] = None
    return list(found)


def _inside(vector: Vector, group: str) -> bool:
    return f"{vector.path}/".startswith(f"{group}/")


def _above(vector: Vector, group: str) -> bool:
    """Whether the dataset is in a parent of this group, e.g. one time for all groups."""
    return not vector.group or (
        f"{group}/".startswith(f"{vector.group}/") and vector.group != group
    )


def _listed(groups: Sequence[str]) -> str:
    rest = len(groups) - _SHOWN
    shown = ", ".join(group or "/" for group in groups[:_SHOWN])
    return f"{shown} and {rest} more" if rest > 0 else shown
