"""Few names are documented at the top of the package; each that was there before is still found."""

import inspect
import re
from collections.abc import Callable
from typing import Any

import pytest

import jointid as jid
from jointid.comparison.comparison import compare_models
from jointid.excitation.designing import design_excitation
from jointid.identification.identification import identify
from jointid.recording.readers.loading import load
from jointid.simulation.simulation import simulate

MOST = 30
BEFORE = [
    "Action",
    "AdaptiveRobust",
    "Bootstrap",
    "Bristle",
    "Comparison",
    "CompensatedPid",
    "Demonstration",
    "Design",
    "DesignProgress",
    "DesignSearch",
    "Estimate",
    "GaOptions",
    "Generation",
    "InputError",
    "Joint",
    "JointEstimates",
    "Known",
    "Limits",
    "Link",
    "LugreObserver",
    "Model",
    "MotionLimits",
    "OnlineEstimate",
    "OnlineIdentifier",
    "OpenLoop",
    "Parameter",
    "Pd",
    "Pid",
    "PositionLoop",
    "Recording",
    "Robot",
    "RobotComparison",
    "RobotEstimate",
    "RobotRecording",
    "Rollout",
    "Scenario",
    "Search",
    "Selection",
    "SelfTest",
    "Sensors",
    "ServoComparison",
    "ServoEstimate",
    "SimulatedBatch",
    "SimulatedRecording",
    "Study",
    "StudyBrokenError",
    "StudyInterruptedError",
    "StudyStep",
    "Trajectory",
    "Truth",
    "VoltageDrive",
    "WindowOptions",
    "__version__",
    "commissioning",
    "compare_models",
    "compare_robot_models",
    "compare_servo_models",
    "control_estimates",
    "demo",
    "design_excitation",
    "export",
    "hardware",
    "identify",
    "identify_joints",
    "identify_robot",
    "identify_servo",
    "load",
    "load_design",
    "load_robot",
    "load_runs",
    "plot",
    "rollout",
    "save_report",
    "simulate",
    "simulate_batch",
    "sweep",
    "thesis_joint",
]
# By verb: what it does for a joint, and for other subjects.
SHOWN: dict[str, list[Callable[..., Any]]] = {
    "identify": [identify, jid.identify_servo, jid.identify_robot, jid.identify_joints],
    "compare": [compare_models, jid.compare_servo_models, jid.compare_robot_models],
    "load": [load, jid.load_robot],
    "simulate": [simulate, jid.rollout],
    "design": [design_excitation],
}
OF_SUBJECTS = {"recordings", "joint", "robot", "estimate", "score", "models"}


def test_few_names_are_documented() -> None:
    assert len(jid.__all__) == len(set(jid.__all__)) <= MOST
    assert {"identify", "compare", "load", "simulate", "design", "export"} <= set(jid.__all__)
    assert {name for name in dir(jid) if name[0] != "_"} == {*jid.__all__} - {"__version__"}


@pytest.mark.parametrize("name", BEFORE)
def test_a_name_of_before_is_found(name: str) -> None:
    assert getattr(jid, name) is not None


@pytest.mark.parametrize("verb", SHOWN)
def test_a_verb_shows_and_describes_the_options_of_all_subjects(verb: str) -> None:
    called = getattr(jid, verb)
    shown = inspect.signature(called).parameters
    text = inspect.cleandoc(called.__doc__ or "")
    known: dict[str, object] = {}
    for function in SHOWN[verb]:
        for name, each in inspect.signature(function).parameters.items():
            if name not in OF_SUBJECTS and each.default is not each.empty:
                known.setdefault(name, each.default)
    assert {name: shown[name].default for name in known} == known
    for name in shown:
        assert re.search(rf"(^|\n|, ){name}( : |, \w)", text), name
    assert ">>>" in text
    assert "\n**" not in text
