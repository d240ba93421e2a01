"""The command line's grammar, and its arguments as values."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from jointid.recording.recording import Recording

BAD_USAGE = 2
_MOST_WINDOWS = 1_000_000_000
TEXT = argparse.RawDescriptionHelpFormatter


class _Parser(argparse.ArgumentParser):
    """One line on bad usage, not a page."""

    def error(self, message: str) -> None:  # type: ignore[override]
        told = " ".join(message.split())
        self.exit(BAD_USAGE, f"{self.prog}: {told}; see {self.prog} --help\n")


def parser() -> argparse.ArgumentParser:
    """The command line's grammar."""
    main_parser = _Parser(
        prog="jointid",
        description="Identify a robot joint's friction and torque sensor from a recording of ordinary motion.",
        epilog="example:\n  jointid identify run.csv --joint joint.toml --report report.html",
        formatter_class=TEXT,
    )
    main_parser.add_argument("--version", action="store_true", help="print the version and exit")
    commands = main_parser.add_subparsers(dest="command", metavar="COMMAND", parser_class=_Parser)
    from jointid.cli.session import add_emulate, add_run
    from jointid.cli.simulation import add_simulate
    from jointid.cli.study import add_sweep

    for add in (_add_demo, _add_identify, _add_compare, add_simulate, add_sweep, add_run):
        add(commands)
    add_emulate(commands)
    _add_report(commands)
    _add_info(commands)
    return main_parser


def _add_demo(commands: Any) -> None:
    demo = commands.add_parser(
        "demo",
        help="identify a real industrial robot's joint that ships with jointid",
        epilog="example:\n  jointid demo --output demo",
        formatter_class=TEXT,
    )
    demo.add_argument(
        "--output", default="demo", type=Path, help="folder for report.html and estimate.json"
    )
    demo.add_argument("--json", action="store_true", help="print the estimate as JSON")
    demo.add_argument("--quiet", action="store_true", help="no progress bar")


def _add_identify(commands: Any) -> None:
    identify = commands.add_parser(
        "identify",
        help="identify a joint from one recording or several",
        epilog=(
            "examples:\n  jointid identify run.csv\n"
            "  jointid identify run.csv --joint joint.toml --set viscous=12 --report report.html --save joint.toml\n"
            "  jointid identify log.csv --column position=enc1_rad --unit position=deg --windows 0.05s --json\n"
            "  jointid identify monday.csv tuesday.csv --joint joint.toml   (one fit, shared parameters)"
        ),
        formatter_class=TEXT,
    )
    several_recordings(identify)
    _identification_arguments(identify, method="ga")
    identify.add_argument(
        "--model",
        help="friction model: coulomb_viscous or stribeck; stribeck:asymmetric:ripple=2,4",
    )
    identify.add_argument("--population", type=int, help="individuals of the genetic algorithm")
    identify.add_argument("--generations", type=int, help="generations of the genetic algorithm")
    identify.add_argument("--checkpoint", type=Path, help="keep the state of a long search here")
    identify.add_argument("--resume", type=Path, help="go on from such a checkpoint")
    _output_arguments(identify)


def _add_compare(commands: Any) -> None:
    compare = commands.add_parser(
        "compare",
        help="compare friction models by how well they predict held-out motion",
        epilog=(
            "examples:\n  jointid compare run.csv\n"
            "  jointid compare run.csv --model stribeck --model stribeck:ripple=2 --folds 8 --json\n"
            "  jointid compare monday.csv tuesday.csv wednesday.csv --joint joint.toml --save joint.toml\n"
            "one recording is cut into blocks; of several, whole recordings are held out"
        ),
        formatter_class=TEXT,
    )
    several_recordings(compare)
    _identification_arguments(compare, method="separable")
    compare.add_argument(
        "--model",
        action="append",
        dest="models",
        metavar="NAME[:OPTION[=VALUE]]",
        help="a model to compare; may be repeated; default: the usual ones",
    )
    compare.add_argument("--folds", type=int, default=5, help="parts held out in turn (5)")
    _output_arguments(compare)


