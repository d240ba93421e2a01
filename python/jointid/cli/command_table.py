"""Table of the commands: their help, the place of their options, and the function that runs them. It imports none."""

from collections.abc import Callable
from importlib import import_module

# For each command: its help, the function that adds its options, and the function that runs it.
_TABLE = {
    "demo": (
        "identify a joint of an industrial robot from a recording that ships with jointid",
        "jointid.cli.grammar:add_demo",
        "jointid.cli.commands:demo",
    ),
    "new": (
        "write a first joint file from options, a recording, or answers at the terminal",
        "jointid.cli.new_joint:add_new",
        "jointid.cli.new_joint:new",
    ),
    "identify": (
        "identify a joint from one recording or several",
        "jointid.cli.grammar:add_identify",
        "jointid.cli.commands:identify",
    ),
    "compare": (
        "compare friction models by how well they predict held-out motion",
        "jointid.cli.grammar:add_compare",
        "jointid.cli.commands:compare",
    ),
    "simulate": (
        "simulate a joint that a controller moves",
        "jointid.cli.simulation:add_simulate",
        "jointid.cli.simulation:simulate",
    ),
    "sweep": (
        "identify with many settings, several times each",
        "jointid.cli.study:add_sweep",
        "jointid.cli.study:sweep",
    ),
    "design": (
        "find the motion that identifies a joint best within limits",
        "jointid.cli.designs:add_design",
        "jointid.cli.designs:design",
    ),
    "check": (
        "show the connected drive, its settings, and the differences from the joint file",
        "jointid.cli.proof:add_check",
        "jointid.cli.proof:check",
    ),
    "first-motion": (
        "move a joint for the first time, by less than half a degree: signs, breakaway, scales",
        "jointid.cli.proof:add_first_motion",
        "jointid.cli.proof:first_motion",
    ),
    "run": (
        "move a joint over CAN, identify it, and move it again with the result",
        "jointid.cli.session:add_run",
        "jointid.cli.session:run",
    ),
    "emulate": (
        "emulate a drive and joint on a CAN bus, for other programs to move",
        "jointid.cli.emulation:add_emulate",
        "jointid.cli.emulation:emulate",
    ),
    "report": (
        "write the HTML report of a saved estimate",
        "jointid.cli.grammar:add_report",
        "jointid.cli.commands:report",
    ),
    "export": (
        "write an identified joint for a simulator, a controller, a PLC or Simulink",
        "jointid.cli.exports:add_export",
        "jointid.cli.exports:export",
    ),
    "app": (
        "open a page: drop a log, fix its units, identify, compare, export",
        "jointid.cli.app:add_app",
        "jointid.cli.app:serve_page",
    ),
    "explain": (
        "show the meaning of a finding, and its remedy",
        "jointid.cli.explaining:add_explain",
        "jointid.cli.explaining:explain",
    ),
    "info": (
        "show what a recording holds",
        "jointid.cli.grammar:add_info",
        "jointid.cli.contents:info",
    ),
}
HELP = {command: row[0] for command, row in _TABLE.items()}
"""Purpose of each command, in the order of `jointid --help`."""


def options_of(command: str) -> Callable[..., object]:
    """Return the function that adds a command's options to its parser."""
    return _imported(_TABLE[command][1])


def runner_of(command: str) -> Callable[..., int | None]:
    """Return the function that runs a command. It returns the exit code, or None for 0."""
    return _imported(_TABLE[command][2])


def _imported(place: str) -> Callable[..., int | None]:
    module, _, name = place.partition(":")
    found: Callable[..., int | None] = getattr(import_module(module), name)
    return found
