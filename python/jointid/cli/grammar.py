"""Options of `demo`, `identify`, `compare`, `report` and `info`."""

from __future__ import annotations

from pathlib import Path

from jointid._core import model_names
from jointid.cli.arguments import (
    Once,
    file_kinds,
    method_argument,
    reading_arguments,
    several_recordings,
    verbose_argument,
    whole,
    whole_seed,
)
from jointid.cli.joint_options import joint_arguments
from jointid.cli.parser import CommandParser
from jointid.cli.requirement import LEVELS


def add_demo(demo: CommandParser) -> None:
    """Add the command's grammar."""
    demo.epilog = "example:\n  jointid demo --output demo"
    demo.add_argument(
        "--output", default="demo", type=Path, help="folder for report.html and estimate.json"
    )
    demo.add_argument("--json", action="store_true", help="print the estimate as JSON")
    verbose_argument(demo)


def add_identify(identify: CommandParser) -> None:
    """Add the command's grammar."""
    identify.epilog = (
        "examples:\n  jointid identify run.csv\n"
        "  jointid identify run.csv --gear-ratio 101 --rotor-inertia 2.5e-4 --torque-constant 0.11\n"
        "  jointid identify run.csv --joint joint.toml --set viscous=12 --report report.html --save joint.toml\n"
        "  jointid identify log.csv --column position=enc1_rad --unit position=deg --windows 0.05s --json\n"
        "  jointid identify monday.csv tuesday.csv --joint joint.toml   (one fit, shared parameters)\n"
        "  jointid identify arm.csv --joints all --gear-ratio 32,32,45,-48,45,32 --report arm.html\n"
        "  jointid identify arm.csv --robot arm.urdf --facts robot.toml --report arm.html   (all joints together)\n"
        "  jointid identify runs/*.csv --joint servo.toml --rollout   (a servo that logs its duty, no torque)"
    )
    several_recordings(identify)
    _identification_arguments(identify)
    identify.add_argument(
        "--model",
        metavar="NAME[:OPTION[=VALUE]]",
        help=(
            f"friction model: {', '.join(model_names())} or auto. Default: the joint's own model, otherwise auto. auto "
            "chooses the first or second model, with or without gravity, by the residual of held-out torque. Options "
            "follow the name, as in stribeck:asymmetric:ripple=2,4. With --robot, each joint can have its own model: "
            "JOINT[,JOINT...]=MODEL, separated by semicolons"
        ),
    )
    _robot_arguments(identify)
    identify.add_argument(
        "--inertia",
        metavar="VALUE|MODE",
        help="inertia of the drive alone at the output [kg·m²]; with --robot: inertias of the links, "
        "urdf (default), scaled or free",
    )
    identify.add_argument(
        "--selftest",
        action="store_true",
        help="self-test: simulate the recorded motion with the identified values and noise, "
        "then identify this simulation",
    )
    identify.add_argument(
        "--causes",
        action="store_true",
        help="list the causes of the residual, the share that each explains, and the values that each changes",
    )
    identify.add_argument(
        "--by",
        metavar="COLUMN",
        help="for a servo: column that numbers the runs in a file; see docs/servos.md",
    )
    identify.add_argument(
        "--rollout",
        action="store_true",
        help="for a servo or a robot: simulate each recorded run, and print the difference from the recorded position",
    )
    identify.add_argument(
        "--population", type=whole, help="number of individuals in the genetic algorithm"
    )
    identify.add_argument(
        "--generations", type=whole, help="number of generations in the genetic algorithm"
    )
    identify.add_argument(
        "--checkpoint", type=Path, help="write the state of a long search to this file"
    )
    identify.add_argument("--resume", type=Path, help="continue from a checkpoint")
    identify.add_argument(
        "--bootstrap",
        type=whole,
        nargs="?",
        const=1000,
        metavar="DRAWS",
        help="check the standard errors by a bootstrap over blocks of the recording (default 1000 draws)",
    )
    identify.add_argument(
        "--require",
        choices=LEVELS,
        help="lowest accepted verdict: usable or care (usable with care); a worse verdict gives exit code 4",
    )
    _output_arguments(identify)


