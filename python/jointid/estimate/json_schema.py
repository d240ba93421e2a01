"""Schemas of an estimate's JSON, by schema number."""

from typing import get_args

from jointid.base.advice import Kind as ActionKind
from jointid.base.schema import Flag, Kind, ListOf, Number, OrNull, Plain, Record, TableOf, Text
from jointid.estimate.findings import Severity
from jointid.estimate.selection import SELECTION
from jointid.estimate.settings import SETTINGS
from jointid.estimate.statistics import SYSTEMATIC_PARTS

_VALUE = Number(low=-1e100, high=1e100)  # far beyond any joint, and the square does not overflow
_NOT_NEGATIVE = Number(low=0.0, high=1e100)
_POSITIVE = Number(low=1e-12, high=1e100)
_COUNT = Number(low=0, high=2**62, whole=True)
_LIMIT = Number(infinite=True)
_SIZE = Number(low=0.0, infinite=True, undefined=True)
_ANY = Number(infinite=True, undefined=True)
MATRIX = ListOf(ListOf(_ANY))

_OLD_PARAMETER: dict[str, Kind] = {
    "name": Text(),
    "meaning": Text(),
    "unit": Text(),
    "value": _VALUE,
    "stderr": OrNull(_ANY),
    "interval": OrNull(ListOf(_ANY, 2, 2)),
    "min": _LIMIT,
    "max": _LIMIT,
    "vary": Flag(),
    "at_bound": OrNull(Text(known=("min", "max"))),
    "shift_halved": OrNull(_ANY),
    "shift_doubled": OrNull(_ANY),
}
_SYSTEMATIC = Record({}, optional=dict.fromkeys(SYSTEMATIC_PARTS, _SIZE))
PARAMETER = Record({**_OLD_PARAMETER, "systematic": _SYSTEMATIC})
RESIDUALS = Record(
    {
        "windows": _COUNT,
        "window_duration": _POSITIVE,
        "samples": _COUNT,
        **dict.fromkeys(("noise_share", "rms", "relative", "r_squared"), _ANY),
        **dict.fromkeys(("autocorrelation", "left_out", "standing"), _ANY),
    }
)
WINDOWS = Record(
    {
        "recording": ListOf(_COUNT, 1),
        "duration": ListOf(_POSITIVE, 1),
        **{name: ListOf(_VALUE, 1) for name in ("start", "stop", "measured", "fitted")},
        **{name: ListOf(_VALUE, 1) for name in ("velocity", "friction")},
    }
)
_CONVERGENCE = Record(
    {
        **{name: ListOf(_COUNT, 1) for name in ("generation", "evaluations")},
        **{name: ListOf(_NOT_NEGATIVE, 1) for name in ("best", "mean")},
        "diversity": ListOf(_ANY, 1),
        **{f"{name}_probability": ListOf(_ANY, 1) for name in ("crossover", "mutation")},
    }
)
_WARNING = Record({"code": Text(), "parameters": ListOf(Text()), "message": Text()})
_ACTION = Record(
    {
        "kind": Text(known=get_args(ActionKind)),
        "arguments": TableOf(Plain()),
        "text": Text(),
        "function": Text(),
    }
)
_SENTENCES = Text(longest=1_000_000)  # one sentence for each of up to thousands of parameters
FINDING = Record(
    {
        "code": Text(),
        "severity": Text(known=get_args(Severity)),
        "parameters": ListOf(Text()),
        "evidence": TableOf(Record({"value": _ANY, "unit": Text()})),
        "cause": _SENTENCES,
        "advice": ListOf(_ACTION),
        "message": _SENTENCES,
    },
    {"title": _SENTENCES, "details": _SENTENCES, "recordings": ListOf(Text())},
)
DELAY = Record(
    {
        "signal": Text(known=("torque", "sensor", "velocity")),
        "value": _VALUE,
        "stderr": _ANY,
        "certain": Flag(),
        "fits": Flag(),
        "applied": _VALUE,
    }
)
_SLOW_MOTION = Record(
    {
        "speed": _NOT_NEGATIVE,
        "excess": _VALUE,
        "stderr": _ANY,
        "level": _VALUE,
        "share": _NOT_NEGATIVE,
        "applied": Flag(),
    }
)
_CROSS_CHECK = Record(
    {
        "values": TableOf(
            Record({"value": _VALUE, "stderr": _SIZE, "spread": _SIZE, "agrees": Flag()})
        ),
        "delay": _VALUE,
        "reason": Text(),
    }
)
_FIELDS: dict[str, Kind] = {
    "schema": _COUNT,
    "kind": Text(),
    "parameters": TableOf(PARAMETER),
    "free": ListOf(Text()),
    "status": Text(),
    "message": Text(),
    "penalty": _NOT_NEGATIVE,
    "correlation": MATRIX,
    "covariance": MATRIX,
    "condition": _ANY,
    "weakest": ListOf(Text()),
    "residuals": RESIDUALS,
    "windows": WINDOWS,
    "convergence": OrNull(_CONVERGENCE),
    "joint": TableOf(Plain()),  # the joint has its own reader
    "settings": SETTINGS,
    "seconds": _NOT_NEGATIVE,
}
_OLD_FIELDS: dict[str, Kind] = {**_FIELDS, "parameters": TableOf(Record(_OLD_PARAMETER))}
VERDICT = Record({"level": Text(), "reasons": ListOf(_SENTENCES), "uses": TableOf(Plain())})
"""Not read: the verdict is computed again."""
ESTIMATE: dict[int, Kind] = {
    1: Record({**_OLD_FIELDS, "warnings": ListOf(_WARNING)}),
    # Derived quantities are computed again.
    2: Record({**_OLD_FIELDS, "findings": ListOf(FINDING)}, {"derived": Plain()}),
    3: Record(
        {**_FIELDS, "findings": ListOf(FINDING)},
        {
            "derived": Plain(),
            "verdict": VERDICT,
            "information": OrNull(ListOf(ListOf(_VALUE))),
            "selection": OrNull(SELECTION),
            "selftest": Plain(),
            "bootstrap": Plain(),
            "delays": TableOf(DELAY),
            "within": TableOf(_SIZE),
            "slow_motion": OrNull(_SLOW_MOTION),
            "cross_check": OrNull(_CROSS_CHECK),
        },
    ),
}
