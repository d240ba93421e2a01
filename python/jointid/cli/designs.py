"""Command `design`: the motion that identifies a joint best within limits."""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.cli.arguments import decimal, pair, verbose_argument, whole, whole_seed
from jointid.cli.outputs import check_folder, check_page

if TYPE_CHECKING:
    from jointid.cli.parser import CommandParser
    from jointid.estimate.estimate import Estimate
    from jointid.excitation.design import Design

_PICTURES = (".png", ".pdf", ".svg")
_DURATION = 12.0  # s


def add_design(design: CommandParser) -> None:
    """Add the command's grammar."""
    design.epilog = (
        "examples:\n"
        "  jointid design joint.toml --duration 12 --output motion.toml\n"
        "  jointid design joint.toml --position -60deg,60deg --velocity 3.4 --torque 160 --output motion.toml\n"
        "  jointid design --after estimate.json --output motion.toml\n"
        "  jointid design joint.toml --parameter sensor_gain --sensor torque_noise=0.5 --plot motion.png\n"
        "the joint file needs a value or bounds for each parameter; its table [session], if there is one,\n"
        'gives the controller, the period, the encoder and the limits, and takes the motion as file = "motion.toml"'
    )
    verbose_argument(design)
    design.add_argument(
        "joint", type=Path, nargs="?", help="joint file (.toml); default: the joint of --after"
    )
    design.add_argument(
        "--after",
        type=Path,
        metavar="ESTIMATE",
        help="estimate (.json): design the next motion, based on what the estimate's recordings already show",
    )
    design.add_argument(
        "--after-joint",
        metavar="NAME",
        help="joint to use, if the file has the estimates of several joints",
    )
    design.add_argument(
        "--duration",
        type=decimal,
        help="duration of the motion [s] (default 12; with --after: as advised)",
    )
    for name, shown, explanation in (
        (
            "--position",
            "LOW,HIGH",
            "position window [rad], or as -60deg,60deg; default: nine tenths of the joint file's window; with "
            "--after: as recorded",
        ),
        (
            "--velocity",
            "LIMIT",
            "largest velocity [rad/s], or as 200deg; default: nine tenths of the joint file's limit",
        ),
        (
            "--acceleration",
            "LIMIT",
            "largest acceleration of the reference [rad/s²]; default: not limited",
        ),
        (
            "--torque",
            "LIMIT",
            "largest torque of the drive at the output [N·m]; default: the joint file's limit",
        ),
        (
            "--sensor-range",
            "LIMIT",
            "largest torque at the torque sensor [N·m]; default: not limited",
        ),
    ):
        design.add_argument(name, metavar=shown, help=explanation)
    _believed(design)
    _sought(design)
    design.add_argument("--output", type=Path, help="file for the motion (.toml)")
    design.add_argument("--plot", type=Path, help="draw the motion: .png, .pdf, .svg")
    design.add_argument("--report", type=Path, help="write the HTML report to this file")
    design.add_argument("--json", action="store_true", help="print the design as JSON")
    design.add_argument("--quiet", action="store_true", help="no progress bar")


def _believed(design: argparse.ArgumentParser) -> None:
    """Add the options for known values of the joint, its controller and its sensors."""
    design.add_argument(
        "--prior",
        action="append",
        type=pair,
        default=[],
        metavar="NAME=LOW,HIGH",
        help="range of a parameter (default: its bounds in the joint file); may be repeated",
    )
    design.add_argument(
        "--controller",
        help="controller, as in simulate; default: [session.controller] of the joint file, otherwise adaptive_robust "
        "without torque feedback",
    )
    design.add_argument(
        "--believe",
        type=Path,
        metavar="JOINT",
        help="joint file with the parameters that the controller assumes; default: this joint's file",
    )
    for name, explanation in (
        ("--gain", "a setting of the controller; may be repeated"),
        (
            "--sensor",
            "a sensor's property, such as torque_noise=0.5, encoder_counts=8000 (per motor turn)",
        ),
    ):
        design.add_argument(
            name, action="append", type=pair, default=[], metavar="NAME=VALUE", help=explanation
        )
    design.add_argument(
        "--control-period",
        type=decimal,
        help="time between two commands [s]; default: the session's period, or 0.001",
    )


def _sought(design: argparse.ArgumentParser) -> None:
    """Add the options for the goal of the search and its method."""
    design.add_argument(
        "--parameter",
        action="append",
        metavar="NAME",
        help="parameter that the motion must determine (default: all identified parameters); may be repeated",
    )
    design.add_argument(
        "--criterion",
        default="worst",
        help="error to minimise: worst (largest relative error, default) or determinant (all errors together)",
    )
    design.add_argument("--evaluations", type=whole, help="number of motions to try (default 3600)")
    design.add_argument(
        "--joints",
        type=whole,
        help="number of simulated joints, drawn from the ranges of --prior (default 4)",
    )
    design.add_argument(
        "--rehearsals",
        type=whole,
        help="number of simulated recordings from which the errors are computed (default 256)",
    )
    design.add_argument("--seed", type=whole_seed, default=0, help="seed of the search (default 0)")
    design.add_argument(
        "--threads", type=whole, default=0, help="threads of the search (default 0: all cores)"
    )


def design(arguments: argparse.Namespace) -> int:
    """Design a motion and write it."""
    from jointid.cli.design_settings import as_option

    _check_outputs(arguments)
    try:
        found = _designed(arguments)
    except InputError as error:
        raise as_option(error) from None
    return _say(found, arguments)


