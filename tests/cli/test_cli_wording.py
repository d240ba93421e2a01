"""Errors and findings in the words of the command line: its options, not Python's arguments."""

from functools import partial
from pathlib import Path

import numpy as np
import pytest
from example_recordings import WELL_EXCITED

import jointid as jid
from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.cli.command_line import main
from jointid.cli.values import in_sentence
from jointid.cli.wording import Wording

WELL = str(WELL_EXCITED)


def test_a_column_may_be_left_out(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["info", WELL, "--column", "velocity=none"]) == 0
    assert "velocity derived from the position" in capsys.readouterr().out


CALL = partial(Action, "call")


@pytest.mark.parametrize(
    ("command", "action", "text"),
    [
        (
            "identify",
            CALL({"units": {"position": "deg", "velocity": "deg/s"}}, function="load"),
            "load with --unit position=deg --unit velocity=deg/s",
        ),
        (
            "identify",
            CALL({"columns": {"velocity": None}}, function="load"),
            "load with --column velocity=none",
        ),
        ("info", CALL({"columns": {"torque": 3}}, function="load"), "load with --column torque=3"),
        ("info", CALL({"where": {"run": 1}}, function="load"), "load with --where run=1"),
        (
            "info",
            CALL({"scale": {"torque": ...}}, function="load"),
            "load with --scale torque=FACTOR",
        ),
        (
            "info",
            CALL({"columns": {"torque": "M mot"}}, function="load"),
            "load with --column torque='M mot'",
        ),
        ("identify", CALL({"parameters": {"coulomb": 3.0}}), "identify with --set coulomb=3"),
        (
            "identify",
            CALL({"parameters": {"coulomb": {"max": 50.0}}}),
            "set max = 50 under [parameters.coulomb] in the joint file",
        ),
        (
            "identify",
            CALL({"parameters": {"inertia": {"vary": True}}}),
            "set vary = true under [parameters.inertia] in the joint file",
        ),
        (
            "identify",
            CALL({"model": "stribeck:ripple=2"}),
            "identify with --model stribeck:ripple=2",
        ),
        ("identify", CALL({"ripple": (2, 4)}), "identify with --model NAME:ripple=2,4"),
        (
            "identify",
            CALL({"model": {"asymmetric": True}}),
            "identify with --model NAME:asymmetric",
        ),
        ("identify", CALL({"residual": "torque"}), "identify with --residual torque"),
        ("identify", CALL({"windows": 0.05}), "identify with --windows 0.05s"),
        ("identify", CALL({"windows": 200}), "identify with --windows 200"),
        (
            "identify",
            CALL({"search": {"method": "separable", "seed": 2, "threads": 1}}),
            "identify with --method separable --seed 2 --threads 1",
        ),
        (
            "identify",
            CALL({"search": {"ga": {"population": 100}}}),
            "identify with --population 100",
        ),
        (
            "identify",
            CALL({"ga": jid.GaOptions(generations=99)}),
            "identify with --generations 99",
        ),
        (
            "identify",
            CALL({"torque_offset": False}, function="Joint"),
            "set torque_offset = false under [model] in the joint file",
        ),
        (
            "simulate",
            CALL(
                {"model": "stribeck:load_friction=false:ripple=none:gravity=none"}, function="Joint"
            ),
            'set friction = "stribeck" and load_friction = false and ripple = [] and gravity = "none" under [model] '
            "in the joint file",
        ),
        (
            "identify",
            CALL({"gear_ratio": 101.0, "friction": "stribeck"}, function="Joint"),
            'set gear_ratio = 101 under [drive] and set friction = "stribeck" under [model] in the joint file',
        ),
        (
            "run",
            CALL({"model": "stribeck:ripple=2"}),
            'set friction = "stribeck" and ripple = [2] under [model] in the joint file',
        ),
        (
            "run",
            CALL({"parameters": {"coulomb": 3.0}}),
            "set value = 3 under [parameters.coulomb] in the joint file",
        ),
        (
            "run",
            CALL({"columns": {"velocity": None}}, function="load"),
            "load with --column velocity=none",
        ),
        ("identify", CALL({"model": "stribeck"}, text="it fits better"), "(it fits better)"),
        ("sweep", CALL({"resume": True}, function="sweep"), "sweep with --resume"),
        ("sweep", CALL({"output": ...}, function="sweep"), "sweep with --output FILE"),
        ("sweep", CALL({"subject": ...}, function="sweep"), "sweep with --simulate JOINT"),
        (
            "compare",
            CALL({"models": ("stribeck", "stribeck:ripple=2")}, function="compare_models"),
            "compare with --model stribeck --model stribeck:ripple=2",
        ),
        (
            "simulate",
            CALL({"parameters": {"coulomb": ...}}, function="simulate"),
            "set value = VALUE under [parameters.coulomb] in the joint file",
        ),
        ("identify", Action("record", text="slower motion"), "record slower motion"),
        ("identify", Action("inspect", text="the encoder"), "inspect the encoder"),
        ("simulate", CALL({"columns": {"velocity": None}}, function="load"), ""),
        ("identify", CALL({"x": 1}, function="load_runs"), ""),
    ],
)
def test_actions(command: str, action: Action, text: str) -> None:
    advice = Wording(command).of_action(action)
    assert advice == text or (text.startswith("(") and advice.endswith(text))


