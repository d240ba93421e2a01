"""Units that no header states: proposed where SI would be impossible, and only there."""

import numpy as np
import pytest

import jointid as jid
from jointid.recording.plausible_units import proposed_units

TIME = np.arange(0.0, 6.0, 0.002)
ANGLE = 0.9 * np.sin(1.9 * TIME)  # [rad]
RATE = np.gradient(ANGLE, TIME)
UNSTATED = ("position", "velocity", "torque")
FACTORS = {"rad": 1.0, "deg": 180 / np.pi, "rad_s": 1.0, "deg_s": 180 / np.pi}
FACTORS |= {"rpm": 30 / np.pi, "rev_s": 0.5 / np.pi}


def read(
    angle: str, speed: str | None, *, unstated: tuple[str, ...] = UNSTATED, torque: float = 1.0
) -> dict[str, str]:
    velocity = None if speed is None else RATE * FACTORS[speed]
    recording = jid.Recording(
        time=TIME,
        position=ANGLE * FACTORS[angle],
        velocity=velocity,
        torque=torque * np.sign(RATE),
        metadata={"assumed_units": list(unstated)},
    )
    return {signal: proposed.unit for signal, proposed in proposed_units(recording).items()}


@pytest.mark.parametrize(
    ("angle", "speed", "units"),
    [
        ("rad", "rad_s", {}),
        ("rad", None, {}),
        ("deg", None, {"position": "deg"}),
        ("deg", "deg_s", {"position": "deg", "velocity": "deg_s"}),
        ("rad", "deg_s", {"velocity": "deg_s"}),
        ("rad", "rpm", {"velocity": "rpm"}),
        ("rad", "rev_s", {"velocity": "rev_s"}),
        ("deg", "rad_s", {"position": "deg"}),
        ("deg", "rpm", {"position": "deg", "velocity": "rpm"}),
        ("deg", "rev_s", {"position": "deg", "velocity": "rev_s"}),
    ],
)
def test_the_pair_that_agrees(angle: str, speed: str | None, units: dict[str, str]) -> None:
    assert read(angle, speed) == units


@pytest.mark.parametrize(
    ("angle", "speed", "unstated", "units"),
    [
        ("deg", "deg_s", ("velocity",), {}),
        ("rad", "rpm", ("velocity",), {"velocity": "rpm"}),
        ("deg", "rad_s", ("position",), {"position": "deg"}),
        ("deg", "rad_s", (), {}),
    ],
)
def test_a_stated_unit_stays(
    angle: str, speed: str, unstated: tuple[str, ...], units: dict[str, str]
) -> None:
    assert read(angle, speed, unstated=unstated) == units


def test_a_torque_beyond_any_joint() -> None:
    assert read("rad", "rad_s", torque=20_000.0) == {"torque": "mNm"}
    assert read("rad", "rad_s", torque=2_000.0) == {}
    assert read("rad", "rad_s", torque=20_000.0, unstated=("position",)) == {}
