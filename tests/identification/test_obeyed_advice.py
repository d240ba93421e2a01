"""Advice is tested by obeying it: each call that a finding advises is made, and nothing may get worse.

Real recordings are held to published or true values, simulated ones with defects to their truth.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest
from defective_logs import Case, names, simulated
from defects import DEFECTS
from obeyed_advice import obeyed

import jointid as jid
from jointid.app.call import Call
from jointid.base.advice import Action
from jointid.estimate.findings import Finding

# How much worse an error may get: this share, and what chance may do.
SMALL = 0.01
CHANCE = 2.0  # standard errors
FOUND = 0.1  # a parameter with a smaller error must not be lost
Truth = Mapping[str, float | tuple[float, float]]


def errors(estimate: jid.Estimate, truth: Truth) -> dict[str, float]:
    """Relative distance from each true value or range."""
    found = {}
    for name, true in truth.items():
        low, high = true if isinstance(true, tuple) else (true, true)
        if name in estimate.parameters:
            value = estimate.parameters[name].value
            found[name] = max(low - value, value - high, 0.0) / abs(0.5 * (low + high))
    return found


def by_chance(estimate: jid.Estimate, truth: Truth, name: str) -> float:
    """Relative standard error."""
    stderr = estimate.parameters[name].stderr
    return 0.0 if stderr is None else stderr / float(abs(np.mean(truth[name])))


def serious(estimate: jid.Estimate) -> list[Finding]:
    return [finding for finding in estimate.findings if finding.severity != "info"]


def shrinks(code: str, action: Action, before: jid.Estimate, after: jid.Estimate) -> bool:
    """Whether a finding is gone, is raised for less, has a smaller number, or advises something else."""
    first = [finding for finding in before.findings if finding.code == code]
    then = [finding for finding in after.findings if finding.code == code]
    if len(then) < len(first):
        return True
    if all(action not in finding.advice for finding in then):
        return True
    pairs = [(old, new) for old, new in zip(first, then, strict=False)]
    return any(
        abs(new.evidence[name].value) < abs(old.evidence[name].value)
        or len(new.parameters) < len(old.parameters)
        for old, new in pairs
        for name in old.evidence
        if name in new.evidence
    )


def complaints(call: Call, truth: Truth) -> list[str]:
    """What gets worse when any advice about a call is obeyed."""
    try:
        before = call.run()
    except jid.InputError:
        return []  # refused, which advises no call
    wrong = []
    for code, action, again in obeyed(call, before):
        advised_call = f"{code}: {action}"
        try:
            after = again.run()
        except jid.InputError as refused:
            wrong.append(f"{advised_call}: {refused}")
            continue
        old, new = errors(before, truth), errors(after, truth)
        for name, error in new.items():
            both = (before, after) if name in old else (after,)
            chance = max(by_chance(each, truth, name) for each in both)
            if error > old.get(name, np.inf) + SMALL + CHANCE * chance:
                wrong.append(f"{advised_call}: {name} off by {old[name]:.2%}, then by {error:.2%}")
        lost = [
            name
            for name, error in old.items()
            if name not in new and error + CHANCE * by_chance(before, truth, name) < FOUND
        ]
        wrong += [f"{advised_call}: {name} is lost" for name in lost]
        if not shrinks(code, action, before, after):
            wrong.append(f"{advised_call}: {code} stays")
        blocking = [found.code for found in after.findings if found.severity == "blocking"]
        had = {found.code for found in before.findings}
        wrong += [f"{advised_call}: {each} is new" for each in blocking if each not in had]
        if len(serious(after)) > len(serious(before)):
            codes = ", ".join(found.code for found in serious(after))
            wrong.append(f"{advised_call}: {len(serious(before))} findings become {codes}")
    return wrong


@pytest.fixture(scope="module")
def cases(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Case]:
    return simulated(tmp_path_factory.mktemp("logs"))


@pytest.mark.parametrize("name", list(names()))
def test_advice_about_a_defective_log_harms_nothing(cases: dict[str, Case], name: str) -> None:
    assert complaints(cases[name].call, cases[name].truth) == []


def test_advice_is_given_and_helps(cases: dict[str, Case]) -> None:
    """Obeyed until none is left, it mends what can be helped without looking at the hardware."""
    helped = {
        "sensor: degrees": "implausible_units",
        "no sensor: position in degrees": "implausible_units",
        "sensor: velocity scaled": "velocity_mismatch",
        "sensor: velocity late": "delay_removed",
        "no sensor: filtered": "delay_removed",
        "sensor: rippled": "ripple",
        "no sensor: no Stribeck effect": "model_too_rich",
        "sensor: few windows": "few_windows",
    }
    for name, code in helped.items():
        call, rounds = cases[name].call, 0
        estimate = call.run()
        assert code in {finding.code for finding in estimate.findings}, name
        while rounds < 5 and (advised := next(obeyed(call, estimate), None)) is not None:
            call, rounds = advised[2], rounds + 1
            estimate = call.run()
        assert serious(estimate) == [], name
        assert max(errors(estimate, cases[name].truth).values()) < 0.05, name


WELL_EXCITED = {
    "coulomb": 25.0,
    "static": 20.0,
    "stribeck": 100.0,
    "viscous": 20.0,
    "sensor_gain": 2.4,
    "sensor_offset": 15.0,
}


@pytest.mark.parametrize("defect", [None, *DEFECTS])
@pytest.mark.parametrize("joint", [jid.thesis_joint(), None], ids=["joint", "no joint"])
def test_advice_about_a_damaged_recording_harms_nothing(
    repo: Path, tmp_path: Path, defect: str | None, joint: jid.Joint | None
) -> None:
    file = repo / "examples" / "data" / "well_excited.csv.gz"
    if defect is not None:
        recording = DEFECTS[defect][0](jid.load(file))
        file = tmp_path / "damaged.npz"
        recording.save(file)
    assert complaints(Call(file=file, joint=joint), WELL_EXCITED) == []


# Ranges: the authors' nominal values and quick integral least squares.
KR300: Truth = {"viscous": (1820.0, 2050.0), "coulomb": (355.0, 389.0)}
EMPS: Truth = {
    "inertia": 95.1089,
    "viscous": 203.5034,
    "coulomb": 20.3935,
    "torque_offset": -3.1648,
}


@pytest.mark.parametrize(
    "model", [None, "coulomb_viscous", "stribeck", "coulomb_viscous:gravity=free"]
)
def test_advice_about_an_industrial_joint_harms_nothing(repo: Path, model: str | None) -> None:
    folder = repo / "examples" / "data"
    joint = jid.Joint.load(folder / "kr300_joint1.toml")
    call = Call(file=folder / "kr300_joint1.csv.gz", joint=joint, identify={"model": model})
    assert complaints(call, KR300) == []


SIMULATED = ("poorly_excited", "rippled", "realistic", "well_excited")


@pytest.mark.parametrize("name", SIMULATED)
@pytest.mark.parametrize("model", [None, "coulomb_viscous"])
def test_advice_about_an_independent_simulation_harms_nothing(
    shared_data: Path, name: str, model: str | None
) -> None:
    file = shared_data / "simulated" / f"{name}.csv.gz"
    call = Call(file=file, joint=jid.thesis_joint(), identify={"model": model})
    assert complaints(call, WELL_EXCITED) == []
    assert complaints(Call(file=file, identify={"model": model}), WELL_EXCITED) == []


@pytest.mark.parametrize("model", [None, "stribeck", "coulomb_viscous:asymmetric"])
def test_advice_about_emps_harms_nothing(emps: Path, model: str | None) -> None:
    call = Call(file=emps / "emps_train.csv.gz", identify={"model": model})
    assert complaints(call, EMPS) == []


# Output side, of Janot, Vandanjon and Gautier; ratios of the motors.
TX40 = {
    1: (32.0, {"viscous": 8.05, "coulomb": 7.14}),
    2: (32.0, {"viscous": 5.53, "coulomb": 8.26}),
    3: (45.0, {"viscous": 1.97, "coulomb": 6.34}),
    4: (-48.0, {"viscous": 1.11, "coulomb": 2.48}),
}


@pytest.mark.parametrize("number", list(TX40))
def test_advice_about_an_arm_harms_nothing(shared_data: Path, number: int) -> None:
    ratio, truth = TX40[number]
    position = f"motor_position_{number}_rad"
    columns = {"position": position, "motor_torque": f"motor_torque_{number}_Nm"}
    call = Call(
        file=shared_data / "tx40" / "tx40.csv.gz",
        joint=jid.Joint(gear_ratio=ratio),
        load={"columns": columns, "scale": {"position": 1.0 / ratio}},
        identify={"model": None if number == 1 else ":gravity=free"},
    )
    assert complaints(call, truth) == []


@pytest.mark.parametrize("name", ["swing_up", "energy_shaping"])
def test_advice_about_a_noisy_velocity_harms_nothing(shared_data: Path, name: str) -> None:
    file = shared_data / "ak80" / f"ak80_{name}.csv"
    assert complaints(Call(file=file, identify={"model": ":gravity=free"}), {}) == []
