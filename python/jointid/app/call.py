"""The user's input on the page: a file, its columns, the joint, the settings, and parts to leave out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.joint.joint import Joint

if TYPE_CHECKING:
    from jointid.estimate.estimate import Estimate
    from jointid.recording.recording import Recording

# As in `Action`. Other arguments replace those of the call.
_MERGED = ("columns", "units", "scale", "parameters", "side")
_FEWEST = 50  # smallest number of samples between two excluded stretches


@dataclass(frozen=True, slots=True, kw_only=True)
class Call:
    """One identification, as a user writes it: ``identify(load(file, …), joint, …)``.

    Attributes
    ----------
    file : Path
        File with the recording.
    name : str
        The user's name of the file; "" for the file's own name.
    load : mapping
        Arguments of `load`.
    joint : Joint or None
    identify : mapping
        Arguments of `identify`.
    left_out : tuple of (float, float)
        Stretches of time [s] in the recording that are not used.
    """

    file: Path
    name: str = ""
    load: Mapping[str, Any] = field(default_factory=dict, hash=False)
    joint: Joint | None = None
    identify: Mapping[str, Any] = field(default_factory=dict, hash=False)
    left_out: tuple[tuple[float, float], ...] = ()

    def obey(self, action: Action) -> Call | None:
        """Return the call with the action's arguments; None if a program cannot do the action."""
        if action.kind != "call" or _unknown(action.arguments):
            return None
        if action.function == "load":
            return replace(self, load=_merged(self.load, action.arguments))
        if action.function == "identify":
            return replace(self, identify=_merged(self.identify, action.arguments))
        if action.function == "Joint":
            return replace(self, joint=(self.joint or Joint()).replace(**action.arguments))
        return None

    def recording(self) -> Recording:
        """Return the complete recording."""
        from jointid.recording.readers.loading import load

        return load(self.file, **{"name": self.name or None, **self.load})

    def recordings(self) -> list[Recording]:
        """Return the remaining pieces of the recording.

        Raises
        ------
        InputError
            The file cannot be read, or no samples remain.
        """
        whole = self.recording()
        if not self.left_out:
            return [whole]
        pieces = [whole.crop(start, stop) for start, stop in self._kept_of(whole)]
        if not pieces:
            raise InputError(
                "the recording has no samples left", argument="left_out", value=self.left_out
            )
        return pieces

    def run(self, recordings: Sequence[Recording] | None = None, **more: Any) -> Estimate:
        """Return the estimate.

        Parameters
        ----------
        recordings : sequence of Recording, optional
            Result of `recordings`. Default: they are read.
        **more
            Further arguments of `identify`, which replace those of the call.
        """
        from jointid.identification.identification import identify

        return identify(recordings or self.recordings(), self.joint, **{**self.identify, **more})

    def _kept_of(self, whole: Recording) -> list[tuple[float | None, float | None]]:
        """Return the remaining stretches, without those of a few samples."""
        time, found = whole.time, []
        for start, stop in kept(self.left_out):
            first = 0 if start is None else int(np.searchsorted(time, start))
            last = len(time) if stop is None else int(np.searchsorted(time, stop, side="right"))
            if last - first >= _FEWEST:
                found.append((start, stop))
        return found

    def script(self, whole: Recording) -> str:
        """Return the call as a Python program.

        Parameters
        ----------
        whole : Recording
            Result of `recording`.
        """
        lines = ["import jointid as jid", ""]
        stated = "".join(f", {name}={value!r}" for name, value in self.load.items())
        lines += [f"recording = jid.load({(self.name or self.file.name)!r}{stated})"]
        what = "recording"
        if self.left_out:
            pieces = ", ".join(
                f"recording[{_bound(start)}:{_bound(stop)}]" for start, stop in self._kept_of(whole)
            )
            lines += [f"pieces = [{pieces}]  # by time [s]"]
            what = "pieces"
        lines += ['joint = jid.Joint.load("joint.toml")  # exported next to this program'] * (
            self.joint is not None
        )
        given = "".join(f", {name}={value!r}" for name, value in self.identify.items())
        lines += [
            f"estimate = jid.identify({what}{', joint' if self.joint is not None else ''}{given})",
            "print(estimate.report())",
            "",
        ]
        return "\n".join(lines)


def kept(
    left_out: tuple[tuple[float, float], ...],
) -> list[tuple[float | None, float | None]]:
    """Return the stretches [s] between the excluded stretches; None for the start and end of the recording.

    Examples
    --------
    >>> kept(((2.0, 3.0), (2.5, 4.0)))
    [(None, 2.0), (4.0, None)]
    """
    found: list[tuple[float | None, float | None]] = []
    at: float | None = None
    for start, stop in sorted(left_out):
        if at is None or start > at:
            found.append((at, start))
        at = stop if at is None else max(at, stop)
    return [*found, (at, None)]


def _bound(time: float | None) -> str:
    return "" if time is None else f"{time:.6g}"


def _merged(given: Mapping[str, Any], advised: Mapping[str, Any]) -> dict[str, Any]:
    merged = dict(given)
    for name, value in advised.items():
        if name in _MERGED and isinstance(value, Mapping) and merged.get(name) is not None:
            merged[name] = {**merged[name], **value}
        else:
            merged[name] = value
    return merged


def _unknown(value: object) -> bool:
    if isinstance(value, Mapping):
        return any(map(_unknown, value.values()))
    return value is ... or value == "..."
