"""Results as JSON lines, appended one by one, so that an interrupted run continues where it stopped."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

Record = dict[str, Any]


class Store:
    """Records of one run of the benchmark. A finished run, or other settings, start a new store."""

    def __init__(self, path: Path, settings: Record) -> None:
        self.path = path
        self.records: list[Record] = []
        path.parent.mkdir(parents=True, exist_ok=True)
        text = path.read_text() if path.exists() else ""
        whole = text[: text.rfind("\n") + 1]  # the last line may have been cut off
        found = [json.loads(line) for line in whole.splitlines()]
        header = {"kind": "settings", **settings}
        if found and found[0] == header and found[-1]["kind"] != "finished":
            path.write_text(whole)
            self.records = found
            print(f"Continuing from {len(found) - 1} records of {path}", flush=True)
        else:
            path.write_text("")
            self.append(header)

    def append(self, record: Record) -> None:
        """Append a record, on disk first."""
        with self.path.open("a") as file:
            file.write(json.dumps(record) + "\n")
        self.records.append(record)

    def of(self, kind: str, **fields: Any) -> list[Record]:
        """Return the records of a kind with these field values."""
        return [
            record
            for record in self.records
            if record["kind"] == kind
            and all(record.get(key) == value for key, value in fields.items())
        ]
