"""Options of the commands and their arguments in Python; those of `identify` come from their declaration."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from typing import Any

from jointid.base.options import options_of
from jointid.cli.arguments import decimal, numbers_by_name, pair, windows
from jointid.identification.options import IdentifyOptions

# Settings of argparse for each form of an option.
_FORMS: Mapping[str, Mapping[str, Any]] = {
    "text": {},
    "number": {"type": decimal},
    "windows": {"type": windows},
    "numbers by name": {"type": pair, "action": "append"},
    "texts by name": {"type": pair, "action": "append"},
}

DECLARED = {name: option for name, option in options_of(IdentifyOptions).items() if option.flag}
"""Options of the command line by name. `--model` differs between the commands."""

_READING = {
    "columns": "--column",
    "units": "--unit",
    "scale": "--scale",
    "where": "--where",
    "joints": "--joints",
    "gear_ratio": "--gear-ratio",
    "gear_ratios": "--gear-ratio",
    "side": "--side",
    "sample_period": "--rate",
    "topic": "--topic",
    "group": "--group",
    "unpacked": "--unpacked",
    "drop_copies": "--drop-copies",
    "drop_invalid": "--drop-invalid",
    "extra": "--extra",
}
_FACTS = {
    "torque_constant": "--torque-constant",
    "torque_constants": "--torque-constant",
    "rotor_inertia": "--rotor-inertia",
    "inertia": "--inertia",
    "mass": "--mass",
    "centre_of_mass": "--centre-of-mass",
    "link_angle": "--link-angle",
}
_IDENTIFICATION = {
    **_READING,
    "joint": "--joint",
    **_FACTS,
    "model": "--model",
    "method": "--method",
    **{name: option.flag for name, option in DECLARED.items()},
    "seed": "--seed",
    "threads": "--threads",
}
_ROBOT = {
    "robot": "--robot",
    "path": "--robot",
    "facts": "--facts",
}
_SCENARIO = {
    "controller": "--controller",
    "believe": "--believe",
    "trajectory": "--trajectory",
    "gain": "--gain",
    "sensors": "--sensor",
    "control_period": "--control-period",
    "duration": "--duration",
}
_ESTIMATE = {"report": "--report", "save": "--save"}

OPTIONS: Mapping[str, Mapping[str, str]] = {
    "demo": {"output": "--output"},
    "app": {"port": "--port", "largest": "--largest"},
    "new": {
        **_READING,
        **_FACTS,
        "name": "--name",
        "kind": "--kind",
        "position": "--position",
        "velocity": "--velocity",
        "torque": "--torque",
        "current": "--current",
    },
    "identify": {
        **_IDENTIFICATION,
        **_ESTIMATE,
        "ga.population": "--population",
        "ga.generations": "--generations",
        "selftest": "--selftest",
        "causes": "--causes",
        "by": "--by",
        "rollout": "--rollout",
        "checkpoint": "--checkpoint",
        "resume": "--resume",
        "n": "--bootstrap",
        **_ROBOT,
    },
    "compare": {
        **_IDENTIFICATION,
        **_ESTIMATE,
        "models": "--model",
        "folds": "--folds",
        **_ROBOT,
    },
    "simulate": {**_SCENARIO, "seed": "--seed", "output": "--output"},
    "sweep": {
        **{name: option for name, option in _IDENTIFICATION.items() if name not in _FACTS},
        **_SCENARIO,
        "simulate": "--simulate",
        "subject": "--simulate",
        "grid": "--grid",
        "ga": "--ga",
        "trials": "--trials",
        "standard_errors": "--standard-errors",
        "stderr": "--standard-errors",
        "tracking": "--tracking",
        "workers": "--workers",
        "output": "--output",
        "resume": "--resume",
        "table": "--table",
        "plot": "--plot",
        "report": "--report",
    },
    "design": {
        **{name: option for name, option in _SCENARIO.items() if name != "trajectory"},
        "after": "--after",
        "after_joint": "--after-joint",
        "position": "--position",
        "velocity": "--velocity",
        "acceleration": "--acceleration",
        "torque": "--torque",
        "sensor_range": "--sensor-range",
        "prior": "--prior",
        "parameters": "--parameter",
        "criterion": "--criterion",
        "evaluations": "--evaluations",
        "joints": "--joints",
        "rehearsals": "--rehearsals",
        "seed": "--seed",
        "threads": "--threads",
        "output": "--output",
        "plot": "--plot",
        "report": "--report",
    },
    "run": {
        "cycles": "--cycles",
        "emulate": "--emulate",
        "dry_run": "--dry-run",
        "seed": "--seed",
        "threads": "--threads",
        "output": "--output",
        "save": "--save",
    },
    "check": {"emulate": "--emulate", "seed": "--seed"},
    "first-motion": {
        "emulate": "--emulate",
        "seed": "--seed",
        "compare_friction": "--unknown-friction",
        "largest_torque": "--largest-torque",
        "watchdog": "--watchdog",
    },
    "emulate": {
        "json": "--json",
        "rest": "--rest",
        "interface": "--interface",
        "channel": "--channel",
        "duration": "--duration",
        "seed": "--seed",
    },
    "report": {"output": "--output", "joints": "--joints"},
    "export": {
        "path": "--to",
        "joints": "--joints",
        "target": "--target",
        "into": "--into",
        "joint_name": "--joint-name",
        "approximate": "--approximate",
        "speed": "--speed",
    },
    "explain": {},
    "info": {**_READING, **_ROBOT},
}
"""Options by command and argument."""

PLACEHOLDERS: Mapping[str, str] = {
    "--column": "HEADER",
    "--unit": "UNIT",
    "--scale": "FACTOR",
    "--where": "VALUE",
    "--extra": "HEADER",
    "--side": "SIDE",
    **{o.flag: o.metavar.partition("=")[2] for o in DECLARED.values() if o.metavar},
    "--gain": "VALUE",
    "--sensor": "VALUE",
    "--grid": "VALUE",
    "--prior": "LOW,HIGH",
}
"""Options of the form NAME=VALUE, with a placeholder for a value that the user has to choose."""

FILES: Mapping[str, str] = {
    **dict.fromkeys(("--joint", "--believe", "--simulate"), "JOINT"),
    "--after": "ESTIMATE",
    "--robot": "URDF",
    **dict.fromkeys(
        (
            *("--output", "--save", "--report", "--table", "--plot", "--checkpoint", "--resume"),
            *("--to", "--into"),
        ),
        "FILE",
    ),
}
"""Options that take a file, with a placeholder for a file that the user has to choose."""

NUMBERS: Mapping[str, str] = {
    "--gear-ratio": "RATIO",
    "--rate": "HZ",
    "--unpacked": "BYTES",
}
"""Options that take a number, with a placeholder for a number that the user has to choose."""

FLAGS = frozenset(
    {
        *(
            "--drop-copies",
            "--drop-invalid",
            "--resume",
            "--tracking",
            "--standard-errors",
            "--emulate",
            "--dry-run",
        ),
        *("--selftest", "--causes", "--rollout", "--unknown-friction", "--json", "--watchdog"),
        "--approximate",
    }
)
"""Options that may occur without a value."""

# The core and the simulation name a field with its class.
_CLASSES = {
    "GaOptions": "ga",
    "Sensors": "sensors",
    "Trajectory": "trajectory",
    **dict.fromkeys(
        (
            "AdaptiveRobust",
            "CompensatedPid",
            "LugreObserver",
            "Pid",
            "Pd",
            "OpenLoop",
            "controller",
        ),
        "gain",
    ),
}


def option_of(command: str, argument: str) -> tuple[str, str]:
    """Return the option for an argument, and its key; both are empty if the command has no such option.

    Parameters
    ----------
    command : str
    argument : str
        ``"method"``, ``"columns.velocity"``, ``"GaOptions.population"``.

    Examples
    --------
    >>> option_of("info", "columns.velocity")
    ('--column', 'velocity')
    """
    table = OPTIONS.get(command, {})
    if argument in table:
        return table[argument], ""
    root, _, key = argument.replace("['", ".").replace("']", "").partition(".")
    if root in ("search", "Search", "Scenario") and key:
        return option_of(command, key)
    root = _CLASSES.get(root, root)
    for name in (f"{root}.{key}" if key else root, f"ga.{root}"):
        if name in table:
            return table[name], ""
    return (table[root], key) if root in table else ("", "")


def declared_arguments(command: argparse.ArgumentParser) -> None:
    """Add the declared options."""
    for name, option in DECLARED.items():
        command.add_argument(
            option.flag,
            dest=name,
            metavar=option.metavar,
            help=option.phrase,
            **_FORMS[option.form],
        )


def stated_options(arguments: argparse.Namespace) -> dict[str, Any]:
    """Return the options of a command line, except own terms, which `with_terms` adds to the model.

    Raises
    ------
    InputError
        A value is not a number, or a name is given twice.
    """
    typed = {name: getattr(arguments, name) for name in DECLARED if name != "terms"}
    return {
        name: numbers_by_name(name, value) if DECLARED[name].form == "numbers by name" else value
        for name, value in typed.items()
        if value is not None
    }
