"""What the mutants showed, as a page of the documentation."""

from __future__ import annotations

from collections.abc import Sequence

from mutants.catalogue import Mutant
from mutants.running import Verdict

ASKED = 0.9  # share of all mutants that must die


def complaints(verdicts: Sequence[Verdict]) -> list[str]:
    """Why the lists do not pass."""
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
    """One line of counts."""
    left = _left(verdicts)
    justified = sum(bool(each.mutant.justified) for each in left)
    return (
        f"{len(verdicts)} mutants: {len(verdicts) - len(left)} killed, {justified} justified, "
        f"{len(left) - justified} survived"
    )


def written(verdicts: Sequence[Verdict], mutants: Sequence[Mutant]) -> str:
    """The page.

    Parameters
    ----------
    verdicts : sequence of Verdict
        Of all mutants that were tried.
    mutants : sequence of Mutant
        Those and the others.
    """
    tried = {each.mutant for each in verdicts}
    untried = [each for each in mutants if each not in tried]
    rooms = sorted({each.room for each in mutants})
    minutes = sum(each.seconds for each in verdicts) / 60.0
    named = [each for each in verdicts if each.mutant.named]
    skipped = sum(each.named for each in untried)
    dead = sum(each.killed for each in named)
    lines = [
        "# Mutants",
        "",
        "A mutant is the program with one line changed: a threshold moved, a sign turned, a guard left out. A test "
        "that runs the line",
        "and does not fail does not test it. `make mutants` tries the mutants of the lists in `tools/mutants/lists`, "
        "each with the tests",
        "that are named beside it, and writes this page. A mutant is found by the text of its line; where that text is "
        "gone, the run",
        "ends and says so. C++ is compiled once, with all mutants in it, and a number in the environment chooses one.",
        "Verdicts lie in `tools/mutants/verdicts`, each with its date, until the line changes; where its file or its "
        "tests have",
        "changed since, the next run tries it again.",
        "",
        f"Of {len(mutants)} mutants in the lists these were tried: **{summary(verdicts)}**",
        f"({minutes:.0f} minutes on one processor, without the compiler's). Of {len(named) + skipped} places",
        f"that survived when mutants were first tried by hand, {dead} die now and {skipped} were not tried again.",
        "",
        "| list | mutants | killed | of these without an end | justified | survived | not tried | on |",
        "|---|---:|---:|---:|---:|---:|---:|---|",
    ]
    for room in [*rooms, "all"]:
        of = [each for each in verdicts if room in (each.mutant.room, "all")]
        left = _left(of)
        justified = sum(bool(each.mutant.justified) for each in left)
        endless = sum(each.by == "did not end" for each in of)
        missing = sum(room in (each.room, "all") for each in untried)
        survived = len(left) - justified
        counts = (len(of) + missing, len(of) - len(left), endless, justified, survived, missing)
        days = sorted({each.date for each in of})
        lines.append(
            f"| {room} | {' | '.join(map(str, counts))} | {' to '.join(days[:1] + days[1:][-1:])} |"
        )
    left = sorted(_left(verdicts), key=lambda each: not each.mutant.justified)
    if left:
        lines += ["", "## Those that no test notices", "", "| change | why |", "|---|---|"]
        lines += [row(each.mutant) for each in left]
    return "\n".join(lines) + "\n"


def row(mutant: Mutant) -> str:
    """The line of one that no test notices."""
    was, becomes = (text.replace("|", "\\|") for text in (mutant.was, mutant.becomes))
    changed = f"`{was}` becomes `{becomes}`" if becomes else f"without `{was}`"
    return f"| {mutant.path}: {changed} | {mutant.justified or '**not justified**'} |"
