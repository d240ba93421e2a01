"""Identify a robot joint's friction and its built-in torque sensor from one recording of ordinary motion.

>>> import jointid as jid
>>> recording = jid.load("run.csv")
>>> joint = jid.Joint.load("joint.toml")
>>> estimate = jid.identify(recording, joint)
>>> print(estimate.report())
"""

from collections.abc import Callable
from importlib import import_module
from importlib.util import find_spec

from jointid.base.interruption import exit_on_interruption
from jointid.base.joining import join

TYPE_CHECKING = False  # as in typing, which `jointid --help` does without

exit_on_interruption()  # before what takes long to import
if find_spec("jointid._core") is None:
    raise ModuleNotFoundError(
        "jointid's compiled core is missing; install the package with pip instead of running it from its source folder",
        name="jointid._core",
    )

if TYPE_CHECKING:
    from jointid import hardware, plot
    from jointid._core import (
        AdaptiveRobust,
        CompensatedPid,
        GaOptions,
        Generation,
        LugreObserver,
        OpenLoop,
        Pd,
        Pid,
        Sensors,
        WindowOptions,
    )
    from jointid.base.advice import Action
    from jointid.base.errors import InputError
    from jointid.cli.demonstration import Demonstration, demo
    from jointid.commissioning import ring as commissioning
    from jointid.comparison.comparison import compare_models
    from jointid.comparison.result import Comparison
    from jointid.excitation.design import Design
    from jointid.excitation.design_file import load_design
    from jointid.excitation.design_search import DesignProgress, DesignSearch
    from jointid.excitation.designing import design_excitation
    from jointid.excitation.information import Known
    from jointid.excitation.motion_limits import MotionLimits
    from jointid.estimate.bootstrap import Bootstrap
    from jointid.estimate.estimate import Estimate
    from jointid.estimate.selection import Selection
    from jointid.estimate.self_test import SelfTest
    from jointid.exports.exporting import export
    from jointid.identification.identification import identify
    from jointid.identification.search.search import Search
    from jointid.joint.joint import Joint
    from jointid.joint.link import Limits, Link
    from jointid.joint.model import Model
    from jointid.joint.parameters import Parameter
    from jointid.joint.thesis import thesis_joint
    from jointid.joint.voltage_drive import PositionLoop, VoltageDrive
    from jointid.joints.identifying import identify_joints
    from jointid.joints.result import JointEstimates
    from jointid.online.online_estimate import OnlineEstimate
    from jointid.online.online_identifier import OnlineIdentifier
    from jointid.recording.readers.loading import load, load_runs
    from jointid.recording.readers.loading_robot import load_robot
    from jointid.recording.recording import Recording
    from jointid.recording.wide.robot_recording import RobotRecording
    from jointid.report.saving import save_report
    from jointid.robot.comparing import compare_robot_models
    from jointid.robot.identifying import identify_robot
    from jointid.robot.links.robot import Robot
    from jointid.robot.result.comparison_result import RobotComparison
    from jointid.robot.result.result import RobotEstimate
    from jointid.servo.comparing import ServoComparison, compare_servo_models
    from jointid.servo.estimate import ServoEstimate
    from jointid.servo.identifying import identify_servo
    from jointid.servo.rolling_out import Rollout, rollout
    from jointid.simulation.batch import SimulatedBatch, simulate_batch
    from jointid.simulation.plant import Bristle, control_estimates
    from jointid.simulation.scenario import Scenario
    from jointid.simulation.simulated_recording import SimulatedRecording, Truth
    from jointid.simulation.simulation import simulate
    from jointid.simulation.trajectory import Trajectory
    from jointid.study.study_result import Study
    from jointid.study.sweeping import StudyBrokenError, StudyInterruptedError, StudyStep, sweep

    __version__: str

