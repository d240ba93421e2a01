"""Sentences that speak Python, for people at the command line: options instead of arguments."""

from __future__ import annotations

import re
from collections.abc import Callable

_OPTIONS = {
    "columns": "--column",
    "units": "--unit",
    "scale": "--scale",
    "where": "--where",
    "output": "--output",
    "model": "--model",
    "residual": "--residual",
    "method": "--method",
    "torque_hold": "--torque-hold",
}
_PAIR = re.compile(r"""['"](\w+)['"]: ['"]?([^'"},]+)['"]?""")


def _pairs(match: re.Match[str]) -> str:
    """`columns={'position': 'enc1'}` as `--column position=enc1`."""
    option = _OPTIONS[match[1]]
    places = {"--column": "HEADER", "--scale": "FACTOR", "--unit": "UNIT"}
    told = [
        f"{option} {name}={places.get(option, 'VALUE') if value == '...' else value}"
        for name, value in _PAIR.findall(match[2])
    ]
    return " ".join(told).replace("=None", "=none")


_RULES: tuple[tuple[str, str | Callable[[re.Match[str]], str]], ...] = (
    (r"\b(columns|units|scale|where)=\{([^{}]*)\}", _pairs),
    (r"columns\['(\w+)'\] is '?([^',]*)'?", r"--column \1=\2"),
    (r"(?:units|scale)\['(\w+)'\]", r"\1"),
    (r", or take load_runs", ""),
    (
        r"with parameters=\{'(\w+)': \{'vary': True\}\}",
        r"by vary = true under [parameters.\1] in the joint file",
    ),
    (r"parameters=\{'(\w+)': value\}", r"--set \1=VALUE"),
    (
        r"give it with joint\.with_parameters\(\{'(\w+)': \.\.\.\}\)",
        r"give it as value under [parameters.\1] in the joint file",
    ),
    (r"use asymmetric=False", "leave out :asymmetric"),
    (r"asymmetric=False", "no :asymmetric"),
    (r"add ripple=\((\d+),\) to the model", r"add :ripple=\1 to the name given to --model"),
    (r"\bcolumns gives", "--column gives"),
    (r"\b(units|scale) names", lambda match: f"{_OPTIONS[match[1]]} names"),
    (r"tracking=True", "--tracking"),
    (r"\bresume=True", "--resume"),
    (r"sweep\(output=\.\.\.\)", "sweep --output"),
    (r"\boutput (\S+: a study grows)", r"--output \1"),
    (r"Study\.save writes", "--table writes"),
    (r"GaOptions or (one of)", r"\1"),
    (r"; use jointid\.GaOptions\(population=\.\.\.\)", ""),
    (r"(?:ga: )?GaOptions\.", ""),
    (r"a jointid\.Scenario", "--simulate JOINT"),
    (
        r"(\w+)\(\) missing \d+ required (?:positional|keyword-only) (?:argument|option)s?: (.*)",
        lambda match: f"{match[1]} needs {match[2]}".replace("'", ""),
    ),
    (r"(\w+)\(\) got an unexpected (?:option|keyword argument)", r"\1 has no option"),
    (r"\b(model|residual|method)='(\w+)'", lambda match: f"{_OPTIONS[match[1]]} {match[2]}"),
    (r"\b(columns|units|scale|where|output|torque_hold)=(?=[\s,;.)]|$)", lambda m: _OPTIONS[m[1]]),
)
_COMPILED = tuple((re.compile(pattern), told) for pattern, told in _RULES)


def spoken(sentence: str) -> str:
    """A sentence with the command line's options for Python's arguments."""
    for pattern, told in _COMPILED:
        sentence = pattern.sub(told, sentence)
    return sentence
