"""The exported functions and tables have jointid's own values, each computed by its consumer."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from exported_joints import EVERYTHING, JOINTS, THESIS, shipped_estimate

import jointid as jid
from jointid import _core
from jointid.exports.identifiers import identifier

MOTIONS = [
    (position, velocity, load)
    for position, load in ((-2.3, 0.0), (0.4, -6.0), (3.0, 11.0))
    for velocity in (-3.0, -0.5, -0.04, -1e-9, 0.0, 1e-9, 0.003, 0.2, 1.5)
]


def expected(
    joint: jid.Joint, position: float, velocity: float, load: float, *, dry: bool = True
) -> tuple[float, ...]:
    """Friction, gravity, harmonics and ripple of a joint, from its own values and the core's basis functions.

    Not `dry`: only the friction that vanishes with the speed.
    """
    values = {name: p.value for name, p in joint.parameters.items() if p.value is not None}
    model = joint.model.resolved
    keys = list(_core.model_terms(model.name, asymmetric=model.asymmetric))
    keys += ["load_friction"] if model.load_friction else []
    friction = 0.0
    for key in keys:
        term = _core.term(key)
        if not dry and term.at_rest != 0.0:
            continue
        shapes = np.array([values[name] for name in term.shapes], dtype=np.float64)
        basis = _core.friction_basis(key, np.array([velocity]), shapes, load)[0]
        friction += values[term.name] * basis
    gravity = 0.0
    if model.gravity == "free":
        cos, sin = values["gravity_cos"], values["gravity_sin"]
        gravity = cos * np.cos(position) + sin * np.sin(position)
    elif joint.link is not None:
        link = joint.link
        weight = link.mass * link.gravity * link.centre_of_mass
        gravity = weight * np.cos(position + link.angle)
    around, motor = 0.0, joint.gear_ratio * position
    ripple = 0.0
    for order in model.harmonics:
        around += values[f"position_cos_{order:g}"] * np.cos(order * position)
        around += values[f"position_sin_{order:g}"] * np.sin(order * position)
    for order in model.ripple:
        ripple += values[f"ripple_cos_{order:g}"] * np.cos(order * motor)
        ripple += values[f"ripple_sin_{order:g}"] * np.sin(order * motor)
    return friction, gravity, around, ripple


def compiler() -> str:
    found = shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")
    if found is None:
        pytest.skip("there is no C compiler")
    return found


PROGRAM = """
#include <stdio.h>
#include "joint.h"
int main(void)
{{
    double position, velocity, load;
    while (scanf("%lf %lf %lf", &position, &velocity, &load) == 3) {{
        printf("%.17g %.17g %.17g %.17g %.17g %.17g %.17g\\n",
            (double){n}_friction(({n}_real)velocity, ({n}_real)load),
            (double){n}_gravity(({n}_real)position), (double){n}_harmonics(({n}_real)position),
            (double){n}_ripple(({n}_real)({u}_GEAR_RATIO * ({n}_real)position)),
            (double){n}_friction_smooth(({n}_real)velocity, ({n}_real)load, ({n}_real)0.05),
            (double){n}_torque(({n}_real)position, ({n}_real)velocity, ({n}_real)0.7, ({n}_real)load, ({n}_real)0.0),
            (double){n}_motor_torque(({n}_real)1.0));
    }}
    return {n}_self_check();
}}
"""
WARNINGS = ["-Wall", "-Wextra", "-Wpedantic", "-Werror", "-Wconversion", "-Wshadow"]
WARNINGS += ["-Wdouble-promotion", "-Wfloat-conversion", "-Wundef", "-Wstrict-prototypes"]


def run_c(folder: Path, joint: Any, *, single: bool = False, edit: str = "") -> tuple[int, Any]:
    """The exit code, which is what the header's own check returns, and the values at the motions."""
    cc = compiler()
    header = jid.export(joint, folder / "joint.h")
    if edit:
        text = header.read_text(encoding="ascii")
        assert edit in text
        header.write_text(text.replace(edit, edit[:-1] + " * 1.001)", 1), encoding="ascii")
    subject = joint.joint if isinstance(joint, jid.Estimate) else joint
    name = identifier(subject.name).lower()
    source, program = folder / "main.c", folder / "main"
    source.write_text(PROGRAM.format(n=name, u=name.upper()), encoding="ascii")
    options = ["-std=c99", *WARNINGS, *([f"-D{name.upper()}_USE_FLOAT"] if single else [])]
    subprocess.run([cc, *options, str(source), "-o", str(program), "-lm"], check=True, timeout=60)
    lines = "".join(f"{p!r} {v!r} {load!r}\n" for p, v, load in MOTIONS)
    done = subprocess.run([str(program)], input=lines, capture_output=True, text=True, timeout=60)
    return done.returncode, np.loadtxt(done.stdout.splitlines())


