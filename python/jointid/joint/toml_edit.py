"""Edits of a TOML document that preserve comments, order and layout."""

from collections.abc import Collection, Mapping
from typing import Any


def update_table(
    parts: list[Any],
    wanted: Mapping[str, Any],
    defaults: Mapping[str, Any],
    *,
    kept: Collection[str] = (),
    inline: bool,
) -> None:
    """Change the entries of a tomlkit table that differ from the wanted values.

    Parameters
    ----------
    parts : list
        Parts of the table; other tables may be between them.
    wanted : mapping
        New keys and values.
    defaults : mapping
        Default values, which are not added.
    kept : collection of str
        Further keys that are not removed. Default: none.
    inline : bool
        Whether new tables are inline.
    """
    for part in parts:
        for key in [key for key in part if key not in wanted and key not in kept]:
            _remove(part, key)
    for key, value in wanted.items():
        part = next((part for part in parts if key in part), None)
        usual = defaults.get(key, {})
        if part is None:
            if value != usual:
                _add(parts[-1], key, _entries(value, usual, inline))
        elif isinstance(value, Mapping) and isinstance(part[key], Mapping):
            inner = [table for whole in parts for table in _parts(whole, key)]
            update_table(inner, value, usual, inline=inline)
        else:
            fixed = isinstance(value, Mapping) and not value.keys() - {"value", "vary"}
            if fixed and value["vary"] is False:
                value = value["value"]  # a number without a table fixes a parameter
            if part[key] != value:
                part[key] = _entries(value, usual, inline)


def _entries(value: Any, defaults: Any, inline: bool) -> Any:
    """Return a value for a tomlkit table, without entries equal to defaults."""
    import tomlkit

    if not isinstance(value, Mapping):
        return value
    written = {
        key: _entries(entry, defaults.get(key, {}), inline)
        for key, entry in value.items()
        if entry != defaults.get(key, {})
    }
    if not inline:
        return written
    table = tomlkit.inline_table()
    table.update(written)
    return table


def _body(table: Any) -> list[Any]:
    """Return keys, comments and blank lines of a tomlkit document or table as (key, item)."""
    from tomlkit.container import Container

    body: list[Any] = (table if isinstance(table, Container) else table.value).body
    return body


def _parts(table: Any, key: str) -> list[Any]:
    """Return the parts of an inner table; other tables may be between them."""
    from tomlkit.items import Table

    found = [item for name, item in _body(table) if name is not None and name.key == key]
    blocks = [item for item in found if isinstance(item, Table)]
    return blocks or found


def _add(table: Any, key: str, value: Any) -> None:
    """Add a new key after the last one, before the comments that belong to the following table."""
    from tomlkit.items import Table

    if isinstance(table, Table):
        body = _last_body(table)
        start = _tail_start(body)
        tail = body[start:]
        del body[start:]
        table[key] = value
        _last_body(table).extend(tail)
        return
    first = next((item for _, item in _body(table) if isinstance(item, Table)), None)
    indent = first.trivia.indent if first else ""
    table[key] = value
    if first is None or isinstance(value, Mapping):
        return
    # tomlkit adds a key directly before the first table, with a blank line after it.
    first.trivia.indent = indent
    body = _body(table)
    at = [name and name.key for name, _ in body].index(key)
    body.insert(_tail_start(body[:at]), body.pop(at))


def _remove(table: Any, key: str) -> None:
    """Remove a key or a table; comments after a table's last key stay, because they belong to the next."""
    from tomlkit.items import Table, Whitespace

    body = _body(table)
    tails = {}
    for slot, (name, item) in enumerate(body):
        if name is not None and name.key == key and isinstance(item, Table):
            last = _last_body(item)
            tails[slot] = "".join(item.as_string() for _, item in last[_tail_start(last) :])
    del table[key]
    for slot, tail in tails.items():
        if "#" in tail:
            body[slot] = (None, Whitespace(tail))


def _last_body(table: Any) -> list[Any]:
    """Return the body of a tomlkit table, or of the last table in it."""
    from tomlkit.items import Table

    body = _body(table)
    keyed = [item for name, item in body if name is not None]
    return _last_body(keyed[-1]) if keyed and isinstance(keyed[-1], Table) else body


def _tail_start(body: list[Any]) -> int:
    """Return the index at which the comments and blank lines after the last key begin."""
    return max((index + 1 for index, (name, _) in enumerate(body) if name is not None), default=0)
