"""`make study`: 46 conditions with random joints each.

Clean conditions show errors, coverage and false findings. Mismatches and defects show whether a finding names each
parameter with a large error. The outcomes are stored in `results/conditions_study.jsonl`, and the next call adds to
them. Delete this file after a change of the code. `--page` publishes the stored outcomes.
"""

from __future__ import annotations

import argparse
import collections
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from conditions import CONDITIONS, DURATION, Condition
from measured import Part, publish
from plants import Bench, simulate
from store import Record, Store

import jointid as jid

PATH = Path(__file__).resolve().parent / "results" / "conditions_study.jsonl"
OFF = 0.05  # a finding must name a larger relative error
_SHOWN = 2  # number of findings in a row, the most frequent ones
CLEAN = Part(
    title="Conditions: clean recordings",
    asked="How accurate is `identify` on clean recordings, and which findings are false? {joints} random joints per "
    "condition, 12 s at 1 kHz unless the condition says otherwise, seed {seed}. Parameters with an error above 5 % "
    "and without a finding: {unnamed}.",
    header=(
        "condition",
        "joints with all errors within 5 %",
        "largest error [%] (parameter)",
        "coverage of the 95 % intervals [%]",
        "false findings: number of joints",
    ),
    reading="*Sensor*: the joint has a torque sensor. A finding that states a large uncertainty is false only if all "
    "95 % intervals are narrow: within ±4 % of the value, for the sensor's gain within ±1 %.",
)
WRONG = Part(
    title="Conditions: mismatches and defects",
    asked="How accurate is `identify` on a joint or a recording that violates an assumption? {joints} random joints "
    "per condition. Only the two most frequent findings of a condition are shown. Parameters with an error above 5 % "
    "and without a finding: {unnamed}.",
    header=(
        "condition",
        "joints with all errors within 5 %",
        "largest error [%] (parameter)",
        "coverage of the 95 % intervals [%]",
        "warnings and blocking findings: number of joints",
    ),
    reading="A warning names the parameters that it lists. A blocking finding counts for all parameters.",
)
_SIDE_BY_SIDE = 250  # most runs of one simulation
_ROUND = 10  # joints of each condition in a round
_NEAR_ZERO = ("torque_offset", "sensor_offset", "gravity_cos", "gravity_sin")


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """One identification compared with the truth.

    Attributes
    ----------
    errors : dict of str to float
        Relative errors; infinite for a parameter that the estimate does not have.
    inside : dict of str to bool
        Whether the 95 % interval contains the truth; no entry without an interval.
    named : frozenset of str
        Parameters that a finding of severity "warning" or "blocking" names.
    codes : frozenset of str
        Codes of these findings.
    false : frozenset of str
        Codes of the findings that are false if the recording is clean.
    """

    errors: dict[str, float]
    inside: dict[str, bool]
    named: frozenset[str]
    codes: frozenset[str]
    false: frozenset[str]

    @property
    def off(self) -> list[str]:
        """Parameters with an error above 5 %."""
        return [name for name, error in self.errors.items() if abs(error) > OFF]

    @property
    def unnamed(self) -> list[str]:
        """Parameters with an error above 5 % that no finding names."""
        return [name for name in self.off if name not in self.named]


def outcome(condition: Condition, recording: jid.Recording) -> Outcome:
    """Identify one recording, and compare the estimate with the truth."""
    estimate = jid.identify(recording, condition.joint(recording))
    truth = dict(recording.truth or {})
    for name in ("torque_offset", "sensor_offset"):
        if name in truth:
            truth[name] += _undivided(recording)
    if truth["static"] == 0.0:  # the shape of a missing static friction is undefined
        truth = {name: value for name, value in truth.items() if name not in ("static", "stribeck")}
    errors, inside = {}, {}
    for name, true in truth.items():
        parameter = estimate.parameters.get(name)
        absent = name in _NEAR_ZERO and true == 0.0
        if (parameter is None and absent) or (parameter is not None and not parameter.vary):
            continue
        scale = abs(true)
        if name in _NEAR_ZERO:
            scale = max(scale, truth["coulomb"])  # the true value may be near 0
        error = np.inf if parameter is None else (parameter.value - true) / scale
        errors[name] = float(error)
        if parameter is not None and parameter.interval is not None:
            low, high = parameter.interval
            inside[name] = bool(low <= true <= high)
    serious = [f for f in estimate.findings if f.severity != "info"]
    named = {name for finding in serious for name in finding.parameters}
    if any(finding.severity == "blocking" for finding in serious):
        named |= set(errors)  # a blocking finding says that no value can be used
    codes = {finding.code for finding in serious}
    return Outcome(
        errors=errors,
        inside=inside,
        named=frozenset(named),
        codes=frozenset(codes),
        false=frozenset(codes - UNCERTAIN if uncertain(estimate, truth) else codes),
    )


