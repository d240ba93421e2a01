"""Writing a file completely or not at all."""

import errno
import os
from pathlib import Path

from jointid.base.errors import InputError


def write_whole(path: Path, content: bytes) -> None:
    """Write a file so that a reader, or a crash, finds the old one or the new one, never a part.

    Parameters
    ----------
    path : Path
        Replaced when it exists; a symbolic link's target is replaced, the link stays.
    content : bytes

    Raises
    ------
    InputError
        The folder does not exist.
    OSError
        The path is a folder, or its folder cannot be written; the error names the path. The old
        file is unchanged.
    """
    target = path.resolve()
    for folder in (path.parent, target.parent):
        if not folder.is_dir():
            raise InputError(
                f"the folder '{folder}' does not exist", place=str(path), remedy="create it first"
            )
    if target.is_dir():
        raise IsADirectoryError(
            errno.EISDIR, "this is a folder; a file name is expected", str(path)
        )
    try:
        _replace(target, content)
    except OSError as error:  # it names the temporary file, which nobody knows
        if error.errno is None:  # a message of its own
            raise
        raise OSError(error.errno, error.strerror, str(path)) from error


def _replace(target: Path, content: bytes) -> None:
    import tempfile  # takes as long as a tenth of numpy

    mode = target.stat().st_mode & 0o7777 if target.exists() else 0o666 & ~_umask()
    handle, temporary = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}.")
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        Path(temporary).chmod(mode)
        Path(temporary).replace(target)
    except BaseException:
        Path(temporary).unlink(missing_ok=True)
        raise


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
