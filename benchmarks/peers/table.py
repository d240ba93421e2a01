"""All rows of the contest, in the table's order."""

from __future__ import annotations

from peers import (
    cma_peers,
    deap_peers,
    ours,
    projection_peers,
    pygad_peers,
    pygmo_peers,
    pymoo_peers,
    scipy_peers,
)
from peers.peer import Peer


def all_peers() -> list[Peer]:
    """Return all rows, ours first."""
    rooms = (
        ours,
        projection_peers,
        scipy_peers,
        pygmo_peers,
        pymoo_peers,
        deap_peers,
        pygad_peers,
        cma_peers,
    )
    return [peer for room in rooms for peer in room.peers()]
