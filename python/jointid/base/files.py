"""Writing a file completely or not at all."""

import errno
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from io import FileIO
from pathlib import Path

from jointid.base.errors import InputError

_NO_LINKS = (errno.EPERM, errno.EOPNOTSUPP, errno.ENOTSUP, errno.ENOSYS, errno.EMLINK)
_LONGEST = 50  # characters of a name in that of a file beside it: the whole must be a name, too


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
        _require_folder(folder, path)
    if target.is_dir():
        raise IsADirectoryError(
            errno.EISDIR, "this is a folder; a file name is expected", str(path)
        )
    mode = target.stat().st_mode & 0o7777 if target.exists() else 0o666 & ~_umask()
    with _named(path):
        _put(target, content, mode, Path.replace)


def write_new(path: Path, content: bytes) -> None:
    """Write a file that does not exist yet; there is the whole of it or nothing, also after a crash.

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
    """Make a folder, and those above it that are missing; on return their names are on the disk.

    Without that, everything in it may go with the power, however safe the files are.

    Raises
    ------
    OSError
        It is a file, or cannot be made.
    """
    missing = [each for each in (path, *path.parents) if not each.exists()]
    path.mkdir(parents=True, exist_ok=True)
    for each in missing:
        sync_folder(each.parent)


def open_locked(path: Path) -> FileIO:
    """Open a file to read and write, without a buffer; nobody else can open it so until it is closed.

    It is made if it does not exist.

    The lock ends with the program, however it ends. Systems without such locks (Windows) have none.

    Raises
    ------
    InputError
        Another program, or another part of this one, has it open.
    OSError
        It cannot be opened.
    """
    file = FileIO(os.open(path, os.O_RDWR | os.O_CREAT | getattr(os, "O_BINARY", 0), 0o666), "r+")
    try:
        import fcntl

        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except ModuleNotFoundError:
        return file
    except OSError as error:
        if error.errno not in (errno.EWOULDBLOCK, errno.EACCES):
            return file  # a file system without locks, such as some of a network
        file.close()
        raise InputError(
            "another program is writing this file",
            place=str(path),
            remedy=("wait until it ends", "write another file"),
        ) from None
    return file


def new_beside(target: Path) -> tuple[int, Path]:
    """Make an empty file in a file's folder that only this user may read, hidden and named after it.

    It is what `tempfile.mkstemp` does, whose import takes as long as a tenth of numpy's.

    Returns
    -------
    int
        Descriptor of the new file, open to read and write; the caller closes it.
    Path
        Its path; the caller removes or renames it.

    Raises
    ------
    OSError
        The folder takes no files.
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
    """Let an error name the file, not the one beside it, which nobody knows."""
    try:
        yield
    except OSError as error:
        if error.errno is None:  # a message of its own
            raise
        raise OSError(error.errno, error.strerror, str(path)) from error


def _link(temporary: Path, target: Path) -> None:
    """Give a file its name, unless that is taken."""
    try:
        os.link(temporary, target)
    except FileExistsError:
        raise
    except OSError as error:  # some file systems have no second names
        if error.errno not in _NO_LINKS:
            raise
        if os.path.lexists(target):
            raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST)) from None
        temporary.replace(target)
    else:
        temporary.unlink()


def _put(target: Path, content: bytes, mode: int, name: Callable[[Path, Path], object]) -> None:
    """Write a file beside its place, and then let it be named."""
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
    """Write a folder's new entries to the disk, where the system can do that.

    A file that was made or renamed may lose its name with the power before that.
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
