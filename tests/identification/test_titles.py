"""A finding's title fits one line and names no interface; what must be dealt with says what to do."""

from __future__ import annotations

import functools
import re
import sys
import tempfile
from pathlib import Path

import pytest

import jointid as jid
from jointid.cli.wording import ADVICE
from jointid.estimate.findings import TITLE, Finding
from jointid.identification.warnings.registry import finding_types
from jointid.identification.warnings.undetermined import listed

sys.path.insert(0, str(Path(__file__).parents[2] / "tools"))
from documentation.defective import GOOD, Case, cases, damaged

# Of these the titles are still to be written.
NOT_YET = frozenset(
    {"undivided_offset", "ripple", "gravity", "inertia_varies", "load_friction", "slow_motion"}
    | {
        "presliding",
        "smooth_friction",
        "stribeck_exponent",
        "drift",
        "harmonic",
        "delay",
        "other_signal",
    }
    | {"disturbance", "asymmetry", "offset", "standing", "hardly_moves", "late_samples"}
    | {"cross_check", "poor_fit", "structured_residual", "undetermined", "gaps"}
)
QUICK = ("delay_removed", "at_bound", "wrong_scale")
SYNTAX = re.compile(r"\w=\S|[{}`]|--\w|jid\.|jointid |\w\(|\bNone\b|\bTrue\b|\n")
ADVISED = 80  # characters of an act


@functools.cache
def _all_cases() -> dict[str, Case]:
    with tempfile.TemporaryDirectory() as folder:
        return cases(Path(folder))


@functools.cache
def _quick_cases() -> dict[str, Case]:
    return damaged(jid.load(GOOD))


def _case(code: str) -> Case:
    return _quick_cases()[code] if code in QUICK else _all_cases()[code]


def _codes() -> list[object]:
    slow = [code for code in finding_types() if code not in (*QUICK, *NOT_YET)]
    return [*QUICK, *(pytest.param(code, marks=pytest.mark.slow) for code in slow)]


def faults(found: Finding) -> list[str]:
    """What is wrong with the words of a finding."""
    wrong = []
    if len(found.title) > TITLE:
        wrong.append(f"{len(found.title)} characters")
    if SYNTAX.search(found.title):
        wrong.append("syntax")
    if found.title.endswith((".", ";", ":")) or found.title != found.title.strip():
        wrong.append("stops")
    acts = [each.text for each in found.advice if each.kind == "inspect"]
    wrong += [f"a long act: {text}" for text in acts if len(text) > ADVISED]
    return wrong


@pytest.mark.parametrize("code", _codes())
def test_a_title_is_one_line_and_says_what_to_do(code: str) -> None:
    estimate = _case(code).estimate()
    raised = [each for each in estimate.findings if each.code == code]
    assert raised
    for found in estimate.findings:
        if found.code not in NOT_YET:
            assert faults(found) == [], found.title
    for found in raised:
        # After a blocking finding, other fits are no advice to those that are not.
        if found.severity != "info":
            assert found.advice
            assert ADVICE.of_command(found.advice[0])


@pytest.mark.parametrize("room", [100, 90, 70, 40])
def test_as_many_names_are_listed_as_fit(room: int) -> None:
    sizes = [f"viscous_negative[{k}] by 12 %" for k in range(6)]
    text = listed(sizes, room)
    shown = text.count("by")
    assert len(text) <= room
    assert text.endswith(f" and {6 - shown} others")
    assert shown == 3 or len(listed(sizes[: shown + 1])) > room - len(" and 9 others")
    assert listed(sizes[:1]) == sizes[0]


def test_a_title_with_syntax_or_two_lines_is_found() -> None:
    for title in ("use --unit torque=Nm", "call load(units)", "one\ntwo", "x" * 91, "a stop."):
        assert faults(Finding(code="spikes", title=title)), title
    assert faults(Finding(code="spikes", title="velocity lags by 4.4 ms (1.1 samples)")) == []
