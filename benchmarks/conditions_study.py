"""`make study`: 46 conditions with random joints each; writes docs/conditions.md.

Clean conditions show errors, coverage and false findings; mismatches and defects show whether a finding names every
parameter that is off. Outcomes are kept in `results/conditions_study.jsonl`, which the next call continues: delete it
when the code has changed. `--page` writes the tables of what is there.
"""

from __future__ import annotations

import argparse
import collections
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from conditions import CONDITIONS, DURATION, Condition
from plants import Bench, simulate
from store import Record, Store

import jointid as jid

PATH = Path(__file__).resolve().parent / "results" / "conditions_study.jsonl"
OFF = 0.05  # a relative error above this one has to be named
_SIDE_BY_SIDE = 250  # runs of one simulation
_ROUND = 10  # joints of each condition
_NEAR_ZERO = ("torque_offset", "sensor_offset", "gravity_cos", "gravity_sin")


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """One identification against the truth.

    Attributes
    ----------
    errors : dict of str to float
        Relative; infinite for a parameter that the estimate does not have.
    inside : dict of str to bool
        Whether the 95 % interval contains the truth; no entry without an interval.
    named : frozenset of str
        Parameters that a finding of severity "warning" or "blocking" names.
    codes : frozenset of str
        Of those findings.
    false : frozenset of str
        Of those that would be false if the recording is clean.
    """

    errors: dict[str, float]
    inside: dict[str, bool]
    named: frozenset[str]
    codes: frozenset[str]
    false: frozenset[str]

    @property
    def off(self) -> list[str]:
        """Parameters that are off by more than 5 %."""
        return [name for name, error in self.errors.items() if abs(error) > OFF]

    @property
    def unnamed(self) -> list[str]:
        """Those of them that no finding names."""
        return [name for name in self.off if name not in self.named]


def outcome(condition: Condition, recording: jid.Recording) -> Outcome:
    """Identify one recording, and hold it against its truth."""
    estimate = jid.identify(recording, condition.joint(recording))
    truth = dict(recording.truth or {})
    for name in ("torque_offset", "sensor_offset"):
        if name in truth:
            truth[name] += _undivided(recording)
    if truth["static"] == 0.0:  # without static friction its shape means nothing
        truth = {name: value for name, value in truth.items() if name not in ("static", "stribeck")}
    errors, inside = {}, {}
    for name, true in truth.items():
        parameter = estimate.parameters.get(name)
        absent = name in _NEAR_ZERO and true == 0.0
        if (parameter is None and absent) or (parameter is not None and not parameter.vary):
            continue
        scale = abs(true)
        if name in _NEAR_ZERO:
            scale = max(scale, truth["coulomb"])  # these may be near 0
        error = np.inf if parameter is None else (parameter.value - true) / scale
        errors[name] = float(error)
        if parameter is not None and parameter.interval is not None:
            low, high = parameter.interval
            inside[name] = bool(low <= true <= high)
    serious = [f for f in estimate.findings if f.severity != "info"]
    named = {name for finding in serious for name in finding.parameters}
    if any(finding.severity == "blocking" for finding in serious):
        named |= set(errors)  # the values cannot be used, and it says so
    codes = {finding.code for finding in serious}
    return Outcome(
        errors=errors,
        inside=inside,
        named=frozenset(named),
        codes=frozenset(codes),
        false=frozenset(codes - UNCERTAIN if uncertain(estimate, truth) else codes),
    )


def _undivided(recording: jid.Recording) -> float:
    """Half of the difference of the Coulomb frictions, which no recording tells from an offset."""
    plant = recording.metadata["plant"]
    return float(plant["asymmetry"] * plant["coulomb"])


UNCERTAIN = {"undetermined", "at_bound", "model_too_rich", "noisy_velocity"}
_WIDE = 0.04  # what `undetermined` says: half of a 95 % interval
_WIDE_GAIN = 0.01


