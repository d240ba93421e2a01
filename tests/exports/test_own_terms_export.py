"""Own terms in exported files: those of the joint's own position are there, those of other signals are told."""

from __future__ import annotations

import functools
import re
from pathlib import Path

import numpy as np
import pytest
from exported_joints import LOADED
from test_static_maps import compiler, run_c

import jointid as jid
from jointid.exports.subject import subject_of

SWINGING = jid.Joint(
    name="swinging joint",
    gear_ratio=50.0,
    model=jid.Model("coulomb_viscous", terms={"position": "inertia_over(0.2)+torque_over(-0.1)"}),
).with_parameters(
    {
        "inertia": 2.0,
        "coulomb": 5.0,
        "viscous": 3.0,
        "inertia_cos_of_position": 0.6,
        "inertia_sin_of_position": 0.3,
        "torque_cos_of_position": 4.0,
        "torque_sin_of_position": -2.0,
    }
)


def own_torque(position: float, velocity: float, acceleration: float) -> tuple[float, float]:
    """What the two own terms add, from their definition: the torque, and that of the inertia."""
    turned, swung = position + 0.1, position - 0.2
    torque = 4.0 * (np.cos(turned) - 1.0) - 2.0 * np.sin(turned)
    inertia = 0.6 * (np.cos(swung) - 1.0) + 0.3 * np.sin(swung)
    slope = -0.6 * np.sin(swung) + 0.3 * np.cos(swung)
    return float(torque), float(inertia * acceleration + 0.5 * slope * velocity**2)


@functools.cache
def led() -> jid.Estimate:
    """An estimate with a signal that no exported file has."""
    time = np.arange(0.0, 8.0, 0.002)
    position = 0.8 * np.sin(1.1 * time) + 0.3 * np.sin(3.1 * time)
    velocity = 0.88 * np.cos(1.1 * time) + 0.93 * np.cos(3.1 * time)
    acceleration = -0.968 * np.sin(1.1 * time) - 2.883 * np.sin(3.1 * time)
    signal = np.cos(0.7 * time)
    torque = 2.0 * acceleration + 5.0 * np.sign(velocity) + 3.0 * velocity + 1.5 * signal
    torque += 0.05 * np.random.default_rng(0).standard_normal(len(time))
    recording = jid.Recording(time=time, position=position, torque=torque, extra={"cable": signal})
    return jid.identify(
        recording, model="coulomb_viscous", search="separable", terms={"cable": "scaled"}
    )


@pytest.mark.parametrize("ending", [".xml", ".urdf"])
def test_bodies_have_no_own_terms(tmp_path: Path, ending: str) -> None:
    path = tmp_path / f"joint{ending}"
    with pytest.raises(jid.InputError, match="only Coulomb and viscous friction") as refused:
        jid.export(led(), path)
    assert "the torque of other signals (cable=scaled; scale_of_cable = 1.5" in str(refused.value)
    time = np.arange(0.0, 8.0, 0.002)
    size = 1.5 * np.sqrt(np.mean(np.cos(0.7 * time) ** 2))
    told = re.search(r"\), ([\d.]+) N·m root mean square in the", str(refused.value))
    assert told is not None
    assert float(told[1]) == pytest.approx(size, rel=0.02)
    assert not path.exists()
    text = jid.export(led(), path, approximate=True).read_text(encoding="utf-8")
    assert "lost: the torque of other signals (cable=scaled" in text
    # The friction is not another one for it.
    assert repr(led().parameters["coulomb"].value) in text
    assert "least-squares" not in text


@pytest.mark.parametrize("ending", [".xml", ".urdf"])
def test_bodies_have_no_terms_over_the_position(tmp_path: Path, ending: str) -> None:
    path = tmp_path / f"joint{ending}"
    with pytest.raises(jid.InputError, match="would lose inertia over the joint's angle") as no:
        jid.export(SWINGING, path)
    assert "torque over the joint's angle (up to 8.472 N·m)" in str(no.value)
    assert "other signals" not in jid.export(SWINGING, path, approximate=True).read_text("utf-8")


