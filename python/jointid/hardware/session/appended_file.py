"""New file to which blocks are only appended, and the thread that writes such files from memory to the disk."""

from __future__ import annotations

import os
import threading
from collections.abc import Sequence
from pathlib import Path

_NEW = os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_APPEND | getattr(os, "O_BINARY", 0)


class AppendedFile:
    """New file. Appended blocks survive the end of this program, whatever the cause of the end.

    Parameters
    ----------
    path : Path

    Raises
    ------
    OSError
        The file exists, or cannot be created.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.descriptor = os.open(path, _NEW, 0o644)

    def append(self, block: bytes) -> None:
        """Write a block, in one piece if the system accepts it.

        Raises
        ------
        OSError
        """
        while block:
            block = block[os.write(self.descriptor, block) :]

    def sync(self) -> None:
        """Wait until everything is on the disk.

        Raises
        ------
        OSError
        """
        os.fsync(self.descriptor)

    def close(self) -> None:
        """Close the file; call it only once."""
        os.close(self.descriptor)


class Syncing:
    """Thread that writes files to the disk repeatedly. A slow disk does not delay the session.

    Parameters
    ----------
    files : sequence of AppendedFile
    interval : float
        Time between two writes [s].
    """

    def __init__(self, files: Sequence[AppendedFile], interval: float) -> None:
        self._files, self._interval = files, interval
        self._ending = threading.Event()
        self.failure: OSError | None = None
        self._thread = threading.Thread(target=self._run, name="recorder disk", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Ask the thread to end. It may still be writing."""
        self._ending.set()
        self._thread.join()

    def _run(self) -> None:
        try:
            while not self._ending.wait(self._interval):
                for file in self._files:
                    file.sync()
        except OSError as error:
            self.failure = error
