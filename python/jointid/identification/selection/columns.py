"""Window columns of a penalty at many shapes in one matrix, from which all models are made."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.values import dataclass
from jointid.identification.search.computed_bounds import shape_range
from jointid.joint.parameters import Parameter
from jointid.problem.block_sums import BlockSums
from jointid.problem.terms import TermChoice

Array = NDArray[np.float64]

# Number of shapes between the bounds, in equal ratios, and then between the neighbors of the best shape.
_COARSE, _FINE = 12, 8


@dataclass(frozen=True, slots=True, kw_only=True)
class ShapedColumns:
    """Columns of one penalty. A column that depends on a shape occurs once for each shape; the torque is last.

    Attributes
    ----------
    matrix : ndarray, shape (windows, columns)
    shapes : ndarray, shape (shapes,)
        Shapes in ascending order; only one if the shape is fixed or no column depends on a shape.
    free_shape : bool
        Whether the shape is free.
    keys : tuple of str
        Key of the term of each coefficient.
    first : tuple of int
        First column of each coefficient. A coefficient with a shape has one column for each shape.
    shaped : tuple of bool
        Whether each coefficient's column depends on a shape.
    known : tuple of Parameter
        Value and bounds of each coefficient, set by joint and call.
    """

    matrix: Array
    shapes: Array
    free_shape: bool
    keys: tuple[str, ...]
    first: tuple[int, ...]
    shaped: tuple[bool, ...]
    known: tuple[Parameter, ...]

    @classmethod
    def of(
        cls,
        penalty: _core.Penalty,
        known: Sequence[Parameter],
        peak_speed: float,
        threads: int,
    ) -> ShapedColumns:
        """Return the columns of a penalty with at most one shape.

        Parameters
        ----------
        known : sequence of Parameter
            Value and bounds of each parameter of the penalty, set by joint and call.
        """
        count = penalty.coefficients
        stated = known[count:]
        low, high = shape_range(stated[0], peak_speed) if stated else (1.0, 1.0)
        coarse = np.geomspace(max(low, 1e-300), high, _COARSE) if low < high else np.array([low])
        fixed, *blocks = _at(penalty, coarse)
        made = cls._joined(penalty, fixed, blocks, coarse, known)
        if not made.free_shape:
            return made
        whole = BlockSums.of(made.matrix, [np.arange(len(made.matrix))], threads)
        best = int(np.argmin(whole.fitted(made.combined(None)).penalty))
        near = coarse[max(best - 1, 0)], coarse[min(best + 1, len(coarse) - 1)]
        fine = np.geomspace(*near, _FINE + 2)[1:-1]
        blocks += _at(penalty, fine)[1:]
        order = np.argsort(np.concatenate([coarse, fine]), kind="stable")
        shapes = np.concatenate([coarse, fine])[order]
        return cls._joined(penalty, fixed, [blocks[i] for i in order], shapes, known)

    @classmethod
    def _joined(
        cls,
        penalty: _core.Penalty,
        fixed: Array,
        blocks: Sequence[Array],
        shapes: Array,
        known: Sequence[Parameter],
    ) -> ShapedColumns:
        count = penalty.coefficients
        shaped = tuple(bool(term.shapes) for term in penalty.terms[:count])
        parts: list[Array] = []
        first: list[int] = []
        for index in range(count):
            first.append(len(parts))
            place = sum(shaped[:index])
            if shaped[index]:
                parts += [block[:, place] for block in blocks]
            else:
                parts.append(fixed[:, index - place])
        parts.append(np.asarray(penalty.target))
        return cls(
            matrix=np.asfortranarray(np.column_stack(parts)),
            shapes=shapes,
            free_shape=len(shapes) > 1,
            keys=tuple(term.key for term in penalty.terms[:count]),
            first=tuple(first),
            shaped=shaped,
            known=tuple(known[:count]),
        )

    def stated(self, known: Sequence[Parameter]) -> ShapedColumns:
        """Return the same columns with other known coefficients and the same shapes."""
        return replace(self, known=tuple(known[: len(self.keys)]))

    def free(self, choice: TermChoice | None) -> list[int]:
        """Return the free coefficients of a model, or of all terms if None."""
        return [
            index
            for index, key in enumerate(self.keys)
            if self.known[index].vary and (choice is None or key in choice.terms)
        ]

    def shapes_of(self, choice: TermChoice | None) -> bool:
        """Return whether a model has a term with a shape."""
        return any(
            shaped and (choice is None or key in choice.terms)
            for shaped, key in zip(self.shaped, self.keys, strict=True)
        )

    def combined(self, choice: TermChoice | None) -> Array:
        """Return the combinations of columns that give a model's regressors and its target, at every shape.

        Returns
        -------
        ndarray, shape (shapes, columns, p + 1)
            The last combination is the target: the torque minus the terms with known coefficients.
        """
        free = self.free(choice)
        shapes = len(self.shapes) if self.shapes_of(choice) else 1
        made = np.zeros((shapes, self.matrix.shape[1], len(free) + 1))
        every = np.arange(shapes)
        for place, index in enumerate(free):
            made[every, self.first[index] + every * self.shaped[index], place] = 1.0
        made[:, -1, -1] = 1.0
        for index, key in enumerate(self.keys):
            parameter = self.known[index]
            if not parameter.vary and (choice is None or key in choice.terms):
                assert parameter.value is not None  # a fixed Parameter always has a value
                made[every, self.first[index] + every * self.shaped[index], -1] -= parameter.value
        return made


def _at(penalty: _core.Penalty, shapes: Array) -> list[Array]:
    """Return the columns without a shape, then those with a shape at each shape."""
    shaped = [bool(term.shapes) for term in penalty.terms[: penalty.coefficients]]
    count = len(penalty.names) - penalty.coefficients
    made: list[Array] = []
    for shape in shapes:
        columns = penalty.columns(np.full(count, shape))
        if not made:
            made.append(columns[:, np.logical_not(shaped)])
        made.append(columns[:, shaped])
    return made