@pytest.mark.parametrize("single", [False, True], ids=["double", "float"])
@pytest.mark.parametrize("name", JOINTS)
def test_the_c_header_has_our_values(tmp_path: Path, name: str, single: bool) -> None:
    joint = JOINTS[name]
    wrong, values = run_c(tmp_path, joint, single=single)
    assert wrong == 0
    want = np.array([expected(joint, *motion) for motion in MOTIONS])
    tolerance = 3e-4 if single else 1e-9
    np.testing.assert_allclose(values[:, :4], want, rtol=tolerance, atol=tolerance)
    inertia = joint.known_inertia or 0.0
    inertia += joint.link_inertia if joint.sensor else 0.0
    offset = joint.parameters.get("torque_offset")
    constant = 0.7 * inertia + (0.0 if offset is None else offset.value or 0.0)
    np.testing.assert_allclose(
        values[:, 5], want.sum(axis=1) + constant, rtol=tolerance, atol=tolerance
    )
    np.testing.assert_allclose(values[:, 6], 1.0 / joint.gear_ratio, rtol=tolerance)
    # The smooth sign leaves no jump at rest, and the same friction at speed.
    speed = np.array([velocity for _, velocity, _ in MOTIONS])
    assert np.all(np.abs(values[np.abs(speed) <= 1e-9, 4]) < 1e-5)
    fast = np.abs(speed) >= 0.5
    np.testing.assert_allclose(values[fast, 4], values[fast, 0], rtol=max(tolerance, 1e-7))


def test_the_header_finds_a_changed_constant_by_itself(tmp_path: Path) -> None:
    """Its check must be able to fail."""
    assert run_c(tmp_path, THESIS, edit="THESIS_JOINT_VISCOUS ((thesis_joint_real)20.0)")[0] > 0


def test_the_header_of_an_estimate_is_its_friction_map(tmp_path: Path) -> None:
    estimate = shipped_estimate()
    wrong, values = run_c(tmp_path, estimate)
    assert wrong == 0
    velocity = np.array([velocity for _, velocity, _ in MOTIONS])
    np.testing.assert_allclose(values[:, 0], estimate.friction(velocity).torque, atol=1e-9)


def test_the_header_is_plain(tmp_path: Path) -> None:
    """No memory, no text, no letters that a compiler may not know, whatever the joint is called."""
    text = jid.export(EVERYTHING, tmp_path / "j.h").read_bytes()
    assert text.isascii()
    assert re.findall(rb"#include <(.*)>", text) == [b"math.h"]
    assert text.count(b"/*") == text.count(b"*/")
    assert b"//" not in text
    assert b"??" not in text


@pytest.mark.parametrize("name", JOINTS)
def test_structured_text_has_our_values(tmp_path: Path, name: str) -> None:
    """Parsed by blark, a parser of TwinCAT's language, and run from its tree."""
    pytest.importorskip("blark")
    from structured_text_interpreter import Instance, function_blocks

    joint = JOINTS[name]
    text = jid.export(joint, tmp_path / "joint.st").read_text(encoding="ascii")
    blocks = function_blocks(text[: text.index("END_FUNCTION_BLOCK") + 18])
    (block,) = blocks
    ours = Instance(block, blocks)
    for position, velocity, load in MOTIONS:
        friction, gravity, around, ripple = expected(joint, position, velocity, load)
        ours(position=position, velocity=velocity, load=load, acceleration=0.0, width=0.0)
        found = [ours[each] for each in ("friction", "gravity", "harmonics", "ripple")]
        np.testing.assert_allclose(found, [friction, gravity, around, ripple], atol=1e-9)
        assert ours["motor_torque"] * joint.gear_ratio == pytest.approx(ours["torque"])
        ours(width=0.05)
        # The part that vanishes with the speed is as it was.
        growing, _, _, _ = expected(joint, position, velocity, load, dry=False)
        dry = (friction - growing) * np.tanh(abs(velocity) / 0.05)
        assert ours["friction"] == pytest.approx(dry + growing, abs=1e-9)


