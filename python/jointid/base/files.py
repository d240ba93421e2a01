"""Writing a file completely or not at all."""

import errno
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from io import FileIO
from pathlib import Path

from jointid.base.errors import InputError

_NO_LINKS = (errno.EPERM, errno.EOPNOTSUPP, errno.ENOTSUP, errno.ENOSYS, errno.EMLINK)
_LONGEST = 50  # characters of a name that a temporary file's name keeps, to remain a valid name


def write_whole(path: Path, content: bytes) -> None:
    """Write a file so that a reader always finds the old or the new file, never a part, even after a crash.

    Parameters
    ----------
    path : Path
        An existing file is replaced. For a symbolic link the target is replaced, and the link stays.
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
        _require_folder(folder, path)
    if target.is_dir():
        raise IsADirectoryError(
            errno.EISDIR, "this is a folder; a file name is expected", str(path)
        )
    mode = target.stat().st_mode & 0o7777 if target.exists() else 0o666 & ~_umask()
    with _named(path):
        _put(target, content, mode, Path.replace)


def write_new(path: Path, content: bytes) -> None:
    """Write a new file completely or not at all, even after a crash.

    Parameters
    ----------
    path : Path
    content : bytes

    Raises
    ------
    InputError
        The folder does not exist.
    FileExistsError
        The file exists; it is unchanged.
    OSError
        The folder cannot be written; the error names the path.
    """
    _require_folder(path.parent, path)
    with _named(path):
        _put(path, content, 0o666 & ~_umask(), _link)


def make_folder(path: Path) -> None:
    """Make a folder and its missing parents; on return their names are on the disk.

    Otherwise a power failure may remove the folder with all files in it.

    Raises
    ------
    OSError
        The path is a file, or the folder cannot be made.
    """
    missing = [each for each in (path, *path.parents) if not each.exists()]
    path.mkdir(parents=True, exist_ok=True)
    for each in missing:
        sync_folder(each.parent)


def open_locked(path: Path) -> FileIO:
    """Open a file to read and write, unbuffered and locked: no other call can open it until it is closed.

    The file is created if it does not exist. The lock ends with the program, even after a crash. Windows has no
    such locks.

    Raises
    ------
    InputError
        Another program, or another part of this one, has the file open.
    OSError
        The file cannot be opened.
    """
    file = FileIO(os.open(path, os.O_RDWR | os.O_CREAT | getattr(os, "O_BINARY", 0), 0o666), "r+")
    try:
        import fcntl

        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except ModuleNotFoundError:
        return file
    except OSError as error:
        if error.errno not in (errno.EWOULDBLOCK, errno.EACCES):
            return file  # a file system without locks, such as some network drives
        file.close()
        raise InputError(
            "another program is writing this file",
            place=str(path),
            remedy=("wait until it ends", "write another file"),
        ) from None
    return file


def new_beside(target: Path) -> tuple[int, Path]:
    """Make an empty, hidden file next to the target, named after it, that only this user may read.

    It replaces `tempfile.mkstemp`, because that import takes a tenth of numpy's import time.

    Returns
    -------
    int
        Descriptor of the new file, open to read and write; the caller closes it.
    Path
        Path of the new file; the caller removes or renames it.

    Raises
    ------
    OSError
        The folder does not accept new files.
    """
    flags = os.O_RDWR | os.O_CREAT | os.O_EXCL
    for flag in ("O_NOFOLLOW", "O_BINARY", "O_NOINHERIT"):
        flags |= getattr(os, flag, 0)
    while True:
        path = target.parent / f".{target.name[:_LONGEST]}.{os.urandom(6).hex()}"
        with suppress(FileExistsError):
            return os.open(path, flags, 0o600), path


def _require_folder(folder: Path, path: Path) -> None:
    if not folder.is_dir():
        raise InputError(
            f"the folder '{folder}' does not exist", place=str(path), remedy="create it first"
        )


@contextmanager
def _named(path: Path) -> Iterator[None]:
    """Let an error name the file instead of the temporary file."""
    try:
        yield
    except OSError as error:
        if error.errno is None:  # the error has its own message
            raise
        raise OSError(error.errno, error.strerror, str(path)) from error


def _link(temporary: Path, target: Path) -> None:
    """Give a file its name, unless the name is taken."""
    try:
        os.link(temporary, target)
    except FileExistsError:
        raise
    except OSError as error:  # some file systems have no hard links
        if error.errno not in _NO_LINKS:
            raise
        if os.path.lexists(target):
            raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST)) from None
        temporary.replace(target)
    else:
        temporary.unlink()


def _put(target: Path, content: bytes, mode: int, name: Callable[[Path, Path], object]) -> None:
    """Write a temporary file next to the target, then give it the target's name."""
    handle, temporary = new_beside(target)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        temporary.chmod(mode)
        name(temporary, target)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise
    sync_folder(target.parent)


def sync_folder(folder: Path) -> None:
    """Write a folder's new entries to the disk, if the system supports it.

    Before that, a power failure may remove the name of a new or renamed file.
    """
    with suppress(OSError):
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
