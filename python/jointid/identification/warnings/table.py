"""The table of all findings in docs/findings.md, written from the registry.

python -m jointid.identification.warnings.table docs/findings.md
"""

import re
import sys
from collections.abc import Iterable
from pathlib import Path

from jointid.estimate.types_of_findings import FindingType
from jointid.identification.warnings.registry import finding_types

_HEAD = "| code | severity | meaning | what to do |\n|---|---|---|---|\n"
_TABLE = re.compile(rf"^{re.escape(_HEAD)}(?:\|.*\n)*", re.MULTILINE)


def findings_table() -> str:
    """Return a row for each code, in the order of findings."""
    return _HEAD + table_rows(finding_types().values())


def table_rows(types: Iterable[FindingType]) -> str:
    """Return rows of a page's table, one for each code."""
    return "".join(
        f"| `{each.code}` | {each.severity} | {each.meaning} | {each.advice} |\n" for each in types
    )


def in_place_of_the_table(page: str, text: str) -> str:
    """Return the page of findings with its table replaced by another text."""
    changed, count = _TABLE.subn(lambda _: text, page)
    if count != 1:
        raise ValueError(f"the page has {count} tables of findings, not one")
    return changed


if __name__ == "__main__":
    path = Path(sys.argv[1])
    path.write_text(
        in_place_of_the_table(path.read_text(encoding="utf-8"), findings_table()), encoding="utf-8"
    )
