"""Outputs of a command, checked before its work."""

from __future__ import annotations

import argparse
import errno
import os
from pathlib import Path

from jointid.base.errors import InputError
from jointid.base.files import new_beside


def estimate_file(arguments: argparse.Namespace) -> Path | None:
    """Return the .json file for the estimate of a command: that of `--save`, or one next to the report."""
    save, page = (getattr(arguments, name, None) for name in ("save", "report"))
    if isinstance(save, Path) and save.suffix == ".json":
        return save
    if not isinstance(page, Path):
        return None
    name = "estimate" if page.stem == "report" else f"{page.stem}_estimate"
    return page.with_name(f"{name}.json")


def say_written(**files: Path | None) -> None:
    """Print the written files in one line, each with its kind."""
    written = [
        f"{kind.replace('_', ' ')}: {path}" for kind, path in files.items() if path is not None
    ]
    if written:
        print("   ".join(written))


def check_outputs(arguments: argparse.Namespace) -> None:
    """Refuse outputs that cannot be written, before the work.

    Raises
    ------
    InputError
        An extension is not .toml or .json, or a folder does not exist.
    """
    save = arguments.save
    if save is not None and save.suffix not in (".toml", ".json"):
        raise InputError(
            "an estimate is saved as .toml (joint file) or .json", argument="save", value=save
        )
    check_folder("save", save)
    check_page("report", arguments.report)


_READ = (
    *("recordings", "recording", "joint", "estimate"),
    *("simulate", "believe", "trajectory", "resume"),
    *("source", "into"),
)
_WRITTEN = ("output", "report", "table", "plot", "checkpoint", "save", "to")
# A search may continue in its own file, and a joint file may be updated. But values of an emulated joint do not
# belong in the file of the real one.
_INTENDED = {("resume", "checkpoint"), ("joint", "save"), ("into", "to")}


def check_distinct(arguments: argparse.Namespace) -> None:
    """Refuse to overwrite an input.

    Raises
    ------
    InputError
        An output is one of the inputs.
    """
    for written in _WRITTEN:
        output = getattr(arguments, written, None)
        if not isinstance(output, Path):
            continue
        for read in _READ:
            inputs = getattr(arguments, read, None)
            for path in inputs if isinstance(inputs, list) else [inputs]:
                if not isinstance(path, str | Path):
                    continue
                if (read, written) in _INTENDED and not getattr(arguments, "emulate", False):
                    continue
                if Path(path).is_file() and output.exists() and output.samefile(path):
                    raise InputError(
                        "the command reads this file and cannot overwrite it; give another name",
                        argument=written,
                        value=output,
                    )


def check_page(argument: str, path: Path | None) -> None:
    """Refuse a page with an unknown format, or in a folder that does not exist.

    Raises
    ------
    InputError
        The extension is not supported, or the folder does not exist.
    """
    if path is not None and not path.is_dir():
        from jointid.report.renderers import ending_of_page

        ending_of_page(argument, path)
    check_folder(argument, path)


def check_folder(argument: str, path: Path | None) -> None:
    """Refuse a file in a folder that does not exist or in which no file can be written.

    Raises
    ------
    InputError
        The folder does not exist, or nothing can be written in it.
    """
    if path is None:
        return
    if not path.parent.is_dir():
        raise InputError(f"the folder {path.parent} does not exist", argument=argument, value=path)
    if path.exists():
        return
    try:  # permissions are not enough: some folders accept no files
        handle, tried = new_beside(path)
        try:
            os.close(handle)
        finally:
            tried.unlink()
    except OSError as error:
        # In such a folder, "no such file" refers to the file to be written.
        reason = f" ({error.strerror})" if error.strerror and error.errno != errno.ENOENT else ""
        raise InputError(
            f"no file can be written in the folder {path.parent}{reason}",
            argument=argument,
            value=path,
            remedy="give another name",
        ) from error


def check_output_folder(argument: str, path: Path) -> None:
    """Refuse a new folder if its name is a file's, or if its parent folder does not exist.

    Raises
    ------
    InputError
        The name is a file's, or the parent folder does not exist.
    """
    if path.exists() and not path.is_dir():
        raise InputError("this is a file; a folder is expected", argument=argument, value=path)
    check_folder(argument, path)


def check_recording_file(argument: str, path: Path | None) -> None:
    """Refuse a file without an extension of a recording, or in a folder that does not exist.

    Raises
    ------
    InputError
        The extension is not supported, or the folder does not exist.
    """
    if path is not None and not path.name.lower().endswith((".csv", ".csv.gz", ".npz")):
        raise InputError(
            "a recording is written as .csv, .csv.gz or .npz", argument=argument, value=path
        )
    check_folder(argument, path)