def test_advice_extends_the_model_of_the_command_line() -> None:
    wording = Wording("identify", model="stribeck:asymmetric")
    more, less = CALL({"ripple": (2,)}), CALL({"model": {"asymmetric": False}})
    error = InputError("it does not fit", remedy=(more, CALL({"x": 1}, function="y"), less))
    assert wording.of_error(error) == (
        "it does not fit; identify with --model stribeck:asymmetric:ripple=2; "
        "or identify with --model stribeck"
    )


@pytest.mark.parametrize(
    ("command", "error", "text"),
    [
        (
            "identify",
            InputError("choose one of ga, separable", argument="method", value="genetic"),
            "--method genetic: choose one of ga, separable",
        ),
        (
            "info",
            InputError("no such header", argument="columns.torque", value="foo", place="a.csv"),
            "a.csv: --column torque=foo: no such header",
        ),
        (
            "info",
            InputError("x", argument="columns['torque']", value="a b"),
            "--column torque='a b': x",
        ),
        (
            "info",
            InputError("no such row", argument="where", value={"run": 3}),
            "--where run=3: no s",
        ),
        (
            "info",
            InputError("no such row", argument="where", value={"a": 3, "b": 4}),
            "--where: no s",
        ),
        (
            "identify",
            InputError("x", argument="GaOptions.population", value=1),
            "--population 1: x",
        ),
        ("identify", InputError("x", argument="windows", value=0.05), "--windows 0.05s: x"),
        ("sweep", InputError("x", argument="ga.population", value=1), "--grid ga.population=1: x"),
        ("sweep", InputError("x", argument="resume", value=True), "--resume: x"),
        ("sweep", InputError("x", argument="stderr", value=None), "--standard-errors none: x"),
        (
            "simulate",
            InputError("x", argument="Sensors.torque_noise", value=-1.0),
            "--sensor torque_noise=-1: x",
        ),
        ("simulate", InputError("x", argument="Pid.damping", value=-1.0), "--gain damping=-1: x"),
        (
            "simulate",
            InputError("more than 0 is expected", argument="trajectory.cycle", value=0.0),
            "--trajectory: cycle is 0: more than 0 is expected",
        ),
        (
            "compare",
            InputError("not known", argument="model", value="magic"),
            "--model magic: not known",
        ),
        (
            "identify",
            InputError(
                "a number is expected", argument="gear_ratio", value=None, place="joint.toml"
            ),
            "joint.toml: gear_ratio is none: a number is expected",
        ),
        (
            "identify",
            InputError("x", argument="model", value=(1, True), place="joint.toml"),
            "joint.toml: model is 1, true: x",
        ),
        (
            "info",
            InputError("x", argument="recording", value=jid.Joint()),
            "recording is a joint: x",
        ),
        ("info", InputError("x\n y"), "x y"),
        ("info", InputError("x", remedy=("give y", "give z")), "x; give y or give z"),
    ],
)
def test_errors(command: str, error: InputError, text: str) -> None:
    grid = frozenset({"ga.population"}) if command == "sweep" else frozenset()
    assert Wording(command, grid=grid).of_error(error).startswith(text)


