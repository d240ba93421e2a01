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
    from jointid._core import AdaptiveRobust as AdaptiveRobust
    from jointid._core import CompensatedPid as CompensatedPid
    from jointid._core import GaOptions as GaOptions
    from jointid._core import Generation as Generation
    from jointid._core import LugreObserver as LugreObserver
    from jointid._core import OpenLoop as OpenLoop
    from jointid._core import Pd as Pd
    from jointid._core import Pid
    from jointid._core import Sensors as Sensors
    from jointid._core import WindowOptions as WindowOptions
    from jointid.base.advice import Action as Action
    from jointid.base.errors import InputError
    from jointid.base.result import Result
    from jointid.cli.demonstration import Demonstration as Demonstration
    from jointid.cli.demonstration import demo
    from jointid.commissioning import cycles as commissioning
    from jointid.comparison.comparison import compare_models as compare_models
    from jointid.comparison.result import Comparison as Comparison
    from jointid.estimate.bootstrap import Bootstrap as Bootstrap
    from jointid.estimate.estimate import Estimate
    from jointid.estimate.rollout import Rollout as Rollout
    from jointid.estimate.selection import Selection as Selection
    from jointid.estimate.self_test import SelfTest as SelfTest
    from jointid.excitation.design import Design
    from jointid.excitation.design import load_design as load_design
    from jointid.excitation.design_search import DesignProgress as DesignProgress
    from jointid.excitation.design_search import DesignSearch as DesignSearch
    from jointid.excitation.designing import design_excitation as design_excitation
    from jointid.excitation.information import Known as Known
    from jointid.excitation.motion_limits import MotionLimits
    from jointid.exports.exporting import export
    from jointid.identification.search.search import Search as Search
    from jointid.joint.joint import Joint
    from jointid.joint.link import Limits, Link
    from jointid.joint.model import Model
    from jointid.joint.parameters import Parameter as Parameter
    from jointid.joint.thesis import thesis_joint
    from jointid.joint.voltage_drive import PositionLoop as PositionLoop
    from jointid.joint.voltage_drive import VoltageDrive
    from jointid.joints.identifying import identify_joints as identify_joints
    from jointid.joints.result import JointEstimates as JointEstimates
    from jointid.online.online_estimate import OnlineEstimate as OnlineEstimate
    from jointid.online.online_identifier import OnlineIdentifier as OnlineIdentifier
    from jointid.recording.readers.loading import load_runs as load_runs
    from jointid.recording.readers.loading_robot import load_robot as load_robot
    from jointid.recording.recording import Recording
    from jointid.recording.wide.robot_recording import RobotRecording
    from jointid.report.saving import save_report
    from jointid.robot.comparing import compare_robot_models as compare_robot_models
    from jointid.robot.identifying import identify_robot as identify_robot
    from jointid.robot.links.robot import Robot
    from jointid.robot.result.comparison_result import RobotComparison as RobotComparison
    from jointid.robot.result.result import RobotEstimate as RobotEstimate
    from jointid.servo.comparing import compare_servo_models as compare_servo_models
    from jointid.servo.comparison_result import ServoComparison as ServoComparison
    from jointid.servo.estimate import ServoEstimate as ServoEstimate
    from jointid.servo.identifying import identify_servo as identify_servo
    from jointid.servo.rolling_out import rollout as rollout
    from jointid.simulation.batch import SimulatedBatch as SimulatedBatch
    from jointid.simulation.batch import simulate_batch as simulate_batch
    from jointid.simulation.plant import Bristle as Bristle
    from jointid.simulation.plant import control_estimates as control_estimates
    from jointid.simulation.scenario import Scenario as Scenario
    from jointid.simulation.simulated_recording import SimulatedRecording as SimulatedRecording
    from jointid.simulation.simulated_recording import Truth as Truth
    from jointid.simulation.trajectory import Trajectory
    from jointid.study.study_result import Study
    from jointid.study.sweeping import StudyBrokenError as StudyBrokenError
    from jointid.study.sweeping import StudyInterruptedError as StudyInterruptedError
    from jointid.study.sweeping import StudyStep as StudyStep
    from jointid.study.sweeping import sweep
    from jointid.verbs.comparing import compare
    from jointid.verbs.designing import design
    from jointid.verbs.identifying import identify
    from jointid.verbs.loading import load
    from jointid.verbs.simulating import simulate

    __version__: str

