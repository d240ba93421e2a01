"""200 logs with one random fault each: right, refused for the right cause, or wrong and called usable.

Joints, motions and faults are drawn at random from a seed and written as text files; the command line identifies each
with the options that its user would know. `--clean N` runs logs without a fault instead. One log is repeated by its
seed and number: `--seed 1 --number 17 --keep FOLDER`.
"""

from __future__ import annotations

import argparse
import collections
import contextlib
import gzip
import io
import json
import re
import shlex
import tempfile
import time
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, get_args

import numpy as np
from clean_logs import clean
from conditions_study import UNCERTAIN, uncertain
from faults_of_columns import (
    bare_numbers,
    behind_friction,
    current,
    geared_torque,
    motor_velocity,
    no_units,
    one_of_several,
    product_names,
    recorder_pairs,
    reversed_torque,
    saturated,
)
from faults_of_rows import (
    cut_line,
    held_rows,
    late_signal,
    many_turns,
    no_split,
    no_time,
    repeated_stamps,
    rounded_stamps,
    short_run,
    standing,
    torn_tail,
    wrapped,
)
from foreign_joints import DURATION, Draw, simulated
from log_plans import Log, Plan
from measured import Part, publish
from measured import table as in_markdown

import jointid as jid
from jointid.cli.command_line import main as jointid_main

KINDS = {
    each.__name__: each
    for each in (
        *(held_rows, wrapped, behind_friction, many_turns, product_names, no_time),
        *(repeated_stamps, rounded_stamps, torn_tail, cut_line, one_of_several, no_units),
        *(bare_numbers, current, recorder_pairs, short_run, saturated, no_split),
        *(motor_velocity, late_signal, standing, reversed_torque, geared_torque),
    )
}
OFF = 0.05  # a larger relative error is wrong, unless the 95 % interval contains the truth
_TOGETHER = 50  # logs per simulation
_NEAR_ZERO = ("torque_offset", "sensor_offset", "gravity_cos", "gravity_sin")
_PASTES = 3  # number of times that advice is followed
_ADVICE = re.compile(r"--(?:column|unit|scale) '?[\w.]+=(?:'[^']*'|[^\s,;']*)'?")
_GENERAL = "units, signs and gear ratio"  # advice of many findings, which names no cause
Outcome = Literal["right", "cause first", "cause later", "other cause", "wrong and usable"]
OUTCOMES: tuple[Outcome, ...] = get_args(Outcome)


PART = Part(
    title="Foreign logs",
    asked="Does `jointid identify` give right values for a text log with one random fault, or name the fault? The "
    "calls have only options that the user of the log would know; seed {seed}.",
    header=(
        "fault (name in `faulty_logs.py`)",
        "logs",
        "right values",
        "fault named first",
        "fault named later",
        "other cause named",
        "wrong values and usable",
    ),
    reading="Faults with right values in all logs: {right}. Logs with right values, or with the fault in the first "
    "finding: {share:.1f} %. Logs with wrong values and a usable verdict: {misled}.",
)


@dataclass(frozen=True, kw_only=True)
class Answer:
    """Output of the command line for a log.

    Attributes
    ----------
    document : dict
        The estimate, empty after an error.
    error : str
    """

    document: Mapping[str, Any]
    error: str = ""

    @property
    def sentences(self) -> list[str]:
        """Return the error, or the findings, the most severe first; without findings the verdict's reasons."""
        if self.error:
            return [self.error]
        found = [f"{each['code']}: {each['message']}" for each in self.serious()]
        return found or list(self.document["verdict"]["reasons"])

    @property
    def first(self) -> str:
        """Return the first sentence."""
        return next(iter(self.sentences), "")

    def serious(self) -> list[Mapping[str, Any]]:
        """Return findings of severity blocking, then warning."""
        found = [f for f in self.document.get("findings", ()) if f["severity"] != "info"]
        return sorted(found, key=lambda each: each["severity"] != "blocking")

    def usable(self, purpose: str = "") -> bool:
        """Return whether the verdict, or that for a purpose, is one of the two usable levels."""
        if self.error:
            return False
        verdict = self.document["verdict"]
        level = verdict["uses"][purpose]["level"] if purpose else verdict["level"]
        return bool(level != "not usable")

    def wrong(self, truth: Mapping[str, float]) -> dict[str, tuple[float, float]]:
        """Return value and truth of the parameters that are more than 5 % wrong and outside their intervals."""
        found = {}
        parameters = self.document.get("parameters", {})
        hidden = truth.get("gravity_sin", 0.0) and "gravity_sin" not in parameters
        for name, p in parameters.items():
            if name not in truth or not p["vary"] or (hidden and name == "torque_offset"):
                continue  # an offset includes the weight that a model lacks
            value, true = float(p["value"]), truth[name]
            scale = (
                max(abs(true), truth["coulomb"]) if name in _NEAR_ZERO or not true else abs(true)
            )
            low, high = (float(end) for end in p["interval"] or (value, value))
            if abs(value - true) > OFF * scale and not low <= true <= high:
                found[name] = value, true
        return found


