"""Results of the mutants, as a part of the page of measured results."""

from __future__ import annotations

from collections.abc import Sequence

from measured_page import Part

from mutants.catalogue import Mutant
from mutants.running import Verdict

ASKED = 0.9  # share of all mutants that must die
PART = Part(
    title="Mutants",
    asked="Does a test fail when one line of the program is changed? {summary}, {minutes:.0f} minutes on one "
    "processor. In a first trial by hand {named} mutants survived; now the tests kill {dead} of them.",
    header=(
        "list",
        "mutants",
        "killed by a test",
        "justified",
        "survived",
        "not tried",
        "last trial",
    ),
    reading="The entry `justified` in `tools/mutants/lists` says why a mutant may survive.",
)


def complaints(verdicts: Sequence[Verdict]) -> list[str]:
    """Return the reasons why the lists do not pass."""
    said = [f"survived: {each.mutant}" for each in _left(verdicts) if not each.mutant.justified]
    said += [
        f"justified, and yet it dies by {each.by}: {each.mutant}"
        for each in verdicts
        if each.killed and each.mutant.justified
    ]
    share = sum(each.killed for each in verdicts) / max(1, len(verdicts))
    if share < ASKED:
        said.append(f"{share:.1%} of the mutants die, {ASKED:.0%} are asked")
    return said


def _left(verdicts: Sequence[Verdict]) -> list[Verdict]:
    return [each for each in verdicts if not each.killed]


def summary(verdicts: Sequence[Verdict]) -> str:
    """Return one line of counts."""
    left = _left(verdicts)
    justified = sum(bool(each.mutant.justified) for each in left)
    return (
        f"{len(verdicts)} mutants: {len(verdicts) - len(left)} killed, {justified} justified, "
        f"{len(left) - justified} survived"
    )


def written(verdicts: Sequence[Verdict], mutants: Sequence[Mutant]) -> str:
    """Return the part of the page.

    Parameters
    ----------
    verdicts : sequence of Verdict
        Verdicts of all tried mutants.
    mutants : sequence of Mutant
        All mutants, tried or not.
    """
    tried = {each.mutant for each in verdicts}
    named = [each for each in verdicts if each.mutant.named]
    rows = []
    for room in [*sorted({each.room for each in mutants}), "all"]:
        of = [each for each in verdicts if room in (each.mutant.room, "all")]
        left = _left(of)
        justified = sum(bool(each.mutant.justified) for each in left)
        missing = sum(room in (each.room, "all") for each in mutants if each not in tried)
        counts = (len(of) + missing, len(of) - len(left), justified, len(left) - justified, missing)
        days = sorted({each.date for each in of})
        rows.append([room, *counts, days[-1] if days else "–"])
    return PART.text(
        rows,
        summary=summary(verdicts),
        minutes=sum(each.seconds for each in verdicts) / 60.0,
        named=sum(each.named for each in mutants),
        dead=sum(each.killed for each in named),
    )