def uncertain(estimate: jid.Estimate, truth: Mapping[str, float]) -> bool:
    """Whether a 95 % interval is wider than ±4 % (a gain's: ±1 %), so that a finding that says so is not false."""
    gravity = float(np.hypot(truth.get("gravity_cos", 0.0), truth.get("gravity_sin", 0.0)))
    for name, parameter in estimate.parameters.items():
        if not parameter.vary or name not in truth:
            continue
        if parameter.interval is None:
            return True
        scale = abs(truth[name])
        if name in _NEAR_ZERO:
            scale = gravity if name.startswith("gravity") else max(scale, truth["coulomb"])
        low, high = parameter.interval
        if high - low > 2.0 * (_WIDE_GAIN if name == "sensor_gain" else _WIDE) * scale:
            return True
    return False


def measure(store: Store, conditions: Sequence[Condition], joints: int, seed: int) -> None:
    """Add rounds of ten joints of each condition to the store, all of a round simulated side by side."""
    for number in range((joints + _ROUND - 1) // _ROUND):
        size = min(_ROUND, joints - number * _ROUND)
        missing = [c for c in conditions if not store.of("round", condition=c.name, round=number)]
        for begin in range(0, len(missing), _SIDE_BY_SIDE // _ROUND):
            together = missing[begin : begin + _SIDE_BY_SIDE // _ROUND]
            # A condition's joints do not depend on which others run.
            draws = [np.random.default_rng([seed, CONDITIONS.index(c), number]) for c in together]
            benches = [c.bench(size, rng) for c, rng in zip(together, draws, strict=True)]
            noise = int(np.random.SeedSequence([seed, number, begin]).generate_state(1)[0])
            recordings = iter(simulate(Bench.stack(benches), duration=DURATION, seed=noise))
            for condition in together:
                found = [outcome(condition, _cut(condition, next(recordings))) for _ in range(size)]
                whole = [_record(each) for each in found]
                store.append(
                    {"kind": "round", "condition": condition.name, "round": number, "joints": whole}
                )


def _record(found: Outcome) -> Record:
    lists = {name: sorted(getattr(found, name)) for name in ("named", "codes", "false")}
    return {"errors": found.errors, "inside": found.inside, **lists}


def outcomes(store: Store, condition: Condition) -> list[Outcome]:
    """The kept runs of a condition."""
    return [
        Outcome(
            errors=each["errors"],
            inside=each["inside"],
            named=frozenset(each["named"]),
            codes=frozenset(each["codes"]),
            false=frozenset(each["false"]),
        )
        for record in store.of("round", condition=condition.name)
        for each in record["joints"]
    ]


def _cut(condition: Condition, recording: jid.Recording) -> jid.Recording:
    if condition.duration >= DURATION:
        return recording
    return recording.crop(0.0, condition.duration)


HEAD = (
    f"| condition | all within {OFF:.0%} | worst error | off by more, named | off by more, **not named** |"
    " coverage | warnings |\n|---|--:|---|--:|---|--:|---|"
).replace("%", " %")


def row(condition: Condition, found: Sequence[Outcome]) -> str:
    """One line of the table."""
    good = sum(not each.off for each in found)
    worst = max(
        ((abs(error), name) for each in found for name, error in each.errors.items()),
        default=(0.0, ""),
    )
    off = sum(len(each.off) for each in found)
    unnamed = collections.Counter(name for each in found for name in each.unnamed)
    listed = ", ".join(f"{name} {count}" for name, count in sorted(unnamed.items()))
    codes = collections.Counter(code for each in found for code in each.codes)
    inside = [value for each in found for value in each.inside.values()]
    cells = (
        condition.name,
        f"{good} of {len(found)}",
        f"{'missing' if np.isinf(worst[0]) else f'{100 * worst[0]:.2f} %'} ({worst[1]})",
        str(off - sum(unnamed.values())),
        f"**{sum(unnamed.values())}**: {listed}" if unnamed else "0",
        f"{100 * np.mean(inside):.1f} %" if inside else "",
        ", ".join(f"`{code}` {count}" for code, count in codes.most_common()) or "none",
    )
    return f"| {' | '.join(cells)} |"


def clean_rows(name: str, found: Sequence[Outcome]) -> Iterator[str]:
    """Coverage by parameter, and how often each false finding is raised."""
    parameters = sorted({name for each in found for name in each.inside})
    shares = (
        f"{p} {100 * np.mean([each.inside[p] for each in found if p in each.inside]):.1f}"
        for p in parameters
    )
    codes = collections.Counter(code for each in found for code in each.false)
    said = ", ".join(
        f"`{code}` {100 * count / len(found):.1f} %" for code, count in codes.most_common()
    )
    yield f"| {name} | {', '.join(shares)} | {said or 'none'} |"


def main() -> None:
    """Run the conditions and write the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--joints", type=int, default=20, help="random joints a condition")
    parser.add_argument("--clean-joints", type=int, default=0, help="of the clean ones, if others")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--only", default="", help="conditions whose name contains this")
    parser.add_argument("--output", type=Path, help="a file to write instead of printing")
    parser.add_argument("--page", action="store_true", help="only the tables, of what is kept")
    given = parser.parse_args()
    began = time.perf_counter()
    chosen = [c for c in CONDITIONS if given.only in c.name]
    store = Store(PATH, {"seed": given.seed, "version": jid.__version__})
    if not given.page:
        for clean in (False, True):
            joints = (given.clean_joints if clean else 0) or given.joints
            measure(store, [c for c in chosen if c.clean == clean], joints, given.seed)
    found = {c.name: outcomes(store, c) for c in chosen}
    chosen = [c for c in chosen if found[c.name]]
    cleans = min((len(found[c.name]) for c in chosen if c.clean), default=0)
    lines = [_TEXT.format(clean=cleans, one=100.0 / max(cleans, 1), seed=given.seed)]
    for title, clean in (("Clean conditions", True), ("Mismatches and defects", False)):
        lines += [f"\n## {title}\n", HEAD]
        lines += [row(c, found[c.name]) for c in chosen if c.clean == clean]
    lines += ["\n## Clean conditions: coverage and false findings\n"]
    lines += [
        "| condition | 95 % intervals that contain the truth [%] | false findings of severity warning or blocking |"
    ]
    lines += ["|---|---|---|"]
    for c in chosen:
        if c.clean:
            lines += clean_rows(c.name, found[c.name])
    text = "\n".join(lines) + "\n"
    if given.output is None:
        print(text)
    else:
        given.output.write_text(text, encoding="utf-8")
    print(f"{sum(map(len, found.values()))} runs in {time.perf_counter() - began:.0f} s")


_TEXT = """# Accuracy under many conditions

Written by `benchmarks/conditions_study.py` (`make study`); do not edit. Each condition of `benchmarks/conditions.py`
has random joints (as many as its row says), simulated by
`tests/plants`, which shares no code with the package: other inertia, friction, gravity, sensor and motion each time,
12 s at 1 kHz unless the condition says otherwise; seed {seed}. With a sensor the call knows the drive's inertia and
the model; without one the model with gravity free; "no joint given" is `identify(recording)`.

An error is relative to the true value; that of an offset or a coefficient of gravity, which may be near 0, to the
larger of the true value and the Coulomb friction. Of a value that drifts, the truth is its mean. Where friction
differs by direction, the truth of the offset holds half of the difference of the Coulomb frictions: nothing in a
recording tells the two apart. A parameter is named if a finding of severity "warning" lists it, or if a finding is
"blocking". A parameter that the estimate does not have counts as off. On a clean recording a finding that a value is
uncertain (`undetermined`, `at_bound`, `model_too_rich`, `noisy_velocity`) is false unless a 95 % interval is as wide as
`undetermined` says (±4 %; a gain's ±1 %; a coefficient of gravity against both together) or missing; any other one is
false. Rare findings need many joints: one in {clean} joints is {one:.2g} %."""

if __name__ == "__main__":
    main()
