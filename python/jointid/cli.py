"""The command line: `jointid demo | identify | info`."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from jointid.recording.recording import Recording

DONE, BAD_INPUT, INTERRUPTED = 0, 2, 130


class _Parser(argparse.ArgumentParser):
    """One line on bad usage, not a page."""

    def error(self, message: str) -> None:  # type: ignore[override]
        self.exit(BAD_INPUT, f"{self.prog}: {message}; see {self.prog} --help\n")


def _pair(text: str) -> tuple[str, str]:
    name, separator, value = text.partition("=")
    if not separator or not name or not value:
        raise argparse.ArgumentTypeError(f"'{text}' is not of the form name=value")
    return name, value


def _number_or_text(text: str) -> Any:
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text


def _windows(text: str) -> int | float:
    value = (
        _number_or_text(text.removesuffix("s").strip())
        if text.endswith("s")
        else _number_or_text(text)
    )
    if isinstance(value, str):
        raise argparse.ArgumentTypeError(
            f"'{text}' is neither a number (400) nor a duration (0.05s)"
        )
    return float(value) if text.endswith("s") else value


def parser() -> argparse.ArgumentParser:
    """The command line's grammar."""
    text = argparse.RawDescriptionHelpFormatter
    main_parser = _Parser(
        prog="jointid",
        description="Identify a robot joint's friction and torque sensor from a recording of ordinary motion.",
        epilog="example:\n  jointid identify run.csv --joint joint.toml --report report.html",
        formatter_class=text,
    )
    main_parser.add_argument("--version", action="store_true", help="print the version and exit")
    commands = main_parser.add_subparsers(dest="command", metavar="COMMAND", parser_class=_Parser)

    demo = commands.add_parser(
        "demo",
        help="identify a real industrial robot's joint that ships with jointid",
        epilog="example:\n  jointid demo --output demo",
        formatter_class=text,
    )
    demo.add_argument(
        "--output", default="demo", type=Path, help="folder for report.html and estimate.json"
    )
    demo.add_argument("--json", action="store_true", help="print the estimate as JSON")
    demo.add_argument("--quiet", action="store_true", help="no progress bar")

    identify = commands.add_parser(
        "identify",
        help="identify a joint from a recording",
        epilog=(
            "examples:\n  jointid identify run.csv\n"
            "  jointid identify run.csv --joint joint.toml --set viscous=12 --report report.html --save joint.toml\n"
            "  jointid identify log.csv --column position=enc1_rad --unit position=deg --windows 0.05s --json"
        ),
        formatter_class=text,
    )
    _recording_arguments(identify)
    identify.add_argument("--joint", type=Path, help="joint file (.toml)")
    identify.add_argument("--model", help="friction model: coulomb_viscous or stribeck")
    identify.add_argument("--method", default="ga", help="ga (default) or separable")
    identify.add_argument("--residual", help="sensor or torque")
    identify.add_argument(
        "--windows", type=_windows, help="number of windows (400), or duration (0.05s)"
    )
    identify.add_argument(
        "--set",
        action="append",
        type=_pair,
        default=[],
        metavar="PARAMETER=VALUE",
        help="fix a parameter (SI)",
    )
    identify.add_argument("--population", type=int, help="individuals of the genetic algorithm")
    identify.add_argument("--generations", type=int, help="generations of the genetic algorithm")
    identify.add_argument("--seed", type=int, default=0)
    identify.add_argument("--threads", type=int, default=0, help="0: all")
    identify.add_argument("--report", type=Path, help="write an HTML report here")
    identify.add_argument(
        "--save", type=Path, help="write the estimate to a joint file (.toml) or .json"
    )
    identify.add_argument("--json", action="store_true", help="print the estimate as JSON")
    identify.add_argument("--quiet", action="store_true", help="no progress bar")

    info = commands.add_parser(
        "info",
        help="say what a recording holds",
        epilog="example:\n  jointid info run.csv",
        formatter_class=text,
    )
    _recording_arguments(info)
    info.add_argument("--json", action="store_true", help="for machines")
    return main_parser


def _recording_arguments(command: argparse.ArgumentParser) -> None:
    command.add_argument("recording", type=Path, help="recording: .csv, .csv.gz or .npz")
    command.add_argument(
        "--column",
        action="append",
        type=_pair,
        default=[],
        metavar="SIGNAL=HEADER",
        help="which column (header or number) is which signal; may be repeated",
    )
    command.add_argument(
        "--unit",
        action="append",
        type=_pair,
        default=[],
        metavar="SIGNAL=UNIT",
        help="overrides the header's unit",
    )
    command.add_argument(
        "--where",
        action="append",
        type=_pair,
        default=[],
        metavar="COLUMN=VALUE",
        help="keep only such rows",
    )


