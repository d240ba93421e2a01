"""What every exported file states, what is refused, and that a file is written whole or not at all."""

from __future__ import annotations

import dataclasses
import re
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest
from exported_joints import EVERYTHING, LOADED, THESIS, shipped_estimate

import jointid as jid
from jointid.estimate.findings import Finding
from jointid.exports import registry
from jointid.exports.identifiers import identifier
from jointid.exports.structured_text import literal
from jointid.joint.parameters import Parameter

TEXTS = [".xml", ".urdf", ".h", ".st"]


def text_of(source: Any, path: Path) -> str:
    written = jid.export(source, path, approximate=True).read_text(encoding="utf-8")
    return " ".join(re.sub(r"\n *\*? ?", " ", written).split())


@pytest.mark.parametrize("ending", TEXTS)
def test_a_file_states_where_its_numbers_come_from(tmp_path: Path, ending: str) -> None:
    estimate = shipped_estimate()
    text = text_of(estimate, tmp_path / f"joint{ending}")
    for said in (
        "Joint 'thesis joint', exported by jointid",
        "well_excited (cd4a7f544bdb11b8)",
        "on the output side of the gear",
        "Sign: a positive torque",
        "Gear ratio 101.0",
        "standard error 0.00509, 95 % interval 24.9938 to 25.0141",
    ):
        assert said in text, said
    for name in ("coulomb", "stribeck", "viscous"):
        assert repr(estimate.parameters[name].value) in text  # all digits


@pytest.mark.parametrize("ending", TEXTS)
def test_a_file_states_what_was_not_determined(tmp_path: Path, ending: str) -> None:
    estimate = shipped_estimate()
    weak = dataclasses.replace(
        estimate.parameters["static"], stderr=None, interval=None, at_bound="max"
    )
    doubtful = dataclasses.replace(estimate, parameters={**estimate.parameters, "static": weak})
    text = text_of(doubtful, tmp_path / f"joint{ending}")
    assert "The recording determines these values poorly or not at all: static." in text
    assert "held at its bound max" in text
    assert "poorly or not at all" not in text_of(estimate, tmp_path / f"other{ending}")
    # What the identification warns of keeps its error.
    finding = Finding(code="undetermined", parameters=("viscous",), title="one reversal")
    warned = text_of(dataclasses.replace(estimate, findings=(finding,)), tmp_path / f"w{ending}")
    assert "these values poorly or not at all: viscous." in warned
    assert "19.9932 to 20.0045, not well determined by the recording" in warned
    assert "undetermined (warning): one reversal" in warned
    # A joint file holds no uncertainty at all.
    assert "Values of unknown uncertainty: coulomb, static" in text_of(
        THESIS.replace(limits=jid.Limits(velocity=1.0)), tmp_path / f"third{ending}"
    )


def test_values_of_several_recordings_are_averaged_and_said_so(tmp_path: Path) -> None:
    estimate = shipped_estimate()
    parameters: dict[str, Any] = dict(estimate.parameters)
    coulomb = parameters.pop("coulomb")
    for number in (0, 1):
        name = f"coulomb[{number}]"
        parameters[name] = dataclasses.replace(coulomb, name=name, value=20.0 + 4.0 * number)
    text = text_of(dataclasses.replace(estimate, parameters=parameters), tmp_path / "j.h")
    assert "mean of 2 values, one for each recording, from 20 to 24" in text
    assert "_COULOMB ((thesis_joint_real)22.0)" in text


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ({"path": "joint.txt"}, ".xml, .urdf, .xacro, .h, .st or .mat"),
        ({"path": "joint"}, ".mat is expected"),
        ({"path": "joint.h", "target": "d"}, "it is unknown"),
        ({"path": 3}, "the name of a file"),
        ({"path": "joint.h", "speed": -1.0}, "more than 0"),
        ({"path": "joint.h", "speed": float("nan")}, "a finite number"),
        ({"path": "joint.h", "approximate": 1}, "true or false"),
        ({"path": "joint.h", "joint_name": "elbow"}, "names a joint in a file to edit"),
        ({"path": "joint.h", "into": "arm.urdf"}, "only mujoco and urdf files"),
        ({"path": "new.urdf", "into": "nothing.urdf"}, "cannot be read: No such file"),
        ({"path": "new.urdf", "into": "arm.urdf", "joint_name": "elbo"}, "did you mean 'elbow'"),
        ({"path": "new.urdf", "into": "arm.urdf"}, "choose one of elbow, wrist"),
        ({"path": "new.urdf", "into": "text.urdf", "joint_name": "elbow"}, "not XML"),
        ({"path": "new.urdf", "into": "wide.urdf", "joint_name": "elbow"}, "text in UTF-8"),
        ({"path": "new.urdf", "into": "entity.urdf", "joint_name": "elbow"}, "in entities"),
        ({"path": "new.urdf", "into": "twice.urdf", "joint_name": "elbow"}, "several joints"),
        ({"path": "new.urdf", "into": "empty.urdf", "joint_name": "elbow"}, "no parent and child"),
        (
            {"path": "new.xml", "into": "include.xml", "joint_name": "elbow"},
            "files that this file includes",
        ),
        ({"path": "missing/joint.h"}, "does not exist"),
    ],
)
def test_wrong_input_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, arguments: Mapping[str, Any], says: str
) -> None:
    monkeypatch.chdir(tmp_path)
    joint = '<joint name="{}" type="continuous"><parent link="a"/></joint>'
    arm = f"<robot>{joint.format('elbow')}{joint.format('wrist')}</robot>"
    Path("arm.urdf").write_text(arm, encoding="utf-8")
    Path("wide.urdf").write_text(f'<?xml version="1.0" encoding="utf-16"?>{arm}', encoding="utf-16")
    entity = f"<!DOCTYPE robot [<!ENTITY e '{joint.format('elbow')}'>]><robot>&e;</robot>"
    Path("entity.urdf").write_text(entity, encoding="utf-8")
    Path("text.urdf").write_text("no XML", encoding="utf-8")
    Path("twice.urdf").write_text(f"<robot>{joint.format('elbow') * 2}</robot>", encoding="utf-8")
    Path("empty.urdf").write_text('<robot><joint name="elbow" type="a"/></robot>', encoding="utf-8")
    Path("include.xml").write_text('<mujoco><include file="a.xml"/></mujoco>', encoding="utf-8")
    before = sorted(tmp_path.iterdir())
    with pytest.raises(jid.InputError) as refused:
        jid.export(LOADED, **arguments)
    assert says in str(refused.value)
    assert sorted(tmp_path.iterdir()) == before


