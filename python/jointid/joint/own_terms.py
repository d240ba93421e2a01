"""Own terms of a model: named signals of a recording, and their kinds of term in the torque balance."""

from __future__ import annotations

import functools
import re
from collections.abc import Collection, Iterator, Mapping
from typing import Any

from jointid import _core
from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.joint.checks import suggestion

# Kind → first words of its parameters' names; "_of_SIGNAL" follows.
_PARAMETERS = {
    "viscous": ("viscous",),
    "coulomb": ("coulomb",),
    "coupling": ("coupling",),
    "known": ("known",),
    "scaled": ("scale",),
    "inertia": ("known_inertia",),
    "inertia_own": ("known_inertia",),
    "inertia_others": ("known_inertia",),
    "scaled_inertia": ("scale_inertia",),
    "inertia_over": ("inertia_cos", "inertia_sin"),
    "torque_over": ("torque_cos", "torque_sin"),
}
KINDS = tuple(_PARAMETERS)
"""Kinds of term; see `Model`."""

FRICTION = ("viscous", "coulomb")
"""Kinds that are friction of this joint or another one."""

INERTIA = ("inertia", "inertia_own", "inertia_others", "scaled_inertia")
"""Kinds with an inertia as signal."""

TORQUES = ("known", "scaled", "torque_over")
"""Kinds that are a load torque, or a function of an angle like gravity."""

CENTRED = ("inertia_over", "torque_over")
"""Kinds that are functions of an angle, centred in the angle's range."""

POSITION = "position"
"""Name of the joint's own position as the signal of a term."""

_RATE = "@rate"
_KIND = rf"([a-z_]+)(?:\(([^()]*)\))?({_RATE})?"
_NAME = r"[A-Za-z_][A-Za-z0-9_]{0,59}"
_FIXED = ("known_of_", "known_inertia_of_")


@dataclass(frozen=True, slots=True, kw_only=True)
class OwnTerm:
    """One term of one signal.

    Attributes
    ----------
    signal : str
        Name of an extra signal, or "position".
    kind : str
    rate : bool
        Whether the term uses the signal's rate of change.
    centre : float or None
        Centre of a function of the signal [rad]. None: the middle of the signal's range.
    """

    signal: str
    kind: str
    rate: bool = False
    centre: float | None = None

    @property
    def source(self) -> str:
        """Text at the end of the parameters' names: the signal, or "SIGNAL_rate"."""
        return f"{self.signal}_rate" if self.rate else self.signal

    @property
    def keys(self) -> tuple[str, ...]:
        """Keys of the core's terms; they are also the parameters' names."""
        return tuple(f"{word}_of_{self.source}" for word in _PARAMETERS[self.kind])

    def __str__(self) -> str:
        centre = "" if self.centre is None else f"({self.centre:.6g})".replace("e+", "e")
        return f"{self.kind}{centre}{'@rate' * self.rate}"


