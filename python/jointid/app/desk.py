"""The state of one page and the actions of its buttons. All changes happen here, and a process computes."""

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
from jointid.app.wording import worded
from jointid.app.work import Work
from jointid.app.worker import CancelledWork, Worker
from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.joint.joint import Joint

if TYPE_CHECKING:
    from jointid.comparison.result import Comparison
    from jointid.estimate.estimate import Estimate
    from jointid.recording.readers.table_preview import FirstLook, LookedColumn
    from jointid.recording.recording import Recording

COUNTS = "counts"
"""The unit of an encoder, which needs the counts per revolution."""
READ_WITH = ("gear_ratio", "sample_period")
"""Facts that are used to read a log."""
_TURN = 2.0 * math.pi
_READ = ("columns", "units", "scale", "side")
_JOINT_FACTS = ("gear_ratio", "torque_constant", "inertia")


class Desk:
    """The state of one page.

    Parameters
    ----------
    changed : callable
        Called with the name of the part to redraw: "columns", "ranges", "remarks", "signals", "result",
        "progress".

    Attributes
    ----------
    problem : str
        Reason why the log cannot be read; "" if it can.
    failure : str
        Reason why there is no result; "" if there is one, or none is computed.
    """

    def __init__(self, changed: Callable[[str], object]) -> None:
        self.worker = Worker()
        self.work = Work()
        self.call: Call | None = None
        self.looked: FirstLook | None = None
        self.recording: Recording | None = None
        self.remarks: tuple[str, ...] = ()
        self.problem = self.failure = ""
        self.estimate: Estimate | None = None
        self.report = ""
        self.comparison: Comparison | None = None
        self.brushed: tuple[float, float] | None = None
        self.on_brush: Callable[[tuple[float, float] | None], object] = lambda _stretch: None
        self.counts_per_turn: float | None = None
        self.facts: dict[str, Any] = {}
        self._known: Joint | None = None  # facts of the example
        self._log: tuple[Path | None, str] = (None, "")  # path, and the user's name of it
        self._changed = changed
        self._folder = Path(tempfile.mkdtemp(prefix="jointid-app-"))

    def close(self) -> None:
        """End the computation, and remove the uploaded file."""
        self.worker.cancel()
        shutil.rmtree(self._folder, ignore_errors=True)

    def place_for(self, name: str) -> Path:
        """Return the path for an upload. Only the ending of its name is used.

        Raises
        ------
        InputError
            The ending is unknown.
        """
        from jointid.base.file_endings import ending_of
        from jointid.recording.readers.registry import endings

        return self._folder / f"recording{ending_of(Path(Path(name).name), endings())}"

    async def open(self, path: Path, name: str) -> None:
        """Examine a file, and read it if its headers give enough information."""
        await self._open(Call(file=path, name=Path(name).name))

    async def try_example(self, example: Call) -> None:
        """Read an example with the known facts of its joint, and identify it."""
        await self._open(example)
        await self.identify()

    async def read(self) -> None:
        """Read the recording with the present settings."""
        if self.call is None:
            return
        self.recording, self.problem = None, ""

        async def work() -> None:
            assert self.call is not None
            self.call = replace(self.call, load=self._how_to_read(), joint=self._joint())
            found = await self.worker.run(tasks.read, self.call)
            self.recording, self.remarks = found.recording, found.remarks

        self.problem = await self._do("reading", work)
        for part in ("remarks", "signals", "result"):
            self._changed(part)

    async def identify(self) -> None:
        """Identify, with progress."""

        async def work() -> None:
            self.estimate, self.report = await self.worker.run(
                tasks.identify, self.call, report=self._progress
            )

        await self._answer("identifying", work)

    async def compare(self) -> None:
        """Compare the usual models."""

        async def work() -> None:
            self.comparison = await self.worker.run(
                tasks.compare, self.call, (), report=self._progress
            )

        await self._answer("comparing", work)

    def cancel(self) -> None:
        """End the present computation."""
        self.worker.cancel()

    async def obey(self, action: Action) -> None:
        """Do what a finding advises, and identify again."""
        again = None if self.call is None else self.call.obey(action)
        if again is None:
            self.failure = "jointid cannot follow this advice; follow it by hand"
            self._changed("result")
            return
        self.call = again
        if action.function == "Joint":
            self.facts |= action.arguments
        self._changed("columns")
        await self.identify()

    def assign(self, signal: str, column: int | None) -> None:
        """Set the column of a signal; None for none."""
        assert self.call is not None
        assert self.looked is not None
        load: dict[str, Any] = {name: dict(self.call.load.get(name, {})) for name in _READ}
        load["columns"][signal] = None if column is None else column
        for name in ("units", "scale", "side"):
            load[name].pop(signal, None)
        self._load(load)
        self._changed("columns")

    def measure(self, signal: str, unit: str) -> None:
        """Set the unit of a signal's column."""
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

    def put_on(self, signal: str, side: str) -> None:
        """Set the side of the gear on which a signal is measured; "" for the side in its header."""
        assert self.call is not None
        load: dict[str, Any] = {name: dict(self.call.load.get(name, {})) for name in _READ}
        load["side"].pop(signal, None)
        if side:
            load["side"][signal] = side
        self._load(load)
        self._changed("columns")

    def count(self, per_turn: float | None) -> None:
        """Set the encoder counts per revolution of the joint."""
        self.counts_per_turn = per_turn
        if self.call is not None:
            scale = dict.fromkeys(self.call.load.get("scale", {}), _TURN / (per_turn or 1.0))
            self._load({**{n: self.call.load.get(n, {}) for n in _READ}, "scale": scale})
            self._changed("ranges")

    def choose(self, model: str) -> None:
        """Set the friction model to identify; "auto" chooses it from the data."""
        if self.call is not None:
            self.call = replace(self.call, identify={**self.call.identify, "model": model})

    @property
    def model(self) -> str:
        """The friction model that is set, or known for the example; "auto" for none."""
        known = self._known.model.name if self._known is not None else None
        stated = known if self.call is None else self.call.identify.get("model", known)
        return stated if isinstance(stated, str) and ":" not in stated else "auto"

    def brush(self, bounds: Sequence[float] | None) -> None:
        """Set the selected stretch of time; None for none."""
        whole = self.recording
        self.brushed = None
        if bounds and len(bounds) == 2 and whole is not None:
            start, stop = sorted(float(each) for each in bounds)
            start, stop = max(start, float(whole.time[0])), min(stop, float(whole.time[-1]))
            self.brushed = (start, stop) if stop > start else None
        self.on_brush(self.brushed)

    def leave_out(self) -> None:
        """Exclude the selected stretch."""
        if self.call is not None and self.brushed is not None:
            self.call = replace(self.call, left_out=(*self.call.left_out, self.brushed))
            self.brushed = None

    def keep_all(self) -> None:
        """Use all stretches again."""
        if self.call is not None:
            self.call = replace(self.call, left_out=())

    def column_of(self, signal: str) -> int | None:
        """Return the number of a signal's column, as set or from the headers."""
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
            return None  # used by another signal
        return column

    def unit_of(self, signal: str) -> str:
        """Return the unit of a signal's column, as set or from its header; "" if SI is assumed."""
        assert self.call is not None
        if signal in self.call.load.get("scale", {}):
            return COUNTS
        column = self.looked_at(signal)
        stated = str(self.call.load.get("units", {}).get(signal, ""))
        return stated or ("" if column is None else column.unit)

    def side_of(self, signal: str) -> str:
        """Return the side of the gear that is set for a signal; "" for none."""
        return "" if self.call is None else str(self.call.load.get("side", {}).get(signal, ""))

    def looked_at(self, signal: str) -> LookedColumn | None:
        """Return what the first look found about a signal's column."""
        number = self.column_of(signal)
        return None if number is None or self.looked is None else self.looked.columns[number]

    def _propose(self, looked: FirstLook) -> None:
        columns = {
            signal: looked.columns[index].header
            if [each.header for each in looked.columns].count(looked.columns[index].header) == 1
            else index
            for signal, index in looked.signals.items()
        }
        self._load({"columns": columns, "units": dict(looked.units), "side": dict(looked.side)})

    def _load(self, load: Mapping[str, Mapping[str, Any]]) -> None:
        assert self.call is not None
        kept = {name: value for name, value in self.call.load.items() if name not in _READ}
        stated = {name: mapping for name, mapping in load.items() if mapping}
        self.call = replace(self.call, load={**kept, **stated})

    def _how_to_read(self) -> dict[str, Any]:
        """Return the arguments of `load`, including the facts of the joint that it uses."""
        assert self.call is not None
        kept = {name: value for name, value in self.call.load.items() if name not in READ_WITH}
        stated = {name: self.facts.get(name) for name in READ_WITH}
        return kept | {name: value for name, value in stated.items() if value not in (None, "")}

    def _joint(self) -> Joint | None:
        facts = {name: value for name, value in self.facts.items() if name != "sample_period"}
        stated = {name: value for name, value in facts.items() if value not in (None, "")}
        if not stated and self._known is None:
            return None
        if self.column_of("sensor") is not None:
            stated["sensor"] = True
        known = self._known or Joint()
        left_empty = {name: getattr(Joint(), name) for name in facts if name not in stated}
        return known.replace(**left_empty, **stated)

    async def _open(self, call: Call) -> None:
        """Examine a call's file, and read it with the call's arguments."""
        self.call = self.looked = self.recording = self.estimate = self.comparison = None
        self.problem, self.failure, self.remarks, self.brushed = "", "", (), None
        if call.joint is not None or self._known is not None:  # facts of another joint
            self.facts = _facts_of(call.joint)
        self._known, self._log = call.joint, (call.file, call.name)

        async def work() -> None:
            self.looked = await self.worker.run(tasks.look, call.file)
            self.call = call
            if not self.looked.certain:
                self._propose(self.looked)

        self.problem = await self._do("reading", work)
        for part in ("columns", "remarks", "signals", "result"):
            self._changed(part)
        if self.call is not None:
            await self.read()

    async def _answer(self, what: str, work: Callable[[], Awaitable[None]]) -> None:
        """Compute a result with the present settings."""
        self.failure = ""
        await self.read()
        if self.call is None or self.recording is None:
            self.failure = self.problem or "load a log first"
        else:
            self.failure = await self._do(what, work, len(self.recording.time))
        if self.failure and self.failure != f"{what} was cancelled":
            self.estimate = self.comparison = None  # results of earlier settings
        self._changed("result")
        self._changed("progress")

    def _progress(self, share: float, step: str) -> None:
        self.work.progress(share, step)

    async def _do(self, what: str, work: Callable[[], Awaitable[None]], samples: int = 0) -> str:
        """Do some work. Return the reason if it failed, otherwise ""."""
        self.work.begin(what, samples)
        self._changed("progress")
        failure = "cancelled"
        try:
            await work()
            failure = ""
        except CancelledWork:
            failure = f"{what} was cancelled"
        except InputError as error:
            failure = worded(error, *self._log)
        except RuntimeError as error:
            failure = f"an error in jointid: {str(error).strip().splitlines()[-1]}"
        except asyncio.CancelledError:
            self.worker.cancel()
            raise
        finally:
            self.work.end(done=not failure)
            self._changed("progress")
        return failure


def _facts_of(joint: Joint | None) -> dict[str, Any]:
    """Return the known facts for which the page has fields."""
    fields = {name: getattr(joint, name, None) for name in _JOINT_FACTS}
    unknown = Joint()
    return {n: v for n, v in fields.items() if v is not None and v != getattr(unknown, n)}