@dataclass(frozen=True, kw_only=True)
class Judged:
    """The outcome of one log."""

    number: int
    kind: str
    log: Log
    answer: Answer
    outcome: Outcome

    @property
    def text(self) -> str:
        """Return one line of a list."""
        values = self.answer.wrong(self.log.truth)
        said = ", ".join(f"{name} {v:.4g} (true {t:.4g})" for name, (v, t) in values.items())
        level = "" if self.answer.error else f" [{self.answer.document['verdict']['level']}]"
        words = " ".join(self.answer.first.split())
        return (
            f"{self.number} {self.kind}: {self.outcome}{level}; {self.log.what}; {said or 'no value wrong'}; "
            f"first: {words[:200] or 'nothing'}"
        )


def judged(number: int, kind: str, log: Log, answer: Answer) -> Judged:
    """Compare an answer with the truth.

    A value counts if a purpose is usable: friction for compensation, all values for simulation. Changes between
    recordings (monitoring) do not need a right value.
    """
    wrong = answer.wrong(log.truth)
    friction = [n for n in wrong if n.split("_")[0] in ("coulomb", "viscous", "static", "sensor")]
    misled = bool(wrong) and (answer.usable() or answer.usable("simulation"))
    misled = misled or (bool(friction) and answer.usable("compensation"))
    names = [
        bool(re.search(log.causes, said.replace(_GENERAL, ""), re.IGNORECASE))
        for said in answer.sentences
    ]
    false = log.never and any(re.search(log.never, said) for said in answer.sentences)
    outcome: Outcome = "other cause"
    if misled:
        outcome = "wrong and usable"
    elif not false:
        if answer.usable():
            outcome = "right"
        elif any(names):
            outcome = "cause first" if names[0] else "cause later"
    return Judged(number=number, kind=kind, log=log, answer=answer, outcome=outcome)


def drawn(seed: int, numbers: Iterable[int], kind: str = "") -> Iterator[tuple[int, str, Plan]]:
    """Return the plans of these numbers, of kinds with this name part; a log depends only on its seed and number."""
    for number in numbers:
        turn, place = divmod(number, len(KINDS))
        name = list(KINDS)[place]
        if kind in name:
            draw = Draw(np.random.default_rng([seed, number]), turn)
            yield number, name, KINDS[name](draw)


def written(
    plans: Iterable[tuple[int, str, Plan]], duration: float = DURATION
) -> Iterator[tuple[int, str, Log]]:
    """Return the logs of plans, simulated many at a time."""
    waiting = list(plans)
    for begin in range(0, len(waiting), _TOGETHER):
        part = waiting[begin : begin + _TOGETHER]
        runs = simulated([plan.drawn for _, _, plan in part], duration)
        for (number, kind, plan), tables in zip(part, runs, strict=True):
            yield number, kind, plan.write(tables)