@dataclass(frozen=True, eq=False, repr=False)
class OwnTerms(Mapping[str, str]):
    """A mapping from signals to kinds of term as text, e.g. ``{"q6": "viscous@rate+coulomb@rate"}``.

    Attributes
    ----------
    each : tuple of OwnTerm
        Terms in the stated order, signal by signal.
    """

    each: tuple[OwnTerm, ...] = ()

    @classmethod
    def of(cls, value: object) -> OwnTerms:
        """Return own terms from a mapping of signals to texts or lists of texts.

        Raises
        ------
        InputError
            The value has another type, a kind is unknown, or a parameter occurs twice.
        """
        if isinstance(value, OwnTerms):
            return value
        if not isinstance(value, Mapping):
            raise InputError(
                "a mapping from signals to kinds of term is expected, like q6_rate: viscous",
                argument="terms",
                value=value,
            )
        each = [own for signal, kinds in value.items() for own in _of_signal(signal, kinds)]
        keys = [key for own in each for key in own.keys]
        for key in keys:
            if keys.count(key) > 1:
                raise InputError(
                    f"{key} is given twice", argument="terms", value=str(cls(tuple(each)))
                )
        return cls(tuple(each))

    @classmethod
    def parse(cls, text: str) -> OwnTerms:
        """Return own terms from text like ``q6=viscous@rate+coulomb@rate,tau_model=known``; "none" for none.

        Raises
        ------
        InputError
            The text has another form.
        """
        entries: dict[str, str] = {}
        for part in [] if text == "none" else text.split(","):
            signal, separator, kinds = part.partition("=")
            if not separator:
                raise InputError(
                    "write terms=SIGNAL=KIND, like terms=q6_rate=viscous",
                    argument="terms",
                    value=part,
                )
            if signal in entries:
                raise InputError(f"{signal} is given twice", argument="terms", value=text)
            entries[signal] = kinds
        return cls.of(entries)

    @property
    def signals(self) -> tuple[str, ...]:
        """Extra signals that a recording must have."""
        return tuple(dict.fromkeys(own.signal for own in self.each if own.signal != POSITION))

    @property
    def keys_in_core(self) -> tuple[str, ...]:
        """Keys of the core's terms, in the stated order."""
        return tuple(key for own in self.each for key in own.keys)

    def __getitem__(self, signal: str) -> str:
        kinds = [str(own) for own in self.each if own.signal == signal]
        if not kinds:
            raise KeyError(signal)
        return "+".join(kinds)

    def __iter__(self) -> Iterator[str]:
        return iter(dict.fromkeys(own.signal for own in self.each))

    def __len__(self) -> int:
        return len({own.signal for own in self.each})

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Mapping) and list(self.items()) == list(other.items())

    def __hash__(self) -> int:
        return hash(self.each)

    def __repr__(self) -> str:
        return repr(dict(self))

    def __str__(self) -> str:
        return ",".join(f"{signal}={kinds}" for signal, kinds in self.items()) or "none"

    def __reduce__(self) -> tuple[Any, ...]:
        return functools.partial(OwnTerms, self.each), ()


NO_TERMS = OwnTerms()


def is_fixed(name: str) -> bool:
    """Whether a parameter is the gain of a known term, which is 1 unless a call frees it."""
    return name.startswith(_FIXED)


def _of_signal(signal: object, kinds: object) -> list[OwnTerm]:
    if not isinstance(signal, str) or not re.fullmatch(_NAME, signal):
        raise InputError(
            "the name of an extra signal is expected, with letters, digits and underscores only",
            argument="terms",
            value=signal,
        )
    if isinstance(kinds, str):
        texts = re.split(r"\+(?![^(]*\))", kinds)
    elif isinstance(kinds, Collection) and all(isinstance(kind, str) for kind in kinds):
        texts = [text for kind in kinds for text in re.split(r"\+(?![^(]*\))", kind)]
    else:
        texts = []
    if not texts:
        raise InputError(
            "text like viscous or viscous+coulomb is expected",
            argument=f"terms.{signal}",
            value=kinds,
        )
    return [_own_term(signal, text.strip()) for text in texts]


def _own_term(signal: str, text: str) -> OwnTerm:
    place = f"terms.{signal}"
    found = re.fullmatch(_KIND, text)
    if not found or found[1] not in KINDS:
        name = found[1] if found else text
        rates = [kind + _RATE for kind in KINDS]
        meant = suggestion(text, rates) if "@" in text else suggestion(name, KINDS)
        raise InputError(f"no such kind; {meant}", argument=place, value=text)
    kind, centre, rate = found[1], None, bool(found[3])
    if found[2] is not None:
        try:
            centre = float(found[2])
        except ValueError:
            centre = float("nan")
        if kind not in CENTRED or not abs(centre) < 1e6:
            raise InputError(
                f"only the kinds {' and '.join(CENTRED)} have a centre (an angle in rad)",
                argument=place,
                value=text,
            )
    if signal == POSITION and (kind not in CENTRED or rate):
        raise InputError(
            f"for the joint's own position, only the kinds {' and '.join(CENTRED)} can be identified",
            argument=place,
            value=text,
            remedy="load another signal with `extra`",
        )
    own = OwnTerm(signal=signal, kind=kind, rate=rate, centre=centre)
    for key in own.keys:
        if not _core.is_parameter(key):
            raise InputError(
                "this signal cannot be part of a parameter's name", argument=place, value=signal
            )
    return own
