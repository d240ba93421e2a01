"""Plans for the faults of `faulty_logs.py`: a joint to simulate, and the log written from its runs."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

from foreign_joints import LAYOUTS, RATES, Draw, Drawn, Layout, Table

SI = LAYOUTS[0]


@dataclass(frozen=True, kw_only=True)
class Log:
    """Files of one joint with one fault.

    Attributes
    ----------
    files : mapping of str to str
        Text by file name.
    truth : mapping of str to float
    options : tuple of str
        Options that a user would know and add to `identify`.
    causes : str
        A pattern of the right name of the cause, in a finding's code or sentence, or in an error.
    never : str
        A pattern of findings that would be false, even with right values.
    what : str
        The fault and its size.
    paste : bool
        Whether an error's mapping of columns is once appended to the command.
    """

    files: Mapping[str, str]
    truth: Mapping[str, float]
    options: tuple[str, ...] = ()
    causes: str
    never: str = ""
    what: str = ""
    paste: bool = False


@dataclass(frozen=True, kw_only=True)
class Plan:
    """A joint to simulate, and the function that writes its log from the runs."""

    drawn: Drawn
    write: Callable[[list[Table]], Log]


def one_run(
    draw: Draw, change: Callable[[Draw, Table, Drawn], Log], *, rates: Sequence[int] = RATES
) -> Plan:
    """Return a single ordinary run; `change` makes the log of the sampled table."""
    every, held = draw.one(rates), draw.chance(0.3)
    drawn = draw.joint([draw.motion(draw.scale(0.5, 1.5))], every, held=held)

    def write(runs: list[Table]) -> Log:
        return change(draw, draw.sampled(runs[0], drawn), drawn)

    return Plan(drawn=drawn, write=write)


def log_of(draw: Draw, tables: Sequence[Table], drawn: Drawn, **more: object) -> Log:
    """Write the log of tables in any usual layout, one of three compressed; a user knows that a command is held."""
    form = more.pop("form", None)
    form = form if isinstance(form, Layout) else draw.one(LAYOUTS)
    ending = ".csv.gz" if draw.chance(1 / 3) else ".csv"
    names = [f"run_{k}" for k in range(len(tables))] if len(tables) > 1 else ["log"]
    files = {f"{name}{ending}": form.text(t) for name, t in zip(names, tables, strict=True)}
    if drawn.held:
        more["options"] = (*more.get("options", ()), "--torque-hold", "zoh")  # type: ignore[misc]
    return replace(Log(files=files, truth=drawn.truth, causes=""), **more)  # type: ignore[arg-type]
