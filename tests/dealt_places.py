"""Places of a document, dealt to the values that are tried at each, for tests that cannot try all at all."""

from collections.abc import Sequence
from random import Random
from typing import Any


def dealt(places: Sequence[Any], number: int, shares: int) -> list[Any]:
    """Return one share of the places, in an order of chance that is always the same; the shares hold each once."""
    return Random(0).sample(places, len(places))[number % shares :: shares]
