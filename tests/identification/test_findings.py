"""Findings are values: evidence for every number, advice that can be obeyed, one file and one line to add one."""

import math
import pickle
import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from defects import DEFECTS, changed, late_velocity
from documentation.findings_tables import findings_tables, in_place_of_the_table
from example_recordings import WELL_EXCITED
from simulated_joint import TRUTH

import jointid as jid
from jointid.base.advice import Action
from jointid.cli.demonstration import data_folder
from jointid.estimate.findings import Finding
from jointid.identification import warnings
from jointid.identification.warnings import registry
from jointid.report.saving import report_page

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "python" / "jointid" / "identification" / "warnings"
NUMBER = re.compile(r"(?<![\w.])[−-]?\d+(?:\.\d+)?(?:e[+-]?\d+)?(?![\w])")
FACTORS = (1.0, 1e2, 1e3, 1e6)  # of a share in per cent, of seconds in ms and µs


@pytest.fixture(scope="module")
def well_excited() -> jid.Recording:
    return jid.load(WELL_EXCITED)


def separable(
    recording: jid.Recording, joint: jid.Joint | None = None, **arguments: Any
) -> jid.Estimate:
    options = {"model": "stribeck", "search": "separable"} | arguments
    return jid.identify(recording, joint or jid.thesis_joint(), **options)


def found_in(estimate: jid.Estimate, code: str) -> Finding:
    (found,) = (each for each in estimate.findings if each.code == code)
    return found


def supported(text: str, found: Finding) -> bool:
    """Whether a number of the sentence is one of the evidence, rounded."""
    number = abs(float(text.replace("−", "-")))
    shown = text if "." in text else text.rstrip("0")  # 2300 may be a rounded 2341
    digits = len(shown.lstrip("-−0.").replace(".", "").split("e")[0]) or 1
    tolerance = 0.6 * 10.0 ** (1 - digits)
    values = (abs(measured.value) for measured in found.evidence.values())
    return any(
        abs(factor * value - number) <= tolerance * max(number, 1e-12)
        for value in values
        for factor in FACTORS
    )


@pytest.mark.parametrize("defect", DEFECTS)
def test_every_number_of_a_sentence_is_evidence(well_excited: jid.Recording, defect: str) -> None:
    make, code = DEFECTS[defect]
    for found in separable(make(well_excited)).findings:
        for text in NUMBER.findall(found.cause):
            assert supported(text, found), (text, found)
    assert not supported("12345", found_in(separable(make(well_excited)), code))


def test_every_number_of_other_sentences_is_evidence(well_excited: jid.Recording) -> None:
    robot = jid.load(data_folder() / "kr300_joint1.csv.gz")
    of_robot = jid.Joint.load(data_folder() / "kr300_joint1.toml")
    estimates = [separable(make(well_excited), **given) for make, given in CALLS.values()]
    estimates += [separable(robot, of_robot), separable(robot, of_robot, windows=12)]
    codes = set()
    for found in (found for estimate in estimates for found in estimate.findings):
        codes.add(found.code)
        for text in NUMBER.findall(found.cause):
            assert supported(text, found), (text, found)
    assert codes >= {"undetermined", "at_bound", "model_too_rich", "few_windows", "ripple"}


@pytest.mark.parametrize("defect", DEFECTS)
def test_no_face_shows_in_a_cause(well_excited: jid.Recording, defect: str) -> None:
    make, _ = DEFECTS[defect]
    for found in separable(make(well_excited)).findings:
        texts = (found.cause, *(action.text for action in found.advice))
        for text in texts:
            assert re.search(r"\w=\S|[{}]|--\w|jid\.|\w\((?!s\))", text) is None, text


# --- Advice of kind "call" is obeyed, and the finding is gone. ---


def constant_speed(r: jid.Recording) -> jid.Recording:
    """A few windows of the recording."""
    return r.crop(0.0, 1.2)


def motor_side(r: jid.Recording) -> jid.Recording:
    """The torque on the motor's side, with the wrong sign."""
    assert r.torque is not None
    return changed(r, torque=None, motor_torque=-r.torque / 101.0)


def rippled(r: jid.Recording) -> jid.Recording:
    assert r.sensor is not None
    return changed(r, sensor=r.sensor + 0.4 * np.sin(202.0 * r.position + 1.0))


def reversed_sensor(r: jid.Recording) -> jid.Recording:
    assert r.sensor is not None
    return changed(r, sensor=-r.sensor)


def same(r: jid.Recording) -> jid.Recording:
    return r


