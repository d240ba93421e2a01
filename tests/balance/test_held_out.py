"""Which candidate the prediction of held-out parts prefers."""

import numpy as np
import pytest

from jointid.balance.held_out import in_errors, preferred
from jointid.comparison.judging import Entrant, judged


def entrant(name: str, parameters: int, *parts: float) -> Entrant:
    error = float(np.std(parts, ddof=1)) / len(parts) ** 0.5
    score = float(np.mean(parts))
    return Entrant(name=name, parameters=parameters, score=score, stderr=error, parts=parts)


def test_the_simplest_of_equals_wins_by_their_differences() -> None:
    rich, simple = (
        entrant("rich", 9, 0.0999, 0.1201, 0.1099),
        entrant("simple", 5, 0.10, 0.12, 0.11),
    )
    poor, worse = entrant("poor", 1, 0.2, 0.2, 0.2), entrant("worse", 5, 0.12, 0.14, 0.13)
    assert judged([simple, rich, poor], paired=True).winner == 0
    # Each part is worse by as much, though the scores scatter by as much themselves.
    assert judged([worse, rich, poor], paired=True).winner == 1
    wide = entrant("wide", 9, 0.05, 0.15, 0.10)
    assert judged([entrant("near", 5, 0.06, 0.16, 0.11), wide], paired=False).winner == 0
    assert judged([entrant("near", 5, 0.06, 0.16, 0.11), wide], paired=True).winner == 1


def test_the_best_and_the_preferred_may_be_the_same() -> None:
    assert preferred([0.2, 0.1, 0.1], [1, 3, 3], lambda *_: True) == (1, 1)
    assert preferred([0.2, 0.1, 0.3], [1, 3, 1], lambda *_: False) == (1, 0)


def test_differences_are_held_against_their_scatter() -> None:
    assert in_errors(np.array([0.0, 0.0])) == 0.0
    assert in_errors(np.array([1.0, 1.0])) == np.inf
    assert in_errors(np.array([1.0])) == 0.0
    assert in_errors(np.array([1.0, 2.0, 3.0])) == pytest.approx(2.0 * 3.0**0.5)
