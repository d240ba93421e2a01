"""A robot's block bootstrap: its errors, its bits, and what it needs."""

import pickle
from pathlib import Path

import numpy as np
import pytest
from small_arm import recording, urdf

import jointid as jid
from jointid.balance.resampling import Cells, draws

pytest.importorskip("pinocchio")


@pytest.fixture(name="found", scope="module")
def _found(tmp_path_factory: pytest.TempPathFactory) -> jid.RobotEstimate:
    path = urdf(tmp_path_factory.mktemp("small"))
    run = recording(path, duration=30.0)
    return jid.identify_robot(run, jid.Robot.from_urdf(path), model="coulomb_viscous")


def test_white_noise_gives_the_reported_errors(found: jid.RobotEstimate) -> None:
    drawn = found.bootstrap(400)
    assert list(drawn.parameters) == list(found.parameters)
    assert drawn.samples.shape == (400, len(found.parameters))
    assert drawn.block == pytest.approx(1.0, rel=0.05)
    assert drawn.blocks == 30
    ratios = [p.ratio for p in drawn.parameters.values()]
    assert all(each is not None and 0.5 < each < 1.5 for each in ratios)
    assert np.median(np.array(ratios, dtype=float)) == pytest.approx(0.95, abs=0.2)
    assert "elbow.coulomb" in drawn.report()


def test_errors_are_widened_for_few_blocks(found: jid.RobotEstimate) -> None:
    """Four parameters of a joint, 30 blocks: the draws themselves are too narrow by the square root of 30 / 26."""
    drawn = found.bootstrap(400)
    moved = drawn.samples[:, list(drawn.parameters).index("elbow.coulomb")]
    low, high = np.quantile(moved, (0.158655, 0.841345))
    widened = drawn.parameters["elbow.coulomb"].stderr / (0.5 * (high - low))
    assert widened == pytest.approx(np.sqrt(30.0 / 26.0), rel=1e-3)


def test_a_seed_is_a_promise(found: jid.RobotEstimate) -> None:
    first, again, other = (found.bootstrap(30, seed) for seed in (1, 1, 2))
    assert first.samples.tobytes() == again.samples.tobytes()
    assert first.samples.tobytes() != other.samples.tobytes()


def test_all_joints_of_a_stretch_are_drawn_together(found: jid.RobotEstimate) -> None:
    """The elbow's torque acts on the shoulder: cells are stretches of time, whatever the joint."""
    source = found.draws
    assert source is not None
    names = list(found.parameters)
    coulomb = [names.index(f"{joint}.coulomb") for joint in ("shoulder", "elbow")]
    assert np.all(source.cells.square[:, coulomb, coulomb] > 0.0)
    np.testing.assert_allclose(
        np.einsum("ci->i", source.cells.gradient) + source.cells.sure_gradient, 0.0, atol=1e-5
    )


def test_what_is_known_beforehand_is_in_every_draw(tmp_path: Path) -> None:
    """At the estimate the data and the URDF's base parameters pull each other: no draw may lose either."""
    path = urdf(tmp_path)
    robot = jid.Robot.from_urdf(path)
    found = jid.identify_robot(recording(path), robot, inertia="free", model="coulomb_viscous")
    source = found.draws
    assert source is not None
    cells = source.cells
    assert cells.sure_gradient is not None
    pull = np.einsum("ci->i", cells.gradient)
    size = np.sqrt(np.einsum("cii->i", cells.square))
    np.testing.assert_allclose((pull + cells.sure_gradient) / size, 0.0, atol=1e-3)
    alone = np.median([p.stderr for p in found.bootstrap(50).parameters.values()])
    assert alone > 0.0
    certain = Cells(
        square=cells.square,
        gradient=cells.gradient,
        starts=cells.starts,
        sure_square=1e12 * np.diag(size**2),
        sure_gradient=cells.sure_gradient,
    )
    room = np.full(size.size, np.inf)
    assert np.abs(draws(certain, -room, room, 20, 0) * size).max() < 1e-3


def test_friction_stays_above_zero(tmp_path: Path) -> None:
    path = urdf(tmp_path)
    robot = jid.Robot.from_urdf(path)
    found = jid.identify_robot(recording(path, static=0.05), robot, model="stribeck")
    drawn = found.bootstrap(200)
    for name, p in drawn.parameters.items():
        if name.endswith((".static", ".coulomb", ".viscous", ".rotor_inertia")):
            column = drawn.samples[:, list(drawn.parameters).index(name)]
            assert column.min() >= 0.0, name
            assert p.interval[0] >= 0.0 or not p.near_bound


def test_a_number_that_is_none_is_refused(found: jid.RobotEstimate) -> None:
    for options, argument in (({"n": 1}, "n"), ({"seed": -1}, "seed")):
        with pytest.raises(jid.InputError) as caught:
            found.bootstrap(**options)
        assert caught.value.argument == argument


def test_a_copy_without_the_recordings_says_so(found: jid.RobotEstimate) -> None:
    copied = pickle.loads(pickle.dumps(found))
    assert copied.draws is None
    with pytest.raises(jid.InputError, match="read from a file"):
        copied.bootstrap()
