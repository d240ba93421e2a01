"""What no joint's recording holds: absurdly large values."""

from collections.abc import Mapping

import numpy as np

from jointid.recording.signals import FloatArray

_LARGEST = 1e15  # in SI: beyond it a value is a mark for "none", or damaged


def too_large(signals: Mapping[str, FloatArray]) -> tuple[str, int] | None:
    """Return signal and index of a value that is larger than any of a joint, or None."""
    for signal, values in signals.items():
        if len(values) and max(float(values.max()), -float(values.min())) > _LARGEST:
            return signal, int(np.argmax(np.abs(values)))
    return None
