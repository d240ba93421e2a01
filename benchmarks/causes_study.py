"""Which cause is named for which broken assumption, over many random joints and motions, as a table in markdown.

python benchmarks/causes_study.py [joints a plant] [seed]
"""

import sys
from collections import Counter, defaultdict
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import causes_plants as plants

import jointid as jid

HARM = 0.05  # of a parameter; or two of its errors


def main() -> None:
    """Print the table with a sensor, then without one."""
    joints = int(sys.argv[1]) if len(sys.argv) > 1 else 20
    seed = int(sys.argv[2]) if len(sys.argv) > 2 else 1
    for sensor in (True, False):
        kinds = plants.SENSOR if sensor else plants.SENSORLESS
        rows: dict[str, Counter[str]] = defaultdict(Counter)
        for first in range(0, joints, 10):
            some = min(10, joints - first)
            for run in plants.simulate(list(kinds) * some, sensor=sensor, seed=seed + first):
                _count(run, rows[run.plant])
        print(f"\n{'With' if sensor else 'Without'} a torque sensor, {joints} joints a row\n")
        print("| plant | harmed | named rightly | another name first | no name | harmless named | first names |")
        print("|---|---|---|---|---|---|---|")
        for kind in kinds:
            row = rows[kind]
            names = {name: n for name, n in row.items() if name.startswith(":")}
            told = ", ".join(f"{n[1:]} {c}" for n, c in sorted(names.items(), key=lambda e: -e[1]))
            cells = [row[key] for key in ("harmed", "right", "wrong", "none", "false")]
            print(f"| {kind} | " + " | ".join(map(str, cells)) + f" | {told} |")


def _count(run: plants.Run, row: Counter[str]) -> None:
    estimate = jid.identify(run.recording, run.joint, search="separable")
    codes = {each.code for each in estimate.findings}
    if run.signals:
        found = [cause.name for cause in estimate.causes(run.signals).found]
    else:
        found = [each.code for each in estimate.findings if each.code in NAMES]
    right = plants.NAMES.get(run.plant, set())
    harmed = False
    for name, true in run.truth.items():
        value = estimate.parameters.get(name)
        if value is None or not value.vary:
            continue
        error = abs(value.value - true)
        scale = max(abs(true), 10.0) if "offset" in name else abs(true)
        harmed |= error > HARM * scale or (value.stderr is not None and error > 2 * value.stderr)
    row["harmed"] += harmed
    row[":" + (found[0] if found else "-")] += 1
    if harmed and right:
        key = "right" if right & set(found[:1]) else "wrong" if found else "none"
        row[key] += 1
    elif found and not right & set(found):
        row["false"] += 1
    if "-v" in sys.argv:
        print(run.plant, harmed, found, sorted(codes))


NAMES = set().union(*plants.NAMES.values()) | {"asymmetry", "offset", "wrong_scale"}

if __name__ == "__main__":
    main()
