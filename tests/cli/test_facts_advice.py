"""A correction of a robot's facts names the file and the line, and what it says to write is read as it was meant."""

import re
from math import radians
from pathlib import Path
from typing import Any

import pytest

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.cli.advice import words_of_action
from jointid.cli.facts_advice import words_of_facts
from jointid.robot.links.facts import read_facts

OTHERS = """joints = ["a", "b"]  # in order
gravity = [
  0, 0,
  -9.81,
]
zero_offsets_deg = [0, -90]

[couplings.b]
a = 1.0
"""


def done(words: str, path: Path) -> None:
    """Do what the words say, as a person would: lines are counted in the file as it is."""
    lines = path.read_text(encoding="utf-8").splitlines()
    first, gone = [], set()
    changed = {}
    file = re.escape(str(path))
    for act in re.split(r" and (?=change|delete|write)", words):
        numbers = re.search(rf"lines? (\d+)(?:-(\d+))? of {file}", act)
        text = re.search(r"(?:to|write) (\S+ = .*?)(?: as (?:the|its) first line.*)?$", act)
        if numbers:
            low, high = int(numbers[1]), int(numbers[2] or numbers[1])
            gone |= set(range(low, high + 1))
        if numbers and text:
            changed[low] = text[1]
        elif text:
            first.append(text[1])
    kept = [
        changed.get(k, line) for k, line in enumerate(lines, 1) if k not in gone or k in changed
    ]
    path.write_text("\n".join([*first, *kept, ""]), encoding="utf-8")


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ({"torque_scales": [1.0, -1.0]}, "write torque_scales = [1, -1] as the first line of "),
        ({"gravity": [0.1, 0.0, -9.8]}, "change lines 2-5 of "),
        ({"zero_offsets": [0.0, radians(-85.0)]}, "change line 6 of "),
        ({"couplings": {"a": {"b": -1.0}}}, "delete lines 8-9 of "),
        ({"directions": [1.0, -1.0], "torque_scales": [1.0, -1.0]}, " and write torque_scales"),
        ({"gravity": [0.0, 0.0, 9.8], "directions": [1.0, -1.0]}, " and write directions"),
    ],
)
def test_what_it_says_is_read_as_meant(
    tmp_path: Path, arguments: dict[str, Any], says: str
) -> None:
    path = tmp_path / "robot.toml"
    path.write_text(OTHERS, encoding="utf-8")
    before = read_facts(path)
    words = words_of_facts(Action("call", arguments, function="Robot.from_urdf"), str(path))
    assert says in words
    done(words, path)
    found = read_facts(path)
    for name, value in {**before, **arguments}.items():
        if isinstance(value, list) and not isinstance(value[0], str):
            assert found[name] == pytest.approx(value, abs=1e-4)
        else:
            assert found[name] == value


def test_without_a_file_it_names_one(tmp_path: Path) -> None:
    action = Action("call", {"directions": [1.0, -1.0]}, "if so", "Robot.from_urdf")
    words = words_of_facts(action, "")
    assert words == "write directions = [1, -1] in robot.toml, and add --facts robot.toml (if so)"


def test_a_delay_for_each_joint_has_no_option() -> None:
    shift = {"torque": {"elbow": 0.002}}
    assert words_of_action(Action("call", {"shift": shift}), "identify") == ""


def test_a_misspelt_fact_is_answered_with_the_fact(tmp_path: Path) -> None:
    path = tmp_path / "robot.toml"
    path.write_text("gear_ratio = [32, 45]\n")
    with pytest.raises(InputError, match=r"gear_ratio: .*; did you mean 'gear_ratios'"):
        read_facts(path)