def _add_report(commands: Any) -> None:
    report = commands.add_parser(
        "report",
        help="write the HTML report of a saved estimate",
        epilog=(
            "example:\n  jointid identify run.csv --save estimate.json\n"
            "  jointid report estimate.json --output report.html"
        ),
        formatter_class=TEXT,
    )
    report.add_argument(
        "estimate", type=Path, help="estimate (.json), from identify --save or estimate.save"
    )
    report.add_argument(
        "--output", type=Path, default=Path("report.html"), help="where to write it (report.html)"
    )
    report.add_argument("--json", action="store_true", help="for machines")


def _add_info(commands: Any) -> None:
    info = commands.add_parser(
        "info",
        help="say what a recording holds",
        epilog="example:\n  jointid info run.csv",
        formatter_class=TEXT,
    )
    from jointid.recording.readers.registry import endings_text

    info.add_argument("recording", type=Path, help=f"recording: {endings_text()}")
    reading_arguments(info)
    info.add_argument("--json", action="store_true", help="for machines")


def several_recordings(command: argparse.ArgumentParser) -> None:
    """Add recordings and how they are read."""
    from jointid.recording.readers.registry import endings_text

    command.add_argument(
        "recordings",
        type=Path,
        nargs="+",
        metavar="recording",
        help=f"recording: {endings_text()}; several are read alike",
    )
    reading_arguments(command)


def reading_arguments(command: argparse.ArgumentParser) -> None:
    """Add how a recording is read."""
    for name, shown, told in (
        (
            "--column",
            "SIGNAL=HEADER",
            "which column (header or number) is which signal, or none; may be repeated",
        ),
        ("--unit", "SIGNAL=UNIT", "overrides the header's unit"),
        ("--scale", "SIGNAL=FACTOR", "SI value of the file's 1, for a unit nobody knows"),
        ("--where", "COLUMN=VALUE", "keep only such rows"),
    ):
        command.add_argument(name, action="append", type=pair, default=[], metavar=shown, help=told)


def _identification_arguments(command: argparse.ArgumentParser, *, method: str) -> None:
    other = "separable" if method == "ga" else "ga"
    command.add_argument("--joint", type=Path, help="joint file (.toml)")
    command.add_argument("--method", default=method, help=f"{method} (default) or {other}")
    command.add_argument("--residual", help="sensor or torque")
    command.add_argument(
        "--torque-hold", help="zoh: a command held between samples; linear: measured"
    )
    command.add_argument(
        "--windows", type=_windows, help="number of windows (400), duration (0.05s) or cumulative"
    )
    command.add_argument(
        "--set",
        action="append",
        type=pair,
        default=[],
        metavar="PARAMETER=VALUE",
        help="fix a parameter (SI)",
    )
    command.add_argument("--seed", type=whole_seed, default=0, help="same seed, same bits (0)")
    command.add_argument("--threads", type=int, default=0, help="0: all")


def _output_arguments(command: argparse.ArgumentParser) -> None:
    command.add_argument("--report", type=Path, help="write the estimate's HTML report here")
    command.add_argument(
        "--save", type=Path, help="write the estimate to a joint file (.toml) or .json"
    )
    command.add_argument("--json", action="store_true", help="print the result as JSON")
    command.add_argument("--quiet", action="store_true", help="no progress bar")


def pair(text: str) -> tuple[str, str]:
    """Name and value of `name=value`."""
    name, separator, value = text.partition("=")
    if not separator or not name or not value:
        raise argparse.ArgumentTypeError(f"'{text}' is not of the form name=value")
    return name, value


def number_or_text(text: str) -> Any:
    """An int, else a float, else the text."""
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text


def _windows(text: str) -> int | float | str:
    if text == "cumulative":
        return text
    value = (
        number_or_text(text.removesuffix("s").strip())
        if text.endswith("s")
        else number_or_text(text)
    )
    if isinstance(value, str):
        raise argparse.ArgumentTypeError(
            f"'{text}' is neither a number (400) nor a duration (0.05s) nor cumulative"
        )
    if value > _MOST_WINDOWS:
        raise argparse.ArgumentTypeError(f"'{text}' is more than any recording holds")
    return float(value) if text.endswith("s") else value


