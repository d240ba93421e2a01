"""Bad input found by the core is an InputError with its parts; a bug in the core is not."""

import math
from typing import Any

import numpy as np
import pytest

import jointid as jid
from jointid import _core

MISSPELT: dict[str, Any] = {"stifness": 1.0}
WRONG: list[Any] = [2.5, "no"]
BAD: list[tuple[Any, str, Any, str]] = [
    (lambda: jid.GaOptions(population=1), "GaOptions.population", 1, "must be 4 to 1000000"),
    (lambda: jid.GaOptions(population=10**12), "GaOptions.population", 10**12, "4 to 1000000"),
    (lambda: jid.GaOptions(islands=-(10**30)), "GaOptions.islands", -(10**30), "must be 1 to"),
    (
        lambda: jid.GaOptions(migration_interval=2**40),
        "GaOptions.migration_interval",
        2**40,
        "must be at most 2147483647",
    ),
    (lambda: jid.GaOptions(elite=WRONG[0]), "GaOptions.elite", 2.5, "a whole number is expected"),
    (lambda: jid.GaOptions(polish=WRONG[1]), "GaOptions.polish", "no", "True or False is expected"),
    (lambda: jid.GaOptions(tolerance=True), "GaOptions.tolerance", True, "a number is expected"),
    (
        lambda: jid.GaOptions(selection="best"),
        "GaOptions.selection",
        "best",
        "choose one of tournament, roulette",
    ),
    (lambda: jid.Sensors(torque_noise=-1.0), "Sensors.torque_noise", -1.0, "must be finite and"),
    (
        lambda: jid.Pd(**MISSPELT),
        "Pd.stifness",
        None,
        "no such field; fields are stiffness",
    ),
    (lambda: _core.WindowOptions(count=-1), "windows.count", -1, "must be positive"),
    (lambda: _core.term("colomb"), "term", "colomb", "choose one of inertia, coulomb"),
    (
        lambda: _core.GaState.from_bytes(b"x"),
        "checkpoint of a genetic search",
        None,
        "not a checkpoint",
    ),
    (
        lambda: jid.Trajectory.sigmoid(1.0, rise=-1.0, duration=1.0),
        "Trajectory.rise",
        -1.0,
        "must be finite and above 0",
    ),
]


@pytest.mark.parametrize(("call", "argument", "value", "reason"), BAD, ids=[b[1] for b in BAD])
def test_bad_input_has_its_parts(call: Any, argument: str, value: Any, reason: str) -> None:
    with pytest.raises(jid.InputError) as caught:
        call()
    error = caught.value
    assert error.argument == argument
    assert reason in error.reason
    if value is None:
        assert repr(error.value) == "NOT_GIVEN"
    else:
        assert error.value == value
        assert type(error.value) is type(value)


def test_not_a_number_stays_one() -> None:
    with pytest.raises(jid.InputError) as caught:
        jid.Sensors(torque_noise=math.nan)
    assert repr(caught.value.value) == "nan"


def test_a_bug_of_a_caller_is_not_bad_input() -> None:
    """What our own code computes wrongly must end in a traceback, not in advice to the user."""
    signal = np.linspace(0.0, 1.0, 20)
    hold = _core.Hold.linear
    bugs = (
        lambda: _core.shape("width"),
        lambda: _core.friction_basis("inertia", signal, np.array([])),
        lambda: _core.friction_basis("static", signal, np.array([])),
        lambda: _core.Recording(
            time=signal,
            position=signal,
            velocity=signal[:-1],
            torque=signal,
            sensor=None,
            torque_hold=hold,
            gap_after=[],
        ),
    )
    for bug in bugs:
        with pytest.raises(ValueError, match=r"\S") as caught:
            bug()
        assert not isinstance(caught.value, jid.InputError)
    with pytest.raises(TypeError):
        _core.term(3)  # type: ignore[arg-type]