@pytest.mark.parametrize(
    ("joint", "constant"),
    [
        (THESIS, "P_VISCOUS"),
        pytest.param(EVERYTHING, "P_VISCOUS_POSITIVE", marks=pytest.mark.slow),
    ],
    ids=["thesis", "everything"],
)
def test_structured_text_checks_itself(tmp_path: Path, joint: jid.Joint, constant: str) -> None:
    pytest.importorskip("blark")
    from structured_text_interpreter import Instance, function_blocks

    text = jid.export(joint, tmp_path / "joint.st").read_text(encoding="ascii")
    blocks = function_blocks(text)
    (name,) = (each for each in blocks if each.endswith("SelfCheck"))
    check = Instance(name, blocks)
    check()
    assert check["wrong"] == 0
    check["joint"].variables[constant] *= 1.001
    check()
    assert check["wrong"] > 0


def test_structured_text_is_plain(tmp_path: Path) -> None:
    text = jid.export(EVERYTHING, tmp_path / "j.st").read_bytes()
    assert text.isascii()
    assert text.count(b"(*") == text.count(b"*)")
    # A real number has a point, also before its exponent.
    assert not re.search(rb"(?<![\w.])\d+e", re.sub(rb"\(\*.*?\*\)", b"", text, flags=re.DOTALL))


@pytest.mark.parametrize("name", JOINTS)
def test_the_matlab_struct_has_our_values(tmp_path: Path, name: str) -> None:
    from scipy.io import loadmat

    joint = JOINTS[name]
    path = jid.export(joint, tmp_path / "joint.mat")
    ((key, struct),) = [
        (key, value)
        for key, value in loadmat(path, simplify_cells=True).items()
        if not key.startswith("__")
    ]
    assert key.isidentifier()
    for parameter in joint.parameters.values():
        (entry,) = [p for p in struct["parameters"].values() if p["name"] == parameter.name]
        assert entry["value"] == parameter.value
        assert np.isnan(entry["standard_error"])
    lookup = struct["friction"]
    assert np.all(np.diff(lookup["velocity"]) > 0.0)  # Simulink wants rising breakpoints
    for velocity, torque in zip(lookup["velocity"][::20], lookup["torque"][::20], strict=True):
        assert torque == pytest.approx(expected(joint, 0.0, velocity, 0.0)[0], abs=1e-9)
    side = lookup["negative"]
    assert side["torque"][5] == pytest.approx(
        -expected(joint, 0.0, -side["speed"][5], 0.0)[0], abs=1e-9
    )
    assert struct["gear_ratio"] == joint.gear_ratio
    assert np.size(struct["position_torque"]["ripple"]["order"]) == len(joint.model.resolved.ripple)
    if joint.sensor:
        assert struct["sensor"]["gain"] == 2.4
        assert struct["sensor"]["offset"] == 15.0


def test_the_matlab_struct_of_an_estimate_has_its_errors(tmp_path: Path) -> None:
    from scipy.io import loadmat

    estimate = shipped_estimate()
    struct = loadmat(jid.export(estimate, tmp_path / "j.mat"), simplify_cells=True)["thesis_joint"]
    for name in ("coulomb", "sensor_gain"):
        found, ours = struct["parameters"][name], estimate.parameters[name]
        assert found["value"] == ours.value
        assert found["standard_error"] == ours.stderr
        assert ours.interval is not None
        assert tuple(found["interval"]) == ours.interval
        assert found["unit"] == ours.unit
    assert struct["friction"]["velocity"][-1] == np.abs(estimate.windows.velocity).max()
    assert "well_excited" in struct["source"]
