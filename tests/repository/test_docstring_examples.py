"""Every example in a docstring runs, and prints what stands below it.

What an example takes for granted (a recording, a joint, an estimate, files by their names) is prepared here; an
example without anything below it may return what it likes.
"""

import contextlib
import doctest
import importlib
import inspect
import io
import re
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
import pandas as pd
import pytest
import simulated_servo
import small_arm

import jointid as jid
from jointid.cli.command_line import main as cli

matplotlib.use("Agg")
OPTIONS = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE | doctest.IGNORE_EXCEPTION_DETAIL


class _Checker(doctest.OutputChecker):
    def check_output(self, want: str, got: str, optionflags: int) -> bool:
        return not want or super().check_output(want, got, optionflags)


def _examples() -> Iterator[doctest.DocTest]:
    """Those of the sources that have any; what brings a browser's packages is not loaded for none."""
    finder = doctest.DocTestFinder(exclude_empty=True)
    seen: set[str] = set()
    package = Path(jid.__file__).parent
    for path in sorted(package.rglob("*.py")):
        if ">>>" not in path.read_text(encoding="utf-8"):
            continue
        parts = path.relative_to(package.parent).with_suffix("").parts
        name = ".".join(parts).removesuffix(".__init__")
        for test in finder.find(importlib.import_module(name), name):
            if test.examples and test.name not in seen:
                seen.add(test.name)
                yield test


EXAMPLES = [*_examples()]
# A first motion, a session, and what is read from one.
SLOW = {
    "jointid.hardware",
    "jointid.hardware.bench.frame_replay.replay",
    "jointid.hardware.proof.procedure.first_motion",
    "jointid.hardware.session.session.Session.run",
}


@pytest.mark.parametrize(
    "example",
    [
        pytest.param(each, id=each.name, marks=[pytest.mark.slow] if each.name in SLOW else [])
        for each in EXAMPLES
    ],
)
def test_an_example_runs(
    example: doctest.DocTest, prepared: dict[str, Any], workplace: Path
) -> None:
    del workplace
    example.globs = {
        **vars(inspect.getmodule(importlib.import_module(_module(example.name)))),
        **prepared,
    }
    said: list[str] = []
    runner = doctest.DocTestRunner(checker=_Checker(), verbose=False, optionflags=OPTIONS)
    runner.run(example, out=said.append)
    assert runner.failures == 0, "".join(said)


def test_every_public_name_has_an_example() -> None:
    """In its own docstring, in that of a method, or as `jid.NAME` in an example of what uses it."""
    lines = [line.source for each in EXAMPLES for line in each.examples if not _skipped(line)]
    used = set(re.findall(r"\bjid\.(\w+)", "\n".join(lines)))
    own = {part for each in EXAMPLES for part in each.name.split(".")[-2:]}
    assert {*jid._HOME_OF} - own - used == set()


def test_few_examples_are_skipped() -> None:
    """What needs the links of a robot, a log of messages, or prints what another computer may print otherwise."""
    skipped = [line.source for each in EXAMPLES for line in each.examples if _skipped(line)]
    assert len(skipped) <= 6, skipped


def _skipped(line: doctest.Example) -> bool:
    return bool(line.options.get(doctest.SKIP))


def _module(name: str) -> str:
    while True:
        try:
            importlib.import_module(name)
        except ImportError:
            name = name.rpartition(".")[0]
        else:
            return name