__all__ = [
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

# Where each public name is defined; its module is imported when the name is asked for.
_HOMES = {
    "jointid._core": (
        "AdaptiveRobust",
        "CompensatedPid",
        "GaOptions",
        "Generation",
        "LugreObserver",
        "OpenLoop",
        "Pd",
        "Pid",
        "Sensors",
        "WindowOptions",
    ),
    "jointid.base.advice": ("Action",),
    "jointid.base.errors": ("InputError",),
    "jointid.cli.demonstration": ("Demonstration", "demo"),
    "jointid.comparison.comparison": ("compare_models",),
    "jointid.comparison.result": ("Comparison",),
    "jointid.excitation.design": ("Design",),
    "jointid.excitation.design_file": ("load_design",),
    "jointid.excitation.design_search": ("DesignProgress", "DesignSearch"),
    "jointid.excitation.designing": ("design_excitation",),
    "jointid.excitation.information": ("Known",),
    "jointid.excitation.motion_limits": ("MotionLimits",),
    "jointid.estimate.bootstrap": ("Bootstrap",),
    "jointid.estimate.estimate": ("Estimate",),
    "jointid.estimate.selection": ("Selection",),
    "jointid.estimate.self_test": ("SelfTest",),
    "jointid.exports.exporting": ("export",),
    "jointid.identification.identification": ("identify",),
    "jointid.identification.search.search": ("Search",),
    "jointid.joint.joint": ("Joint",),
    "jointid.joint.link": ("Limits", "Link"),
    "jointid.joint.model": ("Model",),
    "jointid.joint.parameters": ("Parameter",),
    "jointid.joint.voltage_drive": ("PositionLoop", "VoltageDrive"),
    "jointid.joint.thesis": ("thesis_joint",),
    "jointid.joints.identifying": ("identify_joints",),
    "jointid.joints.result": ("JointEstimates",),
    "jointid.online.online_estimate": ("OnlineEstimate",),
    "jointid.online.online_identifier": ("OnlineIdentifier",),
    "jointid.recording.readers.loading": ("load", "load_runs"),
    "jointid.recording.readers.loading_robot": ("load_robot",),
    "jointid.recording.recording": ("Recording",),
    "jointid.recording.wide.robot_recording": ("RobotRecording",),
    "jointid.report.saving": ("save_report",),
    "jointid.robot.comparing": ("compare_robot_models",),
    "jointid.robot.result.comparison_result": ("RobotComparison",),
    "jointid.robot.identifying": ("identify_robot",),
    "jointid.robot.result.result": ("RobotEstimate",),
    "jointid.robot.links.robot": ("Robot",),
    "jointid.servo.comparing": ("ServoComparison", "compare_servo_models"),
    "jointid.servo.estimate": ("ServoEstimate",),
    "jointid.servo.identifying": ("identify_servo",),
    "jointid.servo.rolling_out": ("Rollout", "rollout"),
    "jointid.simulation.batch": ("SimulatedBatch", "simulate_batch"),
    "jointid.simulation.plant": ("Bristle", "control_estimates"),
    "jointid.simulation.scenario": ("Scenario",),
    "jointid.simulation.simulated_recording": ("SimulatedRecording", "Truth"),
    "jointid.simulation.simulation": ("simulate",),
    "jointid.simulation.trajectory": ("Trajectory",),
    "jointid.study.study_result": ("Study",),
    "jointid.study.sweeping": ("StudyBrokenError", "StudyInterruptedError", "StudyStep", "sweep"),
}
_HOME_OF = {name: home for home, names in _HOMES.items() for name in names}
# Folders that are public as a whole; `hardware` and `commissioning` bring python-can.
_FOLDERS = frozenset({"commissioning", "hardware", "plot"})


def _next_motion() -> Callable[..., object]:
    """Load what designs the motion to record after an estimate."""
    from jointid.excitation.next_motion import motion_after

    return motion_after


def _friction_image() -> Callable[..., object]:
    """Load what draws an estimate in a notebook."""
    from jointid.report.notebook import friction_image

    return friction_image


# The rooms stand one above the other, and here all is seen.
join(next_motion=_next_motion, friction_image=_friction_image)


def _load(name: str) -> object:
    """Import what a public name stands for, once."""
    if name in _FOLDERS:
        return import_module(f"jointid.{name}")
    if name == "__version__":
        found = import_module("jointid._core").__version__
    elif name in _HOME_OF:
        found = getattr(import_module(_HOME_OF[name]), name)
    else:
        raise AttributeError(f"module 'jointid' has no attribute '{name}'")
    globals()[name] = found
    return found


if not TYPE_CHECKING:  # a type checker sees the imports above, and no name that is not there
    __getattr__ = _load


def __dir__() -> list[str]:
    """List the public names, also those that were not asked for yet; not what the package itself imports."""
    own = {name for name in globals() if name.startswith("__")}
    return sorted({*own, *__all__})
