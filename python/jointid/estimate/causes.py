"""Why a model does not fit: causes by name, with what they explain and which values they move."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import field
from types import MappingProxyType
from typing import Any

from jointid.base.advice import Action
from jointid.base.json_layout import json_types
from jointid.base.result import Overview, Quantity, Result
from jointid.base.values import dataclass
from jointid.estimate.findings import TITLE, Measured
from jointid.estimate.wording import percent, signed_percent

_SHOWN = 3  # changes in a sentence
_NOTHING = "no cause of the residual was found"


@dataclass(frozen=True, slots=True, kw_only=True)
class Cause:
    """Something that the model lacks, and that the recordings show.

    Attributes
    ----------
    name : str
        E.g. "gravity", "load_friction", "drift"; `docs/findings.md` lists them.
    meaning : str
        What the name means, as the beginning of a sentence.
    detail : str
        Which of its kind: the coefficient that drifts, the order of a harmonic, the signal that is late.
    share : float
        Share of the residual that it explains, in stretches of time that it was not fitted to.
    scale : float
        Length of the windows at which that share was taken [s].
    size : str
        How large it is, with its unit; empty where one number does not say it.
    numbers : mapping of str to Measured
        The numbers in `detail` and `size`.
    shifts : mapping of str to float
        How much each parameter would change if the model had it, in the parameter's unit.
    relative : mapping of str to float
        The same as shares of the values, of those that change noticeably.
    shares : mapping of str to float
        The same of all values, noticeable or not.
    uncertain : mapping of str to float
        Large relative changes of uncertain values, in standard errors.
    near_zero : mapping of str to str
        Changes of values near zero, in words: "from 0 to 0.12 N·m".
    effect : str
        What it does to the values as a part of a sentence, where that is more than a list of changes.
    harmful : bool
        Whether a value moves by more than 5 %, or by more than two of its errors.
    alike : tuple of str
        Other causes that these recordings hardly tell from it.
    advice : tuple of Action
        What to do about it.
    """

    name: str
    meaning: str = ""
    detail: str = ""
    share: float
    scale: float
    size: str = ""
    numbers: Mapping[str, Measured] = field(default_factory=dict, hash=False)
    shifts: Mapping[str, float] = field(default_factory=dict, hash=False)
    relative: Mapping[str, float] = field(default_factory=dict, hash=False)
    shares: Mapping[str, float] = field(default_factory=dict, hash=False)
    uncertain: Mapping[str, float] = field(default_factory=dict, hash=False)
    near_zero: Mapping[str, str] = field(default_factory=dict, hash=False)
    effect: str = ""
    harmful: bool = True
    alike: tuple[str, ...] = ()
    advice: tuple[Action, ...] = field(default=(), hash=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "numbers", MappingProxyType(dict(self.numbers)))
        object.__setattr__(self, "shifts", MappingProxyType(dict(self.shifts)))
        object.__setattr__(self, "relative", MappingProxyType(dict(self.relative)))
        object.__setattr__(self, "shares", MappingProxyType(dict(self.shares)))
        object.__setattr__(self, "uncertain", MappingProxyType(dict(self.uncertain)))
        object.__setattr__(self, "near_zero", MappingProxyType(dict(self.near_zero)))

    def __str__(self) -> str:
        """Title and details."""
        return f"{self.title}; {self.details}"

    @property
    def title(self) -> str:
        """What is missing, its size, and what it moves, as much as a title holds."""
        return self.titled(TITLE)

    def titled(self, most: int) -> str:
        """Return what is missing and its size, and what it moves up to so many letters."""
        inside = ", ".join(filter(None, (self.detail, self.size.partition(", ")[0])))
        what = self.meaning + (f" ({inside})" if inside else "")
        if not self.harmful:
            return f"{what}: harmless"
        if self.effect:  # says more than a title holds
            return what
        title, before = what, ": with it, "
        for each in self._moved:
            if len(title + before + each) <= most:
                title, before = title + before + each, ", "
        return title

    @property
    def details(self) -> str:
        """How much it explains, what it does, and what looks like it."""
        said = [
            f"explains {percent(self.share)} of the residual in windows of {_seconds(self.scale)}",
            self.size.partition(", ")[2],
            "" if self.harmful and self._is_in_title else self.does,
            f"hardly separable from {' and '.join(self.alike)}" if self.alike else "",
        ]
        return "; ".join(filter(None, said))

    def evidence(self, shifts: Mapping[str, float]) -> dict[str, Measured]:
        """Return the numbers of its finding, with what it moves as shares."""
        measured = {"share": Measured(self.share), "windows": Measured(self.scale, "s")}
        moved = {f"{name}.shift": Measured(share) for name, share in shifts.items()}
        return measured | dict(self.numbers) | moved

    @property
    def _moved(self) -> list[str]:
        return [
            f"{name} {self.near_zero.get(name) or signed_percent(share)}"
            for name, share in _largest(self.relative)
        ]

    @property
    def _is_in_title(self) -> bool:
        return not self.effect and all(each in self.title for each in self._moved)

    @property
    def does(self) -> str:
        """What it does to the values, as a clause."""
        if not self.harmful:
            return f"it {self.harmless}"
        return self.effect or f"with it in the model, {self.changes}"

    @property
    def changes(self) -> str:
        """The largest changes with their verb: "inertia changes by +27 %, viscous by −3 %"."""
        name, _, rest = self.moves.partition(" ")
        return f"{name} changes {rest}"

    @property
    def moves(self) -> str:
        """The largest changes, as a part of a sentence."""
        known = {name: share for name, share in self.shares.items() if name not in self.uncertain}
        moved = _largest(self.relative if self.harmful else known)
        named = [f"{name} {self._change(name, change)}" for name, change in moved]
        if not self.harmful:
            named += [
                f"{name}, itself uncertain, by {_in_errors(size)}"
                for name, size in self.uncertain.items()
            ]
        return ", ".join(named)

    def _change(self, name: str, share: float) -> str:
        return self.near_zero.get(name) or f"by {signed_percent(share)}"

    @property
    def harmless(self) -> str:
        """How little it moves, as a part of a sentence."""
        return f"moves no parameter noticeably ({self.moves})"

    @property
    def did(self) -> str:
        """What it moved where it was taken away, as a part of a sentence."""
        if self.harmful:
            return f"moved {self.moves}"
        return f"moved no parameter noticeably ({self.moves})"

    def __reduce__(self) -> tuple[object, ...]:
        # A read-only mapping cannot be pickled.
        values: dict[str, Any] = {name: getattr(self, name) for name in self.__slots__}
        for name in ("numbers", "shifts", "relative", "shares", "uncertain", "near_zero"):
            values[name] = dict(values[name])
        return _rebuilt, (values,)


@dataclass(frozen=True, slots=True, kw_only=True)
class Causes(Result):
    """What an attribution found.

    Attributes
    ----------
    found : tuple of Cause
        Causes that matter: certain, and they move a parameter. The one that explains most comes first.
    harmless : tuple of Cause
        Causes that are certain and move no parameter by more than 5 % or two errors.
    tried : tuple of str
        Names of all causes that were looked for.
    """

    found: tuple[Cause, ...]
    harmless: tuple[Cause, ...] = ()
    tried: tuple[str, ...] = ()

    _KIND = "causes"

    @property
    def overview(self) -> Overview:
        """Return the summary that a report page shows."""
        tried = self.excluded
        return Overview(
            title="causes of the residual",
            answer=tuple(map(_sentence, self.found)) or (_NOTHING,),
            parameters=tuple(
                Quantity(
                    name=cause.name,
                    value=float(f"{100.0 * cause.share:.2g}"),
                    unit="% of the residual",
                    meaning=str(cause),
                    remark="" if cause in self.found else "harmless",
                )
                for cause in (*self.found, *self.harmless)
            ),
            facts=(("looked for and not found", ", ".join(tried)),) if tried else (),
        )

    @property
    def excluded(self) -> tuple[str, ...]:
        """Causes that were looked for and not found."""
        named = {cause.name for cause in (*self.found, *self.harmless)}
        return tuple(name for name in self.tried if name not in named)

    def report(self, action: Callable[[Action], str] = str, *, verbose: bool = False) -> str:
        """Return the causes as text, one a line, with their advice.

        Parameters
        ----------
        action : callable
            Words one action. Default: as at a Python prompt.
        verbose : bool
            Changes nothing: the answer is everything.
        """
        del verbose
        lines = [
            f"{cause.name}: {cause}" + "".join(f"\n    {action(each)}" for each in cause.advice)
            for cause in self.found
        ]
        lines += [f"{cause.name} (harmless): {cause}" for cause in self.harmless]
        if not lines:
            lines = [_NOTHING]
        if self.excluded:
            lines.append(f"looked for and not found: {', '.join(self.excluded)}")
        return "\n".join(lines)

    def __str__(self) -> str:
        return self.report()

    def to_dict(self) -> dict[str, Any]:
        """Return the causes in JSON's types."""
        document: dict[str, Any] = json_types(
            {
                "found": [_document(cause) for cause in self.found],
                "harmless": [_document(cause) for cause in self.harmless],
                "tried": self.tried,
            }
        )
        return document

    document = to_dict


def _document(cause: Cause) -> dict[str, Any]:
    return {
        "name": cause.name,
        "detail": cause.detail,
        "share": cause.share,
        "scale": cause.scale,
        "size": cause.size,
        "shifts": cause.shifts,
        "relative": cause.relative,
        "alike": cause.alike,
        "advice": [str(each) for each in cause.advice],
    }


def _sentence(cause: Cause) -> str:
    """The cause, and what to do about it."""
    advice = "; or ".join(filter(None, map(str, cause.advice)))
    return f"{cause.name}: {cause}{f'; do: {advice}' if advice else ''}."


def _rebuilt(values: dict[str, Any]) -> Cause:
    return Cause(**values)


def _largest(shares: Mapping[str, float]) -> list[tuple[str, float]]:
    return sorted(shares.items(), key=lambda entry: -abs(entry[1]))[:_SHOWN]


def _seconds(value: float) -> str:
    return f"{1e3 * value:.3g} ms" if value < 1.0 else f"{value:.3g} s"


def _in_errors(size: float) -> str:
    return f"{size:.2g} of its {'error' if size < 1.0 else 'errors'}"