def _designed(arguments: argparse.Namespace) -> Design:
    """Return the design of a command line."""
    from jointid.cli.design_settings import (
        advised_motion,
        controller_after,
        controller_for,
        joint_and_bench,
        limits_of,
        prior_of,
        sensors_after,
        sensors_for,
    )
    from jointid.cli.progress import MotionProgress
    from jointid.excitation.design_search import DesignSearch
    from jointid.excitation.designing import design_excitation

    estimate = _estimate(arguments)
    if arguments.joint is not None:
        joint, bench = joint_and_bench(arguments.joint)
    elif estimate is not None:
        joint, bench = estimate.joint, None
    else:
        raise InputError("missing: joint (a file), or an estimate for --after")
    advised = {} if estimate is None else advised_motion(estimate)
    limits = limits_of(arguments, joint, bench, advised.get("limits", {}))
    duration = arguments.duration
    if duration is None:
        duration = advised.get("duration", _DURATION)
    budget = {
        "evaluations": arguments.evaluations,
        "joints": arguments.joints,
        "rehearsals": arguments.rehearsals,
    }
    search = DesignSearch(
        seed=arguments.seed,
        threads=arguments.threads,
        **{name: value for name, value in budget.items() if value is not None},
    )
    period = arguments.control_period
    if period is None:
        period = 1e-3 if bench is None else bench.options.period
    sensors = sensors_for(arguments.sensor, limits, joint, bench)
    with MotionProgress(enabled=not arguments.quiet) as progress:
        settings: dict[str, Any] = {
            "parameters": arguments.parameter,
            "criterion": arguments.criterion,
            "prior": prior_of(arguments.prior),
            "search": search,
            "control_period": period,
            "callback": progress,
        }
        if estimate is None:
            controller = controller_for(arguments, joint, bench)
            settings |= {"controller": controller, "sensors": sensors}
            return design_excitation(joint, limits, duration, **settings)
        settings["controller"] = controller_after(arguments, estimate.joint, bench)
        settings["sensors"] = sensors_after(arguments.sensor, sensors, estimate)
        found: Design = estimate.next_motion(limits, duration, joint=joint, **settings)
        return found


def _estimate(arguments: argparse.Namespace) -> Estimate | None:
    """Return the estimate of --after; of several joints, that of --after-joint."""
    from jointid.joints.reading import load_estimate

    joint = arguments.after_joint
    if arguments.after is None:
        if joint is not None:
            raise InputError(
                "this option names a joint of --after, but --after is not given",
                argument="after_joint",
                value=joint,
            )
        return None
    try:
        estimate = load_estimate(arguments.after, joint)
        blocked = [each for each in estimate.findings if each.severity == "blocking"]
        if blocked:
            said = f"the values of {arguments.after} cannot be used: {blocked[0].cause}"
            print(f"jointid design: {said}", file=sys.stderr)
        return estimate
    except InputError as error:
        remedies = tuple(
            Action("call", {"after_joint": each.arguments["joint"]}, each.text, each.function)
            if isinstance(each, Action) and "joint" in each.arguments
            else each
            for each in error.remedy
        )
        of_joint = error.argument == "joints"
        raise InputError(
            error.reason,
            argument="after_joint" if of_joint else error.argument,
            value=error.value,
            place=error.place,
            remedy=remedies,
        ) from None


def _say(found: Design, arguments: argparse.Namespace) -> int:
    """Write the requested files and print the design. A motion that violates a limit is not written."""
    from jointid.cli.exit_codes import BAD_INPUT
    from jointid.excitation.design_fields import COMPLETE

    usable = found.status == COMPLETE
    if usable and arguments.output is not None:
        found.save(arguments.output)
    if arguments.plot is not None:
        _draw(found, arguments.plot)
    if arguments.report is not None:
        from jointid.report.saving import save_report

        save_report(found, arguments.report)
    if arguments.json:
        print(json.dumps(found.to_dict(), indent=1, ensure_ascii=False, allow_nan=False))
    else:
        from jointid.excitation.tables import answer

        print(found.summary() if arguments.verbose else answer(found))
        written = (("picture", arguments.plot), ("report", arguments.report))
        lines = [f"{what}: {path}" for what, path in written if path is not None]
        if usable and arguments.output is not None:
            lines.append(f"motion: {arguments.output}")
        if lines:
            print(*lines, sep="\n")
    if usable:
        return 0
    unwritten = f"; {arguments.output} was not written" if arguments.output is not None else ""
    print(f"jointid design: {found.reason or found.status}{unwritten}", file=sys.stderr)
    return BAD_INPUT


def _check_outputs(arguments: argparse.Namespace) -> None:
    for name, endings, text in (
        ("output", (".toml",), "a motion is written as .toml"),
        ("plot", _PICTURES, "a plot is written as .png, .pdf or .svg"),
    ):
        path = getattr(arguments, name)
        if path is not None and path.suffix.lower() not in endings:
            raise InputError(text, argument=name, value=path)
        check_folder(name, path)
    check_page("report", arguments.report)


def _draw(found: Design, path: Path) -> None:
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot

    from jointid.base.pictures import write_picture

    write_picture(found.plot()[0].figure, path, dpi=150)
    pyplot.close("all")
