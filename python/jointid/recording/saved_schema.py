"""Schema of the attributes of a saved recording."""

from jointid.base.schema import LARGEST, Flag, Json, ListOf, Number, OrNull, Record, TableOf, Text
from jointid.recording.signals import KINDS

_TEXT = Text(longest=LARGEST)  # a user's name may have any length up to this
_MOST = 10_000  # joints, signals and extra columns
_ROBOT = Record(
    {
        "names": ListOf(_TEXT, 1, _MOST),
        "side": Text(known=("joint", "motor")),
        "gear_ratio": OrNull(ListOf(Number(), 1, _MOST)),
        "signals": ListOf(Text(), longest=_MOST),
        "extra": TableOf(Number(low=1, high=2, whole=True), _MOST, LARGEST),
    },
)
SAVED = Record(
    {"schema": Number(whole=True)},
    {
        "name": _TEXT,
        "kind": Text(known=KINDS),
        "torque_hold": OrNull(Text(known=("zoh", "linear"))),
        "velocity_derived": Flag(),
        "metadata": OrNull(TableOf(Json(), longest=LARGEST, longest_name=LARGEST)),
        "truth": OrNull(TableOf(Json(), longest=LARGEST, longest_name=LARGEST)),
        "robot": OrNull(_ROBOT),
    },
    other=Json(),
)
