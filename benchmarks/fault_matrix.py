"""Print a table of faults on an emulated bus: what stops the session, how soon, and when the motor is off."""

from __future__ import annotations

from fault_cases import CASES, Outcome, outcome

_HEAD = ("fault", "stop", "detected after [ms]", "motor off after [ms]", "seen off", "message")


def row(name: str, found: Outcome) -> str:
    """Return one line of the table, in Markdown."""
    stop = found.stop
    cells = (
        name,
        f"`{stop.limit}`",
        f"{1e3 * found.detected:.1f}",
        f"{1e3 * found.motor_off:.1f}" if found.motor_off >= 0.0 else "before",
        "yes" if stop.motor_off else "no",
        stop.message.replace("|", "/"),
    )
    return f"| {' | '.join(cells)} |"


def main() -> None:
    """Print the table."""
    print(f"| {' | '.join(_HEAD)} |")
    print("|---|---|--:|--:|---|---|")
    for case in CASES:
        print(row(case.name, outcome(case)))


if __name__ == "__main__":
    main()