CALLS: Mapping[str, tuple[Callable[[jid.Recording], jid.Recording], Mapping[str, Any]]] = {
    "signal_lag": (late_velocity, {"shift": {}}),
    "velocity_mismatch": (lambda r: changed(r, velocity=0.5 * r.velocity), {}),
    "reversed_sign": (reversed_sensor, {}),
    "ripple": (rippled, {}),
    "few_windows": (same, {"windows": 30}),
    "at_bound": (same, {"parameters": {"viscous": {"min": 10.0, "max": 19.9}}}),
}


def obeyed(
    action: Action, recording: jid.Recording, arguments: Mapping[str, Any], folder: Path
) -> jid.Estimate:
    """What a program does with an action."""
    joint = jid.thesis_joint()
    changes = dict(action.arguments)
    if action.function == "load":
        path = folder / "recording.csv"
        recording.save(path)
        return separable(jid.load(path, **changes), joint, **arguments)
    if action.function == "Joint":
        return separable(recording, joint.replace(**changes), **arguments)
    for name, entry in dict(changes.get("parameters", {})).items():
        changes["parameters"] = {name: {**arguments.get("parameters", {}).get(name, {}), **entry}}
    return separable(recording, joint, **{**arguments, **changes})


@pytest.mark.parametrize("code", CALLS)
def test_a_call_can_be_obeyed(well_excited: jid.Recording, code: str, tmp_path: Path) -> None:
    make, arguments = CALLS[code]
    recording = make(well_excited)
    found = found_in(separable(recording, **arguments), code)
    calls = [action for action in found.advice if action.kind == "call"]
    assert calls, found
    for action in calls:
        after = obeyed(action, recording, arguments, tmp_path)
        assert code not in {each.code for each in after.findings}


def test_a_motor_side_torque_is_flipped_by_the_gear_ratio(
    well_excited: jid.Recording, tmp_path: Path
) -> None:
    recording = motor_side(well_excited)
    found = found_in(separable(recording), "reversed_sign")
    (action,) = (each for each in found.advice if each.kind == "call")
    assert (action.function, dict(action.arguments)) == ("Joint", {"gear_ratio": -101.0})
    assert "reversed_sign" not in {
        each.code for each in obeyed(action, recording, {}, tmp_path).findings
    }


def test_a_model_that_is_too_rich_is_made_simpler(tmp_path: Path) -> None:
    recording = jid.load(data_folder() / "kr300_joint1.csv.gz")
    joint = jid.Joint.load(data_folder() / "kr300_joint1.toml")
    found = found_in(separable(recording, joint, model="stribeck"), "model_too_rich")
    assert dict(found.advice[0].arguments) == {"model": "coulomb_viscous:gravity=none"}
    simpler = separable(recording, joint, **found.advice[0].arguments)
    assert "model_too_rich" not in {each.code for each in simpler.findings}


@pytest.mark.parametrize("gain", [1.0, {"value": 1.0}, {"value": 1.0, "max": 4.0}])
def test_a_reversed_sensor_is_flipped_as_it_is_read(
    well_excited: jid.Recording, gain: Any, tmp_path: Path
) -> None:
    recording = reversed_sensor(well_excited)
    given: dict[str, Any] = {"parameters": {"sensor_gain": gain}}
    found = found_in(separable(recording, **given), "reversed_sign")
    (action,) = (each for each in found.advice if each.kind == "call")
    after = obeyed(action, recording, given, tmp_path)
    assert after.parameters["sensor_gain"].value > 0.0
    assert "reversed_sign" not in {each.code for each in after.findings}


@pytest.mark.parametrize(("unit", "factor"), [("Nm", 1.0), ("mNm", 1e-3)])
@pytest.mark.parametrize("saved", [False, True])
def test_a_torque_is_flipped_in_the_unit_of_its_file(
    well_excited: jid.Recording, unit: str, factor: float, saved: bool, tmp_path: Path
) -> None:
    assert well_excited.torque is not None
    path = tmp_path / "log.csv"
    table = np.column_stack(
        [well_excited.time, well_excited.position, -well_excited.torque / factor]
    )
    header = f"time_s,position_rad,torque_{unit}"
    np.savetxt(path, table, delimiter=",", header=header, comments="")
    if saved:
        jid.load(path).save(path := tmp_path / "log.npz")
    (action,) = (
        each
        for each in found_in(jid.identify(jid.load(path)), "reversed_sign").advice
        if each.kind == "call"
    )
    again = jid.load(path, **action.arguments).torque
    assert again == pytest.approx(well_excited.torque, rel=1e-6)


