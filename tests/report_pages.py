"""One page of each kind of result, small ones; with names that a page must escape where asked."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import defects
import moving_joints
import pytest
import small_arm
from designs import designed
from example_recordings import WELL_EXCITED
from simulated_servo import Truth, bench_runs, servo_joint

import jointid as jid
from jointid.cli.demonstration import data_folder
from jointid.commissioning import Commissioning, commission
from jointid.hardware.bench.bench import Bench
from jointid.report.saving import report_page
from jointid.report.servo_page import servo_report

HOSTILE = "</title></svg><script>document.title = 'run'</script><img src=x onerror=\"document.title = 'run'\">'&"
_EXAMPLE = Path(__file__).resolve().parents[1] / "examples" / "hardware" / "joint.toml"


@cache
def good() -> jid.Recording:
    return jid.load(WELL_EXCITED)


def of_a_joint() -> str:
    joint = jid.Joint.load(data_folder() / "kr300_joint1.toml")
    return report_page(jid.identify(jid.load(data_folder() / "kr300_joint1.csv.gz"), joint))


def of_recordings() -> str:
    """With their signals, what was left out of them, and names that a page must escape."""
    named = [defects.changed(part, name=HOSTILE) for part in (good()[:5.0], good()[6.0:])]
    return report_page(jid.identify(named, jid.thesis_joint()), recordings=named)


def of_a_search() -> str:
    """With a convergence picture, and its joint named by somebody hostile."""
    rough = jid.GaOptions(population=20, generations=3, polish=False)
    joint = replace(jid.thesis_joint(), name=HOSTILE)
    named = defects.changed(good(), name=HOSTILE)
    return report_page(jid.identify(named, joint, search=jid.Search(ga=rough)))


def of_several_joints() -> str:
    motion = moving_joints.sines(2, 1)
    recording = moving_joints.recorded(motion, moving_joints.torques(motion, 1, unmodelled=1.0))
    return report_page(jid.identify_joints(recording))


def of_a_comparison() -> str:
    return report_page(jid.compare_models(good(), jid.thesis_joint(), folds=4))


def of_a_named_comparison() -> str:
    joint = replace(jid.thesis_joint(), name=HOSTILE)
    return report_page(jid.compare_models(good(), joint, models=["stribeck", "coulomb_viscous"]))


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


def of_a_servo() -> str:
    """With rollouts; the joint is named by somebody hostile."""
    runs = bench_runs(Truth(), seed=2)
    found = jid.identify_servo(runs, replace(servo_joint(), name=HOSTILE))
    return servo_report(found, rollout=jid.rollout(found, runs[:3]))


def of_a_study() -> str:
    return report_page(study())


def of_a_study_of_rows() -> str:
    """Settings that are no numbers, no truth, a hostile reason for a refused trial."""
    given = study()
    cells = tuple({"model": f"{HOSTILE} {number}"} for number in range(len(given.cells)))
    first = replace(given.rows[0], status="refused", message=HOSTILE, values={})
    rows = (first, *given.rows[1:-1])
    return report_page(replace(given, swept=("model",), cells=cells, truth={}, rows=rows))


def of_a_design() -> str:
    return report_page(designed(joint=replace(jid.thesis_joint(), name=HOSTILE)))


def of_a_refused_design() -> str:
    return report_page(designed(status="limits exceeded", reason=f"no motion keeps {HOSTILE}"))


@cache
def arm() -> tuple[jid.Robot, jid.RobotRecording]:
    pytest.importorskip("pinocchio")
    with TemporaryDirectory() as folder:
        path = small_arm.urdf(Path(folder))
        return jid.Robot.from_urdf(path), small_arm.recording(path, duration=8.0)


def of_a_robot() -> str:
    robot, recording = arm()
    found = jid.identify_robot(recording, replace(robot, name=HOSTILE), inertia="free")
    return report_page(found)


def of_a_robot_comparison() -> str:
    robot, recording = arm()
    return report_page(jid.compare_robot_models(recording, robot, folds=3))


@cache
def ring() -> Commissioning:
    """One cycle on an emulated drive."""
    return commission(Bench.load(_EXAMPLE), cycles=1, emulate=True, seed=1)


def of_a_session() -> str:
    return report_page(ring())


def of_a_stopped_session() -> str:
    """One run that a limit ended; what the drive says of itself is hostile."""
    first = ring().runs[0]
    told = dict(first.recording.metadata) | {"stop": HOSTILE, "drive": {HOSTILE: HOSTILE}}
    run = replace(first, recording=defects.changed(first.recording, metadata=told))
    return report_page(replace(ring(), runs=(run,), estimates=(), true_run=None))


PAGES: tuple[Callable[[], str], ...] = (
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
    *(of_a_session, of_a_stopped_session),
)


@cache
def page(make: Callable[[], str]) -> str:
    """Return a page, made once."""
    return make()