__all__ = [
    "Design",
    "Estimate",
    "InputError",
    "Joint",
    "Limits",
    "Link",
    "Model",
    "MotionLimits",
    "Pid",
    "Recording",
    "Result",
    "Robot",
    "RobotRecording",
    "Study",
    "Trajectory",
    "VoltageDrive",
    "__version__",
    "commissioning",
    "compare",
    "demo",
    "design",
    "export",
    "hardware",
    "identify",
    "load",
    "plot",
    "save_report",
    "simulate",
    "sweep",
    "thesis_joint",
]
"""The documented names; all others are loaded, too, and described where they are used."""

# Where each name is defined; its module is imported when the name is asked for. Functions that are not in `__all__`
# are what a verb does for one subject, under the names that they had before there were verbs.
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
    "jointid.base.result": ("Result",),
    "jointid.cli.demonstration": ("Demonstration", "demo"),
    "jointid.comparison.comparison": ("compare_models",),
    "jointid.comparison.result": ("Comparison",),
    "jointid.excitation.design": ("Design", "load_design"),
    "jointid.excitation.design_search": ("DesignProgress", "DesignSearch"),
    "jointid.excitation.designing": ("design_excitation",),
    "jointid.excitation.information": ("Known",),
    "jointid.excitation.motion_limits": ("MotionLimits",),
    "jointid.estimate.bootstrap": ("Bootstrap",),
    "jointid.estimate.estimate": ("Estimate",),
    "jointid.estimate.selection": ("Selection",),
    "jointid.estimate.self_test": ("SelfTest",),
    "jointid.exports.exporting": ("export",),
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
    "jointid.recording.readers.loading": ("load_runs",),
    "jointid.recording.readers.loading_robot": ("load_robot",),
    "jointid.recording.recording": ("Recording",),
    "jointid.recording.wide.robot_recording": ("RobotRecording",),
    "jointid.report.saving": ("save_report",),
    "jointid.robot.comparing": ("compare_robot_models",),
    "jointid.robot.result.comparison_result": ("RobotComparison",),
    "jointid.robot.identifying": ("identify_robot",),
    "jointid.robot.result.result": ("RobotEstimate",),
    "jointid.robot.links.robot": ("Robot",),
    "jointid.servo.comparing": ("compare_servo_models",),
    "jointid.servo.comparison_result": ("ServoComparison",),
    "jointid.servo.estimate": ("ServoEstimate",),
    "jointid.servo.identifying": ("identify_servo",),
    "jointid.estimate.rollout": ("Rollout",),
    "jointid.servo.rolling_out": ("rollout",),
    "jointid.simulation.batch": ("SimulatedBatch", "simulate_batch"),
    "jointid.simulation.plant": ("Bristle", "control_estimates"),
    "jointid.simulation.scenario": ("Scenario",),
    "jointid.simulation.simulated_recording": ("SimulatedRecording", "Truth"),
    "jointid.simulation.trajectory": ("Trajectory",),
    "jointid.study.study_result": ("Study",),
    "jointid.study.sweeping": ("StudyBrokenError", "StudyInterruptedError", "StudyStep", "sweep"),
    "jointid.verbs.comparing": ("compare",),
    "jointid.verbs.designing": ("design",),
    "jointid.verbs.identifying": ("identify",),
    "jointid.verbs.loading": ("load",),
    "jointid.verbs.simulating": ("simulate",),
}
_HOME_OF = {name: home for home, names in _HOMES.items() for name in names}
# Folders that are public as a whole; `hardware` and `commissioning` bring python-can.
_FOLDERS = frozenset({"commissioning", "hardware", "plot"})


def _next_motion() -> Callable[..., object]:
    """Load what designs the motion to record after an estimate."""
    from jointid.excitation.next_motion import motion_after

    return motion_after


def _class_of_kind() -> Callable[..., object]:
    """Load what finds the kind of result that a file holds."""
    from jointid.verbs.result_kinds import class_of_kind

    return class_of_kind


def _notebook_view() -> Callable[..., object]:
    """Load what draws an estimate in a notebook."""
    from jointid.report.notebook import notebook_view

    return notebook_view


# The rooms stand one above the other, and here all is seen.
join(next_motion=_next_motion, class_of_kind=_class_of_kind, notebook_view=_notebook_view)


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