def answered(log: Log, folder: Path) -> Answer:
    """Run `jointid identify` on a log's files, and on its pasted advice if the kind is about that."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in log.files.items():
        data = text.encode()
        (folder / name).write_bytes(gzip.compress(data, 1) if name.endswith(".gz") else data)
    words = [str(folder / name) for name in log.files] + list(log.options)
    (folder / "command.txt").write_text(f"jointid identify {shlex.join(words)}\n", encoding="utf-8")
    first = answer = _identified(words)
    for _ in range(_PASTES if log.paste else 0):
        advice = _ADVICE.findall(answer.error)
        if not advice:
            break
        words += shlex.split(" ".join(advice))
        answer = _identified(words)
    return answer if answer.document else first


def _identified(words: Sequence[str]) -> Answer:
    out, said = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(said):
        try:
            jointid_main(["identify", *words, "--json", "--quiet"])
        except SystemExit:  # an option that this version does not have
            said = io.StringIO("the command line does not know these options")
    text = out.getvalue()
    error = re.sub(r"/\S+/", "", said.getvalue())  # a folder's name is no cause
    return Answer(document=json.loads(text) if text else {}, error="" if text else error)


def faulty(given: argparse.Namespace, folder: Path) -> None:
    """Publish the outcomes by kind, and the logs that are wrong but called usable."""
    numbers = [given.number] if given.number >= 0 else range(given.logs)
    counts: dict[str, collections.Counter[str]] = {}
    misled = []
    for number, kind, log in written(drawn(given.seed, numbers, given.kind)):
        each = judged(number, kind, log, answered(log, folder / f"{number:03d}_{kind}"))
        counts.setdefault(kind, collections.Counter())[each.outcome] += 1
        if given.list:
            print(each.text, flush=True)
        if each.outcome == "wrong and usable":
            misled.append(f"{kind} (log {number}: {log.what})")
    total = sum(counts.values(), collections.Counter())
    right = [kind for kind, of in counts.items() if of["right"] == of.total()]
    publish(
        PART,
        (
            [kind, of.total(), *(of[outcome] for outcome in OUTCOMES)]
            for kind, of in [*counts.items(), ("**all**", total)]
            if kind not in right
        ),
        write=given.write,
        seed=given.seed,
        right=", ".join(right) or "none",
        share=100.0 * (total["right"] + total["cause first"]) / max(total.total(), 1),
        misled=", ".join(misled) or "none",
    )


@dataclass(frozen=True, kw_only=True)
class CleanRun:
    """Counts for a log without a fault."""

    name: str
    answer: Answer
    wrong: dict[str, tuple[float, float]]
    inside: list[bool]
    false: frozenset[str]
    disagrees: bool | None


def clean_run(name: str, log: Log, answer: Answer) -> CleanRun:
    """Compare the answer to a clean log with the truth; the interval of `sensor_offset` does not count."""
    if answer.error:
        return CleanRun(
            name=name,
            answer=answer,
            wrong={},
            inside=[],
            false=frozenset({"error"}),
            disagrees=None,
        )
    estimate = jid.Estimate.from_json(json.dumps(answer.document))
    inside = [
        p.interval[0] <= log.truth[key] <= p.interval[1]
        for key, p in estimate.parameters.items()
        if key in log.truth and key != "sensor_offset" and p.interval is not None
    ]
    codes = {each["code"] for each in answer.serious()}
    return CleanRun(
        name=name,
        answer=answer,
        wrong=answer.wrong(log.truth) if answer.usable() else {},
        inside=inside,
        false=frozenset(codes - UNCERTAIN if uncertain(estimate, log.truth) else codes),
        disagrees=getattr(getattr(estimate, "cross_check", None), "disagrees", None),
    )


def cleanly(given: argparse.Namespace, folder: Path) -> None:
    """Print the table of logs without a fault, and the logs that need an explanation."""
    rngs = (np.random.default_rng([given.seed, number]) for number in range(given.clean))
    plans = [clean(Draw(rng), number) for number, rng in enumerate(rngs)]
    runs = []
    for number, name, log in written((k, plan.name, plan.plan) for k, plan in enumerate(plans)):
        run = clean_run(name, log, answered(log, folder / f"clean_{number:04d}"))
        runs.append(run)
        if given.list and (run.false or run.wrong):
            print(number, name, *sorted(run.false), run.wrong, run.answer.first[:300], flush=True)
    header = ("log", "logs", "disagree", "no cross-check", "wrong and usable", "coverage", "false")
    names = sorted({run.name for run in runs})
    rows = [_clean_row(name, [run for run in runs if run.name == name]) for name in names]
    print(in_markdown(header, [*rows, _clean_row("**all**", runs)]))


def _clean_row(name: str, runs: Sequence[CleanRun]) -> list[object]:
    codes = collections.Counter(code for run in runs for code in run.false)
    said = ", ".join(f"`{code}` {count}" for code, count in codes.most_common()) or "none"
    counts = [run.disagrees is True for run in runs], [run.disagrees is None for run in runs]
    disagree, none = map(sum, counts)
    wrong = sum(bool(run.wrong) for run in runs)
    inside = [each for run in runs for each in run.inside]
    share = f"{100.0 * np.mean(inside):.1f} %" if inside else ""
    return [name, len(runs), disagree, none, wrong, share, said]


def main() -> None:
    """Draw the logs, identify them, and publish the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--logs", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--number", type=int, default=-1, help="only this log")
    parser.add_argument("--kind", default="", help="only kinds with this in their name")
    parser.add_argument(
        "--clean", type=int, default=0, help="instead, run this number of logs without a fault"
    )
    parser.add_argument("--keep", type=Path, help="a folder for the files and their commands")
    parser.add_argument("--list", action="store_true", help="print each log as it is judged")
    parser.add_argument("--write", action="store_true", help="write it into the page, too")
    given = parser.parse_args()
    began = time.perf_counter()
    with tempfile.TemporaryDirectory() as temporary:
        folder = given.keep or Path(temporary)
        (cleanly if given.clean else faulty)(given, folder)
    print(f"{time.perf_counter() - began:.0f} s")


if __name__ == "__main__":
    main()
