"""Identify a robot joint's friction and its built-in torque sensor from one recording of ordinary motion.

>>> import jointid as jid
>>> recording = jid.load("run.csv")
>>> joint = jid.Joint.load("joint.toml")
>>> estimate = jid.identify(recording, joint)
>>> print(estimate.report())
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from jointid.base.interruption import exit_on_interruption

try:
    exit_on_interruption()  # before what takes long to import
    from jointid import _core
except ModuleNotFoundError as error:
    if error.name != "jointid._core":
        raise
    raise ModuleNotFoundError(
        "jointid's compiled core is missing; install the package with pip instead of running it from its source folder",
        name=error.name,
    ) from error

from jointid import plot
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
from jointid.comparison.comparison import compare_models
from jointid.comparison.result import Comparison
from jointid.design.design import Design
from jointid.design.design_file import load_design
from jointid.design.design_search import DesignProgress, DesignSearch
from jointid.design.designing import design_excitation
from jointid.design.known import Known
from jointid.design.motion_limits import MotionLimits
from jointid.design.next_motion import motion_after
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
from jointid.joints.identifying import identify_joints
from jointid.joints.result import JointEstimates
from jointid.online.online_estimate import OnlineEstimate
from jointid.online.online_identifier import OnlineIdentifier
from jointid.recording.readers.loading import load, load_runs
from jointid.recording.readers.loading_robot import load_robot
from jointid.recording.recording import Recording
from jointid.recording.wide.robot_recording import RobotRecording
from jointid.robot.identifying import identify_robot
from jointid.robot.result import RobotEstimate
from jointid.robot.robot import Robot
from jointid.simulation.batch import SimulatedBatch, simulate_batch
from jointid.simulation.plant import Bristle, control_estimates
from jointid.simulation.scenario import Scenario
from jointid.simulation.simulated_recording import SimulatedRecording, Truth
from jointid.simulation.simulation import simulate
from jointid.simulation.trajectory import Trajectory
from jointid.study.study_result import Study
from jointid.study.sweeping import StudyBrokenError, StudyInterruptedError, StudyStep, sweep

if TYPE_CHECKING:
    from jointid import hardware
    from jointid.commissioning import ring as commissioning

__version__ = _core.__version__

Estimate._design = (
    motion_after  # a method: the rooms stand one above the other, and here all is seen
)

__all__ = [
    "Action",
    "AdaptiveRobust",
    "Bootstrap",
    "Bristle",
    "Comparison",
    "CompensatedPid",
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
    "Recording",
    "Robot",
    "RobotEstimate",
    "RobotRecording",
    "Scenario",
    "Search",
    "Selection",
    "SelfTest",
    "Sensors",
    "SimulatedBatch",
    "SimulatedRecording",
    "Study",
    "StudyBrokenError",
    "StudyInterruptedError",
    "StudyStep",
    "Trajectory",
    "Truth",
    "WindowOptions",
    "__version__",
    "commissioning",
    "compare_models",
    "control_estimates",
    "design_excitation",
    "export",
    "hardware",
    "identify",
    "identify_joints",
    "identify_robot",
    "load",
    "load_design",
    "load_robot",
    "load_runs",
    "plot",
    "simulate",
    "simulate_batch",
    "sweep",
    "thesis_joint",
]


def __getattr__(name: str) -> Any:
    """Load what moves a real joint when it is asked for: it brings python-can."""
    if name in ("commissioning", "hardware"):
        return import_module(f"jointid.{name}")
    raise AttributeError(f"module 'jointid' has no attribute '{name}'")
