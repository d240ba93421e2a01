"""Writer of samples and raw frames: a thread puts them on the disk as they arrive."""

from __future__ import annotations

import json
import queue
import threading
import time
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from jointid.base.errors import InputError
from jointid.base.files import sync_folder
from jointid.hardware.session.appended_file import AppendedFile, Syncing
from jointid.recording.saved import CSV_MARK, SCHEMA
from jointid.recording.truncated import CLOSING, OPENING

COLUMNS = (
    "time_s",
    "position_rad",
    "torque_Nm",
    "sensor_raw",
    "reference_rad",
    "current_A",
    "late_cycles",
)
_FLUSH = 0.02  # [s]; about the time that is lost if the program is killed
_SYNC = 0.25  # [s]; with the time of a slow disk, less than a second is lost at a power failure

Frame = tuple[float, int, bytes, bool, bool, bool]  # last: whether sent, CAN FD, 29 bits


def check_output(path: Path) -> None:
    """Check that a session's files can be created.

    Raises
    ------
    InputError
        A file exists, the folder does not exist, or the name does not end in .csv.
    """
    if path.suffix != ".csv":
        raise InputError("a session writes .csv", argument="output", value=str(path))
    if not path.parent.is_dir():
        raise InputError(
            "the folder of this file does not exist", argument="output", value=str(path)
        )
    for each in (path, path.with_suffix(".log")):
        if each.exists():
            raise InputError(
                "the file exists, and a session does not overwrite files",
                argument="output",
                value=str(each),
            )


class Recorder:
    """Thread that appends to a recording's file, and to a log of frames next to it (candump's format).

    The session's loop only puts items into a queue. This thread writes them.

    Parameters
    ----------
    path : Path
        Path of the recording, .csv; the frames go to the same name with .log.
    metadata : mapping
        Metadata of the recording; JSON.
    name : str

    Raises
    ------
    InputError
        A file exists, or the folder does not exist.
    OSError
        The files cannot be written.
    """

    def __init__(self, path: Path, metadata: Mapping[str, Any], name: str = "") -> None:
        check_output(path)
        self.path, self.log = path, path.with_suffix(".log")
        attributes = {
            "schema": SCHEMA,
            "grown": True,
            "name": name,
            "kind": "revolute",
            "torque_hold": "zoh",
            "velocity_derived": True,
            "metadata": {**metadata, "session": True},
            "truth": None,
        }
        header = f"{CSV_MARK}{json.dumps(attributes)}\n{','.join(COLUMNS)}\n".encode()
        self._rows, self._frames = _created(self.path, self.log, header)
        self._queue: queue.SimpleQueue[Sequence[float] | Frame | Mapping[str, Any] | None] = (
            queue.SimpleQueue()
        )
        self._failure: Exception | None = None
        self._ending: Mapping[str, Any] | None = None
        self._syncing = Syncing((self._frames, self._rows), _SYNC)
        self._thread = threading.Thread(target=self._write, name="recorder", daemon=True)
        self._thread.start()

    def begin(self, notes: Mapping[str, Any]) -> None:
        """Write the data that is known when the run begins above the first row; JSON."""
        self._queue.put(notes)

    def sample(self, row: Sequence[float]) -> None:
        """Keep a row of `COLUMNS`."""
        self._queue.put(row)

    def frame(
        self,
        when: float,
        identifier: int,
        payload: bytes,
        sent: bool,
        *,
        fd: bool = False,
        extended: bool = False,
    ) -> None:
        """Keep a frame: the arguments of a drive's `tap`."""
        self._queue.put((when, identifier, payload, sent, fd, extended))

    def close(self, ending: Mapping[str, Any] | None = None) -> None:
        """Write the rest. Afterwards everything is on the disk.

        Parameters
        ----------
        ending : mapping, optional
            How the session ended; JSON. It becomes the last line of the same file, as a comment. Written lines do not
            change, and no second file can get lost. Without it the file counts as truncated.

        Raises
        ------
        OSError
            The file could not be written.
        Exception
            A bug in the writing thread.
        """
        if self._thread.is_alive():
            self._ending = ending
            self._queue.put(None)
            self._thread.join()
        if self.failure is not None:
            raise self.failure

    @property
    def failure(self) -> Exception | None:
        """Error of the writing thread, e.g. a full disk; None without an error."""
        return self._failure if self._failure is not None else self._syncing.failure

    def _write(self) -> None:
        files = (self._frames, self._rows)
        try:
            running = True
            while running:
                running = self._write_waiting()
            if self._ending is not None:
                self._rows.append(f"{CLOSING}{json.dumps(self._ending)}\n".encode())
            self._syncing.close()
            for file in files:
                file.sync()
        except Exception as error:  # an OSError, or a bug; the session's loop raises it
            self._failure = error
        finally:
            self._syncing.close()
            for file in files:
                try:
                    file.close()
                except OSError as error:  # some network file systems report their errors here
                    self._failure = self._failure or error

    def _write_waiting(self) -> bool:
        """Write the items that arrive within a short time. Return whether more may follow."""
        rows, frames = [], []
        running, end = True, time.monotonic() + _FLUSH
        while running and (left := end - time.monotonic()) > 0.0:
            try:
                item = self._queue.get(timeout=left)
            except queue.Empty:
                break
            if item is None:
                running = False
            elif isinstance(item, Mapping):
                rows.append(f"{OPENING}{json.dumps(dict(item))}\n".encode())
            elif isinstance(item[2], bytes):
                frames.append(_line(item))  # type: ignore[arg-type]
            else:
                rows.append((",".join(map(repr, item)) + "\n").encode())
        # Whole lines are written in one piece, so that a killed program leaves no partial line. The frames come first,
        # because the recording can be computed from them.
        self._frames.append(b"".join(frames))
        self._rows.append(b"".join(rows))
        return running


def _created(path: Path, log: Path, header: bytes) -> tuple[AppendedFile, AppendedFile]:
    """Return a session's two files, created on the disk. If one fails, none is left."""
    made: list[AppendedFile] = []
    try:
        made.append(AppendedFile(path))
        made.append(AppendedFile(log))
        rows, frames = made
        rows.append(header)
        rows.sync()
        frames.sync()
        sync_folder(path.parent)
    except OSError:
        for file in made:
            with suppress(OSError):
                file.close()
            file.path.unlink(missing_ok=True)
        raise
    return rows, frames


def _line(frame: Frame) -> bytes:
    """Return a line of candump: identifier of 3 digits, or 8 for 29 bits; "##" and flags for CAN FD."""
    when, identifier, payload, sent, fd, extended = frame
    side = "T" if sent else "R"
    digits = f"{identifier:08X}" if extended else f"{identifier:03X}"
    mark = "##1" if fd else "#"  # 1: the data have their own bit rate
    return f"({when:.9f}) can0 {digits}{mark}{payload.hex().upper()} {side}\n".encode()
