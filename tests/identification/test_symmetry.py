"""A sensor's offset and friction that differs between the directions share their doubt: no log divides them."""

from pathlib import Path

import pytest
from defects import changed
from example_recordings import WELL_EXCITED

import jointid as jid
from jointid.estimate.statistics import ParameterEstimate
from jointid.identification.warnings.undetermined import UNDETERMINED


def asymmetric(share: float) -> jid.Recording:
    """The example with so much more Coulomb friction forwards, and as much less backwards."""
    run = jid.load(WELL_EXCITED)
    assert run.torque is not None
    torque = run.torque + share * 25.0 * (run.velocity != 0.0)
    return changed(run, torque=torque)


def half_width(p: ParameterEstimate) -> float:
    assert p.interval is not None
    return 0.5 * (p.interval[1] - p.interval[0])


@pytest.mark.parametrize("share", [-0.09, 0.0, 0.04, 0.09])
def test_the_interval_holds_the_share_of_symmetry(share: float) -> None:
    """The true offset is 15 N·m; friction takes up to a tenth of 25 N·m of it."""
    found = jid.identify(asymmetric(share), jid.thesis_joint())
    offset = found.parameters["sensor_offset"]
    assert offset.interval is not None
    assert offset.interval[0] < 15.0 < offset.interval[1]
    assert half_width(offset) == pytest.approx(2.5, rel=0.01)
    assert offset.largest_part == "symmetry"
    assert half_width(found.parameters["coulomb"]) < 0.1  # the mean of both is what it was
    assert UNDETERMINED.code not in [each.code for each in found.findings]
    if share == 0.0:
        assert found.verdict.level == "usable"


def test_what_is_stated_or_measured_replaces_the_default() -> None:
    run, joint = asymmetric(0.0), jid.thesis_joint()
    sizes = []
    for tolerance in ("2 %", 1.0, "0 %"):
        stated = joint.replace(tolerances={"symmetry": tolerance})
        sizes.append(half_width(jid.identify(run, stated).parameters["sensor_offset"]))
    assert sizes[:2] == pytest.approx([0.5, 1.0], rel=0.02)
    assert sizes[2] < 0.05
    unloaded = jid.identify(run, joint, parameters={"sensor_offset": 15.0})
    assert all(
        "symmetry" not in p.systematic or not p.systematic["symmetry"]
        for p in unloaded.parameters.values()
    )
    each = jid.identify(run, joint, model=jid.Model("stribeck", asymmetric=True))
    assert "symmetry" not in each.parameters["sensor_offset"].systematic


def test_a_joint_file_keeps_it(tmp_path: Path) -> None:
    joint = jid.thesis_joint().replace(tolerances={"symmetry": "3 %"})
    path = tmp_path / "joint.toml"
    joint.save(path)
    assert jid.Joint.load(path).tolerances.symmetry == "3 %"
