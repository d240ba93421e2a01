"""Changing a TOML document where it differs: comments, order and layout stay."""

from collections.abc import Collection, Mapping
from typing import Any


def update_table(
    parts: list[Any],
    wanted: Mapping[str, Any],
    unsaid: Mapping[str, Any],
    *,
    kept: Collection[str] = (),
    inline: bool,
) -> None:
    """Change a tomlkit table, in one or several parts, where it differs; leave the rest."""
    for part in parts:
        for key in [key for key in part if key not in wanted and key not in kept]:
            _remove(part, key)
    for key, value in wanted.items():
        part = next((part for part in parts if key in part), None)
        usual = unsaid.get(key, {})
        if part is None:
            if value != usual:
                _add(parts[-1], key, _entries(value, usual, inline))
        elif isinstance(value, Mapping) and isinstance(part[key], Mapping):
            inner = [table for whole in parts for table in _parts(whole, key)]
            update_table(inner, value, usual, inline=inline)
        else:
            fixed = isinstance(value, Mapping) and not value.keys() - {"value", "vary"}
            if fixed and value["vary"] is False:
                value = value["value"]  # as it was: by a number alone
            if part[key] != value:
                part[key] = _entries(value, usual, inline)


def _entries(value: Any, unsaid: Any, inline: bool) -> Any:
    """Return a value as it is put into a tomlkit table."""
    import tomlkit

    if not isinstance(value, Mapping):
        return value
    said = {
        key: _entries(entry, unsaid.get(key, {}), inline)
        for key, entry in value.items()
        if entry != unsaid.get(key, {})
    }
    if not inline:
        return said
    table = tomlkit.inline_table()
    table.update(said)
    return table


def _body(table: Any) -> list[Any]:
    """Return keys, comments and blank lines of a tomlkit document or table as (key, item)."""
    from tomlkit.container import Container

    body: list[Any] = (table if isinstance(table, Container) else table.value).body
    return body


def _parts(table: Any, key: str) -> list[Any]:
    """Return the parts of an inner table, which other tables may lie between."""
    from tomlkit.items import Table

    found = [item for name, item in _body(table) if name is not None and name.key == key]
    blocks = [item for item in found if isinstance(item, Table)]
    return blocks or found


def _add(table: Any, key: str, value: Any) -> None:
    """Put a new key behind the last one, in front of the comments that lead to what follows."""
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
    # tomlkit puts it right before the first table, and a blank line behind it.
    first.trivia.indent = indent
    body = _body(table)
    at = [name and name.key for name, _ in body].index(key)
    body.insert(_tail_start(body[:at]), body.pop(at))


def _remove(table: Any, key: str) -> None:
    """Remove a key, or a table but for the comments behind its last key: those lead to the next."""
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
    """Return where the comments and blank lines behind the last key begin."""
    return max((index + 1 for index, (name, _) in enumerate(body) if name is not None), default=0)