def test_a_simpler_model_is_advised_without_what_it_lacks() -> None:
    robot = jid.load(data_folder() / "kr300_joint1.csv.gz")
    joint = jid.Joint.load(data_folder() / "kr300_joint1.toml")
    bounds = {"static": {"min": 0.0, "max": 900.0}}
    found = found_in(separable(robot, joint, model="stribeck", parameters=bounds), "model_too_rich")
    assert found.advice[0].text == "without the values and bounds of static"
    joint = joint.replace(parameters=bounds)
    found = found_in(separable(robot, joint, model="stribeck"), "model_too_rich")
    assert found.advice[0].text == ""


def test_ripple_that_the_model_has_is_not_added_again(well_excited: jid.Recording) -> None:
    fixed = {"ripple_cos_2": 0.0, "ripple_sin_2": 0.0}
    estimate = separable(rippled(well_excited), model=":ripple=2", parameters=fixed)
    (action,) = found_in(estimate, "ripple").advice
    assert action.kind == "inspect"
    assert "ripple_cos_2 and ripple_sin_2" in action.text


def test_advised_models_keep_what_the_call_set_back(well_excited: jid.Recording) -> None:
    joint = jid.thesis_joint()
    joint = joint.replace(model=joint.model.replace(asymmetric=True))
    given = {"model": ":asymmetric=false"}
    found = found_in(separable(rippled(well_excited), joint, **given), "ripple")
    after = separable(rippled(well_excited), joint, **found.advice[0].arguments)
    assert after.settings["model"] == "stribeck:ripple=2"