def _load(arguments: argparse.Namespace) -> Recording:
    from jointid.recording.loading import load

    columns = {
        signal: int(header) if header.isdigit() else header for signal, header in arguments.column
    }
    where = {column: _number_or_text(value) for column, value in arguments.where}
    return load(
        arguments.recording,
        columns=columns or None,
        units=dict(arguments.unit) or None,
        where=where or None,
    )


def _demo(arguments: argparse.Namespace) -> None:
    from jointid.demo import demonstrate
    from jointid.progress import Progress
    from jointid.reporting import save_report

    with Progress(enabled=not arguments.quiet) as progress:
        demonstration = demonstrate(callback=progress)
    estimate = demonstration.estimate
    arguments.output.mkdir(parents=True, exist_ok=True)
    report = save_report(estimate, arguments.output / "report.html")
    estimate.save(arguments.output / "estimate.json")
    if arguments.json:
        print(estimate.to_json())
        return
    print(estimate.report())
    print()
    for name, nominal in demonstration.nominal.items():
        found = estimate.parameters[name]
        difference = 100.0 * (found.value / nominal - 1.0)
        print(
            f"{name}: {found.value:.4g} {found.unit}, the robot's authors give {nominal:g} ({difference:+.1f} %)"
        )
    print(f"\nreport: {report}")


def _identify(arguments: argparse.Namespace) -> None:
    from jointid._core import GaOptions
    from jointid.errors import InputError
    from jointid.identification.identification import identify
    from jointid.joint.joint import Joint
    from jointid.progress import Progress
    from jointid.reporting import save_report

    changes: dict[str, float] = {}
    for name, value in arguments.set:
        number = _number_or_text(value)
        if isinstance(number, str):
            raise InputError(f"--set {name}={value}: '{value}' is not a number")
        changes[name] = float(number)
    budget = {
        name: getattr(arguments, name)
        for name in ("population", "generations")
        if getattr(arguments, name) is not None
    }
    if arguments.save is not None and arguments.save.suffix not in (".toml", ".json"):
        raise InputError(
            f"--save {arguments.save}: an estimate is saved as .toml (joint file) or .json"
        )
    options = GaOptions(**budget)
    joint = Joint.load(arguments.joint) if arguments.joint is not None else None
    recording = _load(arguments)
    with Progress(total=options.generations, enabled=not arguments.quiet) as progress:
        estimate = identify(
            recording,
            joint,
            model=arguments.model,
            parameters=changes or None,
            method=arguments.method,
            ga=options,
            residual=arguments.residual,
            windows=arguments.windows,
            seed=arguments.seed,
            threads=arguments.threads,
            callback=progress,
        )
    if arguments.report is not None:
        save_report(estimate, arguments.report)
    if arguments.save is not None:
        estimate.save(arguments.save)
    print(estimate.to_json() if arguments.json else estimate.report())


def _info(arguments: argparse.Namespace) -> None:
    recording = _load(arguments)
    if arguments.json:
        print(json.dumps(_facts(recording), indent=1, ensure_ascii=False))
        return
    for label, value in _facts(recording).items():
        if isinstance(value, dict):
            print(f"{label}:")
            for signal, entry in value.items():
                print(
                    f"  {signal:14s} {entry['min']:12.6g} … {entry['max']:<12.6g} {entry['unit']}"
                )
        else:
            print(f"{label}: {value}")


def _facts(recording: Recording) -> dict[str, Any]:
    return {
        "name": recording.name,
        "kind": recording.kind,
        "samples": len(recording),
        "duration [s]": round(recording.duration, 9),
        "sample period [s]": round(recording.sample_period, 9),
        "gaps": len(recording.gaps),
        "velocity": "derived from the position" if recording.velocity_derived else "recorded",
        "fingerprint": recording.fingerprint,
        "signals": {
            signal: {
                "min": float(getattr(recording, signal).min()),
                "max": float(getattr(recording, signal).max()),
                "unit": recording.unit(signal),
            }
            for signal in recording.signals
        },
    }


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit code (0 done, 2 bad input, 130 on Ctrl-C)."""
    grammar = parser()
    arguments = grammar.parse_args(argv)
    if arguments.version:
        from jointid import __version__

        print(f"jointid {__version__}")
        return DONE
    if arguments.command is None:
        grammar.print_help()
        return DONE
    commands = {"demo": _demo, "identify": _identify, "info": _info}
    try:
        commands[arguments.command](arguments)
    except KeyboardInterrupt:
        print("jointid: interrupted", file=sys.stderr)
        return INTERRUPTED
    except BrokenPipeError:  # the reader of our output left: not our failure
        sys.stderr.close()
        return DONE
    except (ValueError, TypeError, OSError) as error:
        print(f"jointid {arguments.command}: {_one_line(error)}", file=sys.stderr)
        return BAD_INPUT
    return DONE


def _one_line(error: Exception) -> str:
    if isinstance(error, OSError) and error.filename is not None:
        return f"{error.filename}: {error.strerror}"
    return " ".join(str(error).split())