def _robot_arguments(
    command: CommandParser,
    purpose: str = "identify all joints together, with the links of this URDF; see docs/robots.md",
) -> None:
    command.add_argument(
        "--robot",
        type=Path,
        metavar="URDF",
        help=purpose,
    )
    command.add_argument(
        "--facts",
        type=Path,
        metavar="TOML",
        help="with --robot: file of the robot's facts (.toml): joints, gear_ratios, torque_constants, "
        "couplings, rotor_inertias, zero_offsets, side, gravity",
    )


def add_compare(compare: CommandParser) -> None:
    """Add the command's grammar."""
    compare.epilog = (
        "examples:\n  jointid compare run.csv\n"
        "  jointid compare run.csv --model stribeck --model stribeck:ripple=2 --folds 8 --json\n"
        "  jointid compare monday.csv tuesday.csv wednesday.csv --joint joint.toml --save joint.toml\n"
        "  jointid compare arm.csv --robot arm.urdf --facts robot.toml --report arm.html   (all joints together)\n"
        "one recording is cut into blocks, which are held out; with several recordings, whole recordings are held out"
    )
    several_recordings(compare)
    _identification_arguments(compare)
    _robot_arguments(compare)
    compare.add_argument(
        "--inertia",
        action="append",
        metavar="VALUE|MODE",
        help="inertia of the drive alone at the output [kg·m²]; with --robot: urdf, scaled or free (default: all "
        "are compared); may be repeated",
    )
    compare.add_argument(
        "--model",
        action="append",
        dest="models",
        metavar="NAME[:OPTION[=VALUE]]",
        help="a model to compare; may be repeated; default: the models that suit the recording",
    )
    compare.add_argument(
        "--folds", type=whole, default=5, help="number of parts, each held out once (default 5)"
    )
    _output_arguments(compare)


def add_report(report: CommandParser) -> None:
    """Add the command's grammar."""
    report.epilog = (
        "example:\n  jointid identify run.csv --save estimate.json\n"
        "  jointid report estimate.json --output report.html"
    )
    report.add_argument(
        "estimate", type=Path, help="estimate (.json), from identify --save or estimate.save"
    )
    report.add_argument(
        "--joints",
        metavar="JOINT",
        help="joint to use, if the file has the estimates of several joints",
    )
    report.add_argument(
        "--output",
        type=Path,
        default=Path("report.html"),
        help="file to write (default report.html)",
    )
    report.add_argument("--json", action="store_true", help="print JSON")


def add_info(info: CommandParser) -> None:
    """Add the command's grammar."""
    info.epilog = "examples:\n  jointid info run.csv\n  jointid info arm.csv --robot arm.urdf   (a line for each joint)"
    recording = info.add_argument("recording", type=Path, help="recording")
    info.help_later(recording, lambda: f"recording: {file_kinds()}")
    reading_arguments(info)
    _robot_arguments(
        info, "compare the torques of a robot's log with the weight of this URDF's links"
    )
    info.add_argument("--json", action="store_true", help="print JSON")
    verbose_argument(info)


def _identification_arguments(command: CommandParser) -> None:
    from jointid.cli.options import declared_arguments

    joint_arguments(command)
    method_argument(command)
    declared_arguments(command)
    command.add_argument(
        "--seed",
        type=whole_seed,
        default=0,
        help="seed; the same seed gives the same result (default 0)",
    )
    command.add_argument(
        "--threads", type=whole, default=0, help="number of threads (default 0: all cores)"
    )


def _output_arguments(command: CommandParser) -> None:
    command.add_argument(
        "--report",
        type=Path,
        help="write the HTML report to this file, and the estimate next to it",
    )
    command.add_argument(
        "--save", type=Path, action=Once, help="write the estimate to a joint file (.toml) or .json"
    )
    command.add_argument("--json", action="store_true", help="print the result as JSON")
    verbose_argument(command)
    command.add_argument("--quiet", action="store_true", help="no progress bar")
