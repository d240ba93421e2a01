"""Samples and raw frames on disk as they arrive, written by a thread of their own."""

from __future__ import annotations

import json
import os
import queue
import threading
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, BinaryIO

from jointid.errors import InputError
from jointid.recording.saving import CSV_MARK, SCHEMA
from jointid.recording.torn import CLOSING, OPENING

COLUMNS = (
    "time_s",
    "position_rad",
    "torque_Nm",
    "sensor_raw",
    "reference_rad",
    "current_A",
)
_FLUSH = 0.02  # [s]: more is not lost when the process is killed
_SYNC = 0.5  # [s]: more is not lost with the power

Frame = tuple[float, int, bytes, bool]


def check_output(path: Path) -> None:
    """See that a session's files can be made.

    Raises
    ------
    InputError
        They exist, or the folder does not, or it is no .csv.
    """
    if path.suffix != ".csv":
        raise InputError(f"output {path}: a session writes .csv")
    if not path.parent.is_dir():
        raise InputError(f"output {path}: the folder {path.parent} does not exist")
    for each in (path, path.with_suffix(".log")):
        if each.exists():
            raise InputError(f"output {each} exists; a session overwrites nothing")


class Recorder:
    """Appends to a recording's file, and to a log of frames beside it (candump's format).

    The session's loop only puts things into a queue; this thread writes them.

    Parameters
    ----------
    path : Path
        Of the recording, .csv; the frames go to the same name with .log.
    metadata : mapping
        What the recording says of itself; JSON.
    name : str

    Raises
    ------
    InputError
        The files exist, or the folder does not.
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
        self._rows: BinaryIO = self.path.open("xb")
        self._frames: BinaryIO = self.log.open("xb")
        self._rows.write(f"{CSV_MARK}{json.dumps(attributes)}\n{','.join(COLUMNS)}\n".encode())
        self._queue: queue.SimpleQueue[Sequence[float] | Frame | Mapping[str, Any] | None] = (
            queue.SimpleQueue()
        )
        self._failure: Exception | None = None
        self._ending: Mapping[str, Any] | None = None
        self._thread = threading.Thread(target=self._write, name="recorder", daemon=True)
        self._thread.start()

    def begin(self, notes: Mapping[str, Any]) -> None:
        """Say above the first row what is known when the run begins; JSON."""
        self._queue.put(notes)

    def sample(self, row: Sequence[float]) -> None:
        """Keep a row of `COLUMNS`."""
        self._queue.put(row)

    def frame(self, when: float, identifier: int, payload: bytes, sent: bool) -> None:
        """Keep a frame."""
        self._queue.put((when, identifier, payload, sent))

    def close(self, ending: Mapping[str, Any] | None = None) -> None:
        """Write what is left; everything is on disk then.

        Parameters
        ----------
        ending : mapping, optional
            How the session ended; JSON. It is the last line of the same file, a comment: nothing that was
            written is touched, and there is no second file to lose. Without it the file counts as torn.

        Raises
        ------
        OSError
            It could not be written.
        """
        if self._thread.is_alive():
            self._ending = ending
            self._queue.put(None)
            self._thread.join()
        if self._failure is not None:
            raise self._failure

    @property
    def failure(self) -> Exception | None:
        """What went wrong while writing, e.g. a full disk."""
        return self._failure

    def _write(self) -> None:
        synced = time.monotonic()
        try:
            running = True
            while running:
                running = self._write_waiting()
                if not running and self._ending is not None:
                    self._rows.write(f"{CLOSING}{json.dumps(self._ending)}\n".encode())
                self._rows.flush()
                self._frames.flush()
                if time.monotonic() - synced > _SYNC or not running:
                    os.fsync(self._rows.fileno())
                    os.fsync(self._frames.fileno())
                    synced = time.monotonic()
        except OSError as error:
            self._failure = error
        finally:
            self._rows.close()
            self._frames.close()

    def _write_waiting(self) -> bool:
        """Write what is there after a while; whether there will be more."""
        end = time.monotonic() + _FLUSH
        while (left := end - time.monotonic()) > 0.0:
            try:
                item = self._queue.get(timeout=left)
            except queue.Empty:
                return True
            if item is None:
                return False
            if isinstance(item, Mapping):
                self._rows.write(f"{OPENING}{json.dumps(dict(item))}\n".encode())
            elif isinstance(item[2], bytes):
                self._frames.write(_line(item))  # type: ignore[arg-type]
            else:
                self._rows.write((",".join(map(repr, item)) + "\n").encode())
        return True


def _line(frame: Frame) -> bytes:
    when, identifier, payload, sent = frame
    side = "T" if sent else "R"
    return f"({when:.9f}) can0 {identifier:03X}#{payload.hex().upper()} {side}\n".encode()