def whole_seed(text: str) -> int:
    """A seed."""
    value = number_or_text(text)
    if not isinstance(value, int) or not 0 <= value < 2**64:
        raise argparse.ArgumentTypeError(f"'{text}' is no whole number from 0 to 2^64 - 1")
    return value


def load_all(paths: Sequence[Path], arguments: argparse.Namespace) -> list[Recording]:
    """The recordings of a command, each read with the same --column, --unit and --where."""
    from jointid.recording.readers.loading import load

    columns = {
        signal: int(header) if header.isdigit() else None if header == "none" else header
        for signal, header in arguments.column
    }
    where = {column: number_or_text(value) for column, value in arguments.where}
    units = dict(arguments.unit)
    scale = _numbers("--scale", arguments.scale)
    return [
        load(
            path,
            columns=columns or None,
            units=units or None,
            scale=scale or None,
            where=where or None,
        )
        for path in paths
    ]


def fixed_values(arguments: argparse.Namespace) -> dict[str, float]:
    """What --set fixes, by parameter name (SI).

    Raises
    ------
    InputError
        Not a number.
    """
    return _numbers("--set", arguments.set)


def _numbers(option: str, pairs: Sequence[tuple[str, str]]) -> dict[str, float]:
    from jointid.base.errors import InputError

    numbers: dict[str, float] = {}
    for name, value in pairs:
        number = number_or_text(value)
        if isinstance(number, str):
            raise InputError(f"{option} {name}={value}: '{value}' is not a number")
        numbers[name] = float(number)
    return numbers


def check_outputs(arguments: argparse.Namespace) -> None:
    """Refuse before the work, not after it, what cannot be written.

    Raises
    ------
    InputError
        Another extension than .toml or .json, or a folder that does not exist.
    """
    from jointid.base.errors import InputError

    save = arguments.save
    if save is not None and save.suffix not in (".toml", ".json"):
        raise InputError(f"--save {save}: an estimate is saved as .toml (joint file) or .json")
    check_folder("--save", save)
    check_page("--report", arguments.report)


_READ = (
    *("recordings", "recording", "joint", "estimate"),
    *("simulate", "believe", "trajectory", "resume"),
)
_WRITTEN = ("output", "report", "table", "plot", "checkpoint", "save")
# Going on where a file ends, and a joint file that keeps its words, are meant.
_MEANT = {("resume", "checkpoint"), ("joint", "save")}


def check_distinct(arguments: argparse.Namespace) -> None:
    """Refuse to write over what is read.

    Raises
    ------
    InputError
        An output is one of the inputs.
    """
    from jointid.base.errors import InputError

    for written in _WRITTEN:
        output = getattr(arguments, written, None)
        if not isinstance(output, Path):
            continue
        for read in _READ:
            given = getattr(arguments, read, None)
            for path in given if isinstance(given, list) else [given]:
                if not isinstance(path, str | Path) or (read, written) in _MEANT:
                    continue
                if Path(path).is_file() and output.exists() and output.samefile(path):
                    raise InputError(
                        f"--{written} {output}: this is read as well, and would be written over; give another name"
                    )


def check_page(option: str, path: Path | None) -> None:
    """Refuse a page that is no .html, or in a folder that does not exist.

    Raises
    ------
    InputError
        Another extension, or no such folder.
    """
    from jointid.base.errors import InputError

    if path is not None and path.suffix.lower() not in (".html", ".htm"):
        raise InputError(f"{option} {path}: a report is a page, .html")
    check_folder(option, path)


def check_folder(option: str, path: Path | None) -> None:
    """Refuse a file to be written in a folder that does not exist.

    Raises
    ------
    InputError
        There is no such folder.
    """
    from jointid.base.errors import InputError

    if path is not None and not path.parent.is_dir():
        raise InputError(f"{option} {path}: the folder {path.parent} does not exist")