@pytest.fixture(scope="module")
def prepared(repo: Path) -> dict[str, Any]:
    """What examples speak of."""
    recording = jid.load(repo / "examples" / "data" / "well_excited.csv.gz")
    joint = jid.thesis_joint()
    estimate = jid.identify(recording, joint)
    bench = jid.hardware.Bench.load(repo / "examples" / "hardware" / "joint.toml")
    motion = jid.Trajectory.thesis(duration=6.0)
    before, after = (
        jid.simulate(estimate.joint, jid.Pd(stiffness=stiffness, damping=20.0), motion)
        for stiffness in (200.0, 400.0)
    )
    sizes = {"ga.population": [10, 20]}
    return {
        "jid": jid,
        "np": np,
        "io": io,
        "Path": Path,
        "recording": recording,
        "joint": joint,
        "known": _known(),
        "estimate": estimate,
        "bench": bench,
        "before": before,
        "after": after,
        "servo": simulated_servo.servo_joint(),
        "servo_runs": simulated_servo.bench_runs(simulated_servo.Truth(), seed=1),
        "study": jid.sweep(recording, joint, grid=sizes, trials=2),
    }


@pytest.fixture
def workplace(
    example: doctest.DocTest,
    prepared: dict[str, Any],
    repo: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> Iterator[Path]:
    """A folder with the files that the example names."""
    text = "".join(line.source for line in example.examples)
    for name, make in FILES.items():
        if f'"{name}"' in text:
            (tmp_path / name).parent.mkdir(exist_ok=True)
            make(tmp_path / name, prepared["recording"])
    if '"joint.toml"' in text:
        shutil.copy(repo / "examples" / "hardware" / "joint.toml", tmp_path)
    if '"arm.urdf"' in text:  # the log is then one of this arm
        pytest.importorskip("pinocchio")
        small_arm.recording(small_arm.urdf(tmp_path).rename(tmp_path / "arm.urdf")).save(
            tmp_path / "arm.csv"
        )
    if "examples/" in text:
        (tmp_path / "examples").symlink_to(repo / "examples")
    monkeypatch.chdir(tmp_path)
    with contextlib.ExitStack() as stack:
        if "Session(drive" in text:
            drive = jid.hardware.open_drive(prepared["bench"], emulate=True)
            prepared["drive"] = stack.enter_context(drive)
        yield tmp_path


def _table(path: Path, **columns: Any) -> None:
    pd.DataFrame(columns).to_csv(path, index=False)


def _arm(path: Path, run: jid.Recording) -> None:
    run = run[:3.0]
    six = {f"q_{k}": run.position for k in range(1, 7)} | {
        f"tau_{k}": run.torque for k in range(1, 7)
    }
    _table(path, time=run.time, **six)


def _weeks(path: Path, run: jid.Recording) -> None:
    numbers = np.repeat([1, 2], len(run) // 2)
    _table(path, time=run.time, position=run.position, torque=run.torque, run=numbers)


def _design(path: Path, _: jid.Recording) -> None:
    limits: Any = {"position": (-1.0, 1.0), "velocity": 3.4, "torque": 160.0}
    search = jid.DesignSearch(evaluations=64, joints=2, rehearsals=10)
    jid.design_excitation(_known(), limits, duration=4.0, search=search).save(path)


def _known() -> jid.Joint:
    values = {"coulomb": 25.0, "static": 20.0, "stribeck": 100.0, "viscous": 20.0}
    return jid.thesis_joint().with_parameters({**values, "sensor_gain": 2.4, "sensor_offset": 15.0})


def _logged(path: Path, _: jid.Recording) -> None:
    bench = Path(__file__).resolve().parents[2] / "examples" / "hardware" / "joint.toml"
    words = [
        "run",
        str(bench),
        "--emulate",
        "--cycles",
        "0",
        "--output",
        str(path.parent),
        "--quiet",
    ]
    assert cli(words) == 0


FILES: dict[str, Callable[[Path, jid.Recording], None]] = {
    "run.csv": lambda path, run: run.save(path),
    "log.csv": lambda path, run: _table(path, time=run.time, enc1=np.degrees(run.position)),
    "robot.csv": lambda path, run: _table(
        path, time=run.time, position=run.position, model_gravity_torque_1_Nm=run.position
    ),
    "arm.csv": _arm,
    "week.csv": _weeks,
    "motion.toml": _design,
    "runs/initial.log": _logged,
}
