"""What a user of the page has stated, obeyed advice included, gives what the same call in Python gives."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from example_recordings import WELL_EXCITED as LOG

import jointid as jid
from jointid.app.call import Call, kept
from jointid.base.advice import Action


def test_advice_is_merged_as_an_action_says() -> None:
    call = Call(file=LOG, load={"units": {"time": "ms"}, "gear_ratio": 2.0})
    again = call.obey(Action("call", {"units": {"position": "deg"}}, function="load"))
    assert again is not None
    assert again.load == {"units": {"time": "ms", "position": "deg"}, "gear_ratio": 2.0}
    model = again.obey(Action("call", {"model": "stribeck"}))
    assert model is not None
    assert model.identify == {"model": "stribeck"}
    geared = model.obey(Action("call", {"gear_ratio": 50.0}, function="Joint"))
    assert geared is not None
    assert geared.joint == jid.Joint(gear_ratio=50.0)


@pytest.mark.parametrize(
    "action",
    [
        Action("inspect", text="the header"),
        Action("record", text="slow motion"),
        Action("call", {"scale": {"torque": ...}}, function="load"),
        Action("call", {"models": ["stribeck"]}, function="compare_models"),
    ],
)
def test_what_only_a_person_can_do_is_not_done(action: Action) -> None:
    assert Call(file=LOG).obey(action) is None


def test_stretches_are_left_out_and_the_program_does_the_same() -> None:
    call = Call(file=LOG, left_out=((2.0, 3.0), (11.0, 20.0)))
    pieces = call.recordings()
    whole = call.recording()
    spans = [(float(each.time[0]), float(each.time[-1])) for each in pieces]
    assert spans == [(0.0, 2.0), (3.0, 11.0)]
    program = call.script(whole).replace("'well_excited.csv.gz'", repr(str(LOG)))
    found: dict[str, Any] = {}
    exec(program.replace("print(estimate.report())", ""), found)
    assert [len(each) for each in found["pieces"]] == [len(each) for each in pieces]
    assert found["estimate"].parameters == jid.identify(pieces).parameters


def test_nothing_left_is_an_error() -> None:
    with pytest.raises(jid.InputError, match="no samples left"):
        Call(file=LOG, left_out=((-1.0, 100.0),)).recordings()


def test_stretches_that_overlap_are_one() -> None:
    assert kept(()) == [(None, None)]
    assert kept(((5.0, 6.0), (1.0, 3.0), (2.0, 4.0))) == [(None, 1.0), (4.0, 5.0), (6.0, None)]


def test_the_name_that_the_user_gave_is_the_recordings(tmp_path: Path) -> None:
    place = tmp_path / "recording.csv.gz"
    place.write_bytes(LOG.read_bytes())
    assert Call(file=place, name="drive 3.csv").recording().name == "drive 3.csv"
