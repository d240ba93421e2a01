"""The table of all findings, docs/findings.md, written from the registry.

python -m jointid.identification.warnings.table > docs/findings.md
"""

import sys
from collections.abc import Iterable

from jointid.estimate.types_of_findings import FindingType
from jointid.identification.warnings.registry import finding_types

_HEAD = """# Findings

An estimate carries `estimate.findings`, values with a code, a severity, the parameters concerned, the evidence (named
numbers with units), the cause, and advice that a program can read. `estimate.warnings` are those of severity "warning"
or "blocking". No warning means that nothing suspicious was found, not that the joint is as modelled.

Of several recordings a finding names those that it is about; what is found in several alike is said once.

- **info**: worth knowing; values are not affected.
- **warning**: values may be biased, or less certain than usual.
- **blocking**: the values cannot be used before the cause is removed.

This table is written from the checks in `python/jointid/identification/warnings`.

| code | severity | meaning | what to do |
|---|---|---|---|
"""


def findings_page() -> str:
    """The page: a row a code, in the order in which findings are listed."""
    return _HEAD + table_rows(finding_types().values())


def table_rows(types: Iterable[FindingType]) -> str:
    """Rows of a page's table, one for each code."""
    return "".join(
        f"| `{each.code}` | {each.severity} | {each.meaning} | {each.advice} |\n" for each in types
    )


if __name__ == "__main__":
    sys.stdout.write(findings_page())