def _undivided(recording: jid.Recording) -> float:
    """Return half of the difference of both Coulomb frictions; no recording separates it from an offset."""
    plant = recording.metadata["plant"]
    return float(plant["asymmetry"] * plant["coulomb"])


UNCERTAIN = {"undetermined", "at_bound", "model_too_rich", "noisy_velocity"}
_WIDE = 0.04  # limit of `undetermined` for half of a 95 % interval, relative
_WIDE_GAIN = 0.01


def uncertain(estimate: jid.Estimate, truth: Mapping[str, float]) -> bool:
    """Return whether a 95 % interval is wider than ±4 % (a gain's: ±1 %); then a finding of uncertainty is right."""
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
    """Add rounds of ten joints per condition to the store; one simulation has all joints of a round."""
    for number in range((joints + _ROUND - 1) // _ROUND):
        size = min(_ROUND, joints - number * _ROUND)
        missing = [c for c in conditions if not store.of("round", condition=c.name, round=number)]
        for begin in range(0, len(missing), _SIDE_BY_SIDE // _ROUND):
            together = missing[begin : begin + _SIDE_BY_SIDE // _ROUND]
            # The joints of a condition do not depend on the other conditions.
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
    """Return the stored runs of a condition."""
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


def row(condition: Condition, found: Sequence[Outcome]) -> list[str]:
    """Return one line of the table."""
    good = sum(not each.off for each in found)
    worst = max(
        ((abs(error), name) for each in found for name, error in each.errors.items()),
        default=(0.0, ""),
    )
    inside = [value for each in found for value in each.inside.values()]
    said = [each.false if condition.clean else each.codes for each in found]
    codes = collections.Counter(code for each in said for code in each)
    return [
        condition.name,
        f"{good}/{len(found)}",
        f"{'missing' if np.isinf(worst[0]) else f'{100 * worst[0]:.2f}'} ({worst[1]})",
        f"{100 * np.mean(inside):.1f}" if inside else "",
        ", ".join(f"`{code}` {count}" for code, count in codes.most_common(_SHOWN)) or "none",
    ]


def unnamed(found: Sequence[tuple[Condition, Sequence[Outcome]]]) -> str:
    """Return the numbers of parameters with a large error that no finding names, by condition."""
    counts = {c.name: sum(len(each.unnamed) for each in runs) for c, runs in found}
    listed = [f"**{count}** ({name})" for name, count in counts.items() if count]
    return ", ".join(listed) or "none"


def main() -> None:
    """Run the conditions and publish the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--joints", type=int, default=20, help="random joints per condition")
    parser.add_argument(
        "--clean-joints",
        type=int,
        default=0,
        help="random joints per clean condition, if different",
    )
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--only", default="", help="conditions whose name contains this")
    parser.add_argument("--write", action="store_true", help="also write the tables into the page")
    parser.add_argument(
        "--page", action="store_true", help="only the tables of the stored outcomes"
    )
    given = parser.parse_args()
    began = time.perf_counter()
    chosen = [c for c in CONDITIONS if given.only in c.name]
    store = Store(PATH, {"seed": given.seed, "version": jid.__version__})
    if not given.page:
        for clean in (False, True):
            joints = (given.clean_joints if clean else 0) or given.joints
            measure(store, [c for c in chosen if c.clean == clean], joints, given.seed)
    total = 0
    for part, clean in ((CLEAN, True), (WRONG, False)):
        mine = [(c, outcomes(store, c)) for c in chosen if c.clean == clean]
        mine = [(c, found) for c, found in mine if found]
        total += sum(len(found) for _, found in mine)
        publish(
            part,
            (row(c, found) for c, found in mine),
            write=given.write,
            joints=min((len(found) for _, found in mine), default=0),
            seed=given.seed,
            unnamed=unnamed(mine),
        )
    print(f"{total} runs in {time.perf_counter() - began:.0f} s")


if __name__ == "__main__":
    main()