def test_without_scipy_a_matlab_file_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("scipy", "scipy.io"):
        monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(jid.InputError) as refused:
        jid.export(LOADED, tmp_path / "joint.mat")
    assert str(refused.value) == (
        "a MATLAB file needs the package scipy, which is not installed; pip install scipy"
    )
    assert list(tmp_path.iterdir()) == []


def test_a_source_without_values_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "j.h"
    with pytest.raises(jid.InputError, match=r"parameters\.coulomb"):
        jid.export(jid.thesis_joint(), path)
    with pytest.raises(jid.InputError, match="an Estimate or Joint is expected"):
        jid.export("estimate.json", path)  # type: ignore[arg-type]
    assert not path.exists()


def test_a_model_that_moves_needs_an_inertia_that_can_be(tmp_path: Path) -> None:
    light = {"coulomb": 1.0, "viscous": 1.0}
    bare = jid.Joint(model=jid.Model("coulomb_viscous")).with_parameters(light)
    with pytest.raises(jid.InputError, match="inertia: a model for simulation needs"):
        jid.export(bare, tmp_path / "j.xml")
    jid.export(bare, tmp_path / "j.h")  # friction alone needs none
    contradicting = LOADED.replace(rotor_inertia=None).with_parameters({"inertia": 0.1})
    with pytest.raises(jid.InputError, match="must be at least the link's inertia"):
        jid.export(contradicting, tmp_path / "j.xml")
    thin = LOADED.replace(link=jid.Link(mass=2.5, centre_of_mass=0.5, inertia=0.1))
    with pytest.raises(jid.InputError, match="cannot be below mass"):
        jid.export(thin, tmp_path / "j.xml")


def test_negative_friction_is_refused_where_a_simulator_refuses_it(tmp_path: Path) -> None:
    joint = LOADED.with_parameters({"viscous": -0.1})
    with pytest.raises(jid.InputError, match=r"parameters.viscous is -0.1: mujoco has no negative"):
        jid.export(joint, tmp_path / "j.xml")
    jid.export(joint, tmp_path / "j.h")


def test_the_nearest_friction_needs_a_range_of_speeds(tmp_path: Path) -> None:
    with pytest.raises(jid.InputError, match="needs a range of speeds"):
        jid.export(THESIS, tmp_path / "j.xml", approximate=True)
    jid.export(THESIS, tmp_path / "j.xml", approximate=True, speed=0.5)


def test_a_folder_that_takes_no_file_leaves_the_old_one(tmp_path: Path) -> None:
    old = tmp_path / "joint.h"
    old.mkdir()
    with pytest.raises(OSError, match="folder"):
        jid.export(LOADED, old)
    assert list(tmp_path.iterdir()) == [old]


def test_the_list_has_every_target() -> None:
    folder = Path(registry.__file__).parent
    files = {
        path.stem
        for path in folder.glob("*.py")
        if re.search(r"^TARGET = ", path.read_text(encoding="utf-8"), re.MULTILINE)
    }
    assert files == set(registry.MODULES)
    endings = [ending for target in registry.TARGETS for ending in target.endings]
    assert len(endings) == len(set(endings))


@pytest.mark.parametrize(
    ("name", "wanted"),
    [("Joint 1 (left)", "Joint_1_left"), ("1", "joint_1"), ("ä*/", "a"), ("关节", "joint")],
)
def test_names_become_identifiers(name: str, wanted: str) -> None:
    assert identifier(name) == wanted


def test_numbers_of_structured_text() -> None:
    for value in (0.0, -1e-05, 1e300, 0.1, 25.0, 1.5e-7, -0.0):
        assert float(literal(value)) == value
        assert re.fullmatch(r"-?\d+\.\d+(e[-+]?\d+)?", literal(value))


def test_fixed_values_are_not_doubtful(tmp_path: Path) -> None:
    fixed = EVERYTHING.replace(
        parameters={
            name: Parameter(name=name, value=each.value, vary=False)
            for name, each in EVERYTHING.parameters.items()
        },
        limits=jid.Limits(velocity=1.0),
    )
    assert "Values of unknown uncertainty" not in text_of(fixed, tmp_path / "j.st")
