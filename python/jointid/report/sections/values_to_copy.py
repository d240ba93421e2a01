"""Section with values to copy: a joint file, a table, and the call that finds them again."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, cast

from jointid._core import GaOptions
from jointid.base.options import options_of
from jointid.base.result import Result
from jointid.estimate.estimate import Estimate
from jointid.estimate.settings import model_of
from jointid.problem.settings import ProblemOptions
from jointid.report.page.content import Code, Part, paragraph
from jointid.report.page.extras import Extras


def content(result: Result, extras: Extras) -> list[Part]:
    """Return the blocks, folded."""
    estimate = cast("Estimate", result)
    blocks = (
        paragraph("As lines of a joint file, with all digits:"),
        Code(joint_file_lines(estimate)),
        paragraph("As a table, for spreadsheets:"),
        Code(table_lines(estimate)),
        paragraph("The call that finds the same values again, with all settings:"),
        Code(program(estimate)),
    )
    return [Part("Values to copy", blocks, f"{extras.prefix}values", "folded")]


def joint_file_lines(estimate: Estimate) -> str:
    """Return the values as the table [parameters] of a joint file."""
    lines = (
        f"{_key(p.name)} = {{ value = {float(p.value)!r} }}" for p in estimate.parameters.values()
    )
    return "\n".join(["[parameters]", *lines])


def table_lines(estimate: Estimate) -> str:
    """Return values, standard errors and 95 % intervals as comma-separated lines. Missing values are empty."""
    lines = ["name,value,stderr,lower,upper,unit"]
    for p in estimate.parameters.values():
        numbers = (p.value, p.stderr, *(p.interval or (None, None)))
        shown = ("" if each is None else repr(float(each)) for each in numbers)
        name = f'"{p.name}"' if "," in p.name else p.name
        lines.append(",".join([name, *shown, p.unit]))
    return "\n".join(lines)


def program(estimate: Estimate) -> str:
    """Return the Python lines that find the same values in the same recordings.

    Parameters
    ----------
    estimate : Estimate

    Returns
    -------
    str
        The lines, with the settings that were chosen automatically. The joint is the argument of `identify`.
    """
    settings = estimate.settings
    windows = "cumulative" if settings.get("cumulative") else settings["windows"]
    runs = settings["recordings"]
    what = "recording" if len(runs) == 1 else "recordings"
    # In one line, so that a name cannot become a line of the program.
    named = ", ".join(
        f"{' '.join(str(run['name'] or 'unnamed').split())} ({run['fingerprint']})" for run in runs
    )
    # Own terms are in the model. The settings list the core's terms.
    found = {**settings, "model": str(model_of(settings)), "windows": windows, "terms": None}
    stated = {name: found.get(name) for name in options_of(ProblemOptions)}
    arguments = [f"    {name}={value!r}," for name, value in stated.items() if value is not None]
    genetic = ""
    if settings["ga"] is not None and (changed := _changed(settings["ga"])):
        genetic = f", ga=jid.GaOptions({changed})"
    return "\n".join(
        [
            "import jointid as jid",
            "",
            f"# {what}: {named}",
            "# joint: the joint of the first call, or None; also copy the argument parameters of that call",
            "estimate = jid.identify(",
            f"    {what},",
            "    joint,",
            *arguments,
            f"    search=jid.Search({settings['method']!r}{genetic}, seed={settings['seed']}),",
            ")",
        ]
    )


def _changed(genetic: Mapping[str, Any]) -> str:
    usual = GaOptions().asdict()
    return ", ".join(f"{k}={v!r}" for k, v in genetic.items() if k in usual and usual[k] != v)


def _key(name: str) -> str:
    """Return a name as a TOML key: without quotes if TOML allows it."""
    return name if name.replace("_", "").isalnum() and name.isascii() else f'"{name}"'