@pytest.mark.parametrize(
    ("error", "text"),
    [
        (InputError("x", argument="ripple", value=[-1]), "--model stribeck:ripple=-1, ripple: x"),
        (InputError("x", argument="model.ripple"), "--model stribeck:ripple=-1, ripple: x"),
        (InputError("x", argument="name", value="stribeck"), "--model stribeck:ripple=-1: x"),
        (InputError("x", argument="harmonics", value=[1]), "harmonics is 1: x"),
        (InputError("x", argument="ripple", place="a.toml"), "a.toml: ripple: x"),
    ],
)
def test_an_error_in_the_model_shows_it_as_it_was_typed(error: InputError, text: str) -> None:
    assert Wording("identify", model="stribeck:ripple=-1").of_error(error) == text


@pytest.mark.parametrize(
    ("wording", "arguments", "text"),
    [
        (
            Wording("identify"),
            {"limits": {"position": ..., "velocity": 1.1}, "duration": 6.0, "joint": ...},
            "jointid design JOINT --after ESTIMATE --position=LOW,HIGH --velocity=1.1 --duration 6",
        ),
        (
            Wording("identify", joint_file="my joint.toml", saved="first.json"),
            {"limits": {"position": [-0.35, 0.3], "torque": 77.0}, "duration": 12.0},
            "jointid design 'my joint.toml' --after first.json --position=-0.35,0.3 --torque=77 --duration 12",
        ),
        (
            Wording("report"),
            {"limits": {"velocity": "...", "sensor_range": 9.5, "acceleration": ...}},
            "jointid design JOINT --after ESTIMATE --velocity=SPEED --sensor-range=9.5 --acceleration=ACCELERATION",
        ),
    ],
)
def test_other_motion_names_the_command_that_designs_it(
    wording: Wording, arguments: dict[str, object], text: str
) -> None:
    action = Action("record", arguments, "slow motion", "next_motion")
    expected = f"record slow motion, designed by {text} --output motion.toml"
    assert wording.of_action(action) == expected


@pytest.mark.parametrize(
    ("command", "error", "text"),
    [
        ("identify", InputError("x", argument="viscos", place="parameters"), "--set viscos: x"),
        (
            "identify",
            InputError("x", argument="value", value=3.0, place="parameter 'coulomb'"),
            "--set coulomb=3: x",
        ),
        (
            "identify",
            InputError("x", argument="min", value=3.0, place="parameter 'coulomb'"),
            "parameter 'coulomb': min is 3: x",
        ),
        ("identify", InputError("x", argument="search.seed", value=-1), "--seed -1: x"),
        (
            "run",
            InputError("x", argument="value", place="parameter 'a'"),
            "parameter 'a': value: x",
        ),
    ],
)
def test_a_place_that_has_an_option(command: str, error: InputError, text: str) -> None:
    assert Wording(command).of_error(error) == text


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (None, "none"),
        (True, "true"),
        (3.0, "3"),
        (0.05, "0.05"),
        (np.float64(2.5), "2.5"),
        (float("nan"), "nan"),
        ((2, 4.0), "2, 4"),
        ([], ""),
        ({"velocity": None}, "velocity=none"),
        (Path("a/b"), "a/b"),
        ("two\nlines", "two lines"),
        (jid.Joint(), "a joint"),
        ("x" * 100, "x" * 59 + "…"),
    ],
)
def test_values(value: object, text: str) -> None:
    assert in_sentence(value) == text


def test_a_page_from_the_command_line_advises_options(tmp_path: Path) -> None:
    """Who made the page with the command line follows its advice there."""
    target = tmp_path / "report.html"
    assert main(["identify", WELL, "--report", str(target), "--quiet"]) == 0
    page = target.read_text(encoding="utf-8")
    command = f"jointid identify {WELL} --report {target} --quiet --torque-hold zoh"
    assert command in page
    assert "with torque_hold=" not in page