def test_assumed_units_are_stated(well_excited: jid.Recording, tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    columns = (well_excited.time, well_excited.position, well_excited.torque, well_excited.sensor)
    table = np.column_stack(columns)  # type: ignore[arg-type]
    np.savetxt(path, table, delimiter=",", header="time_s,position,torque,sensor", comments="")
    found = found_in(separable(jid.load(path)), "assumed_units")
    (action,) = (each for each in found.advice if each.kind == "call")
    assert set(action.arguments["units"]) >= {"position", "torque"}
    stated = separable(jid.load(path, **action.arguments))
    assert "assumed_units" not in {each.code for each in stated.findings}


def test_a_guessed_sign_is_stated() -> None:
    # Two degrees about the horizontal: the link's torque hardly varies, the reading is noise.
    joint = jid.thesis_joint()
    run = jid.simulate(
        joint.with_parameters(TRUTH),
        jid.Pd(stiffness=3000.0, damping=200.0),
        jid.Trajectory.thesis(math.radians(2.0), cycle=10.0, duration=12.0),
        sensors=jid.Sensors(torque_noise=0.5),
        seed=0,
    )
    free = joint.replace(parameters={})
    found = found_in(separable(run, free), "undetermined")
    assert "fits almost as well" in found.cause
    (action,) = (each for each in found.advice if each.kind == "call")
    after = separable(run, free, **action.arguments)
    assert all("fits almost as well" not in each.cause for each in after.findings)


def test_findings_are_values(well_excited: jid.Recording) -> None:
    found = found_in(separable(late_velocity(well_excited), shift={}), "signal_lag")
    assert pickle.loads(pickle.dumps(found)) == found
    assert len({found, found}) == 1
    assert str(found) == found.message == f"{found.cause}; {found.advice[0]}"
    assert found.worded(lambda action: action.kind) == f"{found.cause}; call"


def test_information_is_no_warning(well_excited: jid.Recording) -> None:
    make, _ = DEFECTS["gap"]
    estimate = separable(make(well_excited))
    assert [found.code for found in estimate.findings] == ["gaps"]
    assert estimate.warnings == ()
    assert "info (gaps): gaps in the log: 1" in estimate.report(verbose=True)
    make, _ = DEFECTS["constant sensor"]
    assert found_in(separable(make(well_excited)), "constant_signal").severity == "blocking"


def test_the_most_severe_finding_is_first(
    well_excited: jid.Recording, monkeypatch: pytest.MonkeyPatch
) -> None:
    torn = DEFECTS["gap"][0](well_excited)
    monkeypatch.setattr(registry, "CHECKS", registry.CHECKS[::-1])
    order = [
        found.severity
        for found in separable(changed(torn, sensor=np.full_like(torn.time, 3.0))).findings
    ]
    assert order == sorted(order, key=["blocking", "warning", "info"].index)
    assert {"blocking", "warning", "info"} == set(order)


def test_a_few_pairs_are_named(well_excited: jid.Recording) -> None:
    orders = ",".join(str(order) for order in range(1, 9))
    estimate = separable(well_excited.crop(0.0, 1.2), model=f":harmonics={orders}")
    names, matrix = estimate.free, np.abs(estimate.correlation)
    assert (matrix[np.triu_indices(len(names), 1)] > 0.98).sum() > 5
    cause = found_in(estimate, "undetermined").cause
    assert cause.count("are indistinguishable") == 5


# --- Adding one: a file and a line ---

WOBBLE = """
from jointid.base.advice import Action
from jointid.estimate.findings import Measured
from jointid.identification.warnings.check import Check, FindingType

WOBBLE = FindingType(code="wobble", meaning="the base wobbles", advice="bolt it down")


def _find(evidence):
    count = len(evidence.recordings)
    yield WOBBLE.finding(
        f"the base wobbles in {count} recording(s)",
        Action("inspect", text="the bolts"),
        evidence={"recordings": Measured(count)},
    )


CHECK = Check(_find, (WOBBLE,))
"""


def test_a_check_is_a_file_and_a_line(
    well_excited: jid.Recording, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "wobble.py").write_text(WOBBLE, encoding="utf-8")  # the file
    monkeypatch.setattr(warnings, "__path__", [*warnings.__path__, str(tmp_path)])
    files = (*registry.FILES, "wobble")  # the line
    monkeypatch.setattr(registry, "CHECKS", registry.checks_of(files))
    estimate = separable(well_excited)
    assert [found.code for found in estimate.warnings] == ["wobble"]
    sentence = "the base wobbles in 1 recording(s); inspect the bolts"
    assert f"warning (wobble): {sentence}" in estimate.report(verbose=True)
    page = report_page(estimate)
    assert "the base wobbles in 1 recording(s)" in page
    assert "<b>do: </b>inspect the bolts" in page
    assert "<b>do: </b>inspect the bolts" in estimate._repr_html_()
    assert "the base wobbles in 1 recording(s)" in estimate._repr_html_()
    again = jid.Estimate.from_json(estimate.to_json())
    assert again.findings == estimate.findings
    assert (
        "| `wobble` | warning | the base wobbles | bolt it down |"
        in findings_tables()["findings.md"]
    )


def test_no_file_is_forgotten() -> None:
    checks = {path.stem for path in FOLDER.glob("*.py") if "\nCHECK = " in path.read_text("utf-8")}
    assert checks == set(registry.FILES)
    assert len(registry.FILES) == len(set(registry.FILES))


@pytest.mark.parametrize("path", sorted(FOLDER.glob("*.py")), ids=lambda path: path.stem)
def test_a_check_lists_what_it_yields(path: Path) -> None:
    text = path.read_text("utf-8")
    yielded = set(re.findall(r"yield ([A-Z_]+)\.finding\(", text))
    listed = re.search(r"^CHECK = Check\(\w+, \(([A-Z_, ]+)\)(?:, \w+)?\)", text, re.MULTILINE)
    assert yielded == (set(re.findall(r"[A-Z_]+", listed[1])) if listed else set())


# --- Documents ---


@pytest.mark.parametrize(("page", "table"), findings_tables().items())
def test_a_table_of_findings_is_what_their_types_say(page: str, table: str) -> None:
    written = (ROOT / "docs" / page).read_text(encoding="utf-8")
    assert written == in_place_of_the_table(written, table), (
        "write it again: PYTHONPATH=tools python -m documentation.findings_tables"
    )


def test_a_page_without_a_table_of_findings_is_refused() -> None:
    with pytest.raises(ValueError, match="0 tables"):
        in_place_of_the_table("# Findings\n", "")


def test_a_shift_in_milliseconds_is_doubted(well_excited: jid.Recording) -> None:
    found = found_in(separable(well_excited, shift={"torque": 1.0}), "long_shift")
    assert "torque is shifted by 1 s" in found.title
    assert "1 ms is 0.001" in found.message
    short = separable(well_excited, shift={"torque": 0.05})
    assert "long_shift" not in {each.code for each in short.findings}


def test_a_reversed_torque_is_flipped_as_it_is_read(
    well_excited: jid.Recording, tmp_path: Path
) -> None:
    assert well_excited.torque is not None
    wrong = well_excited.with_signals(torque=-well_excited.torque)
    found = found_in(separable(wrong), "reversed_sign")
    (action,) = (each for each in found.advice if each.kind == "call")
    assert (action.function, dict(action.arguments)) == ("load", {"scale": {"torque": -1.0}})
    after = obeyed(action, wrong, {}, tmp_path)
    assert "reversed_sign" not in {each.code for each in after.findings}
