"""Errors of loading are values: argument, value, place and reason, and a remedy that can be followed."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from recording_files import GOOD, headed, with_line, written

from jointid.base.advice import Action
from jointid.base.errors import NOT_GIVEN, InputError
from jointid.recording.readers.loading import load, load_runs
from jointid.recording.recording import Recording


def error_of(path: Path, arguments: Mapping[str, Any]) -> InputError:
    with pytest.raises(InputError) as caught:
        load(path, **arguments)
    return caught.value


@pytest.mark.parametrize(
    ("text", "arguments", "argument", "value", "place"),
    [
        (GOOD, {"columns": {"sensor": "enc"}}, "columns.sensor", "enc", ", line 1"),
        (GOOD, {"columns": {"sensor": 9}}, "columns.sensor", 9, ", line 1"),
        (GOOD, {"columns": {"sensor": 1.5}}, "columns.sensor", 1.5, None),
        (GOOD, {"columns": {"torqe": 1}}, "columns", NOT_GIVEN, None),
        (GOOD, {"columns": {"sensor": 1, "current": 1}}, "columns.current", 1, ", line 1"),
        (GOOD, {"units": {"position": "ell"}}, "units.position", "ell", ""),
        (GOOD, {"units": {"sensor": "raw"}}, "units.sensor", NOT_GIVEN, ", line 1"),
        (GOOD, {"scale": {"position": 0}}, "scale.position", 0, ""),
        (GOOD, {"scale": {"position": 2}, "units": {"position": "deg"}}, "scale.position", 2, ""),
        (GOOD, {"where": {"torque_Nm": 7}}, "where.torque_Nm", 7, ""),
        (GOOD, {"where": {"torque_Nm": [7]}}, "where.torque_Nm", [7], ""),
        (GOOD, {"where": {"run": 7}}, "where", "run", ", line 1"),
        (GOOD, {"kind": "linear"}, "kind", "linear", None),
        (GOOD, {"torque_hold": "foh"}, "torque_hold", "foh", None),
        (with_line(4, "0.02,nan,1,2"), {}, "position", np.nan, ", line 4, column 'position_rad'"),
        (with_line(6, "0.03,1,1,2"), {}, "time", 0.03, ", line 6, column 'time_s'"),
        (with_line(5, "0,x,1,2"), {}, "", NOT_GIVEN, ", line 5, column 'position_rad'"),
        (GOOD[:6], {}, "time", NOT_GIVEN, ""),
        (headed("t,q_Nm,v,x"), {}, "", NOT_GIVEN, ", line 1, column 'q_Nm'"),
    ],
)
def test_parts(
    text: Any,
    arguments: Mapping[str, Any],
    argument: str,
    value: object,
    place: str | None,
    tmp_path: Path,
) -> None:
    path = written(tmp_path / "a.csv", text)
    error = error_of(path, arguments)
    assert error.argument == argument
    assert error.value == value or (error.value != error.value and value != value)  # nan
    assert error.place == ("" if place is None else f"{path}{place}")


@pytest.mark.parametrize(
    "header",
    [
        "t,q_rad,q_deg,x",
        "t,q,angle,x",
        "t,q_rad,q_mm,x",
        "t,axis_angle,v,x",
        "t,q [furlong],v,x",
        "t,q_counts,v,x",
        "t,q,tau_V,x",
    ],
)
def test_every_call_that_is_advised_loads_the_file(header: str, tmp_path: Path) -> None:
    path = written(tmp_path / "a.csv", headed(header))
    calls = [each for each in error_of(path, {}).remedy if isinstance(each, Action)]
    assert calls
    for call in calls:
        assert (call.kind, call.function) == ("call", "load")
        known = {"scale": dict.fromkeys(call.arguments.get("scale", ()), 0.1)}  # what is asked for
        assert len(load(path, **{**call.arguments, **known})) == 10, call


def test_a_run_is_part_of_the_place(tmp_path: Path) -> None:
    rows = [f"{k // 9},{k % 9 * 0.1},{float(k)}" for k in range(20)]
    path = written(tmp_path / "a.csv", ["run,t_s,q_rad", *rows])
    with pytest.raises(InputError) as caught:
        load_runs(path, by="run")
    assert (caught.value.place, caught.value.argument) == (f"{path} (run=2)", "time")


def test_bad_metadata_in_a_file_names_the_file(tmp_path: Path) -> None:
    path = written(tmp_path / "a.csv", ['# jointid recording {"schema": 1, "name": 3}', *GOOD])
    error = error_of(path, {})
    assert (error.place, error.value) == (f"{path}, line 1: name", 3)


@pytest.mark.parametrize(
    ("call", "argument", "value"),
    [
        (lambda run: run.crop("now"), "start", "now"),
        (lambda run: run.crop(stop=0.01), "stop", NOT_GIVEN),
        (lambda run: run.split(), "parts", None),
        (lambda run: run.split(2, at=[0.05]), "at", [0.05]),
        (lambda run: run.split(9), "parts", 9),
        (lambda run: run.split(at=[0.05, 0.01]), "at[1]", 0.01),
        (lambda run: run.resample(), "period", None),
        (lambda run: run.resample(rate=-1), "rate", -1),
        (lambda run: run.resample(rate=1), "rate", NOT_GIVEN),
        (lambda run: run.unit("torqe"), "signal", NOT_GIVEN),
        (lambda _: Recording(time=range(9), position=range(8)), "position", NOT_GIVEN),
        (lambda _: Recording(time=range(9), position=["x"] * 9), "position", NOT_GIVEN),
        (lambda _: Recording(time=range(9), position=range(9), name=5), "name", 5),  # type: ignore[arg-type]
        (
            lambda _: Recording(time=range(9), position=range(9), metadata={"a": {1, 2}}),
            *("metadata.a", NOT_GIVEN),
        ),
        (lambda _: Recording.from_dataframe([1]), "df", [1]),
    ],
)
def test_parts_of_a_recordings_errors(call: Any, argument: str, value: object) -> None:
    time = 0.01 * np.arange(20)
    with pytest.raises(InputError) as caught:
        call(Recording(time=time, position=time))
    assert (caught.value.argument, caught.value.value) == (argument, value)
