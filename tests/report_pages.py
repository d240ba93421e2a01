"""One page of each kind of result, small ones; with names that a page must escape where asked."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import defects
import moving_joints
import numpy as np
import pytest
import small_arm
from designs import designed
from example_recordings import WELL_EXCITED
from online_feeding import fed
from simulated_servo import Truth, bench_runs, servo_joint

import jointid as jid
from jointid.base.result import Result
from jointid.cli.demonstration import data_folder
from jointid.commissioning import Commissioning, commission
from jointid.hardware.bench.bench import Bench
from jointid.report.saving import report_page

HOSTILE = "</title></svg><script>document.title = 'run'</script><img src=x onerror=\"document.title = 'run'\">'&"
_EXAMPLE = Path(__file__).resolve().parents[1] / "examples" / "hardware" / "joint.toml"


@dataclass(frozen=True, eq=False)
class Shown:
    """A result, and what its page takes besides."""

    result: Result
    recordings: Sequence[jid.Recording] | None = None
    rollout: jid.Rollout | None = None


@cache
def good() -> jid.Recording:
    return jid.load(WELL_EXCITED)


def of_a_joint() -> Shown:
    joint = jid.Joint.load(data_folder() / "kr300_joint1.toml")
    return Shown(jid.identify(jid.load(data_folder() / "kr300_joint1.csv.gz"), joint))


def of_recordings() -> Shown:
    """With their signals, what was left out of them, and names that a page must escape."""
    named = [defects.changed(part, name=HOSTILE) for part in (good()[:5.0], good()[6.0:])]
    return Shown(jid.identify(named, jid.thesis_joint()), recordings=named)


def of_a_search() -> Shown:
    """With a convergence picture, and its joint named by somebody hostile."""
    rough = jid.GaOptions(population=20, generations=3, polish=False)
    joint = replace(jid.thesis_joint(), name=HOSTILE)
    named = defects.changed(good(), name=HOSTILE)
    return Shown(jid.identify(named, joint, search=jid.Search(ga=rough)))


def of_several_joints() -> Shown:
    motion = moving_joints.sines(2, 1)
    recording = moving_joints.recorded(motion, moving_joints.torques(motion, 1, unmodelled=1.0))
    return Shown(jid.identify_joints(recording))


def of_a_comparison() -> Shown:
    return Shown(jid.compare_models(good(), jid.thesis_joint(), folds=4))


def of_a_named_comparison() -> Shown:
    joint = replace(jid.thesis_joint(), name=HOSTILE)
    return Shown(jid.compare_models(good(), joint, models=["stribeck", "coulomb_viscous"]))


@cache
def study() -> jid.Study:
    joint = jid.thesis_joint().with_parameters(
        {"coulomb": 25.0, "static": 20.0, "stribeck": 100.0, "viscous": 20.0}
        | {"sensor_gain": 2.4, "sensor_offset": 15.0}
    )
    return jid.sweep(
        good(),
        jid.thesis_joint(),
        grid={"windows": [50, 100, 200, 400], "model": ["stribeck", "coulomb_viscous"]},
        trials=3,
        search="separable",
        truth={name: p.value for name, p in joint.parameters.items() if p.value is not None},
    )


@cache
def servo() -> tuple[jid.ServoEstimate, list[jid.Recording]]:
    runs = bench_runs(Truth(), seed=2)
    return jid.identify_servo(runs, replace(servo_joint(), name=HOSTILE)), runs


def of_a_servo() -> Shown:
    """With rollouts; the joint is named by somebody hostile."""
    found, runs = servo()
    return Shown(found, rollout=jid.rollout(found, runs[:3]))


def of_a_rollout() -> Shown:
    found, runs = servo()
    return Shown(jid.rollout(found, runs[:1]))


def of_a_servo_comparison() -> Shown:
    found, runs = servo()
    errors = np.array([[0.1, 0.2], [0.01, 0.02]])
    return Shown(
        jid.ServoComparison(
            models=(HOSTILE, "coulomb_viscous:load_friction"),
            errors=errors,
            bistable=errors > 0.15,
            runs=tuple(run.name for run in runs[:2]),
            groups=("10", "20"),
            estimate=found,
        )
    )


@cache
def identified() -> jid.Estimate:
    return jid.identify(good()[:6.0], jid.thesis_joint(), windows=100)


def of_a_bootstrap() -> Shown:
    return Shown(identified().bootstrap(20))


def of_a_self_test() -> Shown:
    return Shown(identified().selftest(trials=1))


def of_causes() -> Shown:
    joint = jid.Joint.load(data_folder() / "kr300_joint1.toml")
    return Shown(jid.identify(jid.load(data_folder() / "kr300_joint1.csv.gz"), joint).causes())


def of_an_online_estimate() -> Shown:
    with jid.OnlineIdentifier(jid.thesis_joint(), window=3.0) as identifier:
        return Shown(fed(identifier, good()[:4.0], 1000))


def of_a_study() -> Shown:
    return Shown(study())


def of_a_study_of_rows() -> Shown:
    """Settings that are no numbers, no truth, a hostile reason for a refused trial."""
    given = study()
    cells = tuple({"model": f"{HOSTILE} {number}"} for number in range(len(given.cells)))
    first = replace(given.rows[0], status="refused", message=HOSTILE, values={})
    rows = (first, *given.rows[1:-1])
    return Shown(replace(given, swept=("model",), cells=cells, truth={}, rows=rows))


def of_a_design() -> Shown:
    return Shown(designed(joint=replace(jid.thesis_joint(), name=HOSTILE)))


def of_a_refused_design() -> Shown:
    return Shown(designed(status="limits exceeded", reason=f"no motion keeps {HOSTILE}"))


@cache
def arm() -> tuple[jid.Robot, jid.RobotRecording]:
    pytest.importorskip("pinocchio")
    with TemporaryDirectory() as folder:
        path = small_arm.urdf(Path(folder))
        return jid.Robot.from_urdf(path), small_arm.recording(path, duration=8.0)


def of_a_robot() -> Shown:
    robot, recording = arm()
    found = jid.identify_robot(recording, replace(robot, name=HOSTILE), inertia="free")
    return Shown(found)


def of_a_robot_comparison() -> Shown:
    robot, recording = arm()
    return Shown(jid.compare_robot_models(recording, robot, folds=3))


@cache
def ring() -> Commissioning:
    """Return one short cycle on an emulated drive."""
    short = jid.Trajectory.thesis(amplitude=1.0, cycle=3.0, duration=6.0)
    bench = replace(Bench.load(_EXAMPLE), trajectory=short)
    return commission(bench, cycles=1, emulate=True, seed=1)


def of_a_session() -> Shown:
    return Shown(ring())


def of_a_stopped_session() -> Shown:
    """One run that a limit ended; what the drive says of itself is hostile."""
    first = ring().runs[0]
    told = dict(first.recording.metadata) | {"stop": HOSTILE, "drive": {HOSTILE: HOSTILE}}
    run = replace(first, recording=defects.changed(first.recording, metadata=told))
    return Shown(replace(ring(), runs=(run,), estimates=(), true_run=None))


PAGES: tuple[Callable[[], Shown], ...] = (
    *(
        of_a_joint,
        of_recordings,
        of_a_search,
        of_several_joints,
        of_a_comparison,
        of_a_named_comparison,
    ),
    *(of_a_study, of_a_study_of_rows, of_a_design, of_a_refused_design),
    *(of_a_robot, of_a_robot_comparison, of_a_servo),
    *(of_a_session, of_a_stopped_session, of_a_rollout, of_a_servo_comparison),
    *(of_a_bootstrap, of_a_self_test, of_causes, of_an_online_estimate),
)


@cache
def shown(make: Callable[[], Shown]) -> Shown:
    """Return a result, made once."""
    return make()


@cache
def page(make: Callable[[], Shown], ending: str = ".html") -> str:
    """Return the page of a result, made once."""
    each = shown(make)
    return report_page(each.result, recordings=each.recordings, rollout=each.rollout, ending=ending)
