"""The state of one page and what its buttons do: every change goes through here, every computation to the process."""

from __future__ import annotations

import asyncio
import math
import shutil
import tempfile
from collections.abc import Awaitable, Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from jointid.app import tasks
from jointid.app.call import Call
from jointid.app.worker import CancelledWork, Worker
from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.joint.joint import Joint

if TYPE_CHECKING:
    from jointid.comparison.result import Comparison
    from jointid.estimate.estimate import Estimate
    from jointid.recording.readers.looking import FirstLook, LookedColumn
    from jointid.recording.recording import Recording

COUNTS = "counts"
"""The unit of an encoder: needs the counts of a turn."""
_TURN = 2.0 * math.pi


class Desk:
    """What one page works on.

    Parameters
    ----------
    changed : callable
        Called with the name of what is to be drawn anew: "columns", "ranges",
        "remarks", "signals", "result", "progress".
    said : callable
        Called with a sentence and whether it is an error.
    """

    def __init__(
        self, changed: Callable[[str], object], said: Callable[[str, bool], object]
    ) -> None:
        self.worker = Worker()
        self.call: Call | None = None
        self.looked: FirstLook | None = None
        self.recording: Recording | None = None
        self.remarks: tuple[str, ...] = ()
        self.problem = ""
        self.estimate: Estimate | None = None
        self.report = ""
        self.comparison: Comparison | None = None
        self.brushed: tuple[float, float] | None = None
        self.on_brush: Callable[[tuple[float, float] | None], object] = lambda _stretch: None
        self.counts_per_turn: float | None = None
        self.facts: dict[str, Any] = {}
        self.busy = ""
        self.share = 0.0
        self.step = ""
        self._changed, self._said = changed, said
        self._folder = Path(tempfile.mkdtemp(prefix="jointid-app-"))

    def close(self) -> None:
        """End what is computed, and remove what was uploaded."""
        self.worker.cancel()
        shutil.rmtree(self._folder, ignore_errors=True)

    def place_for(self, name: str) -> Path:
        """Return where an upload is kept: of its name only the ending is used.

        Raises
        ------
        InputError
            The ending is none that is read.
        """
        from jointid.base.file_endings import ending_of
        from jointid.recording.readers.registry import endings

        return self._folder / f"recording{ending_of(Path(Path(name).name), endings())}"

    async def open(self, path: Path, name: str) -> None:
        """Look at a file, and read it if its headers say enough."""
        self.call = self.looked = self.recording = self.estimate = self.comparison = None
        self.problem, self.remarks, self.brushed = "", (), None

        async def work() -> None:
            self.looked = await self.worker.run(tasks.look, path)
            self.call = Call(file=path, name=Path(name).name)
            if not self.looked.certain:
                self._propose(self.looked)

        await self._do("reading", work)
        self._changed("columns")
        if self.call is not None:
            await self.read()

    async def read(self) -> None:
        """Read the recording as it is stated now."""
        if self.call is None:
            return
        self.recording, self.problem = None, ""

        async def work() -> None:
            assert self.call is not None
            try:
                self.call = replace(self.call, joint=self._joint())
                found = await self.worker.run(tasks.read, self.call)
            except InputError as error:
                self.problem = str(error)
                return
            self.recording, self.remarks = found.recording, found.remarks

        await self._do("reading", work)
        for part in ("remarks", "signals", "result"):
            self._changed(part)

    async def identify(self) -> None:
        """Identify, with progress."""
        await self.read()
        if self.call is None or self.recording is None:
            self._said(self.problem or "load a recording first", True)
            return

        async def work() -> None:
            self.estimate, self.report = await self.worker.run(
                tasks.identify, self.call, report=self._progress
            )

        await self._do("identifying", work)
        self._changed("result")

    async def compare(self) -> None:
        """Compare the usual models."""
        await self.read()
        if self.call is None or self.recording is None:
            self._said(self.problem or "load a recording first", True)
            return

        async def work() -> None:
            self.comparison = await self.worker.run(
                tasks.compare, self.call, (), report=self._progress
            )

        await self._do("comparing", work)
        self._changed("result")

    def cancel(self) -> None:
        """End what is computed now."""
        self.worker.cancel()

    async def obey(self, action: Action) -> None:
        """Do what a finding advises, and identify again."""
        again = None if self.call is None else self.call.obey(action)
        if again is None:
            self._said("jointid cannot do this; do it by hand", True)
            return
        self.call = again
        if action.function == "Joint":
            self.facts |= action.arguments
        self._changed("columns")
        await self.identify()

    def assign(self, signal: str, column: int | None) -> None:
        """Say which column holds a signal; None for none."""
        assert self.call is not None
        assert self.looked is not None
        load: dict[str, Any] = {name: dict(self.call.load.get(name, {})) for name in _READ}
        load["columns"][signal] = None if column is None else column
        for name in ("units", "scale"):
            load[name].pop(signal, None)
        self._load(load)
        self._changed("columns")

    def measure(self, signal: str, unit: str) -> None:
        """Say in which unit a signal's column is."""
        assert self.call is not None
        load: dict[str, Any] = {name: dict(self.call.load.get(name, {})) for name in _READ}
        load["units"].pop(signal, None)
        load["scale"].pop(signal, None)
        if unit == COUNTS:
            load["scale"][signal] = _TURN / (self.counts_per_turn or 1.0)
        elif unit:
            load["units"][signal] = unit
        self._load(load)
        self._changed("columns")

    def count(self, per_turn: float | None) -> None:
        """Say how many counts a turn of the joint has."""
        self.counts_per_turn = per_turn
        if self.call is not None:
            scale = dict.fromkeys(self.call.load.get("scale", {}), _TURN / (per_turn or 1.0))
            self._load({**{n: self.call.load.get(n, {}) for n in _READ}, "scale": scale})
            self._changed("ranges")

    def choose(self, model: str) -> None:
        """Say which friction model is identified; "auto" lets the data choose."""
        if self.call is not None:
            identify = {k: v for k, v in self.call.identify.items() if k != "model"}
            self.call = replace(
                self.call, identify=identify if model == "auto" else {**identify, "model": model}
            )

    @property
    def model(self) -> str:
        """The friction model that is stated; "auto" for none."""
        stated = "auto" if self.call is None else self.call.identify.get("model", "auto")
        return stated if isinstance(stated, str) and ":" not in stated else "auto"

    def brush(self, bounds: Sequence[float] | None) -> None:
        """Say which stretch of time is brushed; None for none."""
        whole = self.recording
        self.brushed = None
        if bounds and len(bounds) == 2 and whole is not None:
            start, stop = sorted(float(each) for each in bounds)
            start, stop = max(start, float(whole.time[0])), min(stop, float(whole.time[-1]))
            self.brushed = (start, stop) if stop > start else None
        self.on_brush(self.brushed)

    def leave_out(self) -> None:
        """Leave the brushed stretch out."""
        if self.call is not None and self.brushed is not None:
            self.call = replace(self.call, left_out=(*self.call.left_out, self.brushed))
            self.brushed = None

    def keep_all(self) -> None:
        """Leave nothing out."""
        if self.call is not None:
            self.call = replace(self.call, left_out=())

    def column_of(self, signal: str) -> int | None:
        """Number of the column that holds a signal, as stated or as the headers say."""
        assert self.call is not None
        assert self.looked is not None
        stated = self.call.load.get("columns", {})
        column: str | int | None = stated.get(signal, self.looked.signals.get(signal))
        if isinstance(column, str):
            headers = [each.header for each in self.looked.columns]
            return headers.index(column) if column in headers else None
        if signal not in stated and column in [
            each for each in stated.values() if isinstance(each, int)
        ]:
            return None  # given to another signal
        return column

    def unit_of(self, signal: str) -> str:
        """Unit of a signal's column, as stated or as its header says; "" where SI is assumed."""
        assert self.call is not None
        if signal in self.call.load.get("scale", {}):
            return COUNTS
        column = self.looked_at(signal)
        stated = str(self.call.load.get("units", {}).get(signal, ""))
        return stated or ("" if column is None else column.unit)

    def looked_at(self, signal: str) -> LookedColumn | None:
        """What was seen of a signal's column."""
        number = self.column_of(signal)
        return None if number is None or self.looked is None else self.looked.columns[number]

    def _propose(self, looked: FirstLook) -> None:
        columns = {
            signal: looked.columns[index].header
            if [each.header for each in looked.columns].count(looked.columns[index].header) == 1
            else index
            for signal, index in looked.signals.items()
        }
        self._load({"columns": columns, "units": dict(looked.units)})

    def _load(self, load: Mapping[str, Mapping[str, Any]]) -> None:
        assert self.call is not None
        kept = {name: value for name, value in self.call.load.items() if name not in _READ}
        stated = {name: mapping for name, mapping in load.items() if mapping}
        self.call = replace(self.call, load={**kept, **stated})

    def _joint(self) -> Joint | None:
        stated = {name: value for name, value in self.facts.items() if value not in (None, "")}
        if not stated:
            return None
        if self.column_of("sensor") is not None:
            stated["sensor"] = True
        return Joint(**stated)

    def _progress(self, share: float, step: str) -> None:
        self.share, self.step = share, step
        self._changed("progress")

    async def _do(self, what: str, work: Callable[[], Awaitable[None]]) -> None:
        self.busy, self.share, self.step = what, 0.0, ""
        self._changed("progress")
        try:
            await work()
        except CancelledWork:
            self._said(f"{what}: cancelled", False)
        except InputError as error:
            self._said(str(error), True)
        except RuntimeError as error:
            self._said(f"an error in jointid: {str(error).strip().splitlines()[-1]}", True)
        except asyncio.CancelledError:
            self.worker.cancel()
            raise
        finally:
            self.busy = ""
            self._changed("progress")


_READ = ("columns", "units", "scale")
