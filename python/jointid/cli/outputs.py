"""Outputs of a command, checked before its work, not after it."""

from __future__ import annotations

import argparse
import errno
import os
from pathlib import Path

from jointid.base.errors import InputError
from jointid.base.files import new_beside


def estimate_file(arguments: argparse.Namespace) -> Path | None:
    """Return the .json file that a command writes its estimate to: the one of `--save`, or one with the report."""
    save, page = (getattr(arguments, name, None) for name in ("save", "report"))
    if isinstance(save, Path) and save.suffix == ".json":
        return save
    if not isinstance(page, Path):
        return None
    name = "estimate" if page.stem == "report" else f"{page.stem}_estimate"
    return page.with_name(f"{name}.json")


def say_written(**files: Path | None) -> None:
    """Say in one line which files were written, by what they are."""
    written = [
        f"{kind.replace('_', ' ')}: {path}" for kind, path in files.items() if path is not None
    ]
    if written:
        print("   ".join(written))


def check_outputs(arguments: argparse.Namespace) -> None:
    """Refuse before the work, not after it, what cannot be written.

    Raises
    ------
    InputError
        Another extension than .toml or .json, or a folder that does not exist.
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
# Continuing a search in its own file, and updating a joint file, are intended; but values of an
# emulated joint do not belong into the file of the real one.
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
                        "the command reads this file and would overwrite it; give another name",
                        argument=written,
                        value=output,
                    )


def check_page(argument: str, path: Path | None) -> None:
    """Refuse a page of a format that is not written, or in a folder that does not exist.

    Raises
    ------
    InputError
        Another extension, or no such folder.
    """
    if path is not None and not path.is_dir():
        from jointid.report.renderers import ending_of_page

        ending_of_page(argument, path)
    check_folder(argument, path)


def check_folder(argument: str, path: Path | None) -> None:
    """Refuse a file to be written in a folder that does not exist, or takes no files.

    Raises
    ------
    InputError
        There is no such folder, or nothing can be written in it.
    """
    if path is None:
        return
    if not path.parent.is_dir():
        raise InputError(f"the folder {path.parent} does not exist", argument=argument, value=path)
    if path.exists():
        return
    try:  # the permissions alone do not tell: some folders take no files from anybody
        handle, tried = new_beside(path)
        try:
            os.close(handle)
        finally:
            tried.unlink()
    except OSError as error:
        # In such a folder "no such file" is meant of the file to be written.
        reason = f" ({error.strerror})" if error.strerror and error.errno != errno.ENOENT else ""
        raise InputError(
            f"nothing can be written in the folder {path.parent}{reason}",
            argument=argument,
            value=path,
            remedy="give another name",
        ) from error


def check_output_folder(argument: str, path: Path) -> None:
    """Refuse a folder to be made that is a file, or in a folder that does not exist.

    Raises
    ------
    InputError
        A file, or no such folder.
    """
    if path.exists() and not path.is_dir():
        raise InputError("this is a file; a folder is expected", argument=argument, value=path)
    check_folder(argument, path)


def check_recording_file(argument: str, path: Path | None) -> None:
    """Refuse a file that is none of a recording's, or in a folder that does not exist.

    Raises
    ------
    InputError
        Another extension, or no such folder.
    """
    if path is not None and not path.name.lower().endswith((".csv", ".csv.gz", ".npz")):
        raise InputError(
            "a recording is written as .csv, .csv.gz or .npz", argument=argument, value=path
        )
    check_folder(argument, path)
