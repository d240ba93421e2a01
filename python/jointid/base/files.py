"""Writing a file completely or not at all."""

import errno
import os
import tempfile
from pathlib import Path


def write_whole(path: Path, content: bytes) -> None:
    """Write a file so that a reader, or a crash, finds the old one or the new one, never a part.

    Parameters
    ----------
    path : Path
        Replaced when it exists; a symbolic link's target is replaced, the link stays.
    content : bytes

    Raises
    ------
    OSError
        The path is a folder, or its folder does not exist or cannot be written. The old file is
        unchanged.
    """
    target = path.resolve()
    if target.is_dir():
        raise IsADirectoryError(
            errno.EISDIR, "this is a folder; a file name is expected", str(path)
        )
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
