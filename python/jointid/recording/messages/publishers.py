"""Detection of two nodes that publish the same joint on one topic: the positions alternate between both."""

import numpy as np

from jointid.recording.signals import FloatArray

_SMALLEST = 1e-2  # rad or m: an encoder's noise is smaller
_RETURN = 0.2  # of the jump: a moving joint is nearly at its position of two messages ago
_BLOCK = 4096
_SHARE = 0.2  # share of the messages: noise alone gives 0.1


def jump_between_publishers(position: FloatArray) -> float | None:
    """Return the jump between the positions of two publishers; None if there seems to be only one publisher.

    The position jumps and returns with the next message, again and again. No joint moves like this between two
    messages, and noise returns in one of ten cases only.

    Parameters
    ----------
    position : ndarray, shape (n,)
        Positions of one joint in the order of time [rad or m].

    Examples
    --------
    >>> jump_between_publishers(np.array([0.0, 1.0] * 20))
    1.0
    >>> jump_between_publishers(np.linspace(0.0, 1.0, 40)) is None
    True
    """
    count, jump = 0, 0.0
    with np.errstate(all="ignore"):  # positions too large to subtract are refused later
        for start in range(0, len(position), _BLOCK):  # in blocks, to avoid copies of a long log
            steps = np.diff(position[start : start + _BLOCK])
            there, back = steps[:-1], steps[1:]
            size = np.abs(there)
            returns = (size > _SMALLEST) & (np.sign(there) * np.sign(back) < 0.0)
            returns &= np.abs(there + back) < _RETURN * size
            count += int(np.count_nonzero(returns))
            if returns.any():
                jump = float(np.median(size[returns]))
    return jump if count > max(_SHARE * len(position), 8.0) else None
