"""Causes of a poor fit, by name, with the explained share of the residual and the effect on the values."""

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
    """An effect that the recordings show and the model lacks.

    Attributes
    ----------
    name : str
        Name, e.g. "gravity", "load_friction", "drift"; `docs/findings.md` lists all.
    meaning : str
        Meaning of the name, as the beginning of a sentence.
    detail : str
        Specification: the drifting coefficient, the order of a harmonic, the late signal.
    share : float
        Explained share of the residual, in held-out stretches of time.
    scale : float
        Length of the windows for this share [s].
    size : str
        Size of the effect with its unit; empty if one number is not enough.
    numbers : mapping of str to Measured
        The numbers in `detail` and `size`.
    shifts : mapping of str to float
        Change of each parameter if the model had the effect, in the parameter's unit.
    relative : mapping of str to float
        Relative changes of the parameters that change noticeably.
    shares : mapping of str to float
        Relative changes of all parameters.
    uncertain : mapping of str to float
        Large relative changes of uncertain values, in standard errors.
    near_zero : mapping of str to str
        Changes of values near zero as text: "from 0 to 0.12 N·m".
    effect : str
        Effect on the values as part of a sentence, if it is more than a list of changes.
    harmful : bool
        Whether a value changes by more than 5 %, or by more than two of its errors.
    alike : tuple of str
        Other causes that these recordings can hardly separate from this one.
    advice : tuple of Action
        Remedies.
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
        """Return title and details."""
        return f"{self.title}; {self.details}"

    @property
    def title(self) -> str:
        """Missing effect, its size, and the values that change, within the length of a title."""
        return self.titled(TITLE)

    def titled(self, most: int) -> str:
        """Return the missing effect, its size, and the values that change, within this number of characters."""
        inside = ", ".join(filter(None, (self.detail, self.size.partition(", ")[0])))
        what = self.meaning + (f" ({inside})" if inside else "")
        if not self.harmful:
            return f"{what}: harmless"
        if self.effect:  # longer than a title
            return what
        title, before = what, ": with it, "
        for each in self._moved:
            if len(title + before + each) <= most:
                title, before = title + before + each, ", "
        return title

    @property
    def details(self) -> str:
        """Explained share, effect on the values, and causes that look alike."""
        said = [
            f"explains {percent(self.share)} of the residual in windows of {_seconds(self.scale)}",
            self.size.partition(", ")[2],
            "" if self.harmful and self._is_in_title else self.does,
            f"hard to separate from {' and '.join(self.alike)}" if self.alike else "",
        ]
        return "; ".join(filter(None, said))

    def evidence(self, shifts: Mapping[str, float]) -> dict[str, Measured]:
        """Return the numbers of the finding, with the relative changes of the values."""
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
        """Effect on the values, as a clause."""
        if not self.harmful:
            return f"it {self.harmless}"
        return self.effect or f"with this effect in the model, {self.changes}"

    @property
    def changes(self) -> str:
        """Largest changes with their verb: "inertia changes by +27 %, viscous by −3 %"."""
        name, _, rest = self.moves.partition(" ")
        return f"{name} changes {rest}"

    @property
    def moves(self) -> str:
        """Largest changes, as part of a sentence."""
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
        """Statement that no value changes noticeably, as part of a sentence."""
        return f"moves no parameter noticeably ({self.moves})"

    @property
    def did(self) -> str:
        """Past effect of a cause that was removed, as part of a sentence."""
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
    """Result of an attribution of the residual.

    Attributes
    ----------
    found : tuple of Cause
        Certain causes that change a parameter, with the largest explained share first.
    harmless : tuple of Cause
        Certain causes that change no parameter by more than 5 % or two errors.
    tried : tuple of str
        Names of all examined causes.
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
            facts=(("searched but not found", ", ".join(tried)),) if tried else (),
        )

    @property
    def excluded(self) -> tuple[str, ...]:
        """Causes that were searched but not found."""
        named = {cause.name for cause in (*self.found, *self.harmless)}
        return tuple(name for name in self.tried if name not in named)

    def report(self, action: Callable[[Action], str] = str, *, verbose: bool = False) -> str:
        """Return the causes as text, one per line, with their remedies.

        Parameters
        ----------
        action : callable
            Words one action. Default: for a Python prompt.
        verbose : bool
            No effect: the report is always complete.
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
            lines.append(f"searched but not found: {', '.join(self.excluded)}")
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
    """Return the cause and its remedies as a sentence."""
    advice = "; or ".join(filter(None, map(str, cause.advice)))
    return f"{cause.name}: {cause}{f'; advice: {advice}' if advice else ''}."


def _rebuilt(values: dict[str, Any]) -> Cause:
    return Cause(**values)


def _largest(shares: Mapping[str, float]) -> list[tuple[str, float]]:
    return sorted(shares.items(), key=lambda entry: -abs(entry[1]))[:_SHOWN]


def _seconds(value: float) -> str:
    return f"{1e3 * value:.3g} ms" if value < 1.0 else f"{value:.3g} s"


def _in_errors(size: float) -> str:
    return f"{size:.2g} of its standard {'error' if size < 1.0 else 'errors'}"
