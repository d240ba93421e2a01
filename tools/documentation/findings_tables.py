"""Tables of findings in docs/, written from their types: PYTHONPATH=tools python -m documentation.findings_tables."""

import re
from collections.abc import Iterable
from pathlib import Path

import jointid.robot.result.finding_types
import jointid.servo.finding_types
from jointid.estimate.types_of_findings import FindingType
from jointid.identification.warnings.registry import finding_types

_DOCUMENTS = Path(__file__).resolve().parents[2] / "docs"
_HEAD = "| code | severity | meaning | what to do |\n|---|---|---|---|\n"
_TABLE = re.compile(rf"^{re.escape(_HEAD)}(?:\|.*\n)*", re.MULTILINE)


def findings_tables() -> dict[str, str]:
    """Return the table of each page, by the page's name."""
    return {
        "findings.md": table_of(finding_types().values()),
        "robot_reference.md": table_of(jointid.robot.result.finding_types.TYPES.values()),
        "servos.md": table_of(jointid.servo.finding_types.TYPES.values()),
    }


def table_of(types: Iterable[FindingType]) -> str:
    """Return a table with one row for each code, in the order of findings."""
    return _HEAD + "".join(
        f"| `{each.code}` | {each.severity} | {each.meaning} | {each.advice} |\n" for each in types
    )


def in_place_of_the_table(page: str, text: str) -> str:
    """Return a page with its table of findings replaced by another text."""
    changed, count = _TABLE.subn(lambda _: text, page)
    if count != 1:
        raise ValueError(f"the page has {count} tables of findings, not one")
    return changed


if __name__ == "__main__":
    for name, table in findings_tables().items():
        path = _DOCUMENTS / name
        page = in_place_of_the_table(path.read_text(encoding="utf-8"), table)
        path.write_text(page, encoding="utf-8")
