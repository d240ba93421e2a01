"""An SQLite file that is read within limits and never changed, not even by SQLite's own recovery."""

import sqlite3
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

from jointid.base.error_text import reason_of

# Limits on steps of SQLite's machine. A row takes some 30 steps, and more than 12 bytes.
_STEPS, _STEPS_A_BYTE, _STEPS_AT_ONCE = 1000, 8, 1000
_LONGEST_STATEMENT, _SCHEMA_STEPS = 20_000, 1000  # of a schema; a bag's takes 60 steps
_UNFINISHED = b"\xd9\xd5\x05\xf9\x20\xa1\x63\xd7"  # start of a journal that SQLite would restore


class SqliteFile:
    """An SQLite file.

    Parameters
    ----------
    path : Path

    Attributes
    ----------
    size : int
        Size in bytes.
    incomplete : str
        Description of the log or journal that a killed recorder left next to the file; otherwise empty. It is not
        read: a log of another state of the file would remove messages. A journal may name any file, and
        SQLite would delete that file.

    Raises
    ------
    OSError
        The file cannot be read.
    """

    def __init__(self, path: Path) -> None:
        path.open("rb").close()  # for an unreadable file this error says more than SQLite's
        self._path = path.resolve()
        self.size = path.stat().st_size
        self.incomplete = _left_beside(self._path)
        self._exhausted = False

    def connected(self) -> sqlite3.Connection:
        """Return a new connection.

        Raises
        ------
        sqlite3.Error
            The file is not an SQLite file. Later: it is damaged, or a query takes far too long.
        """
        connection = sqlite3.connect(f"{self._path.as_uri()}?mode=ro&immutable=1", uri=True)
        try:
            # No value in a table is larger than the file; SQLite's own texts may be.
            longest = min(max(self.size, 1_000_000), 1_000_000_000)
            connection.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, longest)
            # SQLite parses each statement of the schema, and there may be any number of them.
            before = connection.setlimit(sqlite3.SQLITE_LIMIT_SQL_LENGTH, _LONGEST_STATEMENT)
            schema = iter(range(_SCHEMA_STEPS // 100))
            connection.set_progress_handler(lambda: self._ends(schema), 100)
            connection.execute("SELECT COUNT(*) FROM sqlite_master")
            connection.setlimit(sqlite3.SQLITE_LIMIT_SQL_LENGTH, before)
            # Pages that refer to each other give an endless number of rows.
            steps = iter(range(_STEPS + self.size * _STEPS_A_BYTE // _STEPS_AT_ONCE))
            connection.set_progress_handler(lambda: self._ends(steps), _STEPS_AT_ONCE)
        except BaseException:
            connection.close()
            raise
        return connection

    def _ends(self, steps: Iterator[int]) -> bool:
        self._exhausted = next(steps, None) is None
        return self._exhausted

    def reason(self, error: Exception) -> str:
        """Return why the file cannot be read, and what a killed recorder left next to it.

        Raises
        ------
        KeyboardInterrupt
            Ctrl-C stopped SQLite.
        """
        code = getattr(error, "sqlite_errorcode", None)
        # SQLite hides the exception of our progress function.
        if code == sqlite3.SQLITE_INTERRUPT and not self._exhausted:
            raise KeyboardInterrupt
        return "; ".join(filter(None, (reason_of(error), self.incomplete)))


def _left_beside(path: Path) -> str:
    log, journal = (path.with_name(f"{path.name}-{each}") for each in ("wal", "journal"))
    with suppress(OSError):
        if log.stat().st_size:
            return (
                f"its last messages may be in {log.name}, which is not read. To merge the two files, "
                "copy both and open the copied bag with SQLite"
            )
    with suppress(OSError), journal.open("rb") as file:
        if file.read(len(_UNFINISHED)) == _UNFINISHED:
            return f"its last write was not finished; jointid does not restore the earlier content from {journal.name}"
    return ""
