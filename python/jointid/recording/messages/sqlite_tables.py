"""Checks of the tables of a ROS 2 bag in SQLite, so that a small file cannot fill the memory."""

import sqlite3
from collections.abc import Sequence

from jointid.recording.messages.topic import DamageError

_READ = {
    "topics": ("id", "name", "type", "serialization_format"),
    "messages": ("topic_id", "timestamp"),  # message data are read one by one
    "message_definitions": ("topic_type", "encoding", "encoded_message_definition"),
}
_LONGEST_DEFAULT = 1000  # characters


def check_tables(connection: sqlite3.Connection, size: int) -> None:
    """Refuse tables that SQLite could expand to any number of rows of any size.

    Parameters
    ----------
    connection : sqlite3.Connection
    size : int
        Size of the file in bytes.

    Raises
    ------
    DamageError
        A table is a view, has computed columns, or holds more than the file.
    sqlite3.Error
        The file is damaged.
    """
    for name, read in _READ.items():
        other = connection.execute(
            "SELECT COUNT(*) FROM sqlite_master WHERE name = ? COLLATE NOCASE "
            "AND type IN ('table', 'view') AND NOT (type = 'table' AND rootpage > 0)",
            (name,),
        )
        # Each row that ends before a column gets the column's default.
        computed, long = connection.execute(
            "SELECT SUM(hidden <> 0), SUM(length(dflt_value) > ?) FROM pragma_table_xinfo(?)",
            (_LONGEST_DEFAULT, name),
        ).fetchone()
        if other.fetchone()[0] or computed:
            raise DamageError(f"it is not a ROS 2 bag: {name} is not a plain table")
        if long:
            raise DamageError(
                f"a column of {name} has a default of more than {_LONGEST_DEFAULT} characters"
            )
        for column in _passed_over(connection, name, read):
            held = 0
            sizes = connection.execute(  # the size of a blob is known without reading it
                f"SELECT CASE typeof({column}) WHEN 'blob' THEN length({column}) "
                f"WHEN 'text' THEN length(CAST({column} AS BLOB)) ELSE 0 END FROM {name} NOT INDEXED"
            )
            for (each,) in sizes:
                held += each
                if held > size:
                    raise DamageError(
                        f"column {column} of {name}, before {read[-1]!r}, holds more bytes than the file"
                    )


def _passed_over(connection: sqlite3.Connection, table: str, read: Sequence[str]) -> list[str]:
    """Return the unread columns before the last one that is read; a bag of ROS 2 has none.

    To reach a column behind a long value, SQLite follows the value's pages, which the limit on steps does not count.
    """
    columns = [
        name
        for (name,) in connection.execute("SELECT lower(name) FROM pragma_table_xinfo(?)", (table,))
    ]
    last = max((k for k, name in enumerate(columns) if name in read), default=0)
    quoted = ('"' + name.replace('"', '""') + '"' for name in columns[:last] if name not in read)
    return [name for name in quoted if not _is_row_number(connection, table, name)]


def _is_row_number(connection: sqlite3.Connection, table: str, column: str) -> bool:
    """Whether a column is an alias of the row number, and so holds no other value."""
    code = {step[1] for step in connection.execute(f"EXPLAIN SELECT {column} FROM {table}")}
    return "Column" not in code and not code.isdisjoint({"Rowid", "IdxRowid"})