def test_the_law_has_the_terms_over_the_position() -> None:
    law = subject_of(SWINGING).law
    position, velocity, acceleration = 0.7, -1.3, 2.1
    torque, inertia = own_torque(position, velocity, acceleration)
    assert law.position_torque(position)[0] == pytest.approx(torque)
    assert law.inertia_torque(position, velocity, acceleration) == pytest.approx(
        2.0 * acceleration + inertia
    )


@pytest.mark.parametrize("single", [False, True], ids=["double", "float"])
def test_the_c_header_has_them(tmp_path: Path, single: bool) -> None:
    compiler()
    wrong, values = run_c(tmp_path, SWINGING, single=single)
    assert wrong == 0
    from test_static_maps import MOTIONS

    torques = np.array([own_torque(p, v, 0.7) for p, v, _ in MOTIONS])
    friction = values[:, 0]
    np.testing.assert_allclose(values[:, 2], torques[:, 0], atol=1e-5)
    np.testing.assert_allclose(
        values[:, 5], 1.4 + friction + torques.sum(axis=1), rtol=1e-5, atol=1e-4
    )
    text = (tmp_path / "joint.h").read_text(encoding="ascii")
    assert "other signals" not in text


@pytest.mark.parametrize("whole", [False, pytest.param(True, marks=pytest.mark.slow)])
def test_structured_text_has_them(tmp_path: Path, whole: bool) -> None:
    """The block itself, and, which takes long to parse, that which checks it."""
    pytest.importorskip("blark")
    from structured_text_interpreter import Instance, function_blocks

    text = jid.export(SWINGING, tmp_path / "joint.st").read_text(encoding="ascii")
    end = len(text) if whole else text.index("END_FUNCTION_BLOCK") + 18
    blocks = function_blocks(text[:end])
    block, *checks = blocks
    assert len(checks) == whole
    ours = Instance(block, blocks)
    for position, velocity, acceleration in ((0.7, -1.3, 2.1), (-2.0, 0.4, -5.0)):
        torque, inertia = own_torque(position, velocity, acceleration)
        ours(position=position, velocity=velocity, acceleration=acceleration, load=0.0, width=0.0)
        assert ours["harmonics"] == pytest.approx(torque)
        wanted = 2.0 * acceleration + inertia + torque + ours["friction"]
        assert ours["torque"] == pytest.approx(wanted)
    for check in checks:
        checked = Instance(check, blocks)
        checked()
        assert checked["wrong"] == 0


def test_the_matlab_struct_has_them(tmp_path: Path) -> None:
    from scipy.io import loadmat

    path = jid.export(SWINGING, tmp_path / "joint.mat")
    struct = loadmat(path, simplify_cells=True)["swinging_joint"]
    assert struct["position_torque"]["centred"] == {"centre": -0.1, "cos": 4.0, "sin": -2.0}
    assert struct["position_inertia"] == {"centre": 0.2, "cos": 0.6, "sin": 0.3}
    assert not any("other signals" in line for line in struct["statements"])
    plain = loadmat(jid.export(LOADED, path), simplify_cells=True)["loaded_joint"]
    assert np.size(plain["position_inertia"]["cos"]) == 0


def test_a_controller_is_told_what_it_has_to_add(tmp_path: Path) -> None:
    text = jid.export(led(), tmp_path / "joint.st").read_text(encoding="ascii")
    assert "this file lacks the torque of other signals (cable=scaled" in text
    # Read from a file, an estimate knows the coefficients alone.
    again = jid.Estimate.from_json(led().to_json())
    text = jid.export(again, tmp_path / "again.st").read_text(encoding="ascii")
    assert "scale_of_cable = 1.5" in text
    assert "root mean square in" not in text


def test_a_term_without_its_centre_is_refused(tmp_path: Path) -> None:
    joint = SWINGING.replace(model=jid.Model("coulomb_viscous", terms={"position": "torque_over"}))
    with pytest.raises(jid.InputError, match="needs the centre"):
        jid.export(joint, tmp_path / "joint.h")
